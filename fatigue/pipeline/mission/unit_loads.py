"""The unit loads of an event: where each comes from, and the constant ones."""

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Event
from fatigue.case.given_loads import given_loads
from fatigue.errors import Problem
from fatigue.life.records.unit_load import LoadSource
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.event.event_record import EventFiles
from fatigue.readers.neutral.event.load_units import column_names
from fatigue.shown import few


def load_sources(body: Body, event: Event) -> tuple[LoadSource, ...]:
    """Where an event has each unit load of the body from.

    Raises
    ------
    CaseError : a load that is not given and has to be
    """
    case = body.case
    if not case.body.unit_load:
        return ()
    return given_loads(case, event, column_names(case.resolve(event.history) if event.history else None))


def event_files(body: Body, event: Event) -> EventFiles:
    """What the record of an event is read from.

    Raises
    ------
    CaseError : a unit load that is not given and has to be
    """
    case = body.case
    return EventFiles(
        event=event.name,
        path=case.resolve(event.history) if event.history else None,
        modes=body.modes.mode,
        ignore_modes=case.body.ignore_modes,
        start_s=event.start_s,
        residue=case.residue(event),
        loads=load_sources(body, event),
        strict=body.strict,
        beside=[channel.column for channel in event.channel if channel.is_in(event.history)],
    )


def event_constants(body: Body, event: Event) -> NDArray[np.float64]:
    """Constants of the coordinates of an event, (c,): of unit loads that are constant; 0 of all modes and other loads.

    They are never added to the samples, where their row is zero.
    """
    return np.concatenate([np.zeros(len(body.modes.mode)), [load.constant for load in load_sources(body, event)]])


def unused_load_warnings(case_file: str, sources: list[tuple[LoadSource, ...]]) -> list[Problem]:
    """Warning about unit loads that no event gives; ``sources`` are those of all events."""
    unused = [loads[0].name for loads in zip(*sources, strict=True) if all(load.way == "missing" for load in loads)]
    if not unused:
        return []
    names = few([f"'{name}'" for name in unused])
    what = f"no event gives the unit load {names}, so its stress counts nowhere"
    remedy = "Give it in the events, or remove the load from the body"
    return [Problem("unused_unit_load", f"{case_file}: body.unit_load '{unused[0]}'", what, remedy, len(unused))]
