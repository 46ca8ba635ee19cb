"""A finished result with its inputs read again: any of its points can be solved, any of its events prepared anew."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from shutil import rmtree
from typing import Any

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.life.records.spool import Spool
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import HELD_BYTES, event_load
from fatigue.pipeline.mission.loops import LOOP_NAME
from fatigue.pipeline.solve.assessed_body import assessed_body
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.weld_groups import WeldGroups, weld_groups
from fatigue.point.found import Station, meant
from fatigue.results import upsampling_factors
from fatigue.shown import few, shortened, visible
from fatigue.why.points import solved_rows


@dataclass(frozen=True, slots=True, eq=False)
class Reopened:
    """A finished result and its inputs, which have not changed since.

    Attributes
    ----------
    folder, record : where it is, and its provenance
    body, groups : its body, and the welds of it with their forces
    factors : by how much the record of each event was upsampled
    scratch : folder for what is too large for memory
    """

    folder: Path
    record: Mapping[str, Any]
    body: Body
    groups: WeldGroups
    factors: tuple[int, ...]
    scratch: Path

    @property
    def events(self) -> list[str]:
        """Names of the events."""
        return [event.name for event in self.body.case.mission.event]

    @property
    def sequences(self) -> list[str]:
        """Names of the sequences of events, as the tables have them."""
        return [LOOP_NAME.format(i) for i, _ in enumerate(self.body.case.mission.sequence, 1)]


def reopened(folder: Path, record: Mapping[str, Any], scratch: Path, case_file: Path | None = None) -> Reopened:
    """Read the inputs of a result again; ``record`` is its provenance, ``case_file`` None where this says.

    Raises
    ------
    DataError : the case or an input is gone or has changed since
    """
    body = assessed_body(record, folder, case_file)
    groups = weld_groups(body, scratch / "forces")
    return Reopened(folder, record, body, groups, tuple(upsampling_factors(record)), scratch)


def solved_station(inputs: Reopened, station: Station) -> tuple[Model, int]:
    """The welds around a station, solved, and its index among their stations.

    Raises
    ------
    DataError : the result has other points than the case, or its forces cannot be read
    """
    ((model, rows, _),) = solved_rows(inputs.folder, inputs.groups, np.array(station.rows[:1]))
    return model, int(rows[0]) // 2


def event_numbers(inputs: Reopened, event: str | None) -> list[int]:
    """Numbers of all events, or of the one that is named.

    Raises
    ------
    DataError : the mission has no such event, or it is a sequence of events, which has no record of its own
    """
    names = inputs.events
    if event is None:
        return list(range(len(names)))
    if event in names:
        return [names.index(event)]
    where = str(inputs.folder)
    if event in inputs.sequences:
        order = inputs.body.case.mission.sequence[inputs.sequences.index(event)].order
        of = few([f"'{visible(shortened(name))}'" for name in dict.fromkeys(order)])
        what = f"'{event}' is a sequence of events and has no history of its own"
        raise DataError(Problem("sequence_history", where, what, f"Name one of its events: {of}"))
    what = f"the mission has no event '{visible(shortened(str(event)))}'"
    raise DataError(Problem("unknown_event", where, what, meant(str(event), [*names, *inputs.sequences])))


def counted_load(inputs: Reopened, number: int) -> EventLoad:
    """An event as it was counted; a long record goes to the folder ``scratch``."""
    return _load(inputs, number, inputs.factors[number])


def sampled_load(inputs: Reopened, number: int) -> EventLoad:
    """An event at the samples of its file; ``upsample`` is how many there are now for one of these, for unit loads."""
    return _load(inputs, number, 1)


def _load(inputs: Reopened, number: int, factor: int) -> EventLoad:
    event, samples = inputs.body.case.mission.event[number], inputs.record["mission"]["events"][number]["samples"]
    bytes_held = len(inputs.body.coordinates) * samples * factor * (8 if factor > 1 else 4)
    scratch = inputs.scratch / f"event-{number:04d}" if bytes_held > HELD_BYTES else None
    return event_load(inputs.body, event, factor, scratch=scratch)


def forget(load: EventLoad) -> None:
    """Remove what a long record has on disk."""
    if isinstance(load.counted.q, Spool):
        rmtree(load.counted.q.path.parent, ignore_errors=True)
