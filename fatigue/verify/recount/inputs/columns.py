"""Solid welds once more: which nodes stand through the thickness at each station, and what their forces come to."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.inputs.case import RecountInputs, column
from fatigue.verify.recount.inputs.tables import read_rows_where

Floats = NDArray[np.float64]
Column = dict[int, Floats]
"""Positions (3,) [mm] of the nodes of a column, by node."""


def solid_columns(inputs: RecountInputs, sources: Sequence[str]) -> dict[str, dict[int, Column]]:
    """Columns at the stations of some lines in the tables: by line, and by the node of the station."""
    if "weld_columns" not in inputs.case["body"]:
        return {}
    rows = read_rows_where(inputs.path("weld_columns"), "weld", sources)
    if rows.empty:
        return {}
    if "x_mm" not in rows:
        ids = rows["node"].unique().tolist()
        nodes = read_rows_where(inputs.path("nodes"), "node", ids)
        rows = rows.merge(nodes[["node", "x_mm", "y_mm", "z_mm"]], on="node")
    rows = rows.assign(x=column(rows, "x_mm"), y=column(rows, "y_mm"), z=column(rows, "z_mm"))
    stations = read_rows_where(inputs.path("weld_nodes"), "weld", sources)
    named = rows.merge(stations[["weld", "order", "node"]], on=["weld", "order"], suffixes=("", "_of_station"))
    found: dict[str, dict[int, Column]] = {}
    for weld, station, node, x, y, z in named[["weld", "node_of_station", "node", "x", "y", "z"]].itertuples(
        index=False
    ):
        found.setdefault(weld, {}).setdefault(int(station), {})[int(node)] = np.array([x, y, z], dtype=float)
    return found


def about(mid: Floats, at: Floats, forces: Floats) -> Floats:
    """Forces and moments (m, 6) that act at a point, with the moments about another, ``mid``."""
    moved = forces.copy()
    moved[:, 3:] += np.cross(at - mid, forces[:, :3])
    return moved


def at_stations(rows: pd.DataFrame, columns: Mapping[int, Column]) -> pd.DataFrame:
    """Rows of forces with the node of the station in place of each node of its column."""
    station = {node: at for at, nodes in columns.items() for node in nodes}
    return rows.assign(node=rows["node"].map(lambda node: station.get(node, node)))
