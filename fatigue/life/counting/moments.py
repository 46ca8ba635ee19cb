"""Mean and kurtosis of a signal, as a whole or chunk by chunk."""

import math

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

Floats = NDArray[np.float64]


def mean_and_kurtosis(signals: Floats) -> tuple[Floats, Floats]:
    """Mean (n,) and Pearson's kurtosis ``n sum x^4 / (sum x^2)^2`` of ``x = s - mean`` of signals (n, t).

    Deviations from the first sample keep a constant signal exactly constant.
    """
    n, t = signals.shape
    if t == 0:
        return np.full(n, math.nan), np.full(n, math.nan)
    x = signals - signals[:, :1]
    mean = signals[:, 0] + x.sum(axis=1) / t
    np.subtract(signals, mean[:, None], out=x)
    x *= x
    m2 = x.sum(axis=1)
    x *= x
    squared = m2 * m2
    kurtosis = np.divide(x.sum(axis=1) * t, squared, out=np.full(n, math.nan), where=squared > 0.0)
    return mean, kurtosis


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
