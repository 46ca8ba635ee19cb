"""The result folder on disk: whose files are in it, the log, and how a finished result gets there."""

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.results import DIAGNOSED, TABLES, read_provenance

LAST = "provenance.json"  # a folder without it holds no finished result
OUTPUTS = (*(f"{table}.parquet" for table in TABLES), "weld_lines.vtp", "report.html", "fatigue.log", LAST)


def refuse_foreign(folder: Path, *, force: bool) -> None:
    """Refuse to overwrite files that fatigue did not write.

    A folder is ours when it holds a finished result or the state of an interrupted run; in any other folder no file may
    have the name of a result.

    Raises
    ------
    DataError : the folder is a file, or holds foreign files of such a name and ``force`` is not given
    """
    if folder.exists() and not folder.is_dir():
        raise DataError(Problem("not_a_folder", str(folder), "is a file, not a folder", "Give another folder with -o"))
    foreign = [name for name in OUTPUTS if (folder / name).exists()]
    if foreign and not force and not _is_ours(folder):
        raise DataError(
            Problem(
                "foreign_files",
                str(folder / foreign[0]),
                "is there already and was not written by fatigue",
                "Give another folder with -o, or --force to overwrite it",
            )
        )


def _is_ours(folder: Path) -> bool:
    if (folder / ".fatigue-state").is_dir():
        return True
    try:
        read_provenance(folder)
    except DataError:
        return False
    return True


@contextmanager
def result_log(folder: Path) -> Iterator[None]:
    """Write what the run does to ``fatigue.log`` in the result folder."""
    handler = logging.FileHandler(folder / "fatigue.log", mode="a", encoding="utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    handler.setLevel(logging.INFO)
    program = logging.getLogger("fatigue")
    level = program.level
    program.setLevel(logging.INFO)
    program.addHandler(handler)
    try:
        yield
    finally:
        program.setLevel(level)
        program.removeHandler(handler)
        handler.close()


def publish(finished: Path, folder: Path) -> None:
    """Move a finished assessment into the result folder and remove what an earlier one left of a diagnosis."""
    (folder / LAST).unlink(missing_ok=True)
    for table in DIAGNOSED:
        (folder / f"{table}.parquet").unlink(missing_ok=True)
    move(finished, folder)


def move(finished: Path, folder: Path) -> None:
    """Force finished files to disk and move them, provenance last, so that a half-moved result never looks whole."""
    files = sorted(finished.iterdir(), key=lambda path: (path.name == LAST, path.name))
    for path in files:
        with path.open("rb+") as file:
            os.fsync(file.fileno())
    for path in files:
        path.replace(folder / path.name)
