"""What an interrupted run leaves behind, so that the next one goes on from there and ends with the same bytes."""

import errno
import hashlib
import json
import os
import shutil
import zipfile
import zlib
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.pipeline.count.result import GroupResult, arrays_of
from fatigue.results import JOURNAL
from fatigue.results.folder import STATE, refuse_foreign
from fatigue.results.publish import STAGING, complete


def state_key(record: Mapping[str, Any]) -> str:
    """Key of a run: a hash of everything its numbers depend on (inputs, case, program versions, block size)."""
    return hashlib.sha256(json.dumps(record, sort_keys=True).encode()).hexdigest()[:32]


class Checkpoint:
    """Finished groups of welds of one run, in a hidden folder of the result folder.

    A group is written beside its final name, forced to disk and renamed, so that it is either whole or not there; one
    that a power cut damaged all the same fails its checksum when it is read and is computed again.
    """

    def __init__(self, result_folder: Path, key: str) -> None:
        self.folder = result_folder / STATE / key
        self._root = result_folder / STATE

    def __enter__(self) -> Self:
        """Open the folder and drop what runs with other inputs left there."""
        self.folder.mkdir(parents=True, exist_ok=True)
        for other in self._root.iterdir():
            if other.is_dir() and other != self.folder:
                shutil.rmtree(other, ignore_errors=True)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Remove the folder after success, or when nothing in it is worth keeping for the next run."""
        is_of_use = any(self.folder.glob("*.npz")) or (self._root.parent / JOURNAL).exists()
        if kind is None or not is_of_use:
            shutil.rmtree(self._root, ignore_errors=True)

    def load(self, group: str) -> GroupResult | None:
        """What an earlier run finished, its checksums tested; None where there is none or it is damaged."""
        try:
            with self._path(group).open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                return GroupResult(**arrays)
        except (OSError, ValueError, TypeError, EOFError, zipfile.BadZipFile, zlib.error):
            return None

    def save(self, group: str, result: GroupResult) -> None:
        """Write a finished group so that it survives a kill or a power cut at any moment."""
        with replacing(self._path(group)) as unfinished, unfinished.open("wb") as file:
            _write_arrays(file, arrays_of(result))

    def _path(self, group: str) -> Path:
        return self.folder / f"{group}.npz"


def _write_arrays(file: BinaryIO, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write contiguous arrays as ``np.savez`` does, which copies them first, all at a time."""
    with zipfile.ZipFile(file, "w") as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as entry:
                np.lib.format.write_array_header_1_0(entry, np.lib.format.header_data_from_array_1_0(array))
                entry.write(array.data)


@contextmanager
def replacing(final: Path) -> Iterator[Path]:
    """A temporary path to write to; on success it is forced to disk and renamed to ``final`` in one step.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    unfinished = final.with_name(f"{final.name}.{os.getpid()}.unfinished")
    try:
        yield unfinished
        with unfinished.open("rb+") as file:
            os.fsync(file.fileno())
        unfinished.replace(final)
    except OSError as error:
        raise _cannot_write(final, error) from error
    finally:
        unfinished.unlink(missing_ok=True)


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
        raise _cannot_write(result_folder, error) from error
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


def _cannot_write(path: Path, error: OSError) -> DataError:
    full = error.errno in (errno.ENOSPC, errno.EDQUOT)
    what = "the disk is full" if full else f"cannot be written ({error.strerror or error})"
    remedy = (
        "Free some space and run the same command again: finished blocks are kept"
        if full
        else "Give a folder you may write to"
    )
    return DataError(Problem("cannot_write", str(path), what, remedy))
