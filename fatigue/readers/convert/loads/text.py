"""Unit loads in the first ``case.toml``, and what a conversion says of them."""

import json
import tomllib
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

import pyarrow as pa

from fatigue.errors import Problem
from fatigue.readers.convert.loads.names import UnitLoad

UNIT_LOADS = "unit_loads.parquet"

_LOAD = """
[[body.unit_load]]             # {origin}
name = "{name}"
unit = {unit}
element_forces = "{file}"
role = "other"                 # EDIT: "gravity" if it is the weight of the body
when_missing = "error"         # EDIT: "zero" if an event that does not give it has none of it
"""

_LACKING = """
# EDIT: what the events have of these unit loads, which their histories do not give. The same in the whole mission:
# the tables below; under one event: [[mission.event.unit_load]] with name, unit, and constant or history = "p.csv"
# (time_s and {column}).
"""

_CONSTANT = """\
# [[mission.unit_load]]
# name = "{name}"
# unit = {unit}
# constant = 1.0
"""


def loads_text(loads: Sequence[UnitLoad], lacking: Sequence[UnitLoad]) -> tuple[str, str]:
    """Text of the unit loads of the body, and comments on those that some event does not give."""
    own = "".join(
        _LOAD.format(origin=_origin(load), name=load.name, unit=json.dumps(load.unit), file=UNIT_LOADS)
        for load in loads
    )
    constants = "".join(_CONSTANT.format(name=load.name, unit=json.dumps(load.unit)) for load in lacking)
    return own, _LACKING.format(column=lacking[0].column) + constants if lacking else ""


def loads_not_given(loads: Sequence[UnitLoad], events: Mapping[tuple[str, str], pa.Table]) -> tuple[UnitLoad, ...]:
    """Unit loads that have no column in the history of some event."""
    return tuple(
        load for load in loads if not events or any(load.column not in t.column_names for t in events.values())
    )


def load_warnings(loads: Sequence[UnitLoad], lacking: Sequence[UnitLoad], kept_case: Path | None) -> list[Problem]:
    """Warnings about units that nobody gave, loads that events do not give, and a kept case that lacks loads."""
    found = []
    if unknown := [load for load in loads if not load.is_unit_known]:
        what = f"{_some(unknown)}: the files do not tell in what unit the load of the subcase is; one of each is the "
        what += "load as it was run"
        first = unknown[0]
        remedy = f"State --unit-load-name {first.case.subcase} {first.name} AMOUNT UNIT, with how much was applied"
        found.append(Problem("unit_load_unit", "case.toml: [[body.unit_load]]", what, remedy, len(unknown)))
    if lacking and kept_case is None:
        what = f"events do not give {_some(lacking)}: until they do, or when_missing says zero, the case is refused"
        remedy = "Write what each event has of it; the end of case.toml shows how"
        found.append(Problem("unit_load_not_given", "case.toml: [[mission.event]]", what, remedy, len(lacking)))
    if kept_case is not None and (unread := [load for load in loads if load.name not in _named(kept_case)]):
        what = f"the case that is kept does not name {_some(unread)}"
        remedy = f"Add [[body.unit_load]] with element_forces = {UNIT_LOADS!r}, or convert without --keep-case"
        found.append(Problem("unit_load_not_in_case", str(kept_case), what, remedy, len(unread)))
    return found


def _origin(load: UnitLoad) -> str:
    """Where a load comes from, and what one of it is, in words."""
    heading = load.case.heading
    title = next(filter(None, (heading.subtitle, heading.label, heading.title)), "")
    named = f" {json.dumps(title)}" if title else ""
    subcase = f"subcase {load.case.subcase}{named}"
    if load.is_unit_known:
        return f"{subcase}, run with {load.amount:g} {load.unit}"
    return f"{subcase}; EDIT the unit: one is the load as it was run"


def _some(loads: Sequence[UnitLoad]) -> str:
    names = ", ".join(load.name for load in loads[:5]) + (f" and {len(loads) - 5} more" if len(loads) > 5 else "")
    return f"unit load{'s' * (len(loads) > 1)} {names}"


def _named(case: Path) -> Collection[str]:
    """Names of the unit loads of a case that was kept."""
    try:
        loads = tomllib.loads(case.read_text(encoding="utf-8-sig"))["body"]["unit_load"]
        return {str(load.get("name")) for load in loads}
    except (OSError, ValueError, AttributeError, KeyError, TypeError, RecursionError):  # its check will say so
        return ()
