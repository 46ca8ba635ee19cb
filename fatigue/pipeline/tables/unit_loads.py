"""What a result remembers of its unit loads: each as the case has it, and what every event gives of it."""

from typing import Any

from fatigue.case import Event
from fatigue.life.records.unit_load import LoadSource
from fatigue.pipeline.mission.unit_loads import load_sources
from fatigue.pipeline.solve.body import Body


def load_records(body: Body) -> list[dict[str, Any]]:
    """Record of every unit load: its keys in the case, and under ``given`` its source in each event by name."""
    case = body.case
    if not case.body.unit_load:
        return []
    events = {event.name: (event, load_sources(body, event)) for event in case.mission.event}
    return [
        load.model_dump()
        | {"given": {name: _source_record(event, sources[i]) for name, (event, sources) in events.items()}}
        for i, load in enumerate(case.body.unit_load)
    ]


def _source_record(event: Event, source: LoadSource) -> dict[str, Any]:
    """Record of where an event has a load from; ``file`` as the case names it."""
    if source.way == "constant":
        return {"way": "constant", "constant": source.constant}
    if source.way == "values":
        return {"way": "values", "values": list(source.values)}
    if source.way == "column":
        return {"way": "column", "file": event.history, "column": source.column}
    if source.way == "file":
        own = next(load for load in event.unit_load if load.name == source.name)
        return {
            "way": "file",
            "file": own.history,
            "column": source.column,
            "scale": source.scale,
            "shift_s": source.shift_s,
            "interpolation": source.interpolation,
        }
    return {"way": "missing"}
