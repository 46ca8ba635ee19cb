"""What is doubtful about the records of a mission: one at rest, a mode lost from it, one record under two names.

A record without movement makes no damage, and nothing in the results shows it: the welds last longer. A record that
stands for two events by mistake counts one of them twice and the other not at all.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Event
from fatigue.case.plausibility import SPEED
from fatigue.errors import Problem
from fatigue.life.records.history import first_kept
from fatigue.life.records.unit_load import LoadSource
from fatigue.pipeline.mission.record_units import FEWEST_SAMPLES
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.history import TimeGrid
from fatigue.readers.neutral.record_outline import RecordOutline
from fatigue.shown import few, shortened

SAME_STEP = 1e-6  # relative: times in single and in double precision
OVER_TIME = ("column", "file", "values")  # ways in which a load is given that may change
_TOLD_APART = ("share", "per_1000_km", "speed_km_h", "length_km", "start_s", "residue")  # keys of two events


@dataclass(frozen=True, slots=True, eq=False)
class CheckedEvent:
    """The record of an event once it has been read: name of its file, its times, and what is kept of its samples.

    ``loads`` are where its unit loads come from.
    """

    event: Event
    file: str
    grid: TimeGrid
    outline: RecordOutline
    loads: tuple[LoadSource, ...]

    @property
    def kept_samples(self) -> int:
        """Number of samples behind the start-up."""
        return self.grid.samples - first_kept(self.grid.step, self.event.start_s)

    def bends(self, coordinates: Coordinates) -> bool:
        """Whether any coordinate moves that bends the body."""
        return bool(np.any(self.outline.moves & _bends(coordinates)))

    def equals(self, other: "CheckedEvent") -> bool:
        """Whether both records have the same samples."""
        mine, its = self.grid, other.grid
        alike = mine.samples == its.samples and bool(np.isclose(mine.step, its.step, rtol=SAME_STEP, atol=0.0))
        return alike and self.outline.equals(other.outline)


def record_warnings(records: Sequence[CheckedEvent], coordinates: Coordinates, case_file: str) -> list[Problem]:
    """Warnings about the records of all events together, each kind once."""
    moving = [record for record in records if record.bends(coordinates)]
    still = [record for record in records if not record.bends(coordinates)]
    return [
        *_at_rest_warnings(still, coordinates),
        *_lost_mode_warnings(moving, coordinates.modes),
        *_lost_load_warnings(moving, coordinates),
        *_same_record_warnings(moving),
        *_speed_warnings(records, case_file),
    ]


def _speed_warnings(records: Sequence[CheckedEvent], case_file: str) -> list[Problem]:
    """Warning about the speeds that lengths and durations make; a speed that is given is told with the case."""
    found = []
    for record in records:
        event, samples = record.event, record.kept_samples
        if event.speed_km_h is None and event.length_km is not None and samples >= FEWEST_SAMPLES:
            speed = event.length_km / (samples * record.grid.step) * 3600.0
            found += [(SPEED.distance(speed), speed, record)] if SPEED.distance(speed) > 1.0 else []
    if not found:
        return []
    _, speed, worst = max(found, key=lambda one: one[0])
    what = (
        f"length_km = {worst.event.length_km:g} in {worst.kept_samples * worst.grid.step:g} s makes {speed:.4g} km/h, "
    )
    what += f"outside {SPEED.low:g} to {SPEED.high:g} km/h ({SPEED.why})"
    if len(found) > 1:
        what += f"; likewise {_names([record for *_, record in found if record is not worst])}"
    where = f"{case_file}: length_km of event '{shortened(worst.event.name)}'"
    remedy = "Give the length of the kept part in km, not in m"
    return [Problem("unusual_speed", where, what, remedy, len(found))]


def _at_rest_warnings(still: Sequence[CheckedEvent], coordinates: Coordinates) -> list[Problem]:
    """Warning about events in which nothing that bends the body moves."""
    if not still:
        return []
    worst = still[0]
    or_load = " and no unit load" if coordinates.unit_loads else ""
    what = f"no modal coordinate{or_load} changes in event '{shortened(worst.event.name)}', so it does no damage"
    if len(still) > 1:
        what += f"; nor in {_names(still[1:])}"
    remedy = "Export the record again, with the modal coordinates of the running simulation"
    where = f"{worst.file}: columns q_"
    if worst.event.history is None:
        where = f"{worst.file}: mission.event '{shortened(worst.event.name)}'"
        remedy = "Give values that differ: the load before and after"
    return [Problem("event_at_rest", where, what, remedy, len(still))]


def _lost_mode_warnings(records: Sequence[CheckedEvent], modes: Modes) -> list[Problem]:
    """Warning about normal modes that stand still in a simulation in which more modes move than do not."""
    normal = np.array([kind == "normal" for kind in modes.kind])
    found: list[tuple[CheckedEvent, list[int]]] = []
    for record in records:
        moves = record.outline.moves[: len(modes.mode)]
        lost, moving = normal & ~moves, moves & _modes_that_bend(modes)
        if record.grid.samples >= FEWEST_SAMPLES and 0 < np.count_nonzero(lost) < np.count_nonzero(moving):
            found.append((record, modes.mode[lost].tolist()))
    if not found:
        return []
    worst, lost_modes = max(found, key=lambda one: len(one[1]))
    what = f"normal mode {few(lost_modes)} stands still in event '{shortened(worst.event.name)}' while others move"
    if len(found) > 1:
        what += f"; others do in {_names([record for record, _ in found if record is not worst])}"
    remedy = "Check that the simulation uses the mode and that its column was exported; else list it under ignore_modes"
    return [Problem("mode_at_rest", f"{worst.file}: column q_{lost_modes[0]}", what, remedy, len(found))]


def _lost_load_warnings(records: Sequence[CheckedEvent], coordinates: Coordinates) -> list[Problem]:
    """Warning about unit loads that are given over time or by values, and do not change."""
    found: list[tuple[CheckedEvent, LoadSource]] = []
    for record in records:
        moves = record.outline.moves[len(coordinates.modes.mode) :]
        given = zip(record.loads, moves.tolist(), strict=True)
        found += [(record, load) for load, changes in given if load.way in OVER_TIME and not changes]
    if not found:
        return []
    record, load = found[0]
    file = record.file if load.path is None else load.path.name
    event = shortened(record.event.name)
    what = f"the unit load '{load.name}' does not change in event '{event}', so it makes no range"
    if len(found) > 1:
        others = [f"'{one.name}' in '{of.event.name}'" for of, one in found[1:]]
        what += f"; nor do {few(others)}"
    remedy = "Check the column, or give a constant"
    where = f"{file}: column {load.column or 'values'}"
    return [Problem("load_at_rest", where, what, remedy, len(found))]


def _same_record_warnings(records: Sequence[CheckedEvent]) -> list[Problem]:
    """Warning about events with one record; those that scale it by factors of their own are told apart."""
    pairs = [
        (one, other)
        for one, other in combinations(records, 2)
        if one.event.stress_factor == other.event.stress_factor and one.equals(other)
    ]
    if not pairs:
        return []
    one, other = pairs[0]
    names = f"'{shortened(one.event.name)}' and '{shortened(other.event.name)}'"
    files = f"in {one.file} and {other.file}"
    if one.event.history == other.event.history:
        files = "two static load cases" if one.event.history is None else f"both name {one.file}"
    what = f"events {names} have the same record ({files}), and differ in {_difference(one.event, other.event)}"
    if len(pairs) > 1:
        more = [f"'{shortened(a.event.name)}' and '{shortened(b.event.name)}'" for a, b in pairs[1:]]
        what += f"; so have {few(more)}"
    remedy = "Give each event its own record, unless one record is meant to stand for both"
    return [Problem("same_record", f"mission.event {names}", what, remedy, len(pairs))]


def _difference(one: Event, other: Event) -> str:
    """What two events differ in beside their names."""
    values = ((key, getattr(one, key), getattr(other, key)) for key in _TOLD_APART)
    told = [f"{key} ({_said(mine)} and {_said(its)})" for key, mine, its in values if mine != its]
    return ", ".join(told) or "their names alone"


def _said(value: object) -> str:
    return "none" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def _names(records: Sequence[CheckedEvent]) -> str:
    return few([f"'{record.event.name}'" for record in records])


def _bends(coordinates: Coordinates) -> NDArray[np.bool_]:
    """Coordinates that bend the body, (c,): all but rigid modes."""
    return np.array([kind != "rigid" for kind in coordinates.kind])


def _modes_that_bend(modes: Modes) -> NDArray[np.bool_]:
    return np.array([kind != "rigid" for kind in modes.kind])
