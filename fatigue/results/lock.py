"""One run at a time writes to a result folder: the lock, and what a run that was cut off left half published.

The lock is one of the operating system: it goes with the process, however it ends. A file system without locks, as some
network drives are, can do with less: the lock file is made by one process and by no other, and says who made it. That
trusts the drive to let only one process make it, and the user to remove the file of a run that was killed.
"""

import errno
import os
import platform
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import BinaryIO

from fatigue.errors import DataError, Problem
from fatigue.files.mishaps import cannot_write, reason
from fatigue.files.whole import missing_folders, remove_empty
from fatigue.results.folder import LOG, STATE, refuse_foreign
from fatigue.results.provenance import JOURNAL
from fatigue.results.publish import STAGING, complete

LOCK = ".fatigue-lock"
HELD = (errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES, errno.EDEADLK)  # by another process


@contextmanager
def locked(result_folder: Path, *, no_lock: bool = False) -> Iterator[None]:
    """Hold a result folder for one run; the lock goes with the process, however it ends.

    ``no_lock``: do with the lock file alone, for a file system without locks; it stays behind a run that is killed.

    Raises
    ------
    DataError : another run is writing to the folder, or it cannot be written, or its file system has no locks
    """
    path = result_folder / LOCK
    made: list[Path] = []
    try:
        made = missing_folders(result_folder)
        result_folder.mkdir(parents=True, exist_ok=True)
        file = _made_by_us(path) if no_lock else path.open("a+b")
    except OSError as error:
        remove_empty(made)
        raise cannot_write(result_folder, error) from error
    with file:
        try:
            if not no_lock:
                _take(result_folder, path, file)
        except DataError:
            remove_empty(made)
            raise
        try:
            yield
        finally:
            path.unlink(missing_ok=True)
            remove_empty(made)  # refused before anything was written: leave no empty folder behind


@contextmanager
def claimed(
    folder: Path, *, force: bool, case_file: Path, inputs: Collection[Path], no_lock: bool = False
) -> Iterator[None]:
    """Hold a result folder for one assessment that may write there, see ``folder.refuse_foreign``.

    A run that fails and leaves nothing to go on from leaves no log either: it would be in the way of the next one.

    Raises
    ------
    DataError : another run is writing to the folder, or what is in it is not this case's own
    """
    with locked(folder, no_lock=no_lock):
        complete(folder)
        refuse_foreign(folder, force=force, case_file=case_file, inputs=inputs)
        log = folder / LOG
        is_new = not log.exists()
        try:
            yield
        except BaseException:
            if is_new and not (folder / STATE).exists() and not (folder / JOURNAL).exists():
                log.unlink(missing_ok=True)
            raise


def settle_folder(folder: Path, *, no_lock: bool = False) -> None:
    """Complete a publication that was cut off, before a result folder is read.

    Raises
    ------
    DataError : another run is writing to the folder
    """
    if (folder / JOURNAL).exists():
        with locked(folder, no_lock=no_lock):
            complete(folder)
            shutil.rmtree(folder / STAGING, ignore_errors=True)


def _made_by_us(path: Path) -> BinaryIO:
    """The lock file, made by this process and saying so."""
    try:
        file = path.open("x+b")
    except FileExistsError:
        raise _busy(path) from None
    since = datetime.now().astimezone().isoformat(" ", "seconds")
    file.write(f"process {os.getpid()} on {platform.node()} since {since}".encode())
    file.flush()
    return file


def _take(folder: Path, path: Path, file: BinaryIO) -> None:
    """Take an exclusive lock on the open lock file without waiting.

    Raises
    ------
    DataError : another run holds it, or the file system has no locks
    """
    try:
        _lock(file.fileno())
    except OSError as error:
        if error.errno in HELD:
            raise _busy(path) from None
        if os.fstat(file.fileno()).st_size == 0:
            path.unlink(missing_ok=True)
        what = f"the file system has no locks ({reason(error)}), which keep two runs from writing to one folder"
        remedy = "Give a folder on another disk, or --no-lock if no other run writes to this one"
        raise DataError(Problem("no_locks", str(folder), what, remedy)) from error
    is_ours = path.exists() and os.path.samestat(os.fstat(file.fileno()), path.stat())  # not removed by its last holder
    if not is_ours or os.fstat(file.fileno()).st_size:
        raise _busy(path)


def _lock(descriptor: int) -> None:
    if os.name == "nt":
        import msvcrt  # noqa: PLC0415 (only there on Windows)

        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
    else:
        import fcntl  # noqa: PLC0415 (not there on Windows)

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _busy(path: Path) -> DataError:
    """Refusal of a folder that another run writes to: one that holds the lock, or one without locks that says so."""
    try:
        who = path.read_text(encoding="utf-8", errors="replace")[:200]
    except OSError:
        who = ""
    what, remedy = "another run is writing to this folder", "Wait for it to end, or give another folder with -o"
    if who:
        what, remedy = f"{what} ({who})", f"{remedy}. If it was killed, remove {path}"
    return DataError(Problem("busy", str(path.parent), what, remedy))
