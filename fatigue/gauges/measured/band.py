"""The band that measured and simulated strain are compared in; both sides go through the same filter."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_ROUNDING = 1e-9  # of a bin: one that stands on an edge is on it
EDGES_HZ = (0.0, 2.0, 5.0, 8.0, 12.0, 20.0)  # of the bands whose rms is compared, up to the end of the band


def band_limited(x: Floats, rate_hz: float, low_hz: float, high_hz: float) -> Floats:
    """B(x; lo, hi) of signals (..., t): mean removed, and every line with f < lo or f >= hi (measured_data 2.2).

    >>> t = np.arange(200) / 100.0
    >>> x = 3.0 + np.sin(2.0 * np.pi * 5.0 * t)
    >>> [float(band_limited(x, 100.0, 0.0, high).std().round(3)) for high in (5.0, 6.0)]
    [0.0, 0.707]
    """
    return next(in_bands(x, rate_hz, (low_hz, high_hz)))


def in_bands(x: Floats, rate_hz: float, edges_hz: Sequence[float]) -> Iterator[Floats]:
    """What ``band_limited`` makes of signals (..., t) in every band between neighbouring edges, transformed once."""
    samples = x.shape[-1]
    lines = np.fft.rfft(x - x.mean(axis=-1, keepdims=True), axis=-1)
    for first, end in pairwise(bin_from(f, rate_hz, samples) for f in edges_hz):
        inside = np.zeros_like(lines)
        inside[..., first:end] = lines[..., first:end]
        yield np.asarray(np.fft.irfft(inside, samples, axis=-1))


def bin_from(frequency_hz: float, rate_hz: float, samples: int) -> int:
    """First bin of the transform of so many samples that is not below a frequency."""
    return int(np.ceil(frequency_hz * samples / rate_hz - _ROUNDING))


def band_edges(low_hz: float, high_hz: float) -> tuple[float, ...]:
    """Edges of the bands inside [lo, hi).

    >>> band_edges(0.5, 15.0)
    (0.5, 2.0, 5.0, 8.0, 12.0, 15.0)
    """
    return (low_hz, *(f for f in EDGES_HZ if low_hz < f < high_hz), high_hz)
