"""Every cycle of any point under one event or all of them, in the rows of ``cycles.parquet``."""

from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd
import pyarrow as pa

from fatigue.life.mission import Loop, Pass, Plan
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.tables.cycle_rows import KeptPoint, kept_point
from fatigue.pipeline.tables.cycles import point_cycles
from fatigue.pipeline.tables.sequence_cycles import sequence_rows
from fatigue.point.found import Station
from fatigue.point.reopened import Reopened, counted_load, event_numbers, forget, solved_station
from fatigue.results import schema


def counted_point(inputs: Reopened, station: Station, face: int) -> KeptPoint:
    """A face of a station, 0 the top and 1 the bottom, with the stress and the curve its cycles are counted by."""
    model, index = solved_station(inputs, station)
    return kept_point(model, WorstPoint(int(model.stations.weld[index]), index, face))


def cycle_rows(inputs: Reopened, point: KeptPoint, event: str | None = None) -> Iterator[dict[str, Any]]:
    """Rows of ``cycles.parquet`` of a point, some at a time: event after event and the sequences, or one of them.

    They are found as the assessment finds those of the worst points, in double precision.

    Raises
    ------
    DataError : no such event, or records that cannot be read
    """
    if inputs.sequences and (event is None or event in inputs.sequences):
        yield from _with_sequences(inputs, point, event)
        return
    for number in event_numbers(inputs, event):
        load = counted_load(inputs, number)
        yield from point_cycles([point], load)
        forget(load)


def _with_sequences(inputs: Reopened, point: KeptPoint, name: str | None) -> Iterator[dict[str, Any]]:
    """Rows of all events and of the cycles across them, or of one sequence; all records are there meanwhile."""
    loads = [counted_load(inputs, number) for number in event_numbers(inputs, None)]
    if name is None:
        for load in loads:
            yield from point_cycles([point], load)
    plan = recorded_plan(inputs.record)
    for loop, rows in zip(plan.loops, sequence_rows([point], loads, plan), strict=True):
        if name in (None, loop.name):
            yield rows
    for load in loads:
        forget(load)


def recorded_plan(record: Mapping[str, Any]) -> Plan:
    """The mission of a result in numbers, as its provenance has them."""
    mission = record["mission"]
    names = [one["event"] for one in mission["events"]]
    passes = [
        Pass(one["event"], one["samples"], one["length"], one["share"], one["per_1000_km"]) for one in mission["events"]
    ]
    loops = [
        Loop(loop["name"], tuple(names.index(event) for event in loop["order"]), 1000.0 * loop["runs_per_km"])
        for loop in mission.get("sequences", ())
    ]
    target = mission["target_km"], mission["km_per_year"], mission["damage_limit"]
    return Plan(tuple(passes), *target, tuple(loops))


def cycle_frame(inputs: Reopened, station: Station, face: int, event: str | None = None) -> pd.DataFrame:
    """Cycles of a face of a station as one table with the columns of ``cycles.parquet``, all of it in memory."""
    rows = cycle_rows(inputs, counted_point(inputs, station, face), event)
    return pa.concat_tables([cycle_table(some) for some in rows]).to_pandas()


def cycle_table(rows: dict[str, Any]) -> pa.Table:
    """Rows of ``cycles.parquet`` as an Arrow table, texts as plain texts."""
    plain = schema("cycles")
    arrays = [values if isinstance(values, pa.Array) else pa.array(values) for values in (rows[f.name] for f in plain)]
    return pa.table([values.cast(f.type) for values, f in zip(arrays, plain, strict=True)], schema=plain)
