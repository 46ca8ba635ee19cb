"""The factor on all stresses that just meets the target, by counting under many factors at once.

On a curve of one slope without mean stress damage scales with f^k, and the factor follows from the utilisation. On
others it does not: cycles cross knees, pass the cut-off, come into the range of stresses where f_M applies. There the
utilisation is found at some hundred factors between two bounds, then at as many between the two neighbours of which the
lower one meets the target and the upper one does not, until these are close. What is returned meets the target:

- without jumps the utilisation lies between ``f^k`` of the smallest and of the largest slope, and is interpolated;
- where it may jump, at a cut-off or at the onset of f_M, all jumps are put at the lower neighbour. So the factor is the
  largest one that meets the target, or less than ``CLOSE`` below it.

Where f_M ends again, at ranges above twice the yield stress, damage falls while the load rises. The factor is the one
up to which every load meets the target.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw

Floats = NDArray[np.float64]
UtilisationAt = Callable[[NDArray[np.intp], Floats, Floats, int], Floats]

FACTORS = 512  # tried at once
MOST_COUNTS = 50  # after which a factor that meets the target is good enough
CLOSE = 2e-4  # relative distance of the two neighbours in the end
WIDE = np.log(16.0)  # of ln(factor), where little is known before
LARGEST, SMALLEST = 1e250, 1e-250  # factors beyond these are none
ROUNDING = 1e-9  # by which a factor at a jump is lowered


def load_factor_of_counts(
    utilisation_at: UtilisationAt, low: Floats, width: Floats, law: DamageLaw, *, jumps: bool
) -> Floats:
    """Largest factor on all stresses up to which each point meets the target.

    Parameters
    ----------
    utilisation_at : utilisation (r, 2, g) of some rows with their stresses times ``first exp(i step)``, i < g, from the
        rows (r,), ``first`` and ``step`` (r, 2) and g; where ``first`` is 0 nothing is wanted. None is below the
        utilisation anywhere between its factor and the one before
    low : (n, 2) a factor that is likely to be close below; NaN: not wanted
    width : (n, 2) of ln(factor) from ``low`` up, in which the factor is likely to be
    law : its slopes
    jumps : whether the utilisation may jump, at a cut-off or where f_M begins

    Returns
    -------
    (n, 2) factors; +inf where they are beyond 1e250, NaN where they are not wanted
    """
    found = np.full(low.shape, np.nan)
    first, step = np.where(np.isnan(low), 0.0, low), width / (FACTORS - 1)
    k_min = float(law.slopes.min())
    for _ in range(MOST_COUNTS):
        rows = np.flatnonzero((first > 0.0).any(axis=1))
        if not rows.size:
            break
        utilisation = utilisation_at(rows, first[rows], step[rows], FACTORS)
        for row, face in np.argwhere(first[rows] > 0.0):
            at = rows[row], face
            u, f, h = utilisation[row, face], first[at], step[at]
            above, wider = np.flatnonzero(u > 1.0), max(2.0 * h * (FACTORS - 1), WIDE)
            if not above.size:  # all of them meet the target
                first[at], step[at] = f * np.exp(h * (FACTORS - 1)), wider / (FACTORS - 1)
                if first[at] > LARGEST:
                    first[at], found[at] = 0.0, np.inf
            elif above[0] == 0:  # none does
                first[at], step[at] = f * np.exp(-wider), wider / (FACTORS - 1)
                if first[at] < SMALLEST:
                    first[at], found[at] = 0.0, 0.0
            else:
                i = above[0] - 1
                lower = f * np.exp(i * h)
                if h > CLOSE:
                    first[at], step[at] = lower, h / (FACTORS - 1)
                else:
                    first[at], found[at] = 0.0, lower * _beyond(u[i], u[i + 1], h, k_min, jumps=jumps)
    return np.where(first > 0.0, first, found)


def _beyond(lower: float, upper: float, h: float, k_min: float, *, jumps: bool) -> float:
    """Factor on the lower one of two neighbouring factors, exp(h) apart, whose utilisations have the target between."""
    if jumps:
        return max(1.0, float(np.exp(h) * upper ** (-1.0 / k_min)) * (1.0 - ROUNDING))
    return float(np.exp(h * np.log(lower) / (np.log(lower) - np.log(upper)))) if lower > 0.0 else 1.0
