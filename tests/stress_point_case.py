"""The small case with stress points: their tables, and the micro example of hot spots as files."""

from pathlib import Path

import numpy as np
import pandas as pd

from tests.small_case import SmallCase, small_case

CURVE = """
[curves.{name}]
slopes = {slopes}
knees_cycles = {knees}
range_at_2e6_MPa = {reference}
applies = "{applies}"
quantity = "{quantity}"
source = "of the test"
{more}
"""


def curve_text(
    name: str,
    reference: float,
    applies: str = "hot_spot",
    slopes: tuple[float, ...] = (3.0,),
    knees: tuple[float, ...] = (),
    quantity: str = "normal",
    more: str = "",
) -> str:
    """Text of a curve of the user for a case file."""
    numbers = {"slopes": list(slopes), "knees": list(knees), "reference": reference}
    return CURVE.format(name=name, applies=applies, quantity=quantity, more=more, **numbers)


def point(name: str, kind: str = "hot_spot_a", weld: str = "", **changes: object) -> dict[str, object]:
    """A row of ``stress_points``: 10 mm beside the middle of weld A of the small case, e1 across it."""
    row = {"point": name, "kind": kind, "weld": weld, "x_mm": 30.0, "y_mm": 5.0, "z_mm": 0.0, "thickness_mm": 8.0}
    row |= {"e1_x": 0.0, "e1_y": 1.0, "e1_z": 0.0, "normal_x": 0.0, "normal_y": 0.0, "normal_z": 1.0}
    return row | {"curve": "points", "curve_shear": ""} | changes


def stresses(
    name: str,
    tensors: dict[int | str, object],
    distances: tuple[float, ...] = (0.0,),
    surfaces: tuple[str, ...] = ("top",),
) -> pd.DataFrame:
    """Rows of ``modal_stresses``: of each mode, or unit load, the tensor (3,), or (read-out, 3), on all surfaces."""
    rows = []
    for key, tensor in tensors.items():
        at = np.broadcast_to(np.asarray(tensor, dtype=float), (len(distances), 3))
        of = {"mode": key, "unit_load": ""} if isinstance(key, int) else {"mode": None, "unit_load": key}
        for surface in surfaces:
            for number, (distance, (sx, sy, txy)) in enumerate(zip(distances, at, strict=True), 1):
                row = {"point": name, "read_out": number, "distance_mm": distance} | of | {"surface": surface}
                rows.append(row | {"sx_MPa": sx, "sy_MPa": sy, "txy_MPa": txy})
    return pd.DataFrame(rows)


def write_points(
    case: SmallCase, folder: Path, points: list[dict[str, object]], stress: list[pd.DataFrame], suffix: str = "csv"
) -> Path:
    """Write a case with stress points; return the path of the case file."""
    case.body |= {"stress_points": f"stress_points.{suffix}", "modal_stresses": f"modal_stresses.{suffix}"}
    path = case.write(folder, suffix)
    for name, table in (("stress_points", pd.DataFrame(points)), ("modal_stresses", pd.concat(stress))):
        if suffix == "csv":
            table.to_csv(folder / f"{name}.csv", index=False)
        else:
            table.astype({"mode": "Int64"} if name == "modal_stresses" else {}).to_parquet(folder / f"{name}.parquet")
    return path


def micro_example() -> SmallCase:
    """Two modes and a static third one under a track and under loading and unloading; welds of the small case."""
    case = small_case()
    case.modes = pd.DataFrame({"mode": [1, 2, 3], "frequency_hz": [5.0, 12.0, 60.0], "kind": "normal"})
    case.nodal_forces = case.nodal_forces.assign(mode=case.nodal_forces["mode"].replace({7: 3}))
    track = [(0, 0, 1), (1, 1, 1), (-1, 1, 1), (2, -1, 1), (0.5, 2, 1), (-2, 0, 1)]
    of_events = {"track": track, "load_unload": [(0, 0, 1), (3, -2, 1)]}
    case.histories = {
        name: pd.DataFrame(q, columns=["q_1", "q_2", "q_3"], dtype=float).assign(time_s=0.1 * np.arange(len(q)))
        for name, q in of_events.items()
    }
    case.events = [
        {"name": "track", "history": "track", "share": 1.0, "length_km": 0.01},
        {"name": "load_unload", "history": "load_unload", "per_1000_km": 4.0},
    ]
    case.mission = {"target_km": 1500.0, "km_per_year": 2e5, "damage_limit": 1.0}
    return case
