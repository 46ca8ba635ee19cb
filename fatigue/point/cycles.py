"""Every cycle of any point under one event or all of them, in the rows of ``cycles.parquet``."""

from collections.abc import Iterator
from typing import Any

import pandas as pd
import pyarrow as pa

from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.mission.plan import mission_plan
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
    if event not in inputs.sequences:
        for number in event_numbers(inputs, event):
            load = counted_load(inputs, number)
            yield from point_cycles([point], load)
            forget(load)
    if event is None or event in inputs.sequences:
        yield from _of_sequences(inputs, point, event)


def _of_sequences(inputs: Reopened, point: KeptPoint, name: str | None) -> Iterator[dict[str, Any]]:
    """Rows of the cycles across events, of all sequences or of one; the records of all events are there meanwhile."""
    if not inputs.sequences:
        return
    plan, _ = mission_plan(inputs.body)
    loads = [counted_load(inputs, number) for number in range(len(inputs.events))]
    for loop, rows in zip(plan.loops, sequence_rows([point], loads, plan), strict=True):
        if name in (None, loop.name):
            yield rows
    for load in loads:
        forget(load)


def cycle_frame(inputs: Reopened, station: Station, face: int, event: str | None = None) -> pd.DataFrame:
    """Cycles of a face of a station as one table with the columns of ``cycles.parquet``, all of it in memory."""
    rows = cycle_rows(inputs, counted_point(inputs, station, face), event)
    return pa.concat_tables([cycle_table(some) for some in rows]).to_pandas()


def cycle_table(rows: dict[str, Any]) -> pa.Table:
    """Rows of ``cycles.parquet`` as an Arrow table, texts as plain texts."""
    plain = schema("cycles")
    arrays = [values if isinstance(values, pa.Array) else pa.array(values) for values in (rows[f.name] for f in plain)]
    return pa.table([values.cast(f.type) for values, f in zip(arrays, plain, strict=True)], schema=plain)
