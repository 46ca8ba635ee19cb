"""The stress of some points in some samples: the product of their modal stress with the modal coordinates.

Both are laid out for the product first, the rows of modal stress once for all samples and the samples once for all
points. In single precision with AVX-512 ``kernels.simd`` multiplies tiles (n / 12, m, 12) and panels
(t / 32, m, 32), else BLAS multiplies (n, m) and (m, t); they differ by rounding at most. Compiled code can call the
former only.
"""

import importlib.util
from typing import Any

import numpy as np
from numba.extending import overload
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.records.spool import Samples

Numbers = NDArray[np.floating]
Singles = NDArray[np.float32]

STEP = 32  # samples that are laid out side by side
TILE = 12  # rows that are multiplied side by side
CACHE_LINE = 64  # bytes

simd: Any = None
if importlib.util.find_spec("fatigue.life.counting.single.kernels.simd"):
    from fatigue.life.counting.single.kernels import simd


def in_tiles(precision: type[np.floating]) -> bool:
    """Whether ``kernels.simd`` multiplies."""
    return simd is not None and simd.WIDTH == 512 and precision is np.float32


def is_in_panels(record: Samples) -> bool:
    """Whether a record is in memory as compiled code multiplies it."""
    return isinstance(record, np.ndarray) and record.ndim == 3


def prepared_rows(rows: Numbers) -> Numbers:
    """Lay rows (n, m) out for ``multiply``."""
    return np.asarray(simd.tiles_of(rows)) if in_tiles(rows.dtype.type) else rows


def space_for_samples(modes: int, samples: int, precision: type[np.floating]) -> Numbers:
    """Memory for the modal coordinates as ``multiply`` reads them: to use it again is faster than fresh memory."""
    return np.asarray(simd.panels_for(modes, samples)) if in_tiles(precision) else np.empty((modes, samples), precision)


def prepared_samples(q: Numbers, into: Numbers) -> Numbers:
    """Lay modal coordinates (m, t) out for ``multiply``, in the precision of the memory they go to."""
    if in_tiles(into.dtype.type):
        return np.asarray(simd.lay_out(q, into))
    into = into[:, : q.shape[1]]
    np.copyto(into, q)
    return into


def rows_between(laid_out: Numbers, first: int, end: int) -> Numbers:
    """Take some rows of those that were laid out, from the first one of a tile on."""
    return laid_out[first // TILE : -(-end // TILE)] if laid_out.ndim == 3 else laid_out[first:end]


def samples_between(laid_out: Numbers, first: int, end: int) -> Numbers:
    """Take some samples of a record that was laid out, from a multiple of ``STEP`` on."""
    return laid_out[first // STEP : -(-end // STEP)] if laid_out.ndim == 3 else laid_out[:, first:end]


def samples_of(record: Samples, first: int, end: int, into: Numbers) -> Numbers:
    """Give some samples of a record as ``multiply`` reads them: part of what is laid out, or laid out now."""
    if isinstance(record, np.ndarray) and record.dtype == into.dtype:
        return samples_between(record, first, end)
    return prepared_samples(record[:, first:end], into)


def rows_in_tiles(matrix: Singles) -> Singles:
    """Lay a matrix (n, h) out for ``multiply_rows``, tile after tile, the last one filled up with zeros."""
    if in_tiles(np.float32):
        return np.asarray(simd.tiles_of(matrix)).ravel()
    return np.pad(matrix, ((0, -len(matrix) % TILE), (0, 0))).ravel()


@compiled()
def rows_by_blas(tile: Singles, samples: Singles, columns: int, stress: Singles) -> None:
    """``stress = tile @ samples``, as ``multiply_rows`` but in all columns."""
    np.dot(tile.reshape(TILE, len(samples)), samples, stress)


# Compiled code calls it: the product of one tile with samples (h, w) that are not laid out, in their own columns.
multiply_rows = simd.multiply_rows if in_tiles(np.float32) else rows_by_blas


def block_for(rows: int, width: int, precision: type[np.floating]) -> Numbers:
    """Memory for the products of so many rows, ``width`` numbers of each and some more.

    Column 1 of every row begins a line of the cache, as products are written from there on.
    """
    in_line = CACHE_LINE // np.dtype(precision).itemsize
    rows, width = -(-rows // TILE) * TILE, -(-width // in_line) * in_line
    numbers = np.empty(rows * width + 2 * in_line, precision)
    first = (-numbers.ctypes.data % CACHE_LINE) // numbers.itemsize + in_line - 1
    return numbers[first : first + rows * width].reshape(rows, width)


def multiply(rows: Numbers, q: Numbers, stress: Numbers) -> None:
    """``stress[:, 1 : t + 1] = rows @ q`` of what was laid out; the next 31 columns may get anything."""
    if rows.ndim == 3:
        simd.multiply(rows, q, stress)
    else:
        np.matmul(rows, q, out=stress[: len(rows), 1 : q.shape[1] + 1])


@overload(rows_between, strict=False)
def _rows_between(laid_out: Any, first: Any, end: Any) -> Any:
    return lambda laid_out, first, end: laid_out[first // TILE : -(-end // TILE)]


@overload(samples_of, strict=False)
def _samples_of(record: Any, first: Any, end: Any, into: Any) -> Any:
    return lambda record, first, end, into: record[first // STEP : -(-end // STEP)]


@overload(multiply, strict=False)
def _multiply(rows: Any, q: Any, stress: Any) -> Any:
    product = simd.multiply
    return lambda rows, q, stress: product(rows, q, stress)  # noqa: PLW0108
