"""Forward: the damage of every point under a changed mission, curve or load, and what each number rests on.

``exact``       every cycle does a known multiple of what it did: sums of stored damages
``histogram``   ranges in classes are entered into the new law: between two proven bounds
``bound``       a multiple of a stored damage that no cycle exceeds; of points that were not counted, or have no ranges
``recount``     nothing stored says enough: no number
``counted``     counted again, where that was asked for (``recounted``)

Events that keep their damage stay exact beside others that do not. Cycles across events go with the events they join.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.of_result import is_sum_of_events
from fatigue.decide.whatif.change import Change
from fatigue.decide.whatif.curves import Curves, OneCurve
from fatigue.decide.whatif.stored import Kind, Stored, StoredRanges
from fatigue.life.bounds.histogram import Classes, Enclosed, damage_between, damage_of_classes, joined_classes
from fatigue.life.bounds.law_ratio import ratio_extremes

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Ranges = Callable[[Kind], StoredRanges]

BASES = ("exact", "histogram", "bound", "recount", "counted")
EXACT, HISTOGRAM, BOUND, RECOUNT, COUNTED = range(5)
SHARE_OF_LIMIT = 0.1  # a bound that reaches it is counted again
ROUNDING = 1e-9  # relative, of a stored sum


@dataclass(frozen=True, slots=True, eq=False)
class Forward:
    """Damage of n points under a change.

    Attributes
    ----------
    basis : (n,) what each rests on, a number in ``BASES``
    damage : (n,) low, value and high [1/km]; NaN of a point to be counted again. Of a ``bound`` the value is the high
    limit_before, limit : (n,) allowed damage sum
    """

    basis: NDArray[np.int8]
    damage: Enclosed
    limit_before: Floats
    limit: Floats

    def utilisation(self, target_km: float) -> Enclosed:
        """Damage at the target over its limit: low, value and high (n,)."""
        return Enclosed(*(part * target_km / self.limit for part in self.damage))


@dataclass(slots=True, eq=False)
class _Sum:
    """What the events add up to at some points, as they are looked at one kind after the other."""

    low: Floats
    value: Floats
    high: Floats
    basis: NDArray[np.int8]

    def add(self, at: slice | Flags | NDArray[np.intp], found: Enclosed, basis: int) -> None:
        """Add to some points, whose numbers rest on the weaker one of two bases then."""
        self.low[at] += found.low
        self.value[at] += found.value
        self.high[at] += found.high
        self.basis[at] = np.maximum(self.basis[at], basis)


def forward(
    stored: Stored, change: Change, curves: Curves, ranges: Ranges, *, decided_by_shear: bool = False
) -> Forward:
    """Damage of every point under a change, with what it rests on.

    ``ranges`` reads the histograms of a kind. With ``decided_by_shear`` a damage sum of shear, of which nothing is
    stored, may decide at toes.
    """
    number = np.array([curves.of_weld[weld] for weld in stored.welds])
    of_point = number[stored.weld]
    before, after = (np.array([getattr(c, key) for c in curves.curves]) for key in ("limit_before", "limit"))
    found = Forward(
        basis=np.full(len(stored), RECOUNT, dtype=np.int8),
        damage=Enclosed(*np.full((3, len(stored)), np.nan)),
        limit_before=before[of_point],
        limit=after[of_point],
    )
    if change.recount:
        return found
    every = len(curves.curves) == 1
    for i, curve in enumerate(curves.curves):
        rows = np.arange(len(stored)) if every else np.flatnonzero(of_point == i)
        if rows.size:
            total = _of_curve(stored, change, curve, rows, ranges)
            at = slice(None) if every else rows
            found.basis[at] = total.basis
            for part, value in zip(found.damage, (total.low, total.value, total.high), strict=True):
                part[at] = value
    _without_sum(stored, change, curves, found, decided_by_shear=decided_by_shear)
    _recount_bounds(stored, change, found)
    unknown = found.basis == RECOUNT
    for part in found.damage:
        part[unknown] = np.nan
    return found


def _of_curve(stored: Stored, change: Change, curve: OneCurve, rows: NDArray[np.intp], ranges: Ranges) -> _Sum:
    """Damage of the points of one curve."""
    n = len(rows)
    every = n == len(stored)
    per_pass = stored.per_pass if every else stored.per_pass[rows]
    weights, factors = change.after.weights, change.factors
    total = _Sum(np.zeros(n), np.zeros(n), np.zeros(n), np.full(n, EXACT, dtype=np.int8))
    exact = _exact_events(change, curve)
    if exact.any():
        of_law = curve.before.rule.law.log_constants[0] - curve.after.rule.law.log_constants[0]
        multiple = weights * exact * (factors**curve.slope if curve.is_exact else 1.0)
        known = per_pass @ multiple
        if curve.is_exact and not (curve.same_size and of_law == 0.0):
            size = curve.range_factors(stored.thickness[rows], stored.attachment[rows]).most
            known = known * (size**curve.slope * np.exp(of_law))
        total.add(slice(None), Enclosed(known, known, known), EXACT)
    others = ~exact & (weights > 0.0)
    if others.any():
        _add_others(stored, change, curve, rows, others, ranges, total)
    counted = stored.counted[rows]
    total.low[~counted] = 0.0
    total.value = np.where(counted & (total.basis != BOUND), total.value, total.high)
    total.basis = np.where(counted, total.basis, np.maximum(total.basis, BOUND)).astype(np.int8)
    total.basis[~np.isfinite(total.low) | ~np.isfinite(total.high)] = RECOUNT
    return total


def _exact_events(change: Change, curve: OneCurve) -> Flags:
    """Which events and loops (r,) keep their damage but for a known multiple."""
    if curve.is_exact:
        return np.ones(len(change.names), dtype=np.bool_)
    return np.asarray((change.factors == 1.0) & (curve.is_same and curve.same_size))


def _add_others(
    stored: Stored,
    change: Change,
    curve: OneCurve,
    rows: NDArray[np.intp],
    others: Flags,
    ranges: Ranges,
    total: _Sum,
) -> None:
    """Add the events of which the damage of single cycles changes: from their ranges, else by bounds."""
    kind = curve.ranges
    if kind == "none":
        total.basis[:] = RECOUNT
        return
    stored_ranges = ranges(kind)
    place = np.full(len(stored), -1)
    place[rows] = np.arange(len(rows))
    has_ranges = np.zeros(len(rows), dtype=np.bool_)
    here = place[stored_ranges.classes.of] >= 0
    has_ranges[place[stored_ranges.classes.of[here]]] = True
    if has_ranges.any():
        some = stored_ranges.some(here & others[stored_ranges.row])
        found = _of_ranges(stored, change, curve, some, others)
        at = np.flatnonzero(has_ranges)
        total.add(at, Enclosed(*(part[rows[at]] for part in found)), HISTOGRAM)
    if not has_ranges.all():
        at = np.flatnonzero(~has_ranges)
        total.add(at, _bounded(stored, change, curve, rows[at], others), BOUND)


def _of_ranges(stored: Stored, change: Change, curve: OneCurve, some: StoredRanges, others: Flags) -> Enclosed:
    """Damage per km (n,) of the events among ``others`` from their ranges, 0 of points that have none here."""
    classes, f = mission_classes(change, some, others)
    return entered(classes, f, curve, stored, len(stored))


def mission_classes(change: Change, some: StoredRanges, rows: Flags) -> tuple[Classes, Floats]:
    """Classes per km of some events and loops, and the factor on the stress of each.

    Loops are joined with the events whose cycles they replace.
    """
    joined = rows & change.loop_events()
    alone = rows & ~joined
    parts = [some.classes_of(alone[some.row], change.after.weights)]
    factors = [change.factors[some.row[alone[some.row]]]]
    for factor in np.unique(change.factors[joined]):
        of_loops = joined & (change.factors == factor)
        parts.append(joined_classes(some.classes_of(of_loops[some.row], change.after.weights)))
        factors.append(np.full(len(parts[-1]), factor))
    classes = Classes(*(np.concatenate([getattr(part, name) for part in parts]) for name in Classes.__slots__))
    return classes, np.concatenate(factors)


def entered(classes: Classes, f: Floats, curve: OneCurve, stored: Stored, points: int) -> Enclosed:
    """Damage of classes with a factor ``f`` (c,) on their stress, entered into the new law of a curve, by points."""
    own = curve.range_factors(stored.thickness, stored.attachment)
    law = curve.after.rule.law
    least, most = f * own.least[classes.of], f * own.most[classes.of]
    found = damage_of_classes(classes, curve.slope, law, np.sqrt(least * most) if curve.ranges == "S" else most, points)
    if np.array_equal(least, most):
        return found
    low = damage_of_classes(classes, curve.slope, law, least, points).low
    return Enclosed(low, found.value, damage_of_classes(classes, curve.slope, law, most, points).high)


def _bounded(stored: Stored, change: Change, curve: OneCurve, rows: NDArray[np.intp], others: Flags) -> Enclosed:
    """Bounds of the damage per km of some events at points without ranges.

    They are multiples of the damage that no cycle exceeds. Where the old law is straight the damage is a power sum, so
    that of a counted point all cycles of an event are one class from 0 to the largest range.
    """
    low, high = np.zeros(len(rows)), np.zeros(len(rows))
    own = curve.equivalent_factors(stored.thickness[rows], stored.attachment[rows])
    if own is None:
        return Enclosed(low, np.full(len(rows), np.inf), np.full(len(rows), np.inf))
    largest, joined = stored.largest("dS")[rows], others & change.loop_events()
    old, new = curve.before.rule.law, curve.after.rule.law
    is_power_sum = old.is_straight and curve.same_cycle
    cycles = stored.cycles()[rows] if is_power_sum else np.full(largest.shape, np.nan)
    groups = [np.arange(len(others)) == event for event in np.flatnonzero(others & ~joined)]
    groups += [joined & (change.factors == factor) for factor in np.unique(change.factors[joined])]
    for group in groups:
        weights = change.after.weights * group
        damage = np.maximum(stored.per_pass[rows] @ weights, 0.0)
        reach = largest[:, group].max(axis=1)
        f = float(change.factors[group][0])
        of_least = ratio_extremes(old, new, f * own.least, reach).least * damage
        most = ratio_extremes(old, new, f * own.most, reach).most
        there = (reach > 0.0) & ((damage > 0.0) | np.isinf(most))
        of_most = np.where(there, np.where(damage > 0.0, damage, 1.0) * most, 0.0)
        n = cycles[:, group] @ weights[group]
        counted = np.flatnonzero((n > 0.0) & (reach > 0.0))
        power_sum = damage[counted] * np.exp(old.log_constants[0])
        ends = np.zeros(len(counted)), reach[counted] * (1.0 + ROUNDING)
        as_class = damage_between(n[counted], power_sum, ends, curve.slope, new, f * own.most[counted])
        of_least[counted] = np.maximum(of_least[counted], as_class.low)
        of_most[counted] = np.minimum(of_most[counted], as_class.high)
        low += of_least
        high += of_most
    return Enclosed(np.minimum(low, high), high.copy(), high)


def _without_sum(stored: Stored, change: Change, curves: Curves, found: Forward, *, decided_by_shear: bool) -> None:
    """Points whose damage is not the sum of its events, as another sum decides there, in place."""
    differs = ~is_sum_of_events(stored.damage_per_km, stored.per_pass @ change.before.weights)
    if decided_by_shear:
        differs |= stored.toe
    if not differs.any():
        return
    same_mission = np.array_equal(change.before.weights, change.after.weights) and not change.scales_load
    same_curve = np.array([c.is_same and c.same_size for c in curves.curves])
    of_point = np.array([curves.of_weld[weld] for weld in stored.welds])[stored.weld]
    kept = differs & same_mission & same_curve[of_point]
    for part in found.damage:
        part[kept] = stored.damage_per_km[kept]
    found.damage.low[kept & ~stored.counted] = 0.0
    found.basis[differs & ~kept] = RECOUNT


def _recount_bounds(stored: Stored, change: Change, found: Forward) -> None:
    """Toe points whose bound is not enough, in place.

    Of a point that was not counted it is one that reaches a share of the limit, or the worst counted point of its weld;
    of one that was counted and has no ranges, one that leaves open whether the target is met.
    """
    low, _, high = found.utilisation(change.after.target_km)
    known = stored.toe & (found.basis < BOUND)
    worst = np.zeros(len(stored.welds))
    np.maximum.at(worst, stored.weld[known], low[known])
    share = max(SHARE_OF_LIMIT, float(stored.record["rules"]["screening"]["share_of_limit"]))
    reaches = (high >= share) | ((high >= worst[stored.weld]) & (high > 0.0))
    is_open = np.where(stored.counted, (low <= 1.0) & (high > 1.0), reaches)
    found.basis[stored.toe & (found.basis == BOUND) & is_open] = RECOUNT
