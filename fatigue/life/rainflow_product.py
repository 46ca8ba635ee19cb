"""The stress of some points in some samples: the product of their shapes with the modal coordinates.

Both are laid out for the product first, the shapes once for all samples and the samples once for all points. In single
precision with AVX-512 the product is that of `rainflow_simd`, else that of BLAS; they differ by rounding at most.
"""

import importlib.util
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.spool import Spool

Numbers = NDArray[np.floating]

STEP = 32  # samples that are laid out side by side

simd: Any = None
if importlib.util.find_spec("fatigue.life.rainflow_simd"):
    from fatigue.life import rainflow_simd as simd


def in_tiles(precision: type[np.floating]) -> bool:
    """Whether the product is that of `rainflow_simd`."""
    return simd is not None and simd.WIDTH == 512 and precision is np.float32


def prepared_shapes(shapes: Numbers) -> Numbers:
    """Lay shapes (n, m) out for `multiply`."""
    return np.asarray(simd.tiles_of(shapes)) if in_tiles(shapes.dtype.type) else shapes


def space_for_samples(modes: int, samples: int, precision: type[np.floating]) -> Numbers:
    """Memory for the modal coordinates as `multiply` reads them: to use it again is faster than fresh memory."""
    return np.asarray(simd.panels_for(modes, samples)) if in_tiles(precision) else np.empty((modes, samples), precision)


def prepared_samples(q: Numbers, into: Numbers) -> Numbers:
    """Lay modal coordinates (m, t) out for `multiply`, in the precision of the memory they go to."""
    if in_tiles(into.dtype.type):
        return np.asarray(simd.lay_out(q, into))
    into = into[:, : q.shape[1]]
    np.copyto(into, q)
    return into


def samples_between(laid_out: Numbers, first: int, end: int) -> Numbers:
    """Take some samples of a record that was laid out, from a multiple of ``STEP`` on."""
    return laid_out[first // STEP : -(-end // STEP)] if in_tiles(laid_out.dtype.type) else laid_out[:, first:end]


def samples_of(record: Numbers | Spool, first: int, end: int, into: Numbers) -> Numbers:
    """Give some samples of a record as `multiply` reads them: part of one laid out in memory, or read from disk."""
    if isinstance(record, Spool):
        return prepared_samples(record[:, first:end], into)
    return samples_between(record, first, end)


def block_for(shapes: int, width: int, precision: type[np.floating]) -> Numbers:
    """Memory for the products of so many shapes."""
    rows = -(-shapes // simd.TILE) * simd.TILE if in_tiles(precision) else shapes
    return np.empty((rows, width), precision)


def multiply(shapes: Numbers, q: Numbers, stress: Numbers) -> None:
    """Write the product of what was laid out into the columns 1 to t of a block; the next 31 may get anything."""
    if in_tiles(stress.dtype.type):
        simd.multiply(shapes, q, stress)
    else:
        np.matmul(shapes, q, out=stress[: len(shapes), 1 : q.shape[1] + 1])
