"""How far two right programs may differ in what a loop of events adds: the bounds of ``rounding`` for its cycles."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.rounding import (
    UNIT,
    Bounds,
    damage_bound,
    equivalent_bound,
    ratio_bound,
    relative_bound,
)

Floats = NDArray[np.float64]

SUMMED = 1000.0  # roundings of a sum of many cycles: they grow with the root of their number


@dataclass(frozen=True, slots=True, eq=False)
class Chained:
    """What bounds of one run of a loop follow from.

    Attributes
    ----------
    delta : bound on the rounding of a stress, with what is constant [MPa]
    stress : (r,) at the turning points of all its events [MPa]
    ranges, equivalent : (c,) of the cycles that it adds or takes away [MPa, dS], and ``counts``
    R : (l,) stress ratios of the largest cycles that close, as far as rounding may take one for another
    of_events : damage of one pass of each of its entries together
    size : factor of the plate thickness
    mean_stress : whether the equivalent range has the factor of the mean stress
    """

    delta: float
    stress: Floats
    ranges: Floats
    equivalent: Floats
    counts: Floats
    R: Floats
    of_events: float
    size: float
    mean_stress: bool


def chain_bounds(of: Chained, damage: float, largest: float, R_largest: float, curve: RecountCurve) -> Bounds:
    """Bounds on the columns of a loop; its damage is a difference of sums that may be far larger."""
    rho, k = 2.0 * of.delta, curve.slopes[0]
    d_dS = _equivalent_bound(of, rho)
    n, points = np.abs(of.counts), len(of.stress)
    of_cycles = damage_bound(of.equivalent, n, d_dS, points, curve)
    of_sums = SUMMED * UNIT * (2.0 * of.of_events + abs(damage))
    return {
        "damage_per_pass": of_cycles + of_sums,
        "cycles_per_pass": float(n[of.ranges <= 2.0 * rho].sum() + np.count_nonzero(np.abs(np.diff(of.stress)) <= rho)),
        "max_range_MPa": rho,
        "max_equivalent_range_dS": d_dS,
        "power_sum": float(n @ ((of.ranges + rho) ** k - of.ranges**k) + points * rho**k),
        "R_largest": ratio_bound(of.R, R_largest, relative_bound(rho, largest)),
        "with_mean_stress": of_cycles + of_sums,
    }


def chain_cycle_bounds(of: Chained) -> Bounds:
    """Those of ``rounding.cycle_bounds`` but of a damage; equal stresses of two events are always ties."""
    rho = 2.0 * of.delta
    return {
        "delta": of.delta,
        "ties": float(np.count_nonzero(np.diff(np.sort(of.stress)) <= rho)),
        "range_MPa": rho,
        "equivalent_range_dS": _equivalent_bound(of, rho),
    }


def _equivalent_bound(of: Chained, rho: float) -> float:
    """Bound on the equivalent range."""
    return equivalent_bound(of.size, rho, rho, float(np.abs(of.stress).max()) if of.mean_stress else 0.0)
