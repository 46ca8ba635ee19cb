"""What is wrong with the unit loads of a case: names that nobody defined, other units, one load given twice."""

import difflib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from fatigue.case.problems import clash
from fatigue.case.unit_loads import GivenLoad, UnitLoad
from fatigue.errors import Problem


def forms_of_forces(loads: Sequence[UnitLoad], *, by_elements: bool) -> Iterator[Problem]:
    """Refusals of unit loads whose forces are of another form than those of the modes."""
    has, lacks = ("element_forces", "nodal_forces") if by_elements else ("nodal_forces", "element_forces")
    for number, load in enumerate(loads, 1):
        if getattr(load, lacks) is not None and getattr(load, has) is None:
            what = f"unit load '{load.name}' gives {lacks}, and the modes of the body {has}"
            yield clash(f"unit_load[{number}].{lacks}", what, f"Give the {has} of the unit load")


def one_gravity(loads: Sequence[UnitLoad]) -> Iterator[Problem]:
    """Refusal of a second dead load: the mean of q is compared with one field of forces."""
    names = [load.name for load in loads if load.role == "gravity"]
    if len(names) > 1:
        what = f"'{names[0]}' and '{names[1]}' both have the role gravity, and a body has one dead load"
        yield clash("unit_load.role", what, "Keep it for the load of the whole body in the simulation")


def loads_of_event(loads: Sequence[GivenLoad], *, has_history: bool) -> Iterator[Problem]:
    """Refusals of what an event with or without a history cannot give of its unit loads."""
    lengths = {load.name: len(load.values) for load in loads if load.values is not None}
    for number, load in enumerate(loads, 1):
        place = f"unit_load[{number}]"
        if has_history and load.values is not None:
            what = f"values of '{load.name}' are given beside the history of the event"
            yield clash(f"{place}.values", what, "Give the load over time as a history, or an event without history")
        if not has_history and load.history is not None:
            what = f"a history of '{load.name}' is given for an event without one"
            yield clash(f"{place}.history", what, "Give values, or the history of the event as well")
    if not has_history and len(set(lengths.values())) > 1:
        told = ", ".join(f"{length} of '{name}'" for name, length in lengths.items())
        yield clash("unit_load.values", f"the lists have unequal lengths: {told}", "Give as many values of each load")


def unit_load_problems(raw: Mapping[str, Any]) -> Iterator[Problem]:
    """Refusals about the unit loads together, on the file's own values, so that a mistake elsewhere hides none."""
    units: dict[str, Any] = {}
    body, mission = _table(raw.get("body")), _table(raw.get("mission"))
    for place, load in _tables(body.get("unit_load"), "body.unit_load"):
        name = load.get("name")
        if isinstance(name, str) and name in units:
            yield _twice(place, name, "Give every unit load its own name")
        elif isinstance(name, str):
            units[name] = load.get("unit")
    yield from _given(mission.get("unit_load"), "mission.unit_load", units)
    for place, event in _tables(mission.get("event"), "mission.event"):
        yield from _given(event.get("unit_load"), f"{place}.unit_load", units)


def _given(loads: object, where: str, units: Mapping[str, Any]) -> Iterator[Problem]:
    """Refusals of what one list gives: loads that the body does not have, other units, a load given twice."""
    seen: set[str] = set()
    for place, load in _tables(loads, where):
        name, unit = load.get("name"), load.get("unit")
        if not isinstance(name, str):
            continue
        if name in seen:
            yield _twice(place, name, "Keep one of them")
        seen.add(name)
        if name not in units:
            near = difflib.get_close_matches(name, units, n=1)
            known = f"the body has {', '.join(units)}" if units else "the body has none"
            remedy = f"Write {near[0]!r}" if near else f"Define it by a [[body.unit_load]]; {known}"
            yield Problem("unknown_unit_load", f"{place}.name", f"there is no unit load {name!r}", remedy)
        elif isinstance(unit, str) and isinstance(units[name], str) and unit != units[name]:
            what = f"{unit!r} is not the unit of unit load '{name}', whose forces are per 1 {units[name]}"
            remedy = f"Give the values in {units[name]}, by `scale` where it is another unit"
            yield Problem("unit", f"{place}.unit", what, remedy)


def _twice(place: str, name: str, remedy: str) -> Problem:
    return Problem("duplicate", f"{place}.name", f"the unit load {name!r} is there already", remedy)


def _table(value: object) -> Mapping[str, Any]:
    return value if isinstance(value, dict) else {}


def _tables(value: object, where: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Tables of a list with their places; of what is no list of tables the models say so."""
    items = value if isinstance(value, list) else []
    return ((f"{where}[{number}]", item) for number, item in enumerate(items, 1) if isinstance(item, dict))
