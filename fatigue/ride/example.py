"""How to give a case a channel, in the words of this very case."""

import json
import re

from fatigue.case import Case, Event
from fatigue.errors import Problem
from fatigue.readers.neutral.event.load_units import column_names


def no_channels(case: Case) -> Problem:
    """Refusal of a ride without channels, with a line for the case that gives it one."""
    what = "no event has a channel, so that nothing is known of hunting, alarm, comfort or equipment"
    event = next((event for event in case.mission.event if event.history), None)
    if event is None:
        remedy = "Give an event a history and [[mission.event.channel]] tables; all events are static load cases"
    else:
        line = channel_line(case, event)
        remedy = f"Write, for instance, {line} below the name of event '{event.name}', and give the same command again"
    return Problem("no_channels", case.path.name, what, remedy)


def channel_line(case: Case, event: Event) -> str:
    """A line of TOML that gives an event a channel of its own history: a column beside the modes, else a mode."""
    columns = column_names(case.resolve(event.history or ""))
    others = [name for name in columns if name != "time_s" and not re.match(r"[qu]_", name)]
    modes = [name for name in columns if re.fullmatch(r"q_-?\d+", name)]
    column = next(iter([*others, *modes]), "a_bogie")
    unit = "-" if column in modes else "m/s2"
    given = {"name": "bogie y", "column": column, "unit": unit, "role": "bogie", "direction": "y"}
    table = ", ".join(f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in given.items())
    return f"channel = [{{ {table} }}]"
