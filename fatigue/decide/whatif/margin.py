"""The load factor under a change: the scale on all stresses that just meets the target, between two bounds.

On one slope it is the utilisation to the power -1/k. With a knee the utilisation under a factor comes from the ranges
that are stored, so the factor is solved three times: with the upper bound of the damage for the low one, with the
value, and with the lower bound for the high one. Of a large result only the worst point of each weld gets it.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.whatif.change import Change
from fatigue.decide.whatif.curves import Curves, OneCurve
from fatigue.decide.whatif.forward import COUNTED, RECOUNT, Forward, Ranges, entered, mission_classes
from fatigue.decide.whatif.stored import Stored, StoredRanges
from fatigue.life.bounds.histogram import Enclosed, joined_classes
from fatigue.life.mission import straight_load_factor

Floats = NDArray[np.float64]
UtilisationAt = Callable[[Floats, NDArray[np.bool_]], Floats]

MOST_STEPS = 100
CLOSE = 1e-11  # of ln(factor)
EDGE = 0.4 * CLOSE
WIDE = 0.1  # of ln(factor), at first
MOST_CLASSES = 1_000_000  # beyond, of each weld the worst point alone has a load factor: a second for 40 000 classes
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
        elif curve.ranges != "none" and (here := here & (found.basis != COUNTED)).any():  # its ranges are not stored
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
    if len(some.classes) > MOST_CLASSES:
        some = every.some(_worst(stored, limit, here, some)[every.classes.of])
    rows = np.unique(some.classes.of)
    classes, f = mission_classes(change, some, change.after.weights > 0.0)
    if len(np.unique(f)) == 1:  # the events of a point in one: fewer classes, whose bounds are hardly wider
        classes = joined_classes(classes)
        f = np.full(len(classes), f[0])
    place = np.searchsorted(rows, classes.of)
    scale = change.after.target_km / limit[rows]

    def utilisation(part: int) -> UtilisationAt:
        def at(log_factor: Floats, points: NDArray[np.bool_]) -> Floats:
            asked = points[place]
            own = classes.some(asked)
            found = entered(own, f[asked] * np.exp(log_factor)[place[asked]], curve, stored, len(stored))
            return np.asarray(found[part][rows] * scale)

        return at

    low, value, high = (largest_factor(utilisation(part), len(rows)) for part in (2, 1, 0))
    return rows, Enclosed(low, value, high)


def _worst(stored: Stored, limit: Floats, here: NDArray[np.bool_], some: StoredRanges) -> NDArray[np.bool_]:
    """Of some points with ranges the toe point of each weld (n,) that was the worst as assessed."""
    asked = np.zeros(len(stored), dtype=np.bool_)
    asked[some.classes.of] = True
    rows = np.flatnonzero(asked & here & stored.toe)
    order = np.lexsort((-stored.damage_per_km[rows] / limit[rows], stored.weld[rows]))
    _, first = np.unique(stored.weld[rows][order], return_index=True)
    worst = np.zeros(len(stored), dtype=np.bool_)
    worst[rows[order][first]] = True
    return worst


def largest_factor(utilisation: UtilisationAt, n: int) -> Floats:
    """Largest factors (n,) up to which a rising utilisation is at most 1; +inf where it is 0 at any factor.

    ``utilisation`` gives that at ln of the factors (n,), of which only some are asked for (n,). Secants of
    ln(utilisation) over ln(factor), which is nearly straight, within brackets that are halved now and then: a cut-off
    makes it jump.
    """
    low, every = np.zeros(n), np.ones(n, dtype=np.bool_)
    of_low = _log(utilisation(low, every))
    never = (of_low == -np.inf) & (_log(utilisation(low + FAR, every)) == -np.inf)
    high, of_high = low.copy(), of_low.copy()
    width = WIDE
    for _ in range(MOST_STEPS):  # a bracket
        up, down = (of_high <= 0.0) & ~never, of_low > 0.0
        if not (up | down).any():
            break
        low, high = np.where(up, high, low), np.where(down, low, high)
        of_low, of_high = np.where(up, of_high, of_low), np.where(down, of_low, of_high)
        low, high = np.where(down, low - width, low), np.where(up, high + width, high)
        here = _log(utilisation(np.where(up, high, low), up | down))
        of_low, of_high = np.where(down, here, of_low), np.where(up, here, of_high)
        width = min(2.0 * width, 5.0)
    for step in range(MOST_STEPS):
        is_open = (high - low > CLOSE) & ~never
        if not is_open.any():
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            secant = low - of_low * (high - low) / (of_high - of_low)
        aside = np.where(step % 2, EDGE, -EDGE)  # of a secant that has found it, so that both ends close in
        is_secant = np.isfinite(secant) & (secant > low) & (secant < high) & (step % 3 != 2)
        at = np.where(is_secant, np.clip(secant + aside, low, high), 0.5 * (low + high))
        here = _log(utilisation(at, is_open))
        above = here > 0.0
        low, of_low = np.where(is_open & ~above, at, low), np.where(is_open & ~above, here, of_low)
        high, of_high = np.where(is_open & above, at, high), np.where(is_open & above, here, of_high)
    return np.where(never, np.inf, np.exp(low))


def _log(values: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.log(np.maximum(values, 0.0))
