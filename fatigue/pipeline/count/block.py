"""A block of stations under all events of the mission: counted, counted as far as it is needed, or bounded."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.count.bounds import Bound, Bounds
from fatigue.pipeline.count.estimate import Estimate, estimate_event, member_variances
from fatigue.pipeline.count.event_block import EventBlock, bounded_event, count_event, judged
from fatigue.pipeline.count.joined.loops import Joined, LoopBlock, joined_events
from fatigue.pipeline.count.load_factor import bounded_load_factor, counted_load_factor
from fatigue.pipeline.count.mission_block import MissionBlock, mission_block
from fatigue.pipeline.count.overflow import no_overflow
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import ModalStress

TIERS = ("", "modal bound", "weld bound")  # of the column ``screened``: counted, or the bound that settled the point
ROWS_WITH_HISTOGRAM = 256  # counted at a time on a curve with a knee: 16 kB a station and event
ROWS_WITH_RESIDUES = 1024  # counted at a time where events join: some 0.5 kB a station and event


@dataclass(frozen=True, slots=True, eq=False)
class Settled:
    """Stations of a block that were settled in one way, under all events.

    ``rows`` are their places in the block, ascending; ``events`` and ``loops`` are without histograms; ``tier`` is an
    index into ``TIERS``.
    """

    rows: NDArray[np.intp]
    events: tuple[EventBlock, ...]
    loops: tuple[LoopBlock, ...]
    mission: MissionBlock
    tier: int


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Stations of a group of welds that share a curve, and the events that they are under.

    The methods raise ``NumericalError`` where stress or damage exceeds double precision.

    Attributes
    ----------
    stress : modal stress of the n stations, and the rule of their curve
    weld : (n,) which weld a station belongs to, ascending; no weld is divided
    toe : (n, 2) faces that carry a weld toe
    loads, plan : the events, and how often they occur
    welds : which welds these are, in words
    """

    stress: ModalStress
    weld: NDArray[np.int64]
    toe: NDArray[np.bool_]
    loads: Sequence[EventLoad]
    plan: Plan
    welds: str

    def __len__(self) -> int:
        """Count the stations."""
        return len(self.stress)

    def estimated(self) -> tuple[Estimate, ...]:
        """The estimate of every event at all stations."""
        estimates: tuple[Estimate, ...] = ()
        for load in self.loads:
            with no_overflow(load.counted.event, self.welds):
                estimates += (estimate_event(self.stress, load, member_variances(self.stress, load)),)
        return estimates

    def all_counted(self) -> Iterator[Settled]:
        """All stations, all of their events counted."""
        return self.counted(np.arange(len(self)), self.estimated())

    def counted(self, rows: NDArray[np.intp], estimates: Sequence[Estimate]) -> Iterator[Settled]:
        """Some stations, all of their events counted."""
        for some in self._at_once(rows):
            stress = self.stress.at(some)
            events = [self._counted(stress, number, estimates[number].at(some)) for number in range(len(self.loads))]
            yield self._settled(some, self._judged(stress, events), 0)

    def counted_while_unsettled(
        self, rows: NDArray[np.intp], estimates: Sequence[Estimate], bounds: Bounds
    ) -> Iterator[Settled]:
        """Those of some stations that stay unsettled until all of their events have been counted.

        The stations are counted event by event. What was counted tightens the bound of the event, by which a station
        may be settled; the events that are left are not counted there.
        """
        for some in self._at_once(rows):
            events: dict[int, tuple[NDArray[np.intp], EventBlock]] = {}
            for number, left in bounds.event_by_event(some):
                event = self._counted(self.stress.at(left), number, estimates[number].at(left))
                bounds.tighten(number, left, Bound.of_count(event.count))
                events[number] = left, event
            remaining = bounds.unsettled(left)
            if remaining.size:
                in_order = [events[number] for number in sorted(events)]
                of_these = [event.at(np.searchsorted(counted, remaining)) for counted, event in in_order]
                yield self._settled(remaining, self._judged(self.stress.at(remaining), of_these), 0)

    def bounded(self, rows: NDArray[np.intp], estimates: Sequence[Estimate], bounds: Bounds, tier: int) -> Settled:
        """Some stations, with bounds in place of the count of every event."""
        raw_ends = self.stress.raw_ends.at(rows)
        of_events = zip(estimates, bounds.of_events, strict=True)
        events = [bounded_event(e.at(rows), b.at(rows), raw_ends) for e, b in of_events]
        return self._settled(rows, events, tier, bounds.joined(rows))

    def _counted(self, stress: ModalStress, number: int, estimate: Estimate) -> EventBlock:
        load = self.loads[number]
        with no_overflow(load.counted.event, self.welds):
            return count_event(stress, load, estimate, joins=self.plan.joins(number))

    def _judged(self, stress: ModalStress, events: Sequence[EventBlock]) -> list[EventBlock]:
        found = []
        for event, load in zip(events, self.loads, strict=True):
            with no_overflow(load.counted.event, self.welds):
                found.append(judged(event, stress, load))
        return found

    def _settled(
        self, rows: NDArray[np.intp], events: Sequence[EventBlock], tier: int, joined: Joined | None = None
    ) -> Settled:
        """Some stations, their events weighted with the mission; only the weighting needs histograms and residues.

        ``joined`` are bounds of what joins the events; by default it is counted.
        """
        stress = self.stress.at(rows)
        with no_overflow("mission", self.welds):
            joined = self._joined(stress, events) if joined is None else joined
        mission = mission_block(events, self.plan, stress.rule.law, joined)
        if tier:
            factor = bounded_load_factor(stress.rule, self.plan, events, mission.utilisation, joined.loops)
        else:
            with no_overflow("mission", self.welds):
                factor = counted_load_factor(stress, self.loads, self.plan, events, joined.loops, mission.load_factor)
        without = tuple(event.without_histogram() for event in events)
        loops = tuple(loop.without_histogram() for loop in joined.loops)
        return Settled(rows, without, loops, replace(mission, load_factor=factor), tier)

    def _joined(self, stress: ModalStress, events: Sequence[EventBlock]) -> Joined:
        """What joins the counted events of some stations."""
        residues = [event.residues for event in events]
        return joined_events(stress, self.plan, [one for one, _ in residues], [raw for _, raw in residues])

    def _at_once(self, rows: NDArray[np.intp]) -> Iterator[NDArray[np.intp]]:
        """All rows at once, unless their histograms or residues would be large."""
        step = ROWS_WITH_RESIDUES if self.plan.joins_events else max(1, len(rows))
        step = step if self.stress.rule.law.is_straight else ROWS_WITH_HISTOGRAM
        return (rows[first : first + step] for first in range(0, len(rows), step))
