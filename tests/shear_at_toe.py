"""The worked example of shear at a toe: a straight weld under uniform line loads, three coordinates, two events.

Its structural stress per unit coordinate is the same at every node, so that nodal forces follow by hand.
"""

import numpy as np
import pandas as pd

from tests.small_case import SmallCase

THICKNESS, SPACING, NODES = 6.0, 10.0, 3  # mm
STRESSES = {  # per unit coordinate [MPa]: membrane, bending, in-plane, twist, transverse shear
    1: (12.0, 4.5, 3.0, 0.9, 0.3),
    2: (-2.4, 3.6, 7.5, -1.5, 0.6),
    3: (6.0, 1.2, 0.6, 0.0, 0.0),
}
TRACK = [[0, 0, 1], [1, 1, 1], [-1, 1, 1], [2, -1, 1], [0.5, 2, 1], [-2, 0, 1]]
LOAD_UNLOAD = [[0, 0, 1], [3, -2, 1]]


def shear_at_toe(multiaxial: str = "alpha = 1.0", **curve: object) -> SmallCase:
    """The case; ``multiaxial`` are lines of its table, ``curve`` more keys of the curve."""
    nodes = pd.DataFrame(
        {
            "weld": "T",
            "order": np.arange(1, NODES + 1),
            "node": 10 + np.arange(NODES),
            "x_mm": SPACING * np.arange(NODES),
            "y_mm": 0.0,
            "z_mm": 0.0,
            "thickness_mm": THICKNESS,
            "normal_x": 0.0,
            "normal_y": 0.0,
            "normal_z": 1.0,
            "outward_x": 0.0,
            "outward_y": 1.0,
            "outward_z": 0.0,
        }
    )
    modes, kinds = sorted(STRESSES), ["normal", "normal", "interface"]
    return SmallCase(
        modes=pd.DataFrame({"mode": modes, "frequency_hz": [5.0, 12.0, 60.0], "kind": kinds}),
        welds=pd.DataFrame({"weld": ["T"], "surface": ["top"]}),
        weld_nodes=nodes,
        nodal_forces=pd.concat([_forces(mode, *STRESSES[mode]) for mode in modes], ignore_index=True),
        histories={"track": _history(TRACK), "load": _history(LOAD_UNLOAD)},
        curve={"name": "master-aluminium"} | curve,
        mission={"target_km": 1500.0, "km_per_year": 1e5, "damage_limit": 1.0},
        events=[
            {"name": "track", "history": "track", "length_km": 0.01, "share": 1.0, "residue": "repeat"},
            {"name": "load_unload", "history": "load", "per_1000_km": 4.0},
        ],
        extra=f"[multiaxial]\n{multiaxial}\n",
    )


def scaled(case: SmallCase, factor: float) -> SmallCase:
    """The same case with all coordinates times a factor."""
    for name, table in case.histories.items():
        q = [column for column in table if column != "time_s"]
        case.histories[name] = table.assign(**{column: factor * table[column] for column in q})
    return case


def _forces(
    mode: int, membrane: float, bending: float, in_plane: float, twist: float, transverse: float
) -> pd.DataFrame:
    """Consistent nodal forces of a uniform line load with these stresses (Eq. 3)."""
    t, tributary = THICKNESS, np.full(NODES, SPACING)
    tributary[[0, -1]] /= 2.0
    line = np.array([in_plane * t, membrane * t, transverse * t, -bending * t**2 / 6.0, twist * t**2 / 6.0, 0.0])
    table = pd.DataFrame(tributary[:, None] * line, columns=["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"])
    return table.assign(weld="T", node=10 + np.arange(NODES), mode=mode)


def _history(q: list[list[float]]) -> pd.DataFrame:
    values = np.array(q, dtype=float)
    columns = {f"q_{mode}": values[:, i] for i, mode in enumerate(sorted(STRESSES))}
    return pd.DataFrame({"time_s": 0.01 * np.arange(len(values))} | columns)
