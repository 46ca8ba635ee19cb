"""Segments of a record, each less the straight line through it."""

import numpy as np
from numpy.typing import NDArray


def levelled(segments: NDArray[np.float64]) -> NDArray[np.float64]:
    """Segments (segments, samples) without their constants and drifts: the line of least squares is taken off each.

    >>> levelled(np.array([[1.0, 2.0, 3.0], [0.0, 3.0, 0.0]])).round(9) + 0.0
    array([[ 0.,  0.,  0.],
           [-1.,  2., -1.]])
    """
    sample = np.arange(segments.shape[1])
    line, _ = np.linalg.qr(np.stack([np.ones(sample.size), sample], axis=1))
    return np.asarray(segments - (segments @ line) @ line.T)
