"""The loops of a mission: known orders of events in numbers, once it is known how often every event is passed."""

from collections import Counter
from collections.abc import Iterator, Sequence

from fatigue.case import Case
from fatigue.errors import CaseError, Problem, refuse
from fatigue.life.mission import Loop, Pass

ROUNDING = 1e-9  # relative, of numbers of passes

LOOP_NAME = "(sequence {})"  # in the column ``event``; no event may be called so


def plan_loops(case: Case, passes: Sequence[Pass]) -> tuple[Loop, ...]:
    """The sequences of a case as loops over the numbers of its events.

    Raises
    ------
    CaseError : an event is in the loops, or has stints, more often than it is passed
    """
    numbers = {event.name: number for number, event in enumerate(case.mission.event)}
    loops = tuple(
        Loop(LOOP_NAME.format(i), tuple(numbers[name] for name in sequence.order), sequence.per_1000_km)
        for i, sequence in enumerate(case.mission.sequence, 1)
    )
    refuse(CaseError, [*_too_few_in_loops(case, passes, loops), *_too_few_for_stints(case, passes)])
    return loops


def _too_few_in_loops(case: Case, passes: Sequence[Pass], loops: Sequence[Loop]) -> Iterator[Problem]:
    """Refusal of every event that the loops pass more often than the mission does; each stint is a pass at least."""
    stints: Counter[int] = Counter()
    places: dict[int, list[str]] = {}
    for i, loop in enumerate(loops, 1):
        for event, entries in Counter(loop.order).items():
            stints[event] += entries * loop.per_1000_km  # type: ignore[assignment]  # a sum of numbers, not a count
            places.setdefault(event, []).append(f"mission.sequence[{i}]")
    for event, needed in sorted(stints.items()):
        yield from _too_few(case, passes[event], needed, " and ".join(places[event]))


def _too_few_for_stints(case: Case, passes: Sequence[Pass]) -> Iterator[Problem]:
    for one in passes:
        if one.stints_per_1000_km is not None:
            yield from _too_few(case, one, one.stints_per_1000_km, f"mission.event '{one.event}': stints_per_1000_km")


def _too_few(case: Case, one: Pass, needed: float, where: str) -> Iterator[Problem]:
    given = 1000.0 * one.passes_per_km
    if needed <= given * (1.0 + ROUNDING):
        return
    how = "per_1000_km" if one.length is None else f"its share and the length of its record, {one.length:.4g} km"
    yield Problem(
        "sequence_needs_more_passes",
        f"{case.path.name}: {where}",
        f"{needed:.6g} stints of the event '{one.event}' in 1000 km, and it is passed {given:.6g} times, by {how}",
        "Lower per_1000_km of the sequence, or pass the event more often: every stint is one pass at least",
    )
