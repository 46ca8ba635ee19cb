"""Load, curve and thickness: the strength with which each weld just meets the target.

Load and curve are answered from what is stored: in closed form on a straight curve, else on the histogram, between two
bounds. Thickness changes the mix of membrane and bending stress, and so every reversal: it is counted again at every
trial, as is a load under a mean-stress rule, whose conditions do not scale. A point of which only a bound is known is
counted as soon as that bound could govern.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.backsolve.closed import strength_factor
from fatigue.decide.backsolve.counted import CountedPoints
from fatigue.decide.backsolve.forward import Base, with_strength, worst_of_welds
from fatigue.decide.backsolve.root import JUMPS, log_steps, smallest_around, smallest_that_meets
from fatigue.decide.backsolve.strength import Kind
from fatigue.decide.whatif.forward import EXACT, HISTOGRAM, forward
from fatigue.decide.whatif.margin import load_factors
from fatigue.stages import stage

Floats = NDArray[np.float64]
Rows = NDArray[np.int64]
Counting = Callable[[Rows], AbstractContextManager[CountedPoints]]

SCAN = log_steps(0.5, 2.0, 33)  # of thickness: a half to twice
LOAD_STEPS = 33  # about what is known of a load or curve
ROUNDS = 8  # of points that turn out to govern beside those counted so far
MEETS = 1.0 + 1e-6  # utilisation


@dataclass(slots=True, eq=False)
class Strengths:
    """Answers of w welds; all arrays are (w,).

    Attributes
    ----------
    x : strength that just meets the target; 0: any of those looked at does, inf: none does
    low, high : between which it is
    row : of the point that governs, in the table of nodes
    utilisation : at ``x``, by going forward; NaN where nothing was solved
    basis : exact, histogram or recount
    not_monotonic : whether the utilisation rises anywhere with the strength
    jumps : whether the target is passed in a jump, at a cut-off or where a mean-stress rule begins
    """

    x: Floats
    low: Floats
    high: Floats
    row: Rows
    utilisation: Floats
    basis: NDArray[np.object_]
    not_monotonic: NDArray[np.bool_]
    jumps: NDArray[np.bool_]


def from_stored(base: Base, kind: Kind, target_km: float, counting: Counting) -> Strengths:
    """Factors on load or curve of every weld.

    Raises
    ------
    DataError : points have to be counted, and an input is gone or has changed
    """
    stored, slope = base.stored, base.slope
    now = stored.damage_per_km * target_km / base.limit[stored.weld]
    u, row = worst_of_welds(base, now, stored.toe & stored.counted)
    found = _nothing(len(stored.welds), row)
    rules = [base.curve(w).after.rule for w in _each(base)]
    is_straight = np.array([rule.law.is_straight for rule in rules])
    with_f_M = np.array([rule.yield_of_damage is not None for rule in rules])
    of_counted = with_f_M & ((kind == "load") | ~is_straight)  # its conditions do not scale with the load
    straight = is_straight & ~of_counted
    damaged = u > 0.0
    guess = np.where(damaged, strength_factor(np.where(damaged, u, 1.0), slope), 1.0)
    found.x = np.where(damaged & ~of_counted, guess, 0.0)  # counted points ask for more
    found.low, found.high = found.x.copy(), found.x.copy()
    found.basis[straight] = "exact"
    knees = ~straight & ~of_counted & damaged
    if knees.any():
        of_counted |= knees & ~_on_histograms(base, target_km, knees, found)
    found.low, found.high = np.minimum(found.low, found.x), np.maximum(found.high, found.x)  # but for rounding
    to_count = _could_govern(base, kind, target_km, now, found, of_counted)
    if to_count.size:
        stage("counting %d points again", len(to_count))
        with counting(to_count) as counted:
            _with_counted(base, kind, target_km, guess, counted, found)
    _prove(base, target_km, found)
    return found


def _each(base: Base) -> range:
    return range(len(base.stored.welds))


def _nothing(welds: int, row: Rows) -> Strengths:
    flags = np.zeros(welds, np.bool_)
    zero, nan = np.zeros(welds), np.full(welds, np.nan)
    return Strengths(zero, zero.copy(), zero.copy(), row.copy(), nan, np.full(welds, "", object), flags, flags.copy())


def _on_histograms(base: Base, target_km: float, knees: NDArray[np.bool_], found: Strengths) -> NDArray[np.bool_]:
    """Solve welds on curves with a knee: the load factors of their points, between two bounds, in place.

    Returns
    -------
    (w,) welds of which some point has ranges; nothing is known of the others
    """
    stored = base.stored
    change = replace(base.change, after=replace(base.change.after, target_km=target_km))
    at = forward(stored, change, base.curves, base.ranges_of)
    factors = load_factors(stored, change, base.curves, base.ranges_of, at)
    for name, part in (("low", factors.high), ("x", factors.value), ("high", factors.low)):
        with np.errstate(divide="ignore"):
            x, row = worst_of_welds(base, 1.0 / part, stored.toe & ~np.isnan(part))
        solved = row >= 0
        setattr(found, name, np.where(knees, np.where(solved, x, 0.0), getattr(found, name)))
        if name == "x":
            found.row = np.where(knees & solved, row, found.row)
    found.basis[knees & solved] = "histogram"
    return np.asarray(solved)


def _could_govern(
    base: Base, kind: Kind, target_km: float, now: Floats, found: Strengths, of_counted: NDArray[np.bool_]
) -> Rows:
    """Toe points that have to be counted: those of which nothing but a bound is known, and it is above the target."""
    stored = base.stored
    x = np.where(found.x > 0.0, found.x, 1.0)
    at = with_strength(base, x)
    known = np.isin(at.basis, (EXACT, HISTOGRAM)) & stored.counted
    law = [base.curve(w).after.rule.law for w in _each(base)]
    steepest = np.array([float(one.slopes.max()) for one in law])
    may_enter = np.array([one.cutoff > 0.0 for one in law]) & (x < 1.0)
    lowest = np.array([float(one.slopes.min()) for one in law])
    has_cutoff = np.array([one.cutoff > 0.0 for one in law])
    with np.errstate(divide="ignore"):
        growth = np.where(x < 1.0, x**-steepest, np.where(has_cutoff | ~(x > 1.0), 1.0, x**-lowest))
    growth = np.where(may_enter, np.inf, growth)
    with np.errstate(invalid="ignore"):
        bound = np.nan_to_num(now * growth[stored.weld], nan=np.inf)  # 0 times inf: cycles may enter above the cut-off
    candidates = stored.toe & ~known & (bound > MEETS) & ~of_counted[stored.weld]
    rows = set(np.flatnonzero(candidates).tolist())
    for weld in np.flatnonzero(of_counted).tolist():  # no law of forward holds: the worst now is counted
        rows |= _worst_now(base, weld, now)
    return np.array(sorted(rows), np.int64)


def _worst_now(base: Base, weld: int, now: Floats) -> set[int]:
    """Toe points of a weld that reach half of its largest utilisation, and those whose bounds do."""
    own = np.flatnonzero(base.stored.toe & (base.stored.weld == weld))
    return set(own[now[own] >= 0.5 * now[own].max()].tolist()) if now[own].max() > 0.0 else set()


def _with_counted(
    base: Base, kind: Kind, target_km: float, guess: Floats, counted: CountedPoints, found: Strengths
) -> None:
    """Let counted points govern where they ask for more strength, in place."""
    weld = base.stored.weld[counted.rows]
    of = smallest_around(
        lambda x: counted.utilisation(kind, x, target_km), np.maximum(guess, found.x)[weld], LOAD_STEPS
    )
    for i in np.argsort(of.x, kind="stable").tolist():
        w, x = int(weld[i]), float(of.x[i])
        if x > found.x[w] or (found.basis[w] == "" and x == found.x[w]):
            found.x[w], found.low[w], found.high[w] = x, max(found.low[w], x), max(found.high[w], x)
            found.row[w], found.basis[w] = counted.rows[i], "recount"
            found.utilisation[w] = of.utilisation[i]
            found.jumps[w], found.not_monotonic[w] = of.jumps[i], of.not_monotonic[i]


def _prove(base: Base, target_km: float, found: Strengths) -> None:
    """Utilisation of every weld at its answer, in place; counted ones have theirs."""
    solved = np.isfinite(found.x) & (found.x > 0.0)
    at = with_strength(base, np.where(solved, found.x, 1.0)).utilisation(target_km).value
    stored = solved & (found.basis != "recount")
    found.utilisation = np.where(stored, at[np.maximum(found.row, 0)], found.utilisation)
    with np.errstate(invalid="ignore"):
        found.jumps |= solved & (np.abs(found.utilisation - 1.0) > JUMPS)


def of_thickness(base: Base, target_km: float, counting: Counting, rows: Rows) -> Strengths:
    """Factors on the thickness of every weld, the points ``rows`` looked at (ascending), all of them counted.

    Raises
    ------
    DataError : an input is gone or has changed
    """
    stored = base.stored
    now = stored.damage_per_km * target_km / base.limit[stored.weld]
    looked_at = np.zeros(len(stored), np.bool_)
    looked_at[rows] = True
    _, row = worst_of_welds(base, now, stored.toe & looked_at)
    found = _nothing(len(stored.welds), row)
    found.basis[:] = "recount"
    governing = set(row[row >= 0].tolist())
    stage("counting %d thicknesses of the worst points of %d welds", len(SCAN), len(stored.welds))
    with counting(rows) as every:
        for _ in range(ROUNDS):
            chosen = np.searchsorted(every.rows, sorted(governing))
            _thickness_of(base, target_km, every.of(chosen), found)
            more = _worse(base, target_km, every, found)
            if not more - governing:
                break
            governing |= more
    return found


def _thickness_of(base: Base, target_km: float, counted: CountedPoints, found: Strengths) -> None:
    """Solve every weld with the largest utilisation of its counted points, in place."""
    weld = base.stored.weld[counted.rows].astype(np.int64)
    welds = len(base.stored.welds)
    last: dict[str, Floats] = {}

    def utilisation(x: Floats) -> Floats:
        last["u"] = counted.utilisation("thickness", x[weld], target_km)
        largest = np.zeros(welds)
        np.maximum.at(largest, weld, last["u"])
        return largest

    of = smallest_that_meets(utilisation, SCAN, welds)
    found.x, found.not_monotonic, found.jumps = of.x, of.not_monotonic, of.jumps
    found.low, found.high = of.x.copy(), of.x.copy()
    at = np.where(np.isfinite(of.x), np.maximum(of.x, SCAN[0]), SCAN[-1])
    found.utilisation = np.where(np.isfinite(of.x) & (of.x > 0.0), utilisation(at), np.nan)
    order = np.lexsort([-counted.rows, last["u"]])
    found.row[weld[order]] = counted.rows[order]


def _worse(base: Base, target_km: float, every: CountedPoints, found: Strengths) -> set[int]:
    """Points that miss the target at the thickness of their weld, and are the worst of it there."""
    solved = np.isfinite(found.x)
    x = np.where(solved, np.maximum(found.x, SCAN[0]), 1.0)
    weld = base.stored.weld[every.rows]
    u = np.where(solved[weld], every.utilisation("thickness", x[weld], target_km), 0.0)
    worst: dict[int, int] = {}
    for i in np.flatnonzero(u > MEETS).tolist():
        if u[i] > u[worst.get(int(weld[i]), i)] or int(weld[i]) not in worst:
            worst[int(weld[i])] = i
    return {int(every.rows[i]) for i in worst.values()}
