"""A finished result read for its report: every point, the welds worst first, details of the points that govern."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.results import read_provenance, read_table

POINT = ("weld", "part", "order", "surface")


@dataclass(frozen=True, slots=True, eq=False)
class Result:
    """What a report needs of a result folder.

    Attributes
    ----------
    record : provenance
    welds : the register, worst first
    nodes : all points, with the kurtosis of the stress in the governing event of each
    detailed : the welds, worst first, whose worst point is shown in detail
    damage, cycles : the worst points of the detailed welds only
    folder : where the tables lie
    """

    record: Mapping[str, Any]
    welds: pd.DataFrame
    nodes: pd.DataFrame
    detailed: tuple[str, ...]
    damage: pd.DataFrame
    cycles: pd.DataFrame
    folder: Path

    @property
    def target_km(self) -> float:
        """Mileage to be reached [km]."""
        return float(self.record["mission"]["target_km"])

    @property
    def events(self) -> list[dict[str, Any]]:
        """The events of the mission in its order."""
        return list(self.record["mission"]["events"])

    @property
    def passes_per_km(self) -> dict[str, float]:
        """Passes of every event in one km of the mission [1/km]."""
        return {event["event"]: float(event["passes_per_km"]) for event in self.events}

    def worst(self, weld: str) -> pd.Series:
        """Row of the worst point of a weld in the table of nodes."""
        row = self.welds.set_index("weld").loc[weld]
        nodes = self.nodes
        found = (nodes["weld"] == weld) & (nodes["part"] == row["worst_part"]) & (nodes["order"] == row["worst_order"])
        return nodes[found & (nodes["surface"] == row["worst_surface"])].iloc[0]

    def stress_shapes(self, columns: Sequence[str]) -> dict[str, tuple[pd.DataFrame, NDArray[np.float64]]]:
        """Read stress columns of the detailed welds [MPa per unit modal coordinate].

        Returns for each weld its stations (``part`` and ``order``) and an array (column, station, mode), both in the
        order of the table, which lists all modes of a station one after the other.
        """
        modes = len(self.record["modes"]["used"])
        rows = _rows(self.folder, "structural_stress", self.detailed, ["weld", "part", "order", *columns])
        found = {}
        for weld, of_weld in rows.groupby("weld", sort=False):
            stations = of_weld[["part", "order"]].iloc[::modes].reset_index(drop=True)
            found[str(weld)] = (stations, of_weld[list(columns)].to_numpy().T.reshape(len(columns), -1, modes))
        return found


def read_result(folder: Path, most_detailed: int) -> Result:
    """Read a result folder; details for the worst points of at most so many welds.

    Raises
    ------
    DataError : no finished result there, or a table is damaged
    """
    record = read_provenance(folder)
    welds = read_table(folder, "welds").to_pandas()
    welds = welds.sort_values("utilisation", ascending=False, kind="stable", na_position="last", ignore_index=True)
    nodes = read_table(folder, "nodes").to_pandas()
    nodes["kurtosis"] = _kurtosis(folder, nodes)
    assessed = welds[welds["status"] == "assessed"].head(most_detailed)
    detailed = tuple(assessed["weld"])
    worst = assessed[["weld", "worst_part", "worst_order", "worst_surface"]].set_axis(list(POINT), axis=1)
    damage = _rows(folder, "damage", detailed).merge(worst, on=list(POINT))
    cycles = _rows(folder, "cycles", detailed).merge(worst, on=list(POINT))
    return Result(record, welds, nodes, detailed, damage, cycles, folder)


def _rows(folder: Path, table: str, welds: Sequence[str], columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Read the rows of some welds only: the whole table may not fit into memory."""
    read_table(folder, table, ["weld"])  # refuses a table that is missing or damaged
    wanted = pc.field("weld").isin(pa.array(welds, pa.string()))
    return pq.read_table(folder / f"{table}.parquet", columns=columns, filters=wanted).to_pandas()


def _kurtosis(folder: Path, nodes: pd.DataFrame) -> NDArray[np.float64]:
    """Kurtosis of the stress of every point in its governing event; NaN where nothing damages.

    The table of damage lists all events of every point in the order of the table of nodes.
    """
    table = read_table(folder, "damage", ["event", "kurtosis"]).combine_chunks()
    event = table.column("event").chunk(0).dictionary_encode()
    governing = pc.index_in(pa.array(nodes["governing_event"], pa.string()), value_set=event.dictionary)
    column = governing.to_numpy(zero_copy_only=False)
    events = table.num_rows // len(nodes)
    is_governing = event.indices.to_numpy().reshape(-1, events) == column[:, None]
    kurtosis = table.column("kurtosis").to_numpy().reshape(-1, events)
    return np.where(is_governing.any(axis=1), np.nansum(np.where(is_governing, kurtosis, 0.0), axis=1), np.nan)
