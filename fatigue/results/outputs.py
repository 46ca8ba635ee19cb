"""Hashes of what a result consists of: recorded as files are written, compared before they are read.

``provenance.json`` lists every file of a result with its size and SHA-256, but for itself and the log. A file that was
damaged or edited is found before any number of it is shown. Files of another size are not read for it; of the others
some 1 GB a second is hashed, and only those that a command is about to read.
"""

import logging
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, FatigueError, Problem
from fatigue.files.hashes import sha256
from fatigue.results.provenance import PROVENANCE, hashes_on_record, input_register, parsed_provenance

log = logging.getLogger(__name__)


def recorded(record: Mapping[str, Any], paths: Iterable[Path]) -> dict[str, Any]:
    """Record of a result with the hashes of files just written, in place of those of earlier files of these names."""
    before = record.get("outputs", []) if hashes_on_record(record) is not None else []
    entries = {entry["file"]: entry for entry in before}
    entries |= {path.name: input_register([path], path.parent)[0] for path in paths}
    return dict(record) | {"outputs": [entries[name] for name in sorted(entries)]}


def altered(folder: Path, record: Mapping[str, Any], names: Iterable[str]) -> dict[str, str]:
    """What is wrong with files of a result, by name: those that are not as they were written, or not on record.

    Files that are neither there nor on record are left out, and all of them for an older result without hashes.
    """
    if hashes_on_record(record) is None:
        return {}
    known = {entry["file"]: entry for entry in record["outputs"]}
    looked_at = [name for name in names if name in known or (folder / name).exists()]
    found = {name: _alteration(folder / name, known.get(name)) for name in looked_at}
    return {name: what for name, what in found.items() if what}


@contextmanager
def damage_told(folder: Path) -> Iterator[None]:
    """Warn of an older result, one without hashes, and take what cannot be made sense of in it for damage.

    Raises
    ------
    DataError : reading or showing such a result failed
    """
    record = parsed_provenance(folder)
    if hashes_on_record(record) is not None:  # as it was written: whatever fails, the program is at fault
        yield
        return
    what = "no hashes on record, as an older version wrote it: nothing tells whether its tables are as written"
    log.warning("%s", Problem("no_hashes", str(folder / PROVENANCE), what, "Assess again to have them"))
    try:
        yield
    except (FatigueError, OSError, MemoryError):
        raise
    except Exception as error:
        why = f"{type(error).__name__}: {error}".splitlines()[0][:200]
        what = f"holds what does not fit together ({why})"
        raise DataError(Problem("damaged_result", str(folder), what, "Run the assessment again")) from error


def _alteration(path: Path, known: Mapping[str, Any] | None) -> str:
    """How a file differs from what is on record of it; empty where it does not."""
    if known is None:
        return f"is not among the outputs that {PROVENANCE} lists"
    if not path.is_file():
        return "is no file" if path.exists() else f"no such result table, though {PROVENANCE} lists it"
    try:
        size, on_record = path.stat().st_size, str(known["sha256"])
        if size != known["bytes"]:
            return f"was changed since it was written: it has {size} bytes, {PROVENANCE} has {known['bytes']}"
        if (found := sha256(path)) == on_record:
            return ""
    except OSError as error:
        return f"cannot be read ({error.strerror})"
    return f"was changed since it was written: its SHA-256 begins with {found[:12]}, {PROVENANCE} has {on_record[:12]}"
