"""One run at a time writes to a result folder: the lock, and what a run that was cut off left half published."""

import errno
import os
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.results.folder import refuse_foreign
from fatigue.results.provenance import JOURNAL
from fatigue.results.publish import STAGING, complete


@contextmanager
def locked(result_folder: Path) -> Iterator[None]:
    """Hold a result folder for one run; the lock goes with the process, however it ends.

    Raises
    ------
    DataError : another run is writing to the folder, or it cannot be written
    """
    path = result_folder / ".fatigue-lock"
    ours = not result_folder.exists()
    try:
        result_folder.mkdir(parents=True, exist_ok=True)
        file = path.open("a+b")
    except OSError as error:
        raise cannot_write(result_folder, error) from error
    with file:
        if not _take(file.fileno()) or not _is_still(path, file.fileno()):
            raise DataError(
                Problem(
                    "busy",
                    str(result_folder),
                    "another run is writing to this folder",
                    "Wait for it to end, or give another folder with -o",
                )
            )
        try:
            yield
        finally:
            path.unlink(missing_ok=True)
            if ours and not any(result_folder.iterdir()):
                result_folder.rmdir()  # refused before anything was written: leave no empty folder behind


@contextmanager
def claimed(folder: Path, *, force: bool, case_file: Path, inputs: Collection[Path]) -> Iterator[None]:
    """Hold a result folder for one assessment that may write there, see ``folder.refuse_foreign``.

    Raises
    ------
    DataError : another run is writing to the folder, or what is in it is not this case's own
    """
    with locked(folder):
        complete(folder)
        refuse_foreign(folder, force=force, case_file=case_file, inputs=inputs)
        yield


def settle_folder(folder: Path) -> None:
    """Complete a publication that was cut off, before a result folder is read.

    Raises
    ------
    DataError : another run is writing to the folder
    """
    if (folder / JOURNAL).exists():
        with locked(folder):
            complete(folder)
            shutil.rmtree(folder / STAGING, ignore_errors=True)


def _take(descriptor: int) -> bool:
    """Take an exclusive lock on an open file without waiting."""
    try:
        if os.name == "nt":
            import msvcrt  # noqa: PLC0415 (only there on Windows)

            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
        else:
            import fcntl  # noqa: PLC0415 (not there on Windows)

            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _is_still(path: Path, descriptor: int) -> bool:
    """Whether the locked file is the one at the path, not one that a run which just ended has removed."""
    return path.exists() and os.path.samestat(os.fstat(descriptor), path.stat())


def cannot_write(path: Path, error: OSError) -> DataError:
    """Error of a file or folder that cannot be written, which says whether the disk is full."""
    full = error.errno in (errno.ENOSPC, errno.EDQUOT)
    what = "the disk is full" if full else f"cannot be written ({error.strerror or error})"
    remedy = (
        "Free some space and run the same command again: finished blocks are kept"
        if full
        else "Give a folder you may write to"
    )
    return DataError(Problem("cannot_write", str(path), what, remedy))
