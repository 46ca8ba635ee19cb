"""Mean and kurtosis of a signal, as a whole or chunk by chunk."""

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


@compiled()
def add_moments(s: Floats, moments: Floats) -> None:
    """Join the moments of some more samples to those so far (Pebay, 2008, Sandia SAND2008-6212)."""
    n_b = float(s.size)
    offset = 0.0
    for i in range(s.size):
        offset += s[i] - s[0]
    mean_b = s[0] + offset / n_b
    second_b, third_b, fourth_b = 0.0, 0.0, 0.0
    for i in range(s.size):
        d = s[i] - mean_b
        second_b += d * d
        third_b += d * d * d
        fourth_b += d * d * d * d
    n_a, mean_a, second_a, third_a, fourth_a = moments
    n = n_a + n_b
    d = mean_b - mean_a if n_a > 0.0 else 0.0
    moments[0] = n
    moments[1] = mean_a + d * n_b / n if n_a > 0.0 else mean_b
    moments[2] = second_a + second_b + d**2 * n_a * n_b / n
    moments[3] = (
        third_a + third_b + d**3 * n_a * n_b * (n_a - n_b) / n**2 + 3.0 * d * (n_a * second_b - n_b * second_a) / n
    )
    moments[4] = (
        fourth_a
        + fourth_b
        + d**4 * n_a * n_b * (n_a**2 - n_a * n_b + n_b**2) / n**3
        + 6.0 * d**2 * (n_a**2 * second_b + n_b**2 * second_a) / n**2
        + 4.0 * d * (n_a * third_b - n_b * third_a) / n
    )


def mean_and_kurtosis_of(moments: Floats, samples: int) -> tuple[Floats, Floats]:
    """Mean and kurtosis by the moments (..., 5) of so many samples; NaN without any, kurtosis also of constant ones."""
    _, mean, second, _, fourth = np.moveaxis(moments, -1, 0)
    flat = second * second == 0.0
    kurtosis = np.where(flat, math.nan, fourth * samples / np.where(flat, 1.0, second * second))
    return (mean if samples else np.full_like(mean, math.nan)), kurtosis
