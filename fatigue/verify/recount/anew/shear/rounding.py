"""What rounding may do to the half cycles of a path: to what is said of the largest one, and to their Miner sums.

Where other points are as far apart as the two ends of the largest half cycle, rounding may make them the ends; and
where another half cycle is as large, that one the largest. Then the bound is how far apart they are, or infinite.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.rounding import LOST, Bounds, damage_bound
from fatigue.verify.recount.anew.shear.path import HalfCycles

Floats = NDArray[np.float64]

EQUAL = 1.0 - 1e-9  # of the largest range: ranges that are equal


def bound_of_largest(value: float, of_each: Floats, bounds: Floats, path: HalfCycles, rho: float) -> float:
    """Bound on what is said of the largest half cycle, of equal ones the largest value.

    Parameters
    ----------
    value : that is said
    of_each, bounds : (h,) value of each half cycle, and the bound on it
    rho : bound on a range [MPa]
    """
    largest = float(path.range.max(initial=0.0))
    if rho == 0.0:
        return 0.0
    some = path.range >= EQUAL * largest - 2.0 * rho
    if rho >= LOST * largest or not path.is_sure[some].all():
        return np.inf
    pairs = np.unique(np.sort(np.stack([path.start, path.end], axis=1), axis=1), axis=0, return_inverse=True)[1]
    return spread_of_largest(value, of_each, bounds, path.range, pairs, rho)


def spread_of_largest(
    value: float, of_each: Floats, bounds: Floats, ranges: Floats, pairs: NDArray[np.intp], rho: float
) -> float:
    """Bound on the largest value of all equal ranges: rounding in it, and where it may be of others, all of them.

    ``pairs`` are numbers of the two ends of each range: between the same ends the range is the same.
    """
    largest = float(ranges.max())
    some = ranges >= EQUAL * largest - 2.0 * rho
    is_sure = len(np.unique(pairs[some])) == 1 or (ranges[some] >= EQUAL * largest + 2.0 * rho).all()
    apart = 0.0 if is_sure else np.abs(of_each - value)[some]
    return float((bounds[some] + apart).max())


def sums_bounds(
    path: HalfCycles, x: Floats, d_x: float, rho: float, samples: int, alpha: float | None, curve: RecountCurve
) -> Bounds:
    """Bounds on the Miner sums of half cycles with the equivalent ranges x (h,), ``d_x`` the bound on these.

    A half cycle that is little more than rounding may be as long as all its steps.
    """
    if rho == 0.0:
        return dict.fromkeys(("by_range", "by_length", "by_moment"), 0.0)
    per_range, weight = x / path.range, alpha or 0.0
    p, one_g = np.maximum(path.length / path.range, 1.0), 1.0 + weight * path.moment
    longest = samples * rho / LOST
    swept = np.minimum(path.moment_bound * path.range, 4.0 / np.pi * longest)  # no moment is above 4 p / pi
    by_length = p * d_x + per_range * (np.minimum(path.length_bound, longest) + rho * p)
    return {
        "by_range": damage_bound(x, np.full_like(x, 0.5), d_x, samples, curve),
        "by_length": _sum_bound(p * x, by_length, samples * d_x, curve),
        "by_moment": _sum_bound(
            one_g * x, one_g * d_x + weight * per_range * swept, samples * (1.0 + 4.0 / np.pi * weight) * d_x, curve
        ),
    }


def _sum_bound(of: Floats, by: Floats, of_rounding: float, curve: RecountCurve) -> float:
    """Half of the damage of ranges grown by their bounds, and of all that is nothing but rounding as one range."""
    grown, shrunk = curve.damage(of + by), curve.damage(np.maximum(of - by, 0.0))
    return 0.5 * float((grown - shrunk).sum() + curve.damage(np.array([of_rounding]))[0])
