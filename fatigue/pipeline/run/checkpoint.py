"""What an interrupted run leaves behind, so that the next one goes on from there and ends with the same bytes."""

import hashlib
import json
import shutil
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.files.mishaps import refused_writing
from fatigue.files.whole import replacing
from fatigue.pipeline.count.result import GroupResult, arrays_of
from fatigue.results import JOURNAL
from fatigue.results.folder import STATE

KEPT = "run the same command again: finished blocks are kept"


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
        with refused_writing(self.folder):
            self.folder.mkdir(parents=True, exist_ok=True)
        for other in self._root.iterdir():
            if other.is_dir() and other != self.folder:
                shutil.rmtree(other, ignore_errors=True)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Remove the folder after success or when nothing in it is of use for the next run, else what is of none."""
        if kind is not None and (self._root.parent / JOURNAL).exists():
            return  # a result is being put in place, and the next command completes it
        if kind is None or not any(self.folder.glob("*.npz")):
            shutil.rmtree(self._root, ignore_errors=True)
            return
        for scratch in self.folder.iterdir():  # records and half tables would fill the disk until the next run
            if scratch.is_dir():
                shutil.rmtree(scratch, ignore_errors=True)
            elif scratch.suffix != ".npz":
                scratch.unlink(missing_ok=True)

    def load(self, group: str) -> GroupResult | None:
        """What an earlier run finished, its checksums tested; None where there is none or it is damaged."""
        try:
            with self._path(group).open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                return GroupResult(**arrays)
        except (OSError, ValueError, TypeError, EOFError, zipfile.BadZipFile, zlib.error):
            return None

    def save(self, group: str, result: GroupResult) -> None:
        """Write a finished group so that it survives a kill or a power cut at any moment."""
        with replacing(self._path(group), KEPT) as unfinished, unfinished.open("wb") as file:
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
