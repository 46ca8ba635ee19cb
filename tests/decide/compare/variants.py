"""The small case with lives that vary along its welds, and copies of it that another model could be."""

from pathlib import Path

import pandas as pd

from fatigue.assess import assess
from fatigue.diagnose import diagnose
from tests.small_case import SmallCase, small_case

LOADS = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
POINT = ["weld", "part", "order", "surface"]


def sloping(seconds: float = 4.0) -> SmallCase:
    """The small case, its line loads growing by a tenth from node to node."""
    case = small_case(seconds)
    growth = 1.0 + 0.1 * (case.nodal_forces["node"] % 100)
    case.nodal_forces[LOADS] = case.nodal_forces[LOADS].mul(growth, axis=0)
    return case


def renumbered_and_reversed(case: SmallCase) -> SmallCase:
    """The same lines run through the other way, with other node ids."""
    case.weld_nodes = case.weld_nodes.assign(
        order=8 - case.weld_nodes["order"], node=9000 - case.weld_nodes["node"]
    ).sort_values(["weld", "order"])
    case.nodal_forces = case.nodal_forces.assign(node=9000 - case.nodal_forces["node"])
    return case


def turned(case: SmallCase) -> SmallCase:
    """The same plates with their normals turned: top there is bottom here, the toe of B with it."""
    case.weld_nodes = case.weld_nodes.assign(normal_z=-1.0)
    case.welds = case.welds.assign(surface=["both", "bottom"])
    return case


def renamed(case: SmallCase, names: dict[str, str]) -> SmallCase:
    """The same welds under other names."""
    for table in ("welds", "weld_nodes", "nodal_forces"):
        setattr(case, table, getattr(case, table).replace({"weld": names}))
    return case


def result_of(case: SmallCase, folder: Path, *, diagnosed: bool = False) -> Path:
    """Result of a case."""
    assess(case.write(folder / "case"), folder / "result", threads=1, report=False)
    if diagnosed:
        diagnose(folder / "result")
    return folder / "result"


def lives(folder: Path) -> pd.Series:
    """Lives of all points by their keys."""
    return pd.read_parquet(folder / "nodes.parquet").set_index(POINT)["life_km"]
