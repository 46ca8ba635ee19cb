"""Cases of solid welds with a known answer: a T joint of bricks, its forces in both forms, and the same one of shells.

The base plate is 200 x 100 x 10 mm, pinned at its left end and on rollers at its right; 1000 N push the attachment,
50 mm above the plate's middle, to the right. By statics the toe at x has a membrane stress of 1 MPa to the left of the
attachment and none to the right of it, and a bending stress of 0.15 x there and -0.15 (200 - x) here.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from tests.shell_fe import ShellModel, grid
from tests.shell_fe import joined as joined_shells
from tests.solid_fe import SolidModel, block, joined

FORCE = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
TOES = {"left": (95.0, 1.0), "right": (105.0, -1.0)}  # x, outward along x


@dataclass
class SolidCase:
    """Tables of a case before they are written; a test changes what it wants to see refused."""

    tables: dict[str, pd.DataFrame]
    body: dict[str, str]
    extra: str = ""

    def write(self, folder: Path) -> Path:
        """Write all tables and the case; return its path."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, table in self.tables.items():
            table.to_csv(folder / f"{name}.csv", index=False)
        t = np.arange(1000) * 0.005
        q = pd.DataFrame({"time_s": t})
        for mode in self.tables["modes"]["mode"]:
            q[f"q_{mode}"] = 3.0 * np.sin(2 * np.pi * (4.0 + mode) * t)
        q.to_csv(folder / "sine.csv", index=False)
        files = {name: f"{name}.csv" for name in self.tables}
        body = files | {"force_convention": "on_element"} | self.body
        lines = ['title = "solid welds"', "[body]", *(f'{key} = "{value}"' for key, value in body.items() if value)]
        lines += ['[curve]\nname = "master-aluminium"\n[counting]\nupsample = 1\n[spectrum]\nsegment_s = 1.0']
        lines += ["[mission]\ntarget_km = 1e6\nkm_per_year = 2e5\ndamage_limit = 1.0"]
        lines += ['[[mission.event]]\nname = "sine"\nhistory = "sine.csv"\nspeed_km_h = 180.0\nshare = 1.0', self.extra]
        path = folder / "case.toml"
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return path


def stations(width, h):
    """Even stations from 0 to a width, about h apart."""
    return np.linspace(0, width, max(1, round(width / h)) + 1)


def tee(h, layers, quadratic=False, nu=0.0):
    """The T joint of bricks, solved: model and displacements."""
    z = np.linspace(-5, 5, layers + 1)
    x = np.concatenate([stations(95, h), 95 + stations(10, h)[1:], 105 + stations(95, h)[1:]])
    y = stations(100, h)
    mesh = joined(block(x, y, z, quadratic), block(95 + stations(10, h), y, 5 + stations(45, h), quadratic))
    model = SolidModel(*mesh, nu=nu)
    at = model.xyz
    middle = np.abs(at[:, 2]) < 1e-9
    if not (middle & (at[:, 0] == 0)).any():
        raise ValueError("the supports need nodes at mid-thickness: an even number of layers, or mid-side nodes")
    fixed = np.zeros(at.shape, dtype=bool)
    fixed[middle & (at[:, 0] == 0)] = [True, False, True]
    fixed[middle & (at[:, 0] == 200), 2] = True
    fixed[middle & (at[:, 0] == 0) & (at[:, 1] == 0), 1] = True
    load = np.zeros(at.shape)
    for nodes in model.bricks[np.isclose(at[model.bricks[:, 4], 2], 50)]:
        length, width = at[nodes[6], :2] - at[nodes[4], :2]
        share = np.full(4, 1 / 4) if not quadratic else np.repeat([-1 / 12, 1 / 3], 4)
        load[nodes[[4, 5, 6, 7] if not quadratic else [4, 5, 6, 7, 16, 17, 18, 19]], 0] += length * width * share
    return model, model.solve(load, fixed)  # 1000 N: 1 MPa on 10 x 100 mm


def tee_of_shells(h, nu=0.0):
    """The T joint of shells, solved, with mesh lines where the toes of the bricks are: model and displacements."""
    x = np.concatenate([stations(95, h), [100.0], 105 + stations(95, h)])
    y = stations(100, h)
    wall, quads = grid(y, stations(50, h))
    upright = np.column_stack([np.full(len(wall), 100.0), wall[:, 0], wall[:, 1]]), quads
    xyz, quads = joined_shells(grid(x, y), upright)
    model = ShellModel(xyz, quads, 10.0, nu=nu)
    fixed = np.zeros((len(xyz), 6), dtype=bool)
    fixed[(xyz[:, 0] == 0)] = [True, False, True, False, False, False]
    fixed[(xyz[:, 0] == 200) & (xyz[:, 2] == 0), 2] = True
    fixed[(xyz[:, 0] == 0) & (xyz[:, 1] == 0), 1] = True
    load = np.zeros((len(xyz), 6))
    top = np.flatnonzero(xyz[:, 2] == 50)
    load[top, 0] = np.gradient(xyz[top, 1])
    load[top[[0, -1]], 0] /= 2  # of nodes at the edges; 10 N/mm over 100 mm
    load[top, 0] *= 10
    return model, model.solve(load, fixed)


def columns_on(xyz, x, z, across=1):
    """Nodes of a section at x within heights z, grouped by their place along an axis: places, and nodes from below."""
    at = np.flatnonzero((np.abs(xyz[:, 0] - x) < 1e-9) & (xyz[:, 2] >= z[0] - 1e-9) & (xyz[:, 2] <= z[1] + 1e-9))
    places = np.unique(np.round(xyz[at, across], 6))
    groups = [at[np.abs(xyz[at, across] - place) < 1e-6] for place in places]
    return places, [group[np.argsort(xyz[group, 2])] for group in groups]


def tee_case(h=25.0, layers=2, quadratic=False, nu=0.0, form="element_forces", modes=2):
    """The T joint of bricks as a case; mode m is m times the static solution."""
    model, u = tee(h, layers, quadratic, nu)
    return case_of(model, [u * (i + 1) for i in range(modes)], TOES, form)


def case_of(model, shapes, toes, form):
    """Case of a model of bricks with a plate from z = -5 to 5 and toes along y at x, outward along x."""
    xyz, bricks = model.xyz, model.bricks
    centre = xyz[bricks[:, :8]].mean(axis=1)
    in_plate = np.abs(centre[:, 2]) < 5
    nodes, columns, sides = [], [], []
    for weld, (x, out) in toes.items():
        places, groups = columns_on(xyz, x, (-5, 5))
        side = np.flatnonzero(in_plate & ((centre[:, 0] - x) * out < 0))
        touching = side[np.isin(bricks[side], np.concatenate(groups)).any(axis=1)]
        sides.append(pd.DataFrame({"weld": weld, "element": touching + 1}))
        for order, (y, group) in enumerate(zip(places, groups, strict=True), 1):
            columns.append(pd.DataFrame({"weld": weld, "order": order, "node": group + 1}))
            mid = bool(bricks.shape[1] == 20 and order % 2 == 0)
            nodes.append([weld, order, group[-1] + 1, x, y, 0.0, 10.0, 0, 0, 1, out, 0, 0, mid])
    names = ["weld", "order", "node", "x_mm", "y_mm", "z_mm", "thickness_mm"]
    names += [f"{stem}_{axis}" for stem in ("normal", "outward") for axis in "xyz"] + ["edge_mid"]
    tables = {
        "modes": pd.DataFrame({"mode": np.arange(len(shapes)) + 1, "frequency_hz": 5.0, "kind": "normal"}),
        "welds": pd.DataFrame({"weld": list(toes)}),
        "weld_nodes": pd.DataFrame(nodes, columns=names),
        "weld_columns": pd.concat(columns, ignore_index=True),
        "nodes": pd.DataFrame(xyz, columns=["x_mm", "y_mm", "z_mm"]).assign(node=np.arange(len(xyz)) + 1),
    }
    forces = []
    sides = pd.concat(sides, ignore_index=True)
    rows = np.unique(sides["element"]) - 1
    for mode, u in enumerate(shapes, 1):
        force = model.element_forces(u)[rows]
        table = pd.DataFrame(force.reshape(-1, 3), columns=FORCE[:3]).assign(**dict.fromkeys(FORCE[3:], 0.0))
        forces.append(
            table.assign(mode=mode, node=bricks[rows].ravel() + 1, element=np.repeat(rows + 1, bricks.shape[1]))
        )
    forces = pd.concat(forces, ignore_index=True)
    if form == "element_forces":
        return SolidCase(tables | {"element_forces": forces, "weld_elements": sides}, {})
    summed = forces.merge(sides, on="element").merge(tables["weld_columns"][["weld", "node"]], on=["weld", "node"])
    summed = summed.groupby(["weld", "node", "mode"], as_index=False)[FORCE].sum()
    return SolidCase(tables | {"nodal_forces": summed}, {})
