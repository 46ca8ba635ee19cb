"""A folder that a command fills: what its record lists as it is may be replaced, and nothing of somebody else."""

import json
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing

ELSEWHERE = "Give another folder with -o"
AWAY = f"Move it away, or --force to overwrite it. {ELSEWHERE}"


@dataclass(frozen=True, slots=True)
class Filled:
    """What a command leaves in a folder: the names of all its ``files`` but the record, and the name of this.

    The record is JSON with ``program`` and ``outputs``, the SHA-256 of every file by name. ``what`` says what a file is
    part of, as in "a file of the basis".
    """

    program: str
    what: str
    record: str
    files: tuple[str, ...]

    def outputs(self, folder: Path) -> dict[str, str] | None:
        """SHA-256 of what the record of an earlier run lists, by name; None where there is no such record."""
        try:
            record = json.loads((folder / self.record).read_text(encoding="utf-8"))
            return dict(record["outputs"]) if record["program"] == self.program else None
        except (OSError, ValueError, LookupError, TypeError, RecursionError):
            return None


def refuse_foreign(
    folder: Path, filled: Filled, *, force: bool, inputs: Collection[Path], editable: Collection[str] = ()
) -> None:
    """Refuse to overwrite or remove what the command did not write as it is, and any of its inputs.

    ``editable`` are files that may have been changed since.

    Raises
    ------
    DataError : everything in the way; with ``force`` only folders and inputs are
    """
    refuse(DataError, in_the_way(folder, filled, force=force, inputs=inputs, editable=editable))


def in_the_way(
    folder: Path, filled: Filled, *, force: bool, inputs: Collection[Path], editable: Collection[str] = ()
) -> Iterator[Problem]:
    """What ``refuse_foreign`` refuses, for a command that fills more than files of known names."""
    if folder.exists() and not folder.is_dir():
        yield Problem("not_a_folder", str(folder), "is a file, not a folder", ELSEWHERE)
        return
    known = filled.outputs(folder)
    for path in (folder / name for name in (*filled.files, filled.record)):
        if not path.exists():
            continue
        if path.is_dir():
            what = f"is a folder where a file of the {filled.what} has its place"
            yield Problem("foreign_files", str(path), what, "Move it away")
        elif any(one.exists() and path.samefile(one) for one in inputs):
            yield Problem("input_in_the_way", str(path), f"is an input of this {filled.what}", ELSEWHERE)
        elif not force and not _is_ours(path, known, filled, editable):
            what = f"is there already and was not written by {filled.program}, or was changed since"
            yield Problem("foreign_files", str(path), what, AWAY)


def _is_ours(path: Path, known: dict[str, str] | None, filled: Filled, editable: Collection[str]) -> bool:
    """Whether an earlier run wrote a file as it is, or wrote it and lets it be edited."""
    if known is None:
        return False
    return (
        path.name == filled.record
        or (path.name in known and path.name in editable)
        or (known.get(path.name) == sha256(path))
    )


def put_in_place(stage: Path, folder: Path, filled: Filled, outputs: Iterable[str], kept: Collection[str] = ()) -> None:
    """Move ``outputs`` and the record from a stage into the folder; what else an earlier run left there is removed.

    ``kept`` are files that stay as they are.

    Raises
    ------
    DataError : the place cannot be written
    """
    names = tuple(outputs)
    with refused_writing(folder):
        for name in filled.files:
            if name not in names and name not in kept:
                (folder / name).unlink(missing_ok=True)
        for name in (*names, filled.record):
            (stage / name).replace(folder / name)
