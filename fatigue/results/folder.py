"""The result folder on disk: whose files are in it, the log, and how a finished result gets there."""

import json
import logging
import os
import shutil
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, Problem, refuse
from fatigue.results.belonging import DOCUMENTS, LIST, is_derived
from fatigue.results.columns import TABLES
from fatigue.results.origin import case_of, is_same_case, way_to_case
from fatigue.results.store import JOURNAL, read_provenance

LAST = "provenance.json"  # a folder without it holds no finished result
LOG = "fatigue.log"
OUTPUTS = (*(f"{table}.parquet" for table in TABLES), "weld_lines.vtp", "report.html", LIST, LOG, LAST)
DERIVED = tuple(dict.fromkeys((*(f"{table}.parquet" for table in TABLES), *DOCUMENTS, LIST)))
STATE = ".fatigue-state"  # of an interrupted run
STAGING = ".fatigue-staging"
_CASE_OF_STATE = "case"


def refuse_foreign(folder: Path, *, force: bool, case_file: Path | None = None, inputs: Collection[Path] = ()) -> None:
    """Refuse to overwrite or remove what is not this case's own: files of others, inputs, the result of another case.

    Parameters
    ----------
    force : replace them all the same, inputs excepted
    case_file : the case that is to be assessed
    inputs : its input files

    Raises
    ------
    DataError : all that is in the way
    """
    if folder.exists() and not folder.is_dir():
        raise DataError(Problem("not_a_folder", str(folder), "is a file, not a folder", "Give another folder with -o"))
    another = "Give another folder with -o"
    ours = {path for path in (folder / name for name in OUTPUTS) if path.exists() and _is_one_of(path, inputs)}
    refuse(
        DataError,
        [Problem("input_in_the_way", str(path), "is an input of this case", another) for path in sorted(ours)],
    )
    if force:
        return
    record = _record_in(folder)
    if case_file is not None:
        refuse(DataError, _other_case(folder, record, case_file))
    has_state = (folder / STATE).is_dir()
    problems = []
    for name in (*DERIVED, LOG, LAST):
        path = folder / name
        if not path.exists() or _is_one_of(path, inputs):
            continue
        if name in (LOG, LAST) and (record is not None or has_state):
            continue
        if not is_derived(folder, name, record):
            what = "is there already and was not written by fatigue, or was changed since"
            problems.append(
                Problem("foreign_files", str(path), what, f"Move it away, or --force to overwrite it. {another}")
            )
    refuse(DataError, problems)


def _other_case(folder: Path, record: dict[str, Any] | None, case_file: Path) -> list[Problem]:
    """Say that a folder holds the result, or the unfinished work, of another case."""
    remedy = "Give another folder with -o, or --force to replace it"
    if record is not None and "case_path" in record and not is_same_case(case_file, record, folder):
        what = f"holds the result of another case, {case_of(record, folder)}"
        return [Problem("other_case", str(folder), what, remedy)]
    try:
        way = (folder / STATE / _CASE_OF_STATE).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return []
    known = case_of({"case_path": way}, folder)
    is_worth_it = any((folder / STATE).rglob("*.npz")) and known.exists()
    if is_worth_it and not is_same_case(case_file, {"case_path": way}, folder):
        what = f"holds the unfinished assessment of another case, {known}"
        return [Problem("other_case", str(folder), what, remedy)]
    return []


def remember_case(folder: Path, case_file: Path) -> None:
    """Note whose unfinished work is in a result folder."""
    (folder / STATE / _CASE_OF_STATE).write_text(way_to_case(case_file, folder), encoding="utf-8")


def _is_one_of(path: Path, inputs: Iterable[Path]) -> bool:
    return any(given.exists() and path.samefile(given) for given in inputs)


def _record_in(folder: Path) -> dict[str, Any] | None:
    try:
        return read_provenance(folder)
    except DataError:
        return None


@contextmanager
def result_log(folder: Path) -> Iterator[None]:
    """Write what the run does to ``fatigue.log`` in the result folder."""
    handler = logging.FileHandler(folder / LOG, mode="a", encoding="utf-8")
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


def stale_files(folder: Path, inputs: Collection[Path] = ()) -> list[str]:
    """Name everything in a result folder that was derived from its result, inputs of the case excepted."""
    there = [name for name in DERIVED if (folder / name).exists()]
    return [name for name in there if not _is_one_of(folder / name, inputs)]


def publish(finished: Path, folder: Path, stale: Iterable[str] = ()) -> None:
    """Put finished files in place of what was derived before, all of them or none.

    They are forced to disk first. Then a journal says what goes and what comes; from there on the publication is
    completed, by `complete` at the next command if need be. Provenance goes first and comes last, so that a half-moved
    result never looks whole.

    Parameters
    ----------
    finished : folder of the new files; a new result has its provenance among them
    folder : the result folder, locked
    stale : names of files to remove
    """
    files = sorted(finished.iterdir())
    for path in files:
        with path.open("rb+") as file:
            os.fsync(file.fileno())
    names = {path.name for path in files}
    journal = {"from": os.path.relpath(finished, folder), "remove": [name for name in stale if name not in names]}
    unfinished = folder / f"{JOURNAL}.unfinished"
    with unfinished.open("w", encoding="utf-8") as file:
        file.write(json.dumps(journal))
        file.flush()
        os.fsync(file.fileno())
    unfinished.replace(folder / JOURNAL)
    complete(folder)


@contextmanager
def staging_in(folder: Path) -> Iterator[Path]:
    """Give a hidden folder in a result folder to write to; files are published from it when all are whole."""
    staging = folder / STAGING
    shutil.rmtree(staging, ignore_errors=True)
    staging.mkdir()
    try:
        yield staging
    finally:
        if not (folder / JOURNAL).exists():  # else `complete` needs it
            shutil.rmtree(staging, ignore_errors=True)


def complete(folder: Path) -> None:
    """Complete a publication that has begun; nothing where there is none. The folder has to be locked.

    Raises
    ------
    DataError : a file cannot be replaced or removed, as one that is open on Windows
    """
    try:
        journal = json.loads((folder / JOURNAL).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return
    finished = folder / journal["from"]
    files = sorted(finished.iterdir(), key=lambda path: (path.name == LAST, path.name)) if finished.is_dir() else []
    try:
        for name in journal["remove"]:
            (folder / name).unlink(missing_ok=True)
        if any(path.name == LAST for path in files):
            (folder / LAST).unlink(missing_ok=True)
        for path in files:
            path.replace(folder / path.name)
    except PermissionError as error:
        where, what = str(error.filename2 or error.filename or folder), f"cannot be replaced ({error.strerror})"
        remedy = "Close the program that has it open and run the same command again"
        raise DataError(Problem("cannot_write", where, what, remedy)) from error
    (folder / JOURNAL).unlink()
