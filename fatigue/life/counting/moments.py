"""Mean and kurtosis of a signal."""

import math

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

Floats = NDArray[np.float64]

LANES, DEPTH = 8, 8  # sums side by side, and terms of each that are added up in one go


@compiled()
def mean_and_kurtosis(s: Floats) -> tuple[float, float]:
    """Mean and Pearson's kurtosis ``n sum x^4 / (sum x^2)^2`` of ``x = s - mean``.

    Deviations from the first sample keep a constant signal exactly constant.
    """
    if s.size == 0:
        return math.nan, math.nan
    sums = np.empty((3, LANES))
    offset, _, _ = sums_of_powers(s, s[0], sums)
    mean = s[0] + offset / s.size
    _, m2, m4 = sums_of_powers(s, mean, sums)
    return mean, m4 * s.size / (m2 * m2) if m2 * m2 > 0.0 else math.nan


@compiled()
def sums_of_powers(s: Floats, origin: float, sums: Floats) -> tuple[float, float, float]:
    """``sum x``, ``sum x^2``, ``sum x^4`` of ``x = s - origin``; ``sums`` (3, LANES) is work space.

    The order of the sums is written out, lane by lane: left to the compiler, it is another one in the process that
    compiles than in those that read the compiled code from disk.
    """
    sums[:] = 0.0
    whole = s.size - s.size % (LANES * DEPTH)
    for first in range(0, whole, LANES * DEPTH):
        for lane in range(LANES):
            first_power = second_power = fourth_power = 0.0
            for row in range(DEPTH):
                x = s[first + LANES * row + lane] - origin
                first_power += x
                second_power += x * x
                fourth_power += (x * x) * (x * x)
            sums[0, lane] += first_power
            sums[1, lane] += second_power
            sums[2, lane] += fourth_power
    for i in range(whole, s.size):
        x = s[i] - origin
        sums[0, 0] += x
        sums[1, 0] += x * x
        sums[2, 0] += (x * x) * (x * x)
    first_power = second_power = fourth_power = 0.0
    for lane in range(LANES):
        first_power += sums[0, lane]
        second_power += sums[1, lane]
        fourth_power += sums[2, lane]
    return first_power, second_power, fourth_power
