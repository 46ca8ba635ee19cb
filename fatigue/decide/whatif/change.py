"""What is changed, in numbers: how often everything is passed, factors on stresses, the curve of every weld.

Nothing here is counted. What no number of the result can say is a reason to count again.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case, Event, check_distance
from fatigue.decide.of_result import events_and_loops, loops_of
from fatigue.decide.whatif.asked import TwoCases
from fatigue.decide.whatif.difference import Differences
from fatigue.life.mission import Pass
from fatigue.pipeline.mission.loops import plan_loops
from fatigue.report.of_record import weights_of

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Mission:
    """What a vehicle does: ``weights`` (r,) are passes per km of the events, then runs per km of the loops [1/km]."""

    weights: Floats
    target_km: float
    km_per_year: float
    damage_limit: float


@dataclass(frozen=True, slots=True, eq=False)
class Change:
    """What is changed of a result with e events and l loops, r = e + l.

    Attributes
    ----------
    names : of the events, then of the loops
    loops : numbers of the events of each loop
    before, after : the mission
    factors : (r,) on all stresses; NaN: what there is was not counted so
    recount : why all points have to be counted again; empty: nothing asks for it
    """

    names: tuple[str, ...]
    loops: tuple[tuple[int, ...], ...]
    before: Mission
    after: Mission
    factors: Floats
    recount: tuple[str, ...]

    @property
    def events(self) -> int:
        """Number of events."""
        return len(self.names) - len(self.loops)

    @property
    def scales_load(self) -> bool:
        """Whether any stress is changed of what occurs."""
        return bool((self.factors[self.after.weights > 0.0] != 1.0).any())

    def loop_events(self) -> NDArray[np.bool_]:
        """Which of the rows (r,) are loops that occur, or events in one of them."""
        found = np.zeros(len(self.names), dtype=np.bool_)
        for number, order in enumerate(self.loops):
            if self.after.weights[self.events + number] > 0.0:
                found[[self.events + number, *order]] = True
        return found


def mission_of(record: Mapping[str, Any]) -> Mission:
    """The mission of a result."""
    mission, weights = record["mission"], np.array(list(weights_of(record).values()))
    return Mission(weights, mission["target_km"], mission["km_per_year"], mission["damage_limit"])


def names_of(record: Mapping[str, Any]) -> tuple[tuple[str, ...], tuple[tuple[int, ...], ...]]:
    """Names of the events and of the loops behind them, and the numbers of the events of each loop."""
    names = events_and_loops(record)
    return names, tuple(tuple(names.index(event) for event in loop["order"]) for loop in loops_of(record))


def unchanged(record: Mapping[str, Any]) -> Change:
    """No change at all of a result."""
    names, loops = names_of(record)
    mission = mission_of(record)
    return Change(names, loops, mission, mission, np.ones(len(names)), ())


def change_of(record: Mapping[str, Any], cases: TwoCases, found: Differences) -> Change:
    """The change from the case of a result to another one, whose differences were ``found``.

    Raises
    ------
    CaseError : speed and length of an event contradict each other, or loops run an event more often than it is passed
    """
    reasons = [one.words for one in found.of("recount")]
    start = unchanged(record)
    passes, of_mission = _passes(record, cases)
    weights, of_loops = np.full(len(start.names), np.nan), list[str]()
    if not any(one.share is not None and one.length is None for one in passes):
        weights, of_loops = _weights(record, cases, passes)
    mission = cases.changed.mission
    after = Mission(weights, mission.target_km, mission.km_per_year, mission.damage_limit)
    factors = _factors(start, cases, after)
    reasons += [*of_mission, *of_loops]
    if np.isnan(factors).any():
        reasons.append("a stress_factor of an event in a sequence: its cycles across events are others")
    changed = replace(start, after=after, factors=factors, recount=tuple(reasons))
    if changed.scales_load and cases.base.curve.mean_stress == "asme":
        words = "a factor on stresses under mean_stress = 'asme', whose conditions do not scale"
        return replace(changed, recount=(*changed.recount, words))
    return changed


def _passes(record: Mapping[str, Any], cases: TwoCases) -> tuple[list[Pass], list[str]]:
    """Passes of the events of the changed case, and why some of their lengths are not known."""
    base = {event.name: event for event in cases.base.mission.event}
    known = {event["event"]: event for event in record["mission"]["events"]}
    passes, reasons = [], []
    for event in cases.changed.mission.event:
        before, stored = base[event.name], known[event.name]
        length = _length(before, event, stored, cases.changed)
        is_half = cases.changed.residue(event) == "half"
        if event.share is not None and length is None:
            reasons.append(f"speed_km_h of event '{event.name}': the duration of its record is not stored")
        if is_half != (cases.base.residue(before) == "half") and event.residue == before.residue:
            reasons.append(f"residue of event '{event.name}', which follows from how it is counted")
        passes.append(
            Pass(
                event=event.name,
                samples=stored["samples"],
                length=length if event.share is not None else None,
                share=event.share,
                per_1000_km=event.per_1000_km,
                half=is_half,
                stints_per_1000_km=event.stints_per_1000_km,
            )
        )
    return passes, reasons


def _length(before: Event, after: Event, stored: Mapping[str, Any], case: Case) -> float | None:
    """Distance of a pass [km]; None where the record would have to be read for it."""
    same = (before.speed_km_h, before.length_km) == (after.speed_km_h, after.length_km)
    if same and stored["length"] is not None:
        return float(stored["length"])
    duration = None
    if before.length_km is None and before.speed_km_h is not None and stored["length"] is not None:
        duration = stored["length"] * 3600.0 / before.speed_km_h
        check_distance(after, duration, f"{case.path.name}: mission.event '{after.name}'")
    if after.length_km is not None:
        return after.length_km
    if after.speed_km_h is None or duration is None:
        return None
    return float(stored["length"] * (after.speed_km_h / before.speed_km_h))  # type: ignore[operator]


def _weights(record: Mapping[str, Any], cases: TwoCases, passes: Sequence[Pass]) -> tuple[Floats, list[str]]:
    """Passes and runs per km of what was counted (r,) in the changed mission; 0 of what it has no more."""
    names, loops = names_of(record)
    per_km = {one.event: one.passes_per_km for one in passes}
    events = len(names) - len(loops)
    weights = np.array([*(per_km.get(name, 0.0) for name in names[:events]), *(0.0 for _ in loops)])
    orders = [tuple(names[event] for event in order) for order in loops]
    reasons, taken = [], set()
    for loop in plan_loops(cases.changed, passes):
        order = tuple(passes[event].event for event in loop.order)
        free = [i for i, known in enumerate(orders) if known == order and i not in taken]
        if free:
            taken.add(free[0])
            weights[events + free[0]] = loop.runs_per_km
        elif order not in orders:
            reasons.append(f"a sequence of another order: {', '.join(order)}")
    return weights, reasons


def _factors(change: Change, cases: TwoCases, after: Mission) -> Floats:
    """Factor on the stresses of every event and loop, NaN of a loop whose events have different ones."""
    base = {event.name: event.stress_factor for event in cases.base.mission.event}
    ratio = {event.name: event.stress_factor / base[event.name] for event in cases.changed.mission.event}
    of_events = [cases.load * ratio.get(name, 1.0) for name in change.names[: change.events]]
    of_loops = []
    for number, order in enumerate(change.loops):
        occurs = after.weights[change.events + number] > 0.0
        own = {of_events[event] for event in order}
        of_loops.append(float("nan") if occurs and len(own) > 1 else of_events[order[0]])
    return np.array([*of_events, *of_loops])


def in_words(change: Change, found: Differences, load: float) -> Iterator[str]:
    """What is changed, knob by knob."""
    if load != 1.0:
        yield f"load: all stresses times {load:.10g}"
    yield from found.words
