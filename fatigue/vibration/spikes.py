"""Spikes of a measured record: single samples that no vibration makes, as of a loose plug or a lost telegram."""

import numpy as np
from numpy.typing import NDArray

STANDS_OUT = 20.0  # times the rms of the other steps; those of broadband noise reach 6
ALONE = 0.1  # of its height, what the record does beside it at most: an impact rings
MOST = 1e-3  # of the samples: a record with more of them is of another kind than one with spikes


def spikes(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Index of every spike (s,) among the samples (n,), in their order; none in less than 1000 samples.

    A spike lies above both neighbours, or below both, by more than ``STANDS_OUT`` times the rms of the steps from
    sample to sample of the rest, and the steps before and behind it are small. It scales with the record, and constants
    and drifts do not matter to it.

    Examples
    --------
    >>> sine = np.sin(np.arange(1000.0))
    >>> sine[500] = 80.0
    >>> spikes(sine)
    array([500])
    """
    if values.size < 1.0 / MOST:
        return np.empty(0, dtype=np.int64)
    step = np.diff(values)
    up, down = step[:-1], -step[1:]  # to samples 1 to n - 2, and back from them
    height = np.where(up * down > 0.0, np.minimum(np.abs(up), np.abs(down)), 0.0)
    beside = np.abs(np.pad(step, 1))
    height[np.maximum(beside[:-3], beside[3:]) > ALONE * height] = 0.0
    most = max(1, int(MOST * values.size))
    highest = np.argpartition(height, -most)[-most:]
    others = np.diff(np.delete(values, highest + 1))
    found = highest[height[highest] > STANDS_OUT * np.sqrt(np.mean(others**2))]
    return np.asarray(np.sort(found + 1), dtype=np.int64)
