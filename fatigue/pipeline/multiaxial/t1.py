"""Bound of the damage by path range: what the length of a path can make of its largest range."""

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.screening import ROUNDING
from fatigue.life.rule import CycleRule, cycle_damage, equivalent_range

Floats = NDArray[np.float64]


def path_damage_bound(
    length: Floats, normal_range: Floats, shear_range: Floats, size: Floats, rule: CycleRule, beta: float
) -> Floats:
    """Bound the damage of one pass by path range, ``0.5 c Lambda d(x) / x`` at the largest x that there can be.

    Every half cycle has ``x_k <= c R_k``, c = size / I(0); the ranges R_k add up to the length of the path at most; and
    d(x) / x never falls on a law whose slopes are 1 at least. For others the bound is infinite.
    ``length``, ``normal_range`` and ``shear_range`` are the path's or bounds of them, of any one shape [MPa]; the
    mean-stress factor f_M is not in it.
    """
    law = rule.law
    c = equivalent_range(1.0, size, rule.ratio_factor(np.zeros(())), 1.0)
    largest = c * np.sqrt(normal_range**2 + beta * shear_range**2) * (1.0 + ROUNDING)
    if law.slopes.min() < 1.0:
        return np.full_like(largest, np.inf)
    damage = cycle_damage(largest, law)
    return np.asarray(np.divide(0.5 * c * length * damage, largest, out=np.zeros_like(largest), where=largest > 0.0))
