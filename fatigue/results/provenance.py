"""What a result rests on: its record, the hashes of its inputs, the versions of the software.

A file beside the record, in the format of ``sha256sum``, has the hash of the record and of everything the record lists,
so that ``sha256sum -c`` checks a folder without this program.
"""

import hashlib
import json
import platform
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, get_args

from fatigue import __version__
from fatigue.errors import DataError, Problem, given_path
from fatigue.files.hashes import sha256
from fatigue.results.json_records import write_json

PROVENANCE = "provenance.json"  # a folder without it holds no finished result
CHECKSUMS = "provenance.json.sha256"  # of the record and of the outputs it lists
JOURNAL = ".fatigue-publish"  # says that a finished result is being put in place, see `fatigue.results.publish`

AddedKey = Literal[
    "diagnosis", "identity", "load_spectra", "ride", "shift_study"
]  # of the record: what is said of added tables
WRITTEN_LATER = ("outputs", *get_args(AddedKey))  # keys that change after the assessment, the result staying the same

PUT_BACK = "Put the file back as it was, or run the assessment again with --force"


def read_provenance(folder: Path | str) -> dict[str, Any]:
    """Read ``provenance.json`` of a result folder and compare it with its hash.

    Raises
    ------
    DataError : the folder holds no finished result, or the record was changed or damaged since it was written
    """
    folder = given_path(folder, "folder")
    path, content = folder / PROVENANCE, _content(folder)
    known, found = _known_hash(folder), hashlib.sha256(content).hexdigest()
    if known not in (None, found):
        what = f"was changed or damaged since it was written: its SHA-256 begins with {found[:12]}, {CHECKSUMS} has "
        raise DataError(Problem("damaged_result", str(path), f"{what}{str(known)[:12]}", PUT_BACK))
    record = _parsed(path, content)
    if known is None and hashes_on_record(record) is not None:
        what = "is missing, so that nothing tells whether provenance.json is as it was written"
        raise DataError(Problem("damaged_result", str(folder / CHECKSUMS), what, PUT_BACK))
    return record


def parsed_provenance(folder: Path) -> dict[str, Any]:
    """Record of a result folder as it stands there, perhaps changed since it was written.

    Raises
    ------
    DataError : the folder holds no finished result, or the record is none
    """
    return _parsed(folder / PROVENANCE, _content(folder))


def upsampling_factors(record: Mapping[str, Any]) -> list[int]:
    """Factor by which the record of each event of a result was upsampled before it was counted, in their order."""
    rules, events = record["rules"], [event["event"] for event in record["mission"]["events"]]
    given = rules["upsample"] if isinstance(rules["upsample"], int) else 1
    return [int(rules.get("upsampled", {}).get(event, given)) for event in events]


def _content(folder: Path) -> bytes:
    try:
        return (folder / PROVENANCE).read_bytes()
    except FileNotFoundError:
        what, remedy = "no finished result in this folder", "Run `fatigue assess CASE -o DIR` first and give its DIR"
        if (folder / JOURNAL).exists():
            what = "no finished result in this folder: a new one was being put in place when the program was stopped"
            remedy = "Run the same `fatigue assess` again, or `fatigue show`, which completes it"
        raise DataError(Problem("no_result", str(folder), what, remedy)) from None
    except OSError as error:
        what = f"cannot be read ({error.strerror})"
        raise DataError(Problem("damaged_result", str(folder / PROVENANCE), what, PUT_BACK)) from None


def _parsed(path: Path, content: bytes) -> dict[str, Any]:
    try:
        record = json.loads(content.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        why = "it is nested too deeply" if isinstance(error, RecursionError) else str(error).splitlines()[0]
        raise DataError(Problem("damaged_result", str(path), f"cannot be read ({why})", PUT_BACK)) from None
    if not isinstance(record, dict) or record.get("program") != "fatigue":
        raise DataError(
            Problem("no_result", str(path), "was not written by fatigue", "Give a folder that `fatigue assess` wrote")
        )
    return record


def write_provenance(folder: Path, record: Mapping[str, Any]) -> None:
    """Write ``provenance.json`` and, in the format of ``sha256sum``, its hash and those of the outputs it lists."""
    write_json(folder / PROVENANCE, record)
    hashes = {PROVENANCE: sha256(folder / PROVENANCE)} | (hashes_on_record(record) or {})
    lines = [f"{digits}  {name}\n" for name, digits in hashes.items()]
    (folder / CHECKSUMS).write_text("".join(lines), encoding="utf-8", newline="\n")


def hashes_on_record(record: Mapping[str, Any]) -> dict[str, str] | None:
    """SHA-256 of every output by its name; None in the record of an older result, which has names only."""
    outputs = record.get("outputs")
    if not (isinstance(outputs, list) and outputs and all(isinstance(entry, dict) for entry in outputs)):
        return None
    return {str(entry.get("file")): str(entry.get("sha256")) for entry in outputs}


def is_same_result(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Whether two records are of one result, though more of it may have been written in between."""
    later = dict.fromkeys(WRITTEN_LATER)
    return {**one, **later} == {**other, **later}


def refuse_another(folder: Path, record: Mapping[str, Any]) -> None:
    """Refuse a locked folder whose result is no longer that of ``record``, which was read before.

    Raises
    ------
    DataError : another run has replaced the result
    """
    if not is_same_result(read_provenance(folder), record):
        what = "the result was replaced by another run just now"
        raise DataError(Problem("other_result", str(folder), what, "Give the same command again"))


def _known_hash(folder: Path) -> str | None:
    """SHA-256 of the record as it was written; None where no file tells it.

    Raises
    ------
    DataError : the file that tells it cannot be read, or does not tell it
    """
    path = folder / CHECKSUMS
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as error:
        what = f"cannot be read ({getattr(error, 'strerror', None) or 'it is no text'})"
        raise DataError(Problem("damaged_result", str(path), what, PUT_BACK)) from None
    for line in lines:
        digits, _, name = line.partition(" ")
        if name.lstrip(" *") == PROVENANCE:
            return digits.lower()
    what = "does not tell the SHA-256 of provenance.json"
    raise DataError(Problem("damaged_result", str(path), what, PUT_BACK))


def input_register(paths: Sequence[Path], root: Path) -> list[dict[str, Any]]:
    """Name, size and SHA-256 of every input file, so that a result can be traced to its inputs."""
    return [{"file": _relative(path, root), "bytes": path.stat().st_size, "sha256": sha256(path)} for path in paths]


def software_versions() -> dict[str, str]:
    """Versions of the program and of what its numbers rest on."""
    from importlib.metadata import PackageNotFoundError, version  # noqa: PLC0415 - who only reads needs none of it

    packages = ("numpy", "scipy", "numba", "pyarrow", "pandas", "rainflow")
    found = {"fatigue": __version__, "python": platform.python_version()}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:  # an optional peer that is not installed has no say in the numbers
            continue
    return found


def _relative(path: Path, root: Path) -> str:
    """Name a file as its case does, ``root / name`` is where it is: also through links and from another folder."""
    for path_there, root_there in ((path, root), (path.resolve(), root.resolve())):
        if path_there.is_relative_to(root_there):
            return path_there.relative_to(root_there).as_posix()
    return path.as_posix()  # an input elsewhere on the disk keeps its full path


def curves_of_status(record: Mapping[str, Any], status: str) -> list[str]:
    """Names of the curves of a result whose numbers rest on that: see ``curve_status`` of ``welds.parquet``."""
    return [name for name, curve in record["curves"].items() if curve.get("status") == status]
