"""Unit loads of the shipped car body by its shell model: ``python -m tests.carbody_loads`` writes their files again.

The body stands on its four air springs. Gravity and payload pull down, an overpressure pushes its hull outwards, the
couplers pull at both ends. Each load gives the force ``K_e u_e - f_e`` on the elements of the assessed side of every
weld, summed at its nodes: what the element itself carries of the load, ``f_e``, does not pass through the weld.
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.sparse.linalg import splu

from tests.shell_fe import ShellModel, areas, surface_load

FOLDER = Path(__file__).parents[1] / "data" / "carbody"
G = 9806.65  # mm/s2
AIR_SPRINGS = (4651, 4609, 562, 520)  # (+-8750, +-1288, 0)
COUPLERS = {5138: 1.0, 15: -1.0}  # (+-12250, 0, 0), and which way is out
HANGERS = ((1500.0, 900.0), (1500.0, -900.0), (-1500.0, 900.0), (-1500.0, -900.0))  # x, y of their middle
CONVERTER_T = 1.8
HALF_WIDTH, HEIGHT, HALF_LENGTH = 1500.0, 2600.0, 12250.0
FORCES = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
LOADS = ("gravity", "payload", "tunnel_pressure", "coupler")  # per 1 g, 1 t, 1 kPa, 1 kN


@dataclass
class CarBody:
    """The shell model, its node ids (n,), and mass per area (e,) [t/mm2] of its elements."""

    model: ShellModel
    node: np.ndarray
    element: np.ndarray
    area_mass: np.ndarray

    def index(self, nodes):
        """Indices of nodes given by id."""
        return np.searchsorted(self.node, nodes)


@cache
def car_body():
    """The shell model of ``data/carbody``: flat quads whose double skins bend with a thickness of their own."""
    nodes, elements = (pd.read_parquet(FOLDER / f"{name}.parquet") for name in ("nodes", "elements"))
    sections = pd.read_csv(FOLDER / "properties.csv").set_index("pid").loc[elements["pid"]]
    node = nodes["node"].to_numpy()
    first = sections.iloc[0]
    thickness = sections["thickness_mm"].to_numpy()
    model = ShellModel(
        nodes[["x_mm", "y_mm", "z_mm"]].to_numpy(),
        np.searchsorted(node, elements[["n1", "n2", "n3", "n4"]].to_numpy()),
        thickness,
        E=first["E_MPa"],
        nu=first["nu"],
        rho=first["rho_t_mm3"],
        bending_thickness=sections["bending_thickness_mm"].to_numpy(),
    )
    area_mass = model.rho * thickness + sections["nsm_t_mm2"].to_numpy()
    return CarBody(model, node, elements["element"].to_numpy(), area_mass)


def element_loads(body):
    """Forces (4, e, 4, 3) [N] that the elements themselves carry under each of the ``LOADS``."""
    model = body.model
    corners = model.xyz[model.quads]
    centre, one = corners.mean(axis=1), np.ones(len(corners))
    down, hull = np.array([0.0, 0.0, -1.0]), outward(centre)
    on_floor = np.isclose(centre[:, 2], 0.0)
    floor = areas(corners)[on_floor].sum()
    return np.stack(
        [
            surface_load(corners, G * body.area_mass)[..., None] * down,
            surface_load(corners, G / floor * on_floor)[..., None] * down,
            surface_load(corners, 1e-3 * one)[..., None] * hull[:, None],
            np.zeros((*model.quads.shape, 3)),
        ]
    )


def outward(centre):
    """Outward normal (e, 3) of the elements of the closed box, given their centres; 0 of those inside or outside it."""
    x, y, z = centre.T
    normal = np.zeros_like(centre)
    normal[:, 0] = np.sign(x) * np.isclose(abs(x), HALF_LENGTH)
    normal[:, 1] = np.sign(y) * np.isclose(abs(y), HALF_WIDTH)
    normal[:, 2] = np.isclose(z, HEIGHT) * 1.0 - np.isclose(z, 0.0)
    return normal * (z[:, None] > -1.0)  # the sills reach below the floor


def nodal_loads(body):
    """Forces (4, n, 6) [N] under each of the ``LOADS`` that act on nodes: converter, window panes, couplers."""
    xyz = body.model.xyz
    loads = np.zeros((len(LOADS), len(xyz), 6))
    for x, y in HANGERS:
        edge = np.flatnonzero(np.isclose(xyz[:, 1], y) & np.isclose(xyz[:, 2], -200.0) & (abs(xyz[:, 0] - x) < 200.0))
        loads[0, edge, 2] = -CONVERTER_T * G / len(HANGERS) / len(edge)
    for nodes, area, side in windows(body.model):
        loads[2, nodes, 1] += 1e-3 * area * side / len(nodes)
    for node, out in COUPLERS.items():
        loads[3, body.index(node), 0] = 1e3 * out
    return loads


def windows(model):
    """Openings of the side walls: the nodes of their edge, their area [mm2] and their side, +1 or -1.

    A pane carries its pressure to the edge of its opening.
    """
    edges = np.sort(np.stack([model.quads, np.roll(model.quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edge, used = np.unique(edges, axis=0, return_counts=True)
    free = edge[used == 1]
    xyz = model.xyz.astype(float)
    free = free[np.isclose(abs(xyz[free, 1]), HALF_WIDTH).all(axis=1) & (xyz[free, 2] > 0.0).all(axis=1)]
    opening = {node: node for node in np.unique(free).tolist()}

    def first(node):
        while opening[node] != node:
            node = opening[node]
        return node

    for a, b in free.tolist():
        opening[first(a)] = first(b)
    of_node = np.array([first(node) for node in opening])
    nodes = np.array(list(opening))
    for one in np.unique(of_node):
        own = nodes[of_node == one]
        corners = xyz[own]
        width, _, height = np.ptp(corners, axis=0)
        yield own, width * height, np.sign(corners[0, 1])


def displacements(body, applied):
    """Displacements (4, n, 6) [mm] of the body on its air springs under the forces (4, n, 6) [N]."""
    held = np.zeros((len(body.node), 6), dtype=bool)
    held[body.index(AIR_SPRINGS), 2] = True
    held[body.index(AIR_SPRINGS[0]), :2] = held[body.index(AIR_SPRINGS[2]), 1] = True
    free = ~held.ravel()
    stiffness = body.model.assembled()[free][:, free]
    factors = splu(stiffness, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    u = np.zeros((len(applied), free.size))
    u[:, free] = factors.solve(applied.reshape(len(applied), -1)[:, free].T).T
    return u.reshape(applied.shape)


def applied_forces(body, of_elements):
    """All forces (4, n, 6) [N] on the nodes, those that elements carry included."""
    total = nodal_loads(body)
    for load, forces in zip(total, of_elements, strict=True):
        np.add.at(load[:, :3], body.model.quads, forces)
    return total


def side_forces(body, u, of_elements):
    """Table of the forces on the assessed side of every weld at its nodes, one row per load, weld and node."""
    sides, lines = pd.read_csv(FOLDER / "weld_elements.csv"), pd.read_csv(FOLDER / "weld_nodes.csv")
    rows = []
    for name, shape, forces in zip(LOADS, u, of_elements, strict=True):
        on_element = body.model.element_forces(shape)
        on_element[:, :, :3] -= forces
        for weld, side in sides.groupby("weld", sort=False)["element"]:
            elements = np.searchsorted(body.element, side)
            total = np.zeros((len(body.node), 6))
            np.add.at(total, body.model.quads[elements], on_element[elements])
            node = lines.loc[lines["weld"] == weld, "node"].to_numpy()
            key = pd.DataFrame({"weld": weld, "node": node, "unit_load": name})
            values = pd.DataFrame(
                total[body.index(node)], columns=["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
            )
            rows.append(pd.concat([key, values], axis=1))
    return pd.concat(rows, ignore_index=True)


def unit_loads():
    """The table ``unit_loads.parquet`` of the example."""
    body = car_body()
    of_elements = element_loads(body)
    return side_forces(body, displacements(body, applied_forces(body, of_elements)), of_elements)


def tunnel_pressure():
    """Overpressure [kPa] inside over the time [s] of a tunnel of 1.5 km at 350 km/h, 20 samples/s: an invented one.

    The pressure outside drops as nose and tail enter, rises and drops as the waves come back, and the cabin follows
    with a time constant of 8 s.
    """
    time = np.arange(0.0, 30.0 + 1e-9, 0.05)
    steps = {6.0: -1.0, 7.8: -0.8, 10.5: 1.6, 13.0: -1.2, 16.2: 1.0, 19.0: -0.7, 22.0: 1.1}  # s: kPa
    outside = sum(0.5 * change * (1.0 + np.tanh((time - at) / 0.25)) for at, change in steps.items())
    inside, share = np.zeros_like(time), 1.0 - np.exp(-0.05 / 8.0)
    for i in range(1, len(time)):
        inside[i] = inside[i - 1] + share * (outside[i - 1] - inside[i - 1])
    return pd.DataFrame({"time_s": time.round(2), "u_tunnel_pressure": (inside - outside).round(4)})


if __name__ == "__main__":
    tunnel_pressure().to_csv(FOLDER / "p_tunnel.csv", index=False, lineterminator="\n")
    table = unit_loads()
    numbers = table.select_dtypes("floating").columns
    table[numbers] = table[numbers].astype(np.float32)
    table.to_parquet(FOLDER / "unit_loads.parquet", index=False, compression="zstd")
