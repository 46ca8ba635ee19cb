"""Which stations of a group of welds need counting, and proven bounds for the others.

A station may go without counting when no event, and no choice of bending ratios, can take its damage to a stated share
of the limit, and when it cannot be the worst point of its weld: its bound is below the damage that was counted at
another toe point of the weld. So the point that the spectrum says is worst is counted first, weld by weld. Bounds come
in tiers, each sharper and dearer than the one before; a station leaves as soon as one of them settles it, even while
its events are counted, as soon as those that were counted and the bounds of the others do. Where it is enough to know
the likely worst point of welds that stay below the share everywhere, the second condition is dropped, as a point below
the share is not the worst one of the other welds: it takes most of the time.

Ends without treatment are counted beside the points that are counted, unless the first of the bounds proves that they
stay below the share as well.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.forms import face_forms, part_forms
from fatigue.life.bounds.screening import ModalExtent, extent_bound
from fatigue.life.bounds.weld_basis import reduced_bound, weld_bases
from fatigue.life.counting.record import SingleRecord
from fatigue.life.mission import Plan, mission_sum
from fatigue.pipeline.count.bounds import Bound, Unsettled, event_bound, event_by_event
from fatigue.pipeline.count.estimate import Estimate, estimate_event, mean_stress, member_variances
from fatigue.pipeline.count.event_block import no_overflow
from fatigue.pipeline.count.piece import TIERS, Piece, bounded_at, counted_at, counted_while
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import Shapes

WELD_BOUNDS_AT_ONCE = 1024  # stations, or those of one weld: 10 kB each with 100 modes
BOUNDED_AT_ONCE = 1024  # stations whose bounds are laid out as events at a time: 4 kB each with 12 events


@dataclass(frozen=True, slots=True, eq=False)
class Screening:
    """What settles points without counting.

    ``share`` of the damage limit below which a bound is enough; ``proves_worst``: also the worst point of welds that
    are below it everywhere has to be proven; ``extents`` and ``records`` say of every event how far and how much its
    modal coordinates move, without and with a loop over time.
    """

    share: float
    proves_worst: bool
    extents: tuple[ModalExtent, ...]
    records: tuple[SingleRecord, ...]


def settle(
    shapes: Shapes,
    weld: NDArray[np.int64],
    toe: NDArray[np.bool_],
    loads: Sequence[EventLoad],
    plan: Plan,
    screening: Screening,
    welds: str,
) -> Iterator[Piece]:
    """Settle or count every station of some whole welds that share a curve.

    Parameters
    ----------
    shapes : of the stations
    weld : (n,) which weld a station belongs to, ascending
    toe : (n, 2) faces that carry a weld toe
    loads, plan : the events
    screening : up to which share of the limit a bound is enough
    welds : names of the welds, for messages

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    estimates, modal_bounds = _estimates_and_modal_bounds(shapes, loads, screening, welds)
    bounds = list(modal_bounds)
    shapes = _without_small_raw_ends(shapes, loads, plan, screening, welds)

    tier = np.ones(len(shapes), dtype=np.int8)
    likely_worst = _likely_worst(weld, toe, estimates, bounds, plan)
    tier[likely_worst] = 0
    worst = np.zeros((len(shapes), 1))
    for piece in counted_at(likely_worst, shapes, loads, estimates, plan, welds):
        yield piece
        at_worst = np.where(toe[piece.rows], piece.mission.utilisation, 0.0).max(axis=1)
        of_these = np.isin(weld, weld[piece.rows])
        worst[of_these, 0] = at_worst[np.searchsorted(weld[piece.rows], weld[of_these])]

    def unsettled(rows: NDArray[np.intp]) -> NDArray[np.intp]:
        """Stations whose bound neither stays below the share nor below the worst point of their weld."""
        at_most = _utilisation([bound.at(rows) for bound in bounds], plan)
        remains = at_most >= screening.share
        if screening.proves_worst:
            remains |= toe[rows] & (at_most > worst[rows])
        return rows[np.flatnonzero(remains.any(axis=1))]

    rest = unsettled(np.flatnonzero(tier))
    tier[rest] = 2
    _bound_while(unsettled, rest, bounds, shapes, weld, loads, estimates, plan, screening, welds)
    for piece in counted_while(unsettled, unsettled(rest), bounds, shapes, loads, estimates, plan, welds):
        yield piece
        tier[piece.rows] = 0
    for number in range(1, len(TIERS)):
        rows = np.flatnonzero(tier == number)
        for first in range(0, len(rows), BOUNDED_AT_ONCE):
            some = rows[first : first + BOUNDED_AT_ONCE]
            yield bounded_at(some, shapes, estimates, bounds, plan, number)


def _utilisation(bounds: Sequence[Bound], plan: Plan) -> NDArray[np.float64]:
    """Largest share of the damage limit that the whole mission can use up, (n, 2)."""
    per_km = mission_sum(np.stack([bound.damage for bound in bounds]), plan.passes)
    return per_km * plan.target_km / plan.damage_limit


def _estimates_and_modal_bounds(
    shapes: Shapes, loads: Sequence[EventLoad], screening: Screening, welds: str
) -> tuple[tuple[Estimate, ...], tuple[Bound, ...]]:
    """Estimate every event, and bound it from how its modal coordinates move: both without a loop over time.

    Both need variances; they are worked out once for both unless they are of different samples.
    """
    estimates: tuple[Estimate, ...] = ()
    bounds: tuple[Bound, ...] = ()
    for load, extent in zip(loads, screening.extents, strict=True):
        with no_overflow(load.counted.event, welds):
            forms = part_forms(shapes.membrane, shapes.bending, extent.products)
            variances = member_variances(shapes, load) if load.is_upsampled else forms[0, :, :2]
            estimates += (estimate_event(shapes, load, variances),)
            bounds += (_modal_bound(shapes, estimates[-1].mean, forms[..., 2:], load, extent, welds),)
    return estimates, bounds


def _modal_bound(
    shapes: Shapes,
    mean: NDArray[np.float64],
    forms: NDArray[np.float64],
    load: EventLoad,
    extent: ModalExtent,
    welds: str,
) -> Bound:
    """Bound an event from mean stress (n, 2) and the forms (2, n, 2) that `extent_bound` wants."""
    found = extent_bound(shapes.membrane, shapes.bending, forms, extent)
    return event_bound(found, load.stress_factor, shapes, slice(None), mean)


def _without_small_raw_ends(
    shapes: Shapes, loads: Sequence[EventLoad], plan: Plan, screening: Screening, welds: str
) -> Shapes:
    """Let ends without treatment not matter where they stay below the share as well."""
    ends = shapes.raw_ends
    if not ends.rows.size:
        return shapes
    raw = replace(shapes.at(ends.rows), membrane=ends.membrane, bending=ends.bending)
    bounds = []
    for load, extent in zip(loads, screening.extents, strict=True):
        with no_overflow(load.counted.event, welds):
            forms = face_forms(raw.membrane, raw.bending, extent.products)
            bounds.append(_modal_bound(raw, mean_stress(raw, load), forms, load, extent, welds))
    matters = np.asarray((_utilisation(bounds, plan) >= screening.share).any(axis=1))
    return replace(shapes, raw_ends=replace(ends, matters=matters))


def _bound_while(
    unsettled: Unsettled,
    rows: NDArray[np.intp],
    bounds: list[Bound],
    shapes: Shapes,
    weld: NDArray[np.int64],
    loads: Sequence[EventLoad],
    estimates: Sequence[Estimate],
    plan: Plan,
    screening: Screening,
    welds: str,
) -> None:
    """Tighten the bounds of some stations by the range and the variation of their stress, as long as it is needed.

    As in `counted_while`: event by event, those with the largest share first.
    """
    for part in _in_parts(weld, rows):
        bases = weld_bases(shapes.membrane[part], shapes.bending[part], weld[part], screening.extents)
        for number, left in event_by_event(part, bounds, plan, unsettled):
            record, extent = screening.records[number], screening.extents[number]
            found = reduced_bound(bases, np.searchsorted(part, left), record, extent)
            mean, factor = estimates[number].mean[left], loads[number].stress_factor
            bounded = event_bound(found, factor, shapes, left, mean)
            bounds[number] = bounds[number].tightened(bounded, left)


def _in_parts(weld: NDArray[np.int64], rows: NDArray[np.intp]) -> list[NDArray[np.intp]]:
    """Cut some stations, ascending, between welds, into parts of about `WELD_BOUNDS_AT_ONCE`."""
    if not rows.size:
        return []
    first_of_weld = np.searchsorted(weld[rows], weld[rows])
    return np.split(rows, np.flatnonzero(np.diff(first_of_weld // WELD_BOUNDS_AT_ONCE)) + 1)


def _likely_worst(
    weld: NDArray[np.int64],
    toe: NDArray[np.bool_],
    estimates: Sequence[Estimate],
    bounds: Sequence[Bound],
    plan: Plan,
) -> NDArray[np.intp]:
    """Find the station of every weld with the largest estimated damage at a toe; without spectrum, by the bound."""
    guess = np.stack([np.where(np.isnan(e.dirlik), b.damage, e.dirlik) for e, b in zip(estimates, bounds, strict=True)])
    damage = np.where(toe, mission_sum(guess, plan.passes), -1.0).max(axis=1)
    first = np.flatnonzero(np.diff(weld, prepend=weld[0] - 1))
    return np.array(
        [start + int(part.argmax()) for start, part in zip(first, np.split(damage, first[1:]), strict=True)]
    )
