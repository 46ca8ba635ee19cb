"""A station counted again as the assessment counts it, all of its events, whatever bound once stood for counting."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
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
from fatigue.pipeline.life_band.points import band_points
from fatigue.pipeline.life_band.rows import BandRows
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.stations import modal_stress
from fatigue.pipeline.tables.cycle_rows import kept_point
from fatigue.pipeline.tables.cycles import cycle_writer
from fatigue.pipeline.tables.histogram import BinnedPoint, histogram_writer
from fatigue.pipeline.tables.rows import damage_rows, node_rows, shear_columns
from fatigue.results import table_writer

CYCLES, BAND, HISTOGRAM = "cycles", "band", "histogram"


@dataclass(frozen=True, slots=True, eq=False)
class CountedStation:
    """A station counted again.

    Attributes
    ----------
    model, station : the welds around it, and its index among their stations
    result : of all of these, with the numbers of this one and 0 in the others
    nodes, damage : its rows of ``nodes.parquet``, without what shear adds, and of ``damage.parquet``, top before bottom
    """

    model: Model
    station: int
    result: GroupResult
    nodes: pd.DataFrame
    damage: pd.DataFrame

    def point(self, face: int) -> WorstPoint:
        """A face of it, as tables name points."""
        return WorstPoint(int(self.model.stations.weld[self.station]), self.station, face)


def count_station(model: Model, station: int, loads: Sequence[EventLoad], plan: Plan) -> CountedStation:
    """Count a station under all events, with nothing screened; ``station`` is its index among those of the model.

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
    nodes = every.iloc[2 * station : 2 * station + 2].reset_index(drop=True)
    damage = _frame(damage_rows(stations, result, plan, slice(station, station + 1)))
    return CountedStation(model, station, result, nodes, damage)


def write_cycles(folder: Path, counted: CountedStation, face: int, loads: Sequence[EventLoad], plan: Plan) -> None:
    """Write every cycle of a point as a table ``cycles`` into a folder, some at a time."""
    with table_writer(folder, CYCLES) as table:
        writer = cycle_writer(table, loads, plan)
        writer.add([kept_point(counted.model, counted.point(face))])
        writer.flush()


def write_band(
    folder: Path, counted: CountedStation, face: int, assessed: pd.Series, loads: Sequence[EventLoad], plan: Plan
) -> None:
    """Write the band of the life of a point as a table ``band`` into a folder, and the histogram behind it.

    ``assessed`` is the row of its life and damage: where shear decides about these there is no band.
    """
    model, point = counted.model, counted.point(face)
    (of_normal,) = band_points(model, counted.result, [point], plan, with_lines=False)
    of_point = replace(of_normal, life_km=float(assessed["life_km"]), damage_per_km=float(assessed["damage_per_km"]))
    with table_writer(folder, HISTOGRAM) as table, table_writer(folder, BAND) as band:
        bands = BandRows(band, loads, plan, model.body.case.life_band)
        writer = histogram_writer(table, bands, loads, plan, 1)
        writer.add([BinnedPoint(kept_point(model, point), of_point)])
        writer.flush()
        bands.flush()


def _frame(rows: dict[str, Any]) -> pd.DataFrame:
    """Columns as they are written, as a table; coded texts as texts."""
    plain = {
        name: values.dictionary_decode() if isinstance(values, pa.DictionaryArray) else values
        for name, values in rows.items()
    }
    return pa.table(plain).to_pandas()
