"""A finished result is put in place of what was there before: all of its files or none."""

import json
import os
import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.mishaps import refused_writing
from fatigue.results.provenance import JOURNAL, PROVENANCE

STAGING = ".fatigue-staging"


def publish(finished: Path, folder: Path, stale: Iterable[str] = ()) -> None:
    """Put finished files in place of what was derived before, all of them or none.

    They are forced to disk first. Then a journal says what goes and what comes; from there on the publication is
    completed, by ``complete`` at the next command if need be. Provenance goes first and comes last, so that a
    half-moved result never looks whole.

    Parameters
    ----------
    finished : folder of the new files; a new result has its provenance among them
    folder : the result folder, locked
    stale : names of files to remove

    Raises
    ------
    DataError : a folder is in the way, nothing was changed then; or a file cannot be replaced or removed
    """
    files, stale = sorted(finished.iterdir()), list(stale)
    places = sorted({folder / name for name in (*stale, *(path.name for path in files))})
    what = "is a folder where a file of the result has its place"
    refuse(DataError, (Problem("foreign_files", str(path), what, "Move it away") for path in places if path.is_dir()))
    for path in files:
        with refused_writing(path), path.open("rb+") as file:
            os.fsync(file.fileno())
    names = {path.name for path in files}
    journal = {"from": os.path.relpath(finished, folder), "remove": [name for name in stale if name not in names]}
    unfinished = folder / f"{JOURNAL}.unfinished"
    try:
        with refused_writing(unfinished), unfinished.open("w", encoding="utf-8") as file:
            file.write(json.dumps(journal))
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(folder / JOURNAL)
    except BaseException:
        unfinished.unlink(missing_ok=True)
        raise
    complete(folder)


@contextmanager
def staging_in(folder: Path) -> Iterator[Path]:
    """Hidden folder in a result folder to write to; files are published from it when all are whole."""
    staging = folder / STAGING
    shutil.rmtree(staging, ignore_errors=True)
    with refused_writing(staging):
        staging.mkdir()
    try:
        yield staging
    finally:
        if not (folder / JOURNAL).exists():  # else ``complete`` needs it
            shutil.rmtree(staging, ignore_errors=True)


def complete(folder: Path) -> None:
    """Complete a publication that has begun; nothing where there is none. The folder has to be locked.

    Raises
    ------
    DataError : a file cannot be replaced or removed, for instance as it is open on Windows
    """
    try:
        journal = json.loads((folder / JOURNAL).read_text(encoding="utf-8"))
        finished, stale = folder / journal["from"], [folder / name for name in journal["remove"]]
    except FileNotFoundError:
        return
    except (OSError, ValueError, RecursionError, LookupError, TypeError) as error:
        what = f"says what was being put in place when the program was stopped, and cannot be read ({error})"
        remedy = "Remove it and run the assessment again with --force"
        raise DataError(Problem("damaged_result", str(folder / JOURNAL), what, remedy)) from None
    files = sorted(finished.iterdir()) if finished.is_dir() else []
    files.sort(key=lambda path: path.name == PROVENANCE)
    try:
        for path in stale:
            path.unlink(missing_ok=True)
        if any(path.name == PROVENANCE for path in files):
            (folder / PROVENANCE).unlink(missing_ok=True)
        for path in files:
            path.replace(folder / path.name)
    except OSError as error:
        where, what = str(error.filename2 or error.filename or folder), f"cannot be replaced ({error.strerror})"
        is_open = isinstance(error, PermissionError)
        remedy = f"{'Close the program that has it open' if is_open else 'Move it away'} and run the same command again"
        raise DataError(Problem("cannot_write", where, what, remedy)) from error
    (folder / JOURNAL).unlink()
