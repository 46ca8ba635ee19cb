"""Discrete Fourier transforms of records too long for memory, in scratch files.

A transform of n = r c numbers is r transforms of c numbers and c of r (Cooley and Tukey, 1965; out of core Bailey,
1990): with ``n = c n1 + n2`` and ``k = k1 + r k2``

    X[k1 + r k2] = sum over n2 of exp(-2 pi i n2 k2 / c) exp(-2 pi i n2 k1 / n) sum over n1 of exp(-2 pi i n1 k1 / r) x.

A length without such factors is a convolution of a length that has them (Bluestein, 1970): as ``2 n k = n^2 + k^2 -
(k - n)^2``, ``X[k] = w_k sum over n of (w_n x_n) conj(w_(k-n))`` with ``w_n = exp(-pi i n^2 / N)``.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from fatigue.files.mishaps import refused_writing
from fatigue.life.records.spool import COPY, write_all

Complex = NDArray[np.complex128]
Values = Callable[[int, int], NDArray[np.inexact]]  # numbers between two places

ROWS = 256  # of the two factors the smaller one
LONGEST_ROW = 1 << 22
AT_ONCE = 1 << 20  # numbers in memory: 16 MB, some times over


@dataclass(frozen=True, slots=True, eq=False)
class _Plane:
    """Complex numbers (rows, columns) in an open file."""

    path: Path
    file: BinaryIO
    rows: int
    columns: int

    def read(self, rows: slice, columns: slice) -> Complex:
        """Give a part."""
        found = np.empty((rows.stop - rows.start, columns.stop - columns.start), dtype=np.complex128)
        for part, row in zip(found, range(rows.start, rows.stop), strict=True):
            part[:] = self.numbers(row * self.columns + columns.start, row * self.columns + columns.stop)
        return found

    def write(self, rows: slice, columns: slice, values: Complex) -> None:
        """Write a part."""
        with refused_writing(self.path, COPY):
            for part, row in zip(values, range(rows.start, rows.stop), strict=True):
                self.file.seek(16 * (row * self.columns + columns.start))
                write_all(self.file, part)

    def fill(self, values: Values, length: int) -> None:
        """Write so many numbers row after row, and zeros behind them."""
        size = self.rows * self.columns
        with refused_writing(self.path, COPY):
            self.file.seek(0)
            for first in range(0, size, AT_ONCE):
                block = np.zeros(min(AT_ONCE, size - first), dtype=np.complex128)
                end = min(first + len(block), length)
                if first < end:
                    block[: end - first] = values(first, end)
                write_all(self.file, block)

    def numbers(self, first: int, end: int) -> Complex:
        """Numbers row after row."""
        self.file.seek(16 * first)
        return np.fromfile(self.file, np.complex128, end - first)

    def by_columns(self, first: int, end: int) -> Complex:
        """Numbers column after column: those of a transform in its order."""
        begin, stop = first // self.rows, -(-end // self.rows)
        block = self.read(slice(0, self.rows), slice(begin, stop)).T.ravel()
        return block[first - begin * self.rows : end - begin * self.rows]

    def transform(self) -> None:
        """Transform in place; the result stands column after column."""
        for columns in self._some_columns():
            block = np.fft.fft(self.read(slice(0, self.rows), columns), axis=0)
            self.write(slice(0, self.rows), columns, block * self._twiddle(columns))
        for rows in self._some_rows():
            self.write(rows, slice(0, self.columns), np.fft.fft(self.read(rows, slice(0, self.columns)), axis=1))

    def inverse(self) -> None:
        """Take a transform back; the result stands row after row."""
        for rows in self._some_rows():
            self.write(rows, slice(0, self.columns), np.fft.ifft(self.read(rows, slice(0, self.columns)), axis=1))
        for columns in self._some_columns():
            block = self.read(slice(0, self.rows), columns) * self._twiddle(columns).conj()
            self.write(slice(0, self.rows), columns, np.fft.ifft(block, axis=0))

    def multiply(self, other: "_Plane") -> None:
        """Multiply each number with the one at the same place of another plane."""
        for rows in self._some_rows():
            whole = slice(0, self.columns)
            self.write(rows, whole, self.read(rows, whole) * other.read(rows, whole))

    def _twiddle(self, columns: slice) -> Complex:
        turns = np.arange(self.rows)[:, None] * np.arange(columns.start, columns.stop) / (self.rows * self.columns)
        return np.asarray(np.exp(-2j * np.pi * turns))

    def _some_columns(self) -> Iterator[slice]:
        width = max(1, AT_ONCE // self.rows)
        return (slice(first, min(first + width, self.columns)) for first in range(0, self.columns, width))

    def _some_rows(self) -> Iterator[slice]:
        height = max(1, AT_ONCE // self.columns)
        return (slice(first, min(first + height, self.rows)) for first in range(0, self.rows, height))


@contextmanager
def long_transform(values: Values, length: int, scratch: Path) -> Iterator[Values]:
    """Transform ``sum over n of exp(-2 pi i n k / length) x_n`` of numbers x, as a call that gives those of some k.

    ``values`` gives the numbers between two places, ascending. The work is done in files named like ``scratch``: 16
    bytes for each number, five times as much for a length without factors; they are removed.

    Raises
    ------
    DataError : the disk is full
    """
    rows = factor_of(length)
    if rows:
        with _plane(scratch, rows, length // rows) as plane:
            plane.fill(values, length)
            plane.transform()
            yield plane.by_columns
        return
    size = 1 << (2 * length - 1).bit_length()
    with _plane(scratch, ROWS, size // ROWS) as plane:
        with _plane(scratch.with_name(f"{scratch.name}-chirp"), ROWS, size // ROWS) as chirps:
            plane.fill(lambda a, b: values(a, b) * _chirp(np.arange(a, b), length), length)
            plane.transform()
            chirps.fill(lambda a, b: _around(np.arange(a, b), size, length), size)
            chirps.transform()
            plane.multiply(chirps)
        plane.inverse()
        yield lambda a, b: plane.numbers(a, b) * _chirp(np.arange(a, b), length)


def factor_of(length: int) -> int:
    """Factor of a length that is near ``ROWS`` and leaves rows that are not too long; 0 where there is none."""
    least = max(16, -(-length // LONGEST_ROW))
    possible = range(least, max(least, 16 * ROWS) + 1)
    return min((r for r in possible if length % r == 0), key=lambda r: abs(r - ROWS), default=0)


def _chirp(n: NDArray[np.int64], length: int) -> Complex:
    """``exp(-pi i n^2 / length)``; the square is taken modulo 2 length, in whole numbers."""
    return np.asarray(np.exp(-1j * np.pi * ((n * n) % (2 * length)) / length))


def _around(n: NDArray[np.int64], size: int, length: int) -> Complex:
    """Conjugate chirp around place 0 of a ring of some size, zero where none of ``length`` numbers reaches."""
    away = np.minimum(n, size - n)
    return np.where(away < length, _chirp(away, length).conj(), 0.0)


@contextmanager
def _plane(path: Path, rows: int, columns: int) -> Iterator[_Plane]:
    """Open a scratch file, which is removed at the end."""
    with refused_writing(path, COPY):
        path.parent.mkdir(parents=True, exist_ok=True)
        file = path.open("w+b", buffering=0)
    try:
        with file:
            yield _Plane(path, file, rows, columns)
    finally:
        path.unlink(missing_ok=True)
