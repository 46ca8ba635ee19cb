"""Stations of one curve that were all counted, or all settled by bounds of one kind: their events and their mission."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.count.bounds import Bound, Unsettled, event_by_event
from fatigue.pipeline.count.estimate import Estimate, estimate_event, member_variances
from fatigue.pipeline.count.event_block import EventBlock, bounded_event, count_event, judged, no_overflow
from fatigue.pipeline.count.mission_block import MissionBlock, mission_block
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import Shapes

TIERS = ("", "modal bound", "weld bound")  # of the column `screened`: counted, or the bound that settled the point
ABOVE = 1.0 + 1e-6  # so that what was counted in single precision is a bound as well
ROWS_WITH_HISTOGRAM = 256  # counted at a time on a curve with a knee: 16 kB a station and event


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Some stations of a block, ``rows`` ascending; ``tier`` is an index into `TIERS`; histograms are left out."""

    rows: NDArray[np.intp]
    events: tuple[EventBlock, ...]
    mission: MissionBlock
    tier: int


def estimated(shapes: Shapes, loads: Sequence[EventLoad], welds: str) -> tuple[Estimate, ...]:
    """Estimate all events at all stations of a block, parts of ``welds``, which are for messages.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    estimates: tuple[Estimate, ...] = ()
    for load in loads:
        with no_overflow(load.counted.event, welds):
            estimates += (estimate_event(shapes, load, member_variances(shapes, load)),)
    return estimates


def counted_at(
    rows: NDArray[np.intp],
    shapes: Shapes,
    loads: Sequence[EventLoad],
    estimates: Sequence[Estimate],
    plan: Plan,
    welds: str,
) -> Iterator[Piece]:
    """Count all events at some stations of a block.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    for part in _cut(rows, shapes):
        some = shapes.at(part)
        events = [_counted(part, some, load, e, welds) for load, e in zip(loads, estimates, strict=True)]
        yield _piece(part, _judged(events, part, shapes, loads, estimates), plan, shapes, 0)


def counted_while(
    unsettled: Unsettled,
    rows: NDArray[np.intp],
    bounds: list[Bound],
    shapes: Shapes,
    loads: Sequence[EventLoad],
    estimates: Sequence[Estimate],
    plan: Plan,
    welds: str,
) -> Iterator[Piece]:
    """Count some stations of a block event by event, as long as they are unsettled.

    The events with the largest share come first. What was counted goes into the ``bounds`` of the events, by which a
    station is ``unsettled`` or not; those that remain so have had all of their events counted.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    for part in _cut(rows, shapes):
        events: dict[int, tuple[NDArray[np.intp], EventBlock]] = {}
        for number, left in event_by_event(part, bounds, plan, unsettled):
            event = _counted(left, shapes.at(left), loads[number], estimates[number], welds)
            counted = Bound(*(ABOVE * a for a in (event.damage, event.max_range, event.max_equivalent_range)))
            bounds[number] = bounds[number].tightened(counted, left)
            events[number] = left, event
        remaining = unsettled(left)
        if remaining.size:
            of_these = [event.at(np.isin(rows, remaining)) for _, (rows, event) in sorted(events.items())]
            yield _piece(remaining, _judged(of_these, remaining, shapes, loads, estimates), plan, shapes, 0)


def bounded_at(
    rows: NDArray[np.intp],
    shapes: Shapes,
    estimates: Sequence[Estimate],
    bounds: Sequence[Bound],
    plan: Plan,
    tier: int,
) -> Piece:
    """Take the bounds of all events at some stations of a block."""
    raw_ends = shapes.raw_ends.at(rows)
    events = [bounded_event(e.at(rows), b.at(rows), raw_ends) for e, b in zip(estimates, bounds, strict=True)]
    return _piece(rows, events, plan, shapes, tier)


def _counted(rows: NDArray[np.intp], some: Shapes, load: EventLoad, estimate: Estimate, welds: str) -> EventBlock:
    with no_overflow(load.counted.event, welds):
        return count_event(some, load, estimate.at(rows))


def _judged(
    events: Sequence[EventBlock],
    rows: NDArray[np.intp],
    shapes: Shapes,
    loads: Sequence[EventLoad],
    estimates: Sequence[Estimate],
) -> list[EventBlock]:
    some = shapes.at(rows)
    of_events = zip(events, loads, estimates, strict=True)
    return [judged(event, some, load, estimate.at(rows)) for event, load, estimate in of_events]


def _cut(rows: NDArray[np.intp], shapes: Shapes) -> Iterator[NDArray[np.intp]]:
    """Take all rows at once unless their histograms would be large."""
    step = max(1, len(rows)) if shapes.rule.law.is_straight else ROWS_WITH_HISTOGRAM
    return (rows[first : first + step] for first in range(0, len(rows), step))


def _piece(rows: NDArray[np.intp], events: Sequence[EventBlock], plan: Plan, shapes: Shapes, tier: int) -> Piece:
    """Weight the events with the mission; only that needs their histograms."""
    mission = mission_block(events, plan, shapes.rule.law)
    nothing = np.zeros((len(rows), 2, 0, 2))
    return Piece(rows, tuple(replace(event, histogram=nothing) for event in events), mission, tier)
