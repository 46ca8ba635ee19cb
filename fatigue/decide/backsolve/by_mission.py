"""Mileage in a year and share of an event: both are linear in the damage of single passes, and exact.

The share of one event is s, the others keep their proportions, (1 - s) / (1 - s0) of what they had. Events by number
and cycles across events are held. The utilisation of a point is a line over s, that of a weld the highest of its lines,
so that the shares with which it meets the target are one span, from ``low`` to ``high``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.backsolve.by_strength import Counting
from fatigue.decide.backsolve.closed import Span, km_per_year, shares_that_meet
from fatigue.decide.backsolve.forward import Base, with_counted, with_weights, worst_of_welds
from fatigue.decide.backsolve.question import Question
from fatigue.life.mission import life_km
from fatigue.stages import stage

Floats = NDArray[np.float64]
Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Mileage:
    """Km in a year of w welds, with the row of the point that governs and the utilisation by going forward, (w,)."""

    km_per_year: Floats
    row: Rows
    utilisation: Floats
    counted: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Shares:
    """Shares of w welds; all arrays are (w,).

    Attributes
    ----------
    span : shares with which a weld meets the target, 0 to 1
    answer : the end of the span that is the answer: the one that is passed now, or comes first; NaN: any share or none
    is_upper : whether that is the upper end
    row : of the point that governs there
    utilisation, at_0, at_1 : of the weld, by going forward: at the answer, at a share of 0 and of 1
    counted : whether points were counted for it
    """

    span: Span
    answer: Floats
    is_upper: NDArray[np.bool_]
    row: Rows
    utilisation: Floats
    at_0: Floats
    at_1: Floats
    counted: NDArray[np.bool_]


def mileages(base: Base, asked: Question, counting: Counting) -> tuple[Base, Mileage]:
    """Km in a year that every weld bears for ``asked.years``; infinite where nothing damages.

    Raises
    ------
    DataError : points have to be counted, and an input is gone or has changed
    """
    stored, limit = base.stored, base.limit
    per_limit = stored.damage_per_km / limit[stored.weld]
    least, _ = worst_of_welds(base, per_limit, stored.toe & stored.counted)
    rows = np.flatnonzero(stored.toe & ~stored.counted & (per_limit > np.maximum(least, 0.0)[stored.weld]))
    base, was_counted = _counted(base, rows, counting)
    stored = base.stored
    per_limit = stored.damage_per_km / limit[stored.weld]
    worst, row = worst_of_welds(base, per_limit, stored.toe & stored.counted)
    km = km_per_year(life_km(np.maximum(worst, 0.0), 1.0), asked.years)
    forward = with_weights(base, base.change.before.weights, row)  # damage per km is that of the mission as it is
    with np.errstate(invalid="ignore"):
        utilisation = np.where(np.isfinite(km), forward * km * asked.years, np.nan)
    return base, Mileage(km, row, utilisation, was_counted)


def shares(base: Base, asked: Question, counting: Counting) -> tuple[Base, Shares]:
    """Shares of an event with which every weld meets the target.

    Raises
    ------
    DataError : points have to be counted, and an input is gone or has changed
    """
    allowed = 1.0 / asked.target_km
    sure, safe = (_spans(base, asked, which, allowed)[0] for which in (base.stored.counted, _all(base)))
    narrower = (safe.low > sure.low) | (safe.high < sure.high)
    rows = np.zeros(0, np.int64)
    if narrower.any():
        held, own, rest = _lines(base, asked)
        ends = [np.clip(end, 0.0, 1.0)[base.stored.weld] for end in sure]
        at_ends = [held + s * own + (1.0 - s) * rest for s in ends]
        misses = np.maximum(*at_ends) > allowed
        rows = np.flatnonzero(base.stored.toe & ~base.stored.counted & misses & narrower[base.stored.weld])
    base, was_counted = _counted(base, rows, counting)
    span, (held, own, rest) = _spans(base, asked, base.stored.counted, allowed)
    now = _share(base, asked.event)
    at, is_upper = _answers(span, now)
    welds = np.arange(len(base.stored.welds))

    def worst_at(s: Floats) -> tuple[Floats, Rows]:
        """Largest utilisation of every weld at its share, and the point; the weights are those of that share."""
        line = held + s[base.stored.weld] * own + (1.0 - s[base.stored.weld]) * rest
        _, row = worst_of_welds(base, line, base.stored.toe & base.stored.counted)
        forward = np.array(
            [with_weights(base, weights_of(base, asked.event, float(s[w])), row[w : w + 1])[0] for w in welds]
        )
        return forward * asked.target_km, row

    at_0, at_1 = (worst_at(np.full(len(welds), s))[0] for s in (0.0, 1.0))
    utilisation, row = worst_at(np.where(np.isnan(at), now, at))
    solved = np.where(np.isnan(at), np.nan, utilisation)
    return base, Shares(span, at, is_upper, row, solved, at_0, at_1, was_counted)


def weights_of(base: Base, event: str, share: float) -> Floats:
    """Passes and runs per km (r,) with a share of an event, the others in proportion; what has no share is held.

    The lengths of the passes stay what they are.
    """
    weights, events = base.change.before.weights.copy(), base.stored.record["mission"]["events"]
    before = _share(base, event)
    for number, one in enumerate(events):
        if one["event"] == event:
            weights[number] = share / one["length"]
        elif one["share"] is not None:
            weights[number] *= (1.0 - share) / (1.0 - before)
    return weights


def _share(base: Base, event: str) -> float:
    return float(next(one["share"] for one in base.stored.record["mission"]["events"] if one["event"] == event))


def _all(base: Base) -> NDArray[np.bool_]:
    return np.ones(len(base.stored), np.bool_)


def _lines(base: Base, asked: Question) -> tuple[Floats, Floats, Floats]:
    """Damage per km over the damage limit (n,): what is held, what the event does, what the mix of the others does."""
    events = base.stored.record["mission"]["events"]
    has_share = np.array([one["share"] is not None for one in events] + [False] * len(base.change.loops))
    at_0, at_1 = weights_of(base, asked.event, 0.0), weights_of(base, asked.event, 1.0)
    limit = base.limit[base.stored.weld]
    per_pass = base.stored.per_pass
    held, rest, own = (per_pass @ w / limit for w in (at_0 * ~has_share, at_0 * has_share, at_1 * has_share))
    return held, own, rest


def _spans(
    base: Base, asked: Question, known: NDArray[np.bool_], allowed: float
) -> tuple[Span, tuple[Floats, Floats, Floats]]:
    """Spans of every weld over its known toe points, and the lines of all points."""
    lines = _lines(base, asked)
    of_points = shares_that_meet(*lines, allowed)
    some = base.stored.toe & known
    low, high = np.zeros(len(base.stored.welds)), np.ones(len(base.stored.welds))
    np.maximum.at(low, base.stored.weld[some], of_points.low[some])
    np.minimum.at(high, base.stored.weld[some], of_points.high[some])
    return Span(low, high), lines


def _answers(span: Span, now: float) -> tuple[Floats, NDArray[np.bool_]]:
    """End of each span that answers: the one that is passed now, else the nearer one that is no end of 0 to 1."""
    none = span.low > span.high
    below, above = span.low > 0.0, span.high < 1.0
    to_high, to_low = np.abs(span.high - now), np.abs(span.low - now)
    is_upper = above & (~below | (span.high < now) | ((to_high <= to_low) & (span.low <= now)))
    at = np.where(is_upper, span.high, np.where(below, span.low, np.nan))
    return np.where(none, np.nan, at), is_upper


def _counted(base: Base, rows: Rows, counting: Counting) -> tuple[Base, NDArray[np.bool_]]:
    """The base with some points counted, and the welds (w,) that have any of them."""
    welds = np.zeros(len(base.stored.welds), np.bool_)
    if not rows.size:
        return base, welds
    stage("counting %d points again", len(rows))
    with counting(rows) as counted:
        stored = with_counted(base.stored, counted.rows, counted.per_pass())
    welds[stored.weld[rows]] = True
    return Base(stored, base.change, base.curves, base.ranges), welds
