"""Modal coordinates on disk: sliced like an array, and in memory only as far as a slice reaches.

The file holds chunk after chunk of time, in each of them mode after mode, so that some samples of all modes and all
samples of one mode are both read in few reads. Only what a slice needs is mapped into memory, and no longer than the
slice lives: pages of a file that is mapped as a whole would count as memory of the program.
"""

import errno
import mmap
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.files.mishaps import refused_writing

CHUNK = 4096  # samples
COPY = "give the same command again: long histories need a copy on disk"
AT_ONCE = 2_000_000  # numbers of a record that are in memory in double precision at a time: 16 MB


@dataclass(frozen=True, slots=True, eq=False)
class Spool:
    """Modal coordinates (m, t) in a scratch file.

    ``spool[a:b, c:d]`` reads a part into an array, ``spool[a:b, c:d] = part`` writes one. Each access opens the file
    for itself, so threads may read at the same time. The first ``skipped`` samples of the file do not belong to it.
    """

    path: Path
    shape: tuple[int, int]
    dtype: np.dtype[np.floating]
    skipped: int = 0

    def __getitem__(self, part: tuple[slice, slice]) -> NDArray[np.floating]:
        """Give the part between two modes and two samples; it is not to be written to."""
        first_mode, end_mode, _ = part[0].indices(self.shape[0])
        first, end, _ = part[1].indices(self.shape[1])
        found = np.empty((max(0, end_mode - first_mode), max(0, end - first)), dtype=self.dtype)
        if found.size == 0:
            return found
        with self.path.open("rb", buffering=0) as file:
            for columns, start, width, inside in self._chunks(first, end):
                rows = self._mapped(file, start + first_mode * width, (len(found), width))[:, inside]
                if rows.shape == found.shape:  # no copy of what is in one chunk
                    return rows
                found[:, columns] = rows
        return found

    def __setitem__(self, part: tuple[slice, slice], values: NDArray[np.floating]) -> None:
        """Write the part between two modes and two samples."""
        first_mode, end_mode, _ = part[0].indices(self.shape[0])
        first, end, _ = part[1].indices(self.shape[1])
        with refused_writing(self.path, COPY), self.path.open("r+b", buffering=0) as file:
            for columns, start, width, inside in self._chunks(first, end):
                for mode, row in zip(range(first_mode, end_mode), values, strict=True):
                    file.seek((start + mode * width + inside.start) * self.dtype.itemsize)
                    write_all(file, np.ascontiguousarray(row[columns], dtype=self.dtype))

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[np.floating]:
        """Read all of it, for ``np.asarray``."""
        return np.asarray(self[:, :], dtype=dtype)

    def later(self, first: int) -> "Spool":
        """Leave out the samples before ``first``."""
        first = min(first, self.shape[1])
        return Spool(self.path, (self.shape[0], self.shape[1] - first), self.dtype, self.skipped + first)

    def _chunks(self, first: int, end: int) -> Iterator[tuple[slice, int, int, slice]]:
        """Cut samples into parts of chunks: where among them, where the chunk begins, its width, where in the chunk."""
        stored = self.skipped + self.shape[1]
        first, end = first + self.skipped, end + self.skipped
        for begin in range(first - first % CHUNK, end, CHUNK):
            width = min(CHUNK, stored - begin)
            a, b = max(first, begin), min(end, begin + width)
            yield slice(a - first, b - first), begin * self.shape[0], width, slice(a - begin, b - begin)

    def _mapped(self, file: BinaryIO, position: int, shape: tuple[int, int]) -> NDArray[np.floating]:
        """Map a part of the file: its pages count as memory of the program for as long as the array lives."""
        begin = position * self.dtype.itemsize
        size = shape[0] * shape[1] * self.dtype.itemsize
        if os.fstat(file.fileno()).st_size < begin + size:
            raise DataError(Problem("cut_short", str(self.path), "the scratch file is cut short", "Run it again"))
        ahead = begin % mmap.ALLOCATIONGRANULARITY
        pages = mmap.mmap(file.fileno(), ahead + size, access=mmap.ACCESS_COPY, offset=begin - ahead)
        return np.frombuffer(pages, self.dtype, shape[0] * shape[1], ahead).reshape(shape)


Samples = NDArray[np.floating] | Spool  # modal coordinates (m, t): use slices of time, np.asarray for all of it


def create_spool(path: Path, shape: tuple[int, int], dtype: np.dtype[np.floating]) -> Spool:
    """Make room for modal coordinates of a shape in a file.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    with refused_writing(path, COPY):
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("wb") as file:
            file.truncate(shape[0] * shape[1] * dtype.itemsize)
    return Spool(path, shape, dtype)


class SpoolWriter:
    """Writes modal coordinates of a length that is not known yet, samples after samples, chunk by chunk."""

    def __init__(self, path: Path, modes: int, dtype: np.dtype[np.floating]) -> None:
        self._path, self._modes, self._dtype = path, modes, dtype
        self._waiting, self._held, self._samples = np.empty((modes, CHUNK), dtype), 0, 0

    def __enter__(self) -> Self:
        """Open the file.

        Raises
        ------
        DataError : the place cannot be written
        """
        with refused_writing(self._path, COPY):
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._file = self._path.open("wb", buffering=0)
        return self

    def __exit__(self, *_: object) -> None:
        """Write the last chunk and close the file."""
        with refused_writing(self._path, COPY), self._file:
            write_all(self._file, np.ascontiguousarray(self._waiting[:, : self._held]))

    def append(self, samples: NDArray[np.floating]) -> None:
        """Append samples (m, t).

        Raises
        ------
        DataError : the disk is full
        """
        first = 0
        while first < samples.shape[1]:
            some = min(CHUNK - self._held, samples.shape[1] - first)
            self._waiting[:, self._held : self._held + some] = samples[:, first : first + some]
            first += some
            self._held += some
            self._samples += some
            if self._held == CHUNK:
                with refused_writing(self._path, COPY):
                    write_all(self._file, self._waiting)
                self._held = 0

    def spool(self) -> Spool:
        """What was written, once the file is closed."""
        return Spool(self._path, (self._modes, self._samples), self._dtype)


def time_slices(shape: tuple[int, ...]) -> Iterator[slice]:
    """Cut the samples of modal coordinates (m, t) so that a chunk in double precision takes 16 MB, 32 kB at least."""
    width = max(CHUNK, AT_ONCE // shape[0] // CHUNK * CHUNK)
    return (slice(first, min(first + width, shape[1])) for first in range(0, shape[1], width))


def write_all(file: BinaryIO, values: NDArray[np.inexact]) -> None:
    """Write numbers to a file without a buffer; an ``OSError`` where only a part could be written."""
    if file.write(values.tobytes()) != values.nbytes:
        raise OSError(errno.ENOSPC, "only a part could be written")
