"""The load factor under a change: the scale on all stresses that just meets the target, between two bounds.

On one slope it is the utilisation to the power -1/k. With a knee the utilisation under a factor comes from the ranges
that are stored, so the factor is solved three times: with the upper bound of the damage for the low one, with the
value, and with the lower bound for the high one.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.whatif.change import Change
from fatigue.decide.whatif.curves import Curves, OneCurve
from fatigue.decide.whatif.forward import RECOUNT, Forward, Ranges, entered, mission_classes
from fatigue.decide.whatif.stored import Stored
from fatigue.life.bounds.histogram import Enclosed
from fatigue.life.mission import straight_load_factor

Floats = NDArray[np.float64]

MOST_STEPS = 100
CLOSE = 1e-11  # of ln(factor)
WIDE = 0.1  # of ln(factor), at first
FAR = 20.0  # ln of a factor at which everything damages


def load_factors(stored: Stored, change: Change, curves: Curves, ranges: Ranges, found: Forward) -> Enclosed:
    """Load factors (n,): low, value and high; NaN where nothing stored tells them. +inf where nothing damages."""
    low, value, high = np.full((3, len(stored)), np.nan)
    of_point = np.array([curves.of_weld[weld] for weld in stored.welds])[stored.weld]
    known = found.basis != RECOUNT
    utilisation = found.utilisation(change.after.target_km)
    for i, curve in enumerate(curves.curves):
        rule = curve.after.rule
        here = known & (of_point == i)
        if rule.yield_of_damage is not None or not here.any():
            continue  # the conditions of f_M do not scale
        if rule.law.is_straight:
            k = float(rule.law.slopes[0])
            for part, of in ((low, utilisation.high), (value, utilisation.value), (high, utilisation.low)):
                part[here] = straight_load_factor(of[here], k)
        elif curve.ranges != "none":
            rows, solved = _of_ranges(stored, change, curve, ranges, here, found.limit)
            for part, of in zip((low, value, high), solved, strict=True):
                part[rows] = of
    return Enclosed(low, value, high)


def _of_ranges(
    stored: Stored, change: Change, curve: OneCurve, ranges: Ranges, here: NDArray[np.bool_], limit: Floats
) -> tuple[NDArray[np.intp], Enclosed]:
    """Rows of points with ranges, and their load factors."""
    every = ranges(curve.ranges)  # type: ignore[arg-type]
    some = every.some(here[every.classes.of])
    rows, of = np.unique(some.classes.of, return_inverse=True)
    classes, f = mission_classes(change, some, change.after.weights > 0.0)
    of = np.searchsorted(rows, classes.of)
    scale = change.after.target_km / limit[rows]

    def utilisation(part: int) -> Callable[[Floats], Floats]:
        def at(log_factor: Floats) -> Floats:
            found = entered(classes, f * np.exp(log_factor)[of], curve, stored, len(stored))
            return np.asarray(found[part][rows] * scale)

        return at

    low, value, high = (np.exp(_root(utilisation(part), len(rows))) for part in (2, 1, 0))
    return rows, Enclosed(low, value, high)


def _root(utilisation: Callable[[Floats], Floats], n: int) -> Floats:
    """Ln of the factors (n,) up to which a rising utilisation is at most 1; +inf where it is 0 at any factor.

    Secants of ln(utilisation) over ln(factor), which is nearly straight, within brackets that are halved in between.
    """
    at = np.zeros(n)
    here = _log(utilisation(at))
    never = (here == -np.inf) & (_log(utilisation(at + FAR)) == -np.inf)
    low, high = at.copy(), at.copy()
    of_low, of_high = here.copy(), here.copy()
    width = WIDE
    for _ in range(MOST_STEPS):  # a bracket
        up, down = (of_high <= 0.0) & ~never, of_low > 0.0
        if not (up | down).any():
            break
        high = np.where(up, high + width, high)
        low = np.where(down, low - width, low)
        of_high = np.where(up, _log(utilisation(high)), of_high)
        of_low = np.where(down, _log(utilisation(low)), of_low)
        width = min(2.0 * width, 5.0)
    for step in range(MOST_STEPS):
        open_ = (high - low > CLOSE) & ~never
        if not open_.any():
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            secant = low - of_low * (high - low) / (of_high - of_low)
        middle = 0.5 * (low + high)
        is_secant = np.isfinite(secant) & (secant > low) & (secant < high) & (step % 3 != 2)
        edge = CLOSE * 0.4
        at = np.where(is_secant, np.clip(secant + np.where(step % 2, edge, -edge), low, high), middle)
        here = _log(utilisation(at))
        above = here > 0.0
        low, of_low = np.where(open_ & ~above, at, low), np.where(open_ & ~above, here, of_low)
        high, of_high = np.where(open_ & above, at, high), np.where(open_ & above, here, of_high)
    return np.where(never, np.inf, low)


def _log(values: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.log(np.maximum(values, 0.0))
