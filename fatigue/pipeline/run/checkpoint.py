"""What an interrupted run leaves behind, so that the next one goes on from there and ends with the same bytes."""

import hashlib
import json
import os
import shutil
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.pipeline.count.result import GroupResult, arrays_of
from fatigue.results import JOURNAL
from fatigue.results.folder import STATE
from fatigue.results.lock import cannot_write


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
        raise cannot_write(final, error) from error
    finally:
        unfinished.unlink(missing_ok=True)
