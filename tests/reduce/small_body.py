"""A small body of shells to reduce: a closed box on four bolsters with a hanger plate below its floor."""

from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.vehicle.equations.suspension import NEEDED
from tests.shell_fe import grid, joined

LENGTH, WIDTH, HEIGHT, EDGE = 1200.0, 300.0, 300.0, 100.0  # mm
HANGER = (500.0, 600.0, 700.0)  # x of its nodes
BOLSTERS = {
    "front_left": (1100.0, 300.0),
    "front_right": (1100.0, 0.0),
    "rear_left": (100.0, 300.0),
    "rear_right": (100.0, 0.0),
}
FORCES = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]


def plate(u, v, place):
    """A flat mesh with coordinates u and v, put into space by ``place``."""
    flat, quads = grid(u, v)
    return place(flat[:, 0], flat[:, 1]), quads


def small_mesh():
    """Nodes (n, 3) and quads of the box and, behind them, of the hanger plate; how many quads the box has."""
    x, y, z = (np.arange(0.0, size + 1.0, EDGE) for size in (LENGTH, WIDTH, HEIGHT))
    at = np.full_like
    box = (
        [plate(x, y, lambda u, v, h=h: np.stack([u, v, at(u, h)], axis=1)) for h in (0.0, HEIGHT)]
        + [plate(x, z, lambda u, v, b=b: np.stack([u, at(u, b), v], axis=1)) for b in (0.0, WIDTH)]
        + [plate(y, z, lambda u, v, a=a: np.stack([at(u, a), u, v], axis=1)) for a in (0.0, LENGTH)]
    )
    hanger = plate(np.array(HANGER), np.array([-80.0, 0.0]), lambda u, v: np.stack([u, at(u, 100.0), v], axis=1))
    xyz, quads = joined(*box, hanger)
    return xyz, quads, sum(len(part[1]) for part in box)


def node_at(xyz, *place):
    """Number of the node at a place."""
    (found,) = np.flatnonzero(np.linalg.norm(xyz - np.array(place), axis=1) < 1e-6)
    return int(found) + 1


def write_model(folder: Path) -> Path:
    """Write nodes, elements, properties and the weld of the hanger; returns the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    xyz, quads, of_box = small_mesh()
    pid = np.where(np.arange(len(quads)) < of_box, 1, 2)
    nodes = pd.DataFrame({"node": np.arange(1, len(xyz) + 1), **{f"{a}_mm": xyz[:, k] for k, a in enumerate("xyz")}})
    nodes.to_csv(folder / "nodes.csv", index=False)
    corners = {f"n{k + 1}": quads[:, k] + 1 for k in range(4)}
    elements = pd.DataFrame({"element": np.arange(1, len(quads) + 1), "pid": pid, **corners})
    elements.to_csv(folder / "elements.csv", index=False)
    properties().to_csv(folder / "properties.csv", index=False)
    line = [node_at(xyz, x, 100.0, 0.0) for x in HANGER]
    welds = pd.DataFrame({"weld": ["hanger"], "closed": [False], "surface": ["both"]})
    welds.to_csv(folder / "welds.csv", index=False)
    places = xyz[np.array(line) - 1]
    vectors = {"normal_x": 0.0, "normal_y": 1.0, "normal_z": 0.0, "outward_x": 0.0, "outward_y": 0.0, "outward_z": 1.0}
    of_line = {
        "weld": "hanger",
        "order": np.arange(1, len(line) + 1),
        "node": line,
        **{f"{a}_mm": places[:, k] for k, a in enumerate("xyz")},
    }
    pd.DataFrame({**of_line, "thickness_mm": 8.0, **vectors}).to_csv(folder / "weld_nodes.csv", index=False)
    sides = pd.DataFrame({"weld": "hanger", "element": elements["element"][pid == 2]})
    sides.to_csv(folder / "weld_elements.csv", index=False)
    interface().to_csv(folder / "interface.csv", index=False)
    return folder


def properties():
    """Sections of box and hanger; next to no mass is in the hanger, so that it feels what is applied and no inertia."""
    return pd.DataFrame(
        {
            "pid": [1, 2],
            "thickness_mm": [4.0, 8.0],
            "E_MPa": 70000.0,
            "nu": 0.3,
            "rho_t_mm3": [2.7e-9, 2.7e-13],
            "nsm_t_mm2": [1e-8, 0.0],
        }
    )


def interface():
    """Four bolsters outside, the lower edge of the hanger inside, and two observed points."""
    xyz = small_mesh()[0]
    rows = [(f"bolster_{name}", node_at(xyz, *at, 0.0), "external", "123", "") for name, at in BOLSTERS.items()]
    edge = [node_at(xyz, x, 100.0, -80.0) for x in HANGER]
    rows.append(("converter_1", edge[1], "internal", "123", " ".join(map(str, edge))))
    rows.append(("roof_mid", node_at(xyz, 600.0, 100.0, 300.0), "observed", "123456", ""))
    rows.append(("floor_front", rows[0][1], "observed", "3", ""))
    return pd.DataFrame(rows, columns=["name", "node", "side", "components", "pattern"])


def vehicle_interface(model: Path) -> Path:
    """Write ``all.csv`` of a model: its interface and every further point that a vehicle needs; returns its path."""
    table, nodes = pd.read_csv(model / "interface.csv", dtype=str), iter(range(60, 90))
    rows = [
        {"name": name, "node": next(nodes), "side": "internal", "components": "123"}
        for name in NEEDED
        if name not in set(table["name"])
    ]
    pd.concat([table, pd.DataFrame(rows)]).to_csv(model / "all.csv", index=False)
    return model / "all.csv"


def history(folder: Path, seconds: float = 4.0) -> Path:
    """Write random coordinates of all modes of a reduced body, of one variance of force; returns the file."""
    modes = pd.read_csv(folder / "modes.csv")
    time = np.arange(0.0, seconds, 0.002)
    rng = np.random.default_rng(3)
    w2 = (2.0 * np.pi * modes["frequency_hz"].to_numpy()) ** 2
    q = {f"q_{m}": 3e4 / w * rng.standard_normal(len(time)) for m, w in zip(modes["mode"], w2, strict=True)}
    pd.DataFrame({"time_s": time, **q}).to_parquet(folder / "q.parquet", index=False)
    return folder / "q.parquet"
