"""What a load is between its samples: its trigonometric interpolant as a sum of cosines, or straight lines."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import dct

Floats = NDArray[np.float64]

_HARMONICS_AT_ONCE = 512


class Grid(NamedTuple):
    """Places at which samples are wanted, in steps of the samples from the first one."""

    first: float
    step: float
    samples: int

    @property
    def places(self) -> Floats:
        """All of them."""
        return np.asarray(self.first + self.step * np.arange(self.samples))


def periodic(x: Floats, grid: Grid) -> Floats:
    """Interpolant of samples that repeat.

    ``x(p) = sum_k |X_k| cos(2 pi k p / n + arg X_k)``; of an even number of samples the highest is half a cosine.
    """
    n = len(x)
    lines = np.fft.rfft(x) * 2.0 / n
    lines[0] /= 2.0
    if n % 2 == 0:
        lines[-1] /= 2.0
    return _sum(lines, 2.0 * np.pi / n, grid)


def mirrored(x: Floats, grid: Grid) -> Floats:
    """Interpolant of samples and of their mirror image about both ends."""
    n = len(x) - 1
    lines = dct(x, type=1) / n
    lines[[0, -1]] /= 2.0
    return _sum(lines.astype(complex), np.pi / n, grid)


def straight(x: Floats, grid: Grid) -> Floats:
    """Straight lines between samples, level beyond the ends."""
    return np.interp(grid.places, np.arange(len(x)), x)


def _sum(lines: NDArray[np.complex128], phase: float, grid: Grid) -> Floats:
    """``sum_k lines_k cos(k phase place)``: an angle is one of a row of places and one within the row."""
    width = max(1, round(np.sqrt(grid.samples)))
    rows = grid.first + grid.step * width * np.arange(-(-grid.samples // width))
    within = grid.step * np.arange(width)
    total = np.zeros((len(rows), width))
    for first in range(0, len(lines), _HARMONICS_AT_ONCE):
        some = lines[first : first + _HARMONICS_AT_ONCE]
        turn = 1j * phase * np.arange(first, first + len(some))
        total += (some * np.exp(np.outer(rows, turn)) @ np.exp(np.outer(turn, within))).real
    return total.ravel()[: grid.samples]
