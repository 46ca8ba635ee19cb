"""Percentiles over the units of a fleet, some of which may live for ever."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def percentiles(values: Floats, percent: Sequence[float]) -> Floats:
    """Percentiles over the last axis, linear between the sorted values: (..., u) -> (..., p).

    Those of ``numpy.quantile`` and of ``quantile_cont`` of DuckDB. Between a value and an infinite one they are
    infinite, where numpy has none.

    >>> percentiles(np.array([4.0, 1.0, 2.0]), [0.0, 25.0, 50.0])
    array([1. , 1.5, 2. ])
    >>> percentiles(np.array([1.0, np.inf, np.inf]), [0.0, 25.0, 100.0])
    array([ 1., inf, inf])
    """
    ordered = np.sort(values, axis=-1)
    place = np.asarray(percent, dtype=np.float64) / 100.0 * (ordered.shape[-1] - 1)
    below = np.floor(place).astype(np.intp)
    above = np.minimum(below + 1, ordered.shape[-1] - 1)
    low, high, part = ordered[..., below], ordered[..., above], place - below
    with np.errstate(invalid="ignore"):
        between = low + part * (high - low)
    return np.where((part == 0.0) | (low == high), low, between)
