"""Damage sums of normal stress and of shear at one point, combined; see ``docs/endurance.md``.

Each is counted alone, on a curve of its own. ``u`` is the stress utilisation of either: 1 over the largest factor on
all its stresses up to which its damage sum stays within a limit.

- EN 1993-1-9, EN 1999-1-3:  D_sigma + D_tau <= D_L
- IIW:                       u_sigma^2 + u_tau^2 <= CV
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

HALVINGS = 60  # of a bracket of at most a factor of 2: below the rounding of a number


def combined_factor(u_normal: Floats, k_normal: float, u_shear: Floats, k_shear: float) -> Floats:
    """Largest factor f (n,) on all stresses with ``(f u_sigma)^k_sigma + (f u_tau)^k_tau <= 1``; +inf where both are 0.

    On curves of one slope k it is the factor up to which the damage sums together stay within the limit that u refers
    to. On others, k their smallest slope, it is never above that factor: ``d(x) / x^k`` does not fall as x rises, at
    knees to a steeper slope and at a cut-off, so below the factor 1 / u a damage sum falls at least with f^k.

    >>> combined_factor(np.array([0.8]), 3.0, np.array([0.0]), 5.0)
    array([1.25])
    """
    larger = np.maximum(u_normal, u_shear)
    with np.errstate(divide="ignore", over="ignore"):
        alone = 1.0 / larger  # where the other one is 0
    both = (np.minimum(u_normal, u_shear) > 0.0) & (alone > 0.0) & np.isfinite(alone)
    low, high = alone[both] * 2.0 ** (-1.0 / min(k_normal, k_shear)), alone[both]
    for _ in range(HALVINGS):
        f = 0.5 * (low + high)
        meets = (f * u_normal[both]) ** k_normal + (f * u_shear[both]) ** k_shear <= 1.0
        low, high = np.where(meets, f, low), np.where(meets, high, f)
    alone[both] = low
    return np.asarray(alone)
