"""The unit loads of a result on the page: what each is, and what every event gives of it."""

from collections.abc import Mapping, Sequence
from typing import Any

from fatigue.report.sections.cells import Heading, PageTable, text

_VALUES_SHOWN = 8


def load_table(loads: Sequence[Mapping[str, Any]]) -> PageTable | None:
    """What the events give of every unit load; events that give the same are one row. None without unit loads."""
    rows = []
    for load in loads:
        for given, events in by_source(load).items():
            named = "all events" if len(events) == len(load["given"]) else ", ".join(events)
            rows.append((text(load["name"]), text(load["unit"]), text(_what(load)), text(named), text(given)))
    headings = ("unit load", "unit", "what it is", "events", "what they give of it")
    table = tuple(Heading(name, numeric=False) for name in headings)
    return PageTable("unit-loads", table, tuple(rows), "Find a load") if rows else None


def by_source(load: Mapping[str, Any]) -> dict[str, list[str]]:
    """Events by what they give of a unit load, in words."""
    found: dict[str, list[str]] = {}
    for event, given in load["given"].items():
        found.setdefault(source_in_words(given, load["unit"]), []).append(event)
    return found


def source_in_words(given: Mapping[str, Any], unit: str) -> str:
    """What an event gives of a unit load, in words."""
    way = given["way"]
    if way == "constant":
        return f"constant {given['constant']:g} {unit}"
    if way == "values":
        shown = ", ".join(f"{value:g}" for value in given["values"][:_VALUES_SHOWN])
        more = len(given["values"]) - _VALUES_SHOWN
        return f"values {shown}{f' and {more} more' if more > 0 else ''} {unit}"
    if way == "missing":
        return "not given: zero"
    own = f"column {given['column']} of {given['file']}"
    if way == "column":
        return own
    changes = [f"times {given['scale']:g}"] if given["scale"] != 1.0 else []
    changes += [f"shifted by {given['shift_s']:g} s"] if given["shift_s"] else []
    changes += ["linear between its samples"] if given["interpolation"] == "linear" else []
    return ", ".join([own, *changes])


def _what(load: Mapping[str, Any]) -> str:
    """Role of a load, and whether its elements balance, in words."""
    role = "gravity" if load["role"] == "gravity" else "load beside the modes"
    return f"{role}, on the assessed elements" if load["elements_carry_load"] else role
