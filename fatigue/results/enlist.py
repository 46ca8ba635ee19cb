"""Documents that are written into a result folder one by one, as from a notebook, are listed with its outputs."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from fatigue.results.belonging import DOCUMENTS, listed_of, write_list
from fatigue.results.lock import locked
from fatigue.results.outputs import recorded
from fatigue.results.provenance import hashes_on_record, read_provenance, write_provenance
from fatigue.results.publish import publish, staging_in


def enlist(folder: Path, *documents: Path) -> None:
    """Add documents just written to the list of the result folder they are in, and to its provenance.

    Raises
    ------
    DataError : another run is writing to the folder, or its record was changed
    """
    with locked(folder), staging_in(folder) as staging:
        relist(folder, staging, documents)
        publish(staging, folder)


def relist(folder: Path, staging: Path, written: Iterable[Path], said: Mapping[str, Any] | None = None) -> None:
    """Write to ``staging`` what a result folder says of its outputs once files just written are among them.

    ``said`` are entries of the provenance about them.
    """
    record = read_provenance(folder) | dict(said or {})
    result, new = record.get("result", ""), list(written)
    if documents := [path for path in new if path.name in DOCUMENTS]:
        new.append(write_list(staging, documents, result, listed_of(folder, result)))
    if hashes_on_record(record) is not None:  # an older result stays without
        write_provenance(staging, recorded(record, new))
