"""What makes the ratio of two lives, exactly: each event, how often it occurs, what one pass does, and what does it.

A life is a limit over a sum of damages. The logarithm of the ratio of two sums is shared out with the logarithmic mean
``L``, which turns a difference of damages into a difference of logarithms: nothing is left over, and an event that only
one of them has takes part like any other.

    ln(life_B / life_A) = ln(limit_B / limit_A) + sum_e -(c_eB - c_eA) / L(D_B, D_A)
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

NEAR = 0.5  # relative difference up to which the logarithm is taken of 1 + it, so that nothing cancels


class Split(NamedTuple):
    """What an event adds to the log ratio, NaN where it cannot be split: it is in one of them only, or changes sign.

    ``mission``: by occurring more or less often; ``per_pass``: by the damage of one pass. Both have one shape.
    """

    mission: Floats
    per_pass: Floats


def log_ratio(b: ArrayLike, a: ArrayLike) -> Floats:
    """``ln(b / a)`` of two numbers of one sign, also where they are nearly equal; NaN of others.

    >>> log_ratio([2.0, -3.0, 1.0 + 1e-12], [1.0, -3.0, 1.0]).round(15).tolist()
    [0.693147180559945, 0.0, 1e-12]
    """
    b, a = np.broadcast_arrays(np.asarray(b, np.float64), np.asarray(a, np.float64))
    fits = (a * np.sign(b) > 0.0) & np.isfinite(a) & np.isfinite(b)
    size_a, size_b = np.where(fits, np.abs(a), 1.0), np.where(fits, np.abs(b), 1.0)
    with np.errstate(over="ignore"):  # of numbers that are not near each other
        difference = (size_b - size_a) / size_a
    near = np.abs(difference) < NEAR
    found = np.where(near, np.log1p(np.where(near, difference, 0.0)), np.log(size_b) - np.log(size_a))
    return np.where(fits, found, np.nan)


def log_mean(a: ArrayLike, b: ArrayLike) -> Floats:
    """Logarithmic mean ``(a - b) / ln(a / b)`` of two numbers of one sign, ``a`` where they are equal; NaN of others.

    >>> log_mean([2.0, 3.0, -2.0], [1.0, 3.0, -1.0]).round(6).tolist()
    [1.442695, 3.0, -1.442695]
    """
    a, b = np.broadcast_arrays(np.asarray(a, np.float64), np.asarray(b, np.float64))
    logarithm = log_ratio(a, b)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(logarithm == 0.0, a, (a - b) / logarithm)


def added(c_a: ArrayLike, c_b: ArrayLike, total_a: ArrayLike, total_b: ArrayLike) -> Floats:
    """What a part of the damage adds to ``ln(life_B / life_A)``: ``-(c_B - c_A) / L(D_B, D_A)``.

    A part is an event, a mode or unit load of an event, or a sequence; it may be 0, and below 0 where it relieves.
    ``c`` are weighted damages of it, ``total`` those of everything [1/km].

    >>> float(added(2e-8, 0.0, 1e-7, 8e-8).round(6))  # an event that is gone
    0.223144
    """
    return -(np.asarray(c_b, np.float64) - np.asarray(c_a, np.float64)) / log_mean(total_b, total_a)


def split(
    passes_a: ArrayLike, passes_b: ArrayLike, damage_a: ArrayLike, damage_b: ArrayLike, total_a: Floats, total_b: Floats
) -> Split:
    """What an event adds, split: by how often it occurs [1/km], and by the damage of one pass.

    ``-L(c_B, c_A) / L(D_B, D_A) (ln(n_B / n_A) + ln(d_B / d_A))`` with ``c = n d``; both parts add up to ``added``.
    """
    c_a, c_b = np.multiply(passes_a, damage_a), np.multiply(passes_b, damage_b)
    weight = -log_mean(c_b, c_a) / log_mean(total_b, total_a)
    return Split(weight * log_ratio(passes_b, passes_a), weight * log_ratio(damage_b, damage_a))
