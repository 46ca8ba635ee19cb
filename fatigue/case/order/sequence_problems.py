"""What is wrong with the order of events: names that are not there, or that stand for something else."""

import difflib
from collections.abc import Iterator
from typing import Any

from fatigue.errors import Problem
from fatigue.files.naming import composed


def sequence_problems(raw: dict[str, Any]) -> Iterator[Problem]:
    """Refusals about sequences and events together, on the file's own values."""
    mission = raw.get("mission")
    if not isinstance(mission, dict):
        return
    events, sequences = _tables(mission, "event"), _tables(mission, "sequence")
    names = [event["name"] for event in events if isinstance(event.get("name"), str)]
    for position, event in enumerate(events, 1):
        name = event.get("name")
        if isinstance(name, str) and name.strip().startswith("(") and name.strip().endswith(")"):
            what = f"the name {name!r} is in parentheses, as are the rows of sequences in the tables: '(sequence 1)'"
            yield Problem("bad_name", f"mission.event[{position}].name", what, f"Write {name.strip()[1:-1].strip()!r}")
        if sequences and event.get("stints_per_1000_km") is not None:
            where = f"mission.event[{position}].stints_per_1000_km" + (f" ({name!r})" if isinstance(name, str) else "")
            what = "the key is for an order that is not known, and [[mission.sequence]] gives one"
            yield Problem("contradiction", where, what, "Keep one of them; a second case may have the other")
    counting = raw.get("counting")
    at_vertices = isinstance(counting, dict) and counting.get("reversals") == "vertex"
    if at_vertices and (sequences or any(event.get("stints_per_1000_km") is not None for event in events)):
        what = "'vertex' is for events that are counted alone, and a reversal at the end of a pass has no third sample"
        remedy = "Set reversals = 'samples', with upsample = 'auto', or take sequences and stints out"
        yield Problem("contradiction", "counting.reversals", what, remedy)
    for position, sequence in enumerate(sequences, 1):
        order = sequence.get("order")
        for place, name in enumerate(order if isinstance(order, list) else [], 1):
            if isinstance(name, str) and name and names and name not in names:
                where = f"mission.sequence[{position}].order[{place}]"
                yield Problem("unknown_event", where, f"there is no event {name!r}", _remedy(name, names))


def _remedy(name: str, names: list[str]) -> str:
    if composed(name) in map(composed, names):
        return "Copy the name from [[mission.event]]: there an accent is a character of its own, or here"
    near = difflib.get_close_matches(name, names, n=1)
    return f"Write {near[0]!r}" if near else f"Add the event, or use one of {', '.join(map(repr, names))}"


def _tables(mission: dict[str, Any], key: str) -> list[dict[str, Any]]:
    found = mission.get(key)
    return [table for table in found if isinstance(table, dict)] if isinstance(found, list) else []
