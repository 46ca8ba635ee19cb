"""The result folder on disk: whose files are in it, and the log of what was done."""

import logging
import sys
import threading
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.mishaps import reason, refused_writing
from fatigue.results.belonging import DOCUMENTS, LIST, PAGE, PICTURE, is_derived
from fatigue.results.columns import TABLES
from fatigue.results.origin import case_of, is_same_case, way_to_case
from fatigue.results.provenance import CHECKSUMS, PROVENANCE, parsed_provenance
from fatigue.shown import VisibleFormatter
from fatigue.side_by_side import RUN_THREADS

LOG = "fatigue.log"
OUTPUTS = (*(f"{table}.parquet" for table in TABLES), PICTURE, PAGE, LIST, LOG, PROVENANCE, CHECKSUMS)
DERIVED = tuple(dict.fromkeys((*(f"{table}.parquet" for table in TABLES), *DOCUMENTS, LIST)))
RECORDS = (LOG, PROVENANCE, CHECKSUMS)  # nobody writes into them
STATE = ".fatigue-state"  # of an interrupted run
_CASE_OF_STATE = "case"


def refuse_foreign(folder: Path, *, force: bool, case_file: Path | None = None, inputs: Collection[Path] = ()) -> None:
    """Refuse to overwrite or remove what is not this case's own: files of others, inputs, the result of another case.

    Parameters
    ----------
    force : replace them all the same, inputs excepted
    case_file : the case to be assessed
    inputs : its input files

    Raises
    ------
    DataError : everything in the way
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
    for name in (*DERIVED, *RECORDS):
        path = folder / name
        if not path.exists() or _is_one_of(path, inputs):
            continue
        if name in RECORDS and (record is not None or has_state):
            continue
        if not is_derived(folder, name, record):
            what = "is there already and was not written by fatigue, or was changed since"
            problems.append(
                Problem("foreign_files", str(path), what, f"Move it away, or --force to overwrite it. {another}")
            )
    refuse(DataError, problems)


def _other_case(folder: Path, record: dict[str, Any] | None, case_file: Path) -> list[Problem]:
    """Refusal of a folder that holds the result, or the unfinished work, of another case."""
    remedy = "Give another folder with -o, or --force to replace it"
    if record is not None and "case_path" in record and not is_same_case(case_file, record, folder):
        what = f"holds the result of another case, {case_of(record, folder)}"
        return [Problem("other_case", str(folder), what, remedy)]
    try:
        way = (folder / STATE / _CASE_OF_STATE).read_text(encoding="utf-8", errors="surrogateescape")
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
    path = folder / STATE / _CASE_OF_STATE
    with refused_writing(path):
        path.write_text(way_to_case(case_file, folder), encoding="utf-8", errors="surrogateescape")


def _is_one_of(path: Path, inputs: Iterable[Path]) -> bool:
    return any(given.exists() and path.samefile(given) for given in inputs)


def _record_in(folder: Path) -> dict[str, Any] | None:
    try:
        return parsed_provenance(folder)
    except DataError:
        return None


class _ResultLog(logging.FileHandler):
    """A log that may lose a line to a full disk, and never stops a run nor tells of it in a traceback."""

    _has_told = False

    def handleError(self, record: logging.LogRecord) -> None:  # noqa: N802
        """Say once on stderr why lines are missing; what the run itself cannot write is refused elsewhere."""
        error = sys.exc_info()[1]
        if not isinstance(error, OSError):
            super().handleError(record)
        elif not self._has_told:
            self._has_told = True
            what = f"{self.baseFilename} lacks lines ({reason(error)})"
            said = logging.LogRecord("fatigue", logging.WARNING, "", 0, what, None, None)
            for other in (handler for handler in logging.getLogger("fatigue").handlers if handler is not self):
                other.handle(said)

    def close(self) -> None:
        """Close it, although its last lines may find no room."""
        with suppress(OSError):
            super().close()


@contextmanager
def result_log(folder: Path) -> Iterator[None]:
    """Write what the run does to ``fatigue.log`` in the result folder.

    A run that fails and leaves nothing that the next one can use leaves no log either: it would be in the way.

    Raises
    ------
    DataError : the log cannot be opened for writing
    """
    path = folder / LOG
    with refused_writing(path):
        handler = _ResultLog(path, mode="a", encoding="utf-8", errors="backslashreplace")
    handler.setFormatter(VisibleFormatter("%(asctime)s %(levelname)s %(message)s"))
    handler.setLevel(logging.INFO)
    handler.addFilter(_said_by(threading.current_thread().name))
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


def _said_by(thread: str) -> Callable[[logging.LogRecord], bool]:
    """What belongs into the log of an assessment on a thread: all but what others say that run beside it."""
    return lambda record: not str(record.threadName).startswith(RUN_THREADS) or record.threadName == thread


def stale_files(folder: Path, inputs: Collection[Path] = ()) -> list[str]:
    """Name everything in a result folder that was derived from its result, inputs of the case excepted."""
    there = [name for name in DERIVED if (folder / name).exists()]
    return [name for name in there if not _is_one_of(folder / name, inputs)]
