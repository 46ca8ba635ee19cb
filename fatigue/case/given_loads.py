"""Where an event has each unit load from: what it says itself, else what the mission says, else nothing."""

from collections.abc import Collection

from fatigue.case.tables import Case, Event
from fatigue.case.unit_loads import GivenLoad, UnitLoad
from fatigue.errors import CaseError, Problem, refuse
from fatigue.life.records.unit_load import LoadSource


def given_loads(case: Case, event: Event, columns: Collection[str]) -> tuple[LoadSource, ...]:
    """The source of every unit load of the body in one event; ``columns`` are those of its own record.

    Raises
    ------
    CaseError : loads that are not given and have to be
    """
    of_event = {load.name: load for load in event.unit_load}
    of_mission = {load.name: load.constant for load in case.mission.unit_load}
    found: list[LoadSource] = []
    problems: list[Problem] = []
    for load in case.body.unit_load:
        if load.name in of_event:
            found.append(_stated(case, of_event[load.name]))
        elif f"u_{load.name}" in columns:
            found.append(LoadSource(load.name, "column", column=f"u_{load.name}", unit=load.unit))
        elif load.name in of_mission:
            found.append(LoadSource(load.name, "constant", constant=of_mission[load.name]))
        else:
            found.append(LoadSource(load.name, "missing"))
            problems += [_missing(case, event, load)] if load.when_missing == "error" else []
    refuse(CaseError, problems)
    return tuple(found)


def _stated(case: Case, load: GivenLoad) -> LoadSource:
    """Source of a load that the event states in a table of its own."""
    if load.constant is not None:
        return LoadSource(load.name, "constant", constant=load.scale * load.constant)
    if load.values is not None:
        return LoadSource(load.name, "values", values=tuple(load.scale * value for value in load.values))
    return LoadSource(
        name=load.name,
        way="file",
        column=load.own_column,
        path=case.resolve(load.history or ""),
        scale=load.scale,
        shift_s=load.shift_s,
        interpolation=load.interpolation,
        unit=load.unit,
    )


def _missing(case: Case, event: Event, load: UnitLoad) -> Problem:
    column = f"no column u_{load.name} in {event.history}, " if event.history else ""
    return Problem(
        "missing_unit_load",
        f"{case.path.name}: mission.event '{event.name}'",
        f"the unit load '{load.name}' is not given: {column}no [[mission.event.unit_load]] and no "
        "[[mission.unit_load]] of this name",
        "Give it, or set when_missing = 'zero' for the load",
    )
