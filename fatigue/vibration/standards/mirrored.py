"""A record as cosines: its mirrored extension has no jump at its ends, and every sample counts the same.

Weights and filters here are real gains that do not grow with frequency, so the kink that a mirror leaves at the ends
does no harm. Where a record is differentiated it would: ``vibration.continuation`` carries the record on instead, and
``vibration.shifted`` replaces the free vibration at its start.
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy import fft

Floats: TypeAlias = NDArray[np.float64]
Gain: TypeAlias = Callable[[Floats], Floats]


def lines(values: Floats, step: float) -> tuple[Floats, Floats]:
    """Frequencies (n,) [Hz] and mean squares (n,) of the cosines that a record (n,) is the sum of.

    The lines are 1 / (2 T) apart, T the duration; the first one is the square of the mean. Their sum is the mean square
    of the record (Parseval). No window is laid over the record: a burst at its end counts as much as one in its middle.

    >>> frequency, mean_square = lines(2.0 + np.cos(2 * np.pi * 5.0 * (np.arange(400) + 0.5) / 100), 0.01)
    >>> [(float(frequency[k]), round(float(mean_square[k]), 12)) for k in np.flatnonzero(mean_square > 1e-9)]
    [(0.0, 4.0), (5.0, 0.5)]
    """
    cosines = fft.dct(values, type=2, norm="ortho")
    return lines_at(values.size, step), cosines**2 / values.size


def mean_square(values: Floats, step: float, edges: Floats) -> Floats:
    """Mean squares (k - 1,) of a record between frequencies (k,) [Hz], ascending; NaN above half the sampling rate.

    A line stands for the density around it, so that a band may end between two lines. The mean is left out.
    """
    _, power = lines(values - values.mean(), step)
    power[0] = 0.0
    line_ends = np.append(0.0, (np.arange(power.size) + 0.5) / (2 * power.size * step))
    below = np.interp(edges, line_ends, np.append(0.0, np.cumsum(power)))
    return np.where(edges[1:] <= (0.5 / step) * (1 + 1e-9), np.diff(below), np.nan)


def filtered(values: Floats, step: float, gain: Gain) -> Floats:
    """Record (n,) through a filter without phase, of which ``gain`` gives the factor at frequencies [Hz].

    The response is applied to the lines of :func:`lines`: it is exact at any sampling rate, and nothing rings in.
    """
    cosines = fft.dct(values, type=2, norm="ortho")
    return np.asarray(fft.idct(cosines * gain(lines_at(values.size, step)), type=2, norm="ortho"), np.float64)


def lines_at(samples: int, step: float) -> Floats:
    """Frequencies (n,) [Hz] of the lines of a record of n samples."""
    return np.arange(samples) / (2 * samples * step)


def band_pass(low: float, high: float, order: int = 4) -> Gain:
    """Gain of a Butterworth band-pass between ``low`` and ``high`` [Hz]: 1 / sqrt(2) at its edges.

    >>> band_pass(0.4, 10.0)(np.array([0.0, 0.4, 2.0, 10.0, 100.0])).round(4).tolist()
    [0.0, 0.7071, 1.0, 0.7071, 0.0001]
    """

    def gain(frequency: Floats) -> Floats:
        with np.errstate(divide="ignore", over="ignore"):
            detuning = (frequency**2 - low * high) / (frequency * (high - low))
            return np.asarray(1 / np.sqrt(1 + detuning ** (2 * order)), np.float64)

    return gain


def spread(samples: int, length: int, largest_hop: int) -> NDArray[np.int64]:
    """First samples of blocks of one length that are spread evenly over a record, no further apart than a hop.

    The first block begins with the record and the last one ends with it; there is none where the record is shorter.

    >>> spread(100, 40, 20).tolist(), spread(101, 40, 40).tolist(), spread(30, 40, 20).tolist()
    ([0, 20, 40, 60], [0, 30, 61], [])
    """
    if length < 1 or samples < length:
        return np.array([], np.int64)
    hops = -(-(samples - length) // max(1, largest_hop))
    return np.rint(np.linspace(0, samples - length, hops + 1)).astype(np.int64)
