"""A station counted again as the assessment counts it, all of its events, whatever bound once stood for counting."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from fatigue.life.mission import Plan
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.count.group import weld_names
from fatigue.pipeline.count.result import GroupResult, arrays_of
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.stations import modal_stress
from fatigue.pipeline.tables.cycle_rows import kept_point
from fatigue.pipeline.tables.cycles import cycle_writer
from fatigue.pipeline.tables.rows import damage_rows, node_rows, shear_columns
from fatigue.results import table_writer

CYCLES = "cycles"


def rows_of_station(
    model: Model, station: int, loads: Sequence[EventLoad], plan: Plan
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Rows of a station in ``nodes.parquet`` and in ``damage.parquet``, top before bottom, with nothing screened.

    What shear adds is not among them. ``station`` is its index among those of the ``model``.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    stations, rows = model.stations, np.array([station])
    rated = model.curve_of_weld[stations.weld[station]]
    stress, names = modal_stress(stations, rows, rated), weld_names(stations, rows)
    block = Block(stress, stations.weld[rows], stations.toe[rows], loads, rated.plan(plan), names)
    result = GroupResult.empty(len(loads), len(stations), len(plan.loops))
    for array in arrays_of(result).values():
        array[...] = 0  # of the other stations, whose rows nobody takes
    for settled in block.all_counted():
        result.put(settled, rows[settled.rows])
    status = [one.curve.status for one in model.curve_of_weld]
    every = _frame(node_rows(stations, result, plan, status)).drop(columns=list(shear_columns(result, 0)))
    nodes = every.iloc[2 * station : 2 * station + 2]
    damage = _frame(damage_rows(stations, result, plan, slice(station, station + 1)))
    return nodes.reset_index(drop=True), damage


def write_cycles(folder: Path, model: Model, station: int, face: int, loads: Sequence[EventLoad], plan: Plan) -> None:
    """Write every cycle of a point as a table ``cycles`` into a folder, some at a time."""
    point = kept_point(model, WorstPoint(int(model.stations.weld[station]), station, face))
    with table_writer(folder, CYCLES) as table:
        writer = cycle_writer(table, loads, plan)
        writer.add([point])
        writer.flush()


def _frame(rows: dict[str, Any]) -> pd.DataFrame:
    """Columns as they are written, as a table; coded texts as texts."""
    plain = {
        name: values.dictionary_decode() if isinstance(values, pa.DictionaryArray) else values
        for name, values in rows.items()
    }
    return pa.table(plain).to_pandas()
