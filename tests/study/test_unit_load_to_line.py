"""The whole way of a force: from the vehicle in SI over the history of its body to the stress of a weld in N and mm."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.flexbody.mass import rigid_motions
from fatigue.flexbody.shell import structure
from fatigue.readers.model.read import read_model
from fatigue.reduce.bases import Recipe
from fatigue.reduce.story import reduce
from fatigue.study.car_body import car_body
from fatigue.study.variants.source.builtin import coordinates_of
from fatigue.vehicle.assembly import assembled
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.equations.suspension import Places, springs
from fatigue.vehicle.run import Ride
from tests.reduce.small_body import FORCES, node_at, vehicle_interface, write_model
from tests.shell_fe import ShellModel

LOAD_N = 1000.0  # downwards, on the converter
EVENT = '[[mission.event]]\nname = "run"\nhistory = "q.parquet"\nspeed_km_h = 100.0\nshare = 1.0\n'


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    """The small body with all points that a vehicle needs."""
    return write_model(tmp_path_factory.mktemp("model"))


@pytest.fixture(scope="module")
def folder(model, tmp_path_factory):
    """The same body, reduced."""
    out = tmp_path_factory.mktemp("reduced") / "body"
    reduce(model, vehicle_interface(model), out, Recipe(cut_hz=300.0))
    return out


def standing(vehicle, body):
    """Coordinates (n,) of a vehicle whose converter is loaded, and force (3,) [N] on each point of its car body."""
    of = assembled(vehicle, body)
    load = np.zeros(len(of.M))
    load[of.coordinates.column("conv", "z")] = -LOAD_N
    x = np.linalg.solve(of.K, load)
    forces = {}
    for spring in springs(Places(vehicle, body, of.coordinates)):
        pull = spring.stiffness * spring.row @ x
        if spring.name.startswith("anti-roll"):
            left, right = (f"bolster_{spring.name.split()[-1]}_{side}" for side in ("left", "right"))
            lever = body.points[left].place[1] - body.points[right].place[1]
            on = [(left, 2, -pull / lever), (right, 2, pull / lever)]
        elif not spring.name.startswith("primary"):
            kind, *middle, direction = spring.name.split()
            name = f"bolster_{'_'.join(middle)}" if kind == "secondary" else f"{kind}_{middle[-1]}"
            on = [(name, "xyz".index(direction), -pull)]
        else:
            continue
        for name, direction, force in on:
            forces.setdefault(name, np.zeros(3))[direction] += force
    return x, of.coordinates, forces


def whole(model, points, forces):
    """The whole shell model in N and mm, flying free under forces on its points.

    Returns the elastic displacement (3,) of every point, the nodes of the weld, and the forces (n, 6) on its side.
    """
    nodes, elements = pd.read_csv(model / "nodes.csv"), pd.read_csv(model / "elements.csv")
    xyz, node = nodes[["x_mm", "y_mm", "z_mm"]].to_numpy(), nodes["node"].to_numpy()
    shared = {row.name: row.pattern if isinstance(row.pattern, str) else row.node for row in points.itertuples()}
    rows = {name: np.searchsorted(node, [int(one) for one in of.split()]) for name, of in shared.items()}
    load = np.zeros((len(nodes), 6))
    for row in points.itertuples():
        load[rows[row.name], :3] += forces.get(row.name, np.zeros(3)) / len(rows[row.name])
    t = elements["pid"].map({1: 4.0, 2: 8.0}).to_numpy()
    shell = ShellModel(xyz, elements[["n1", "n2", "n3", "n4"]].to_numpy() - 1, t, E=70000.0, nu=0.3)
    M = structure(read_model(model).body).M
    R = rigid_motions(np.repeat(xyz, 6, axis=0), np.tile(np.arange(6), len(xyz)))
    as_rigid = R @ np.linalg.solve(R.T @ (M @ R), R.T)
    balanced = load.ravel() - M @ (as_rigid @ load.ravel())
    fixed = np.zeros((len(nodes), 6), dtype=bool)
    ends = [node_at(xyz, *at) - 1 for at in ((0.0, 0.0, 0.0), (1200.0, 0.0, 0.0), (0.0, 300.0, 0.0))]
    fixed[ends[0], :3] = fixed[ends[1], 1:3] = fixed[ends[2], 2] = True
    line = pd.read_csv(model / "weld_nodes.csv")["node"].to_numpy()
    u = shell.solve(balanced, fixed)
    elastic = u - (as_rigid @ (M @ u.ravel())).reshape(u.shape)
    moved = {name: elastic[of, :3].mean(axis=0) for name, of in rows.items()}
    return moved, line, shell.side_forces(u, np.flatnonzero(t == 8.0), line - 1)


def ranges(folder, history, out):
    """Largest stress range [MPa] of the points of the weld under a history."""
    pd.DataFrame(history).to_parquet(folder / "q.parquet", index=False)
    case = folder / "case.toml"
    case.write_text(case.read_text().replace('upsample = "auto"', "upsample = 1") + EVENT)
    assess(case, out, report=False)
    return pd.read_parquet(out / "nodes.parquet").set_index(["node", "surface"])["max_range_MPa"]


def test_a_load_on_the_converter_gives_the_stress_of_a_static_solution(model, folder, tmp_path):
    """A vehicle stands still with 1 kN on its converter: its body bends, and its weld is stressed, as the whole model.

    One way goes over modes with a mass of 1 kg, over ``q`` of the folder and its weld forces; the other solves all
    degrees of freedom in N and mm under the forces of the springs, and is assessed as the only mode of a case.
    """
    vehicle = replace(Vehicle(), car=replace(Vehicle().car, body=str(folder)))
    body = car_body(vehicle)
    x, at, forces = standing(vehicle, body)
    assert sum(forces[f"converter_{k}"][2] for k in range(1, 5)) == pytest.approx(-LOAD_N, rel=1e-9)
    assert sum(force[2] for force in forces.values()) == pytest.approx(0.0, abs=1e-6 * LOAD_N)
    time_s = np.arange(0.0, 4.0, 0.01)
    swing = np.sin(np.pi * time_s / 4.0)  # 0 to 1 and back: the range of a stress is the stress itself
    q = np.outer(x[at.flex], swing)
    ride = Ride(0.01, 1.0, time_s, q, {}, {}, np.zeros((4, len(time_s))), np.zeros((4, len(time_s))))
    reduced = Path(shutil.copytree(folder, tmp_path / "reduced"))
    found = ranges(reduced, {"time_s": time_s} | coordinates_of(ride, vehicle), tmp_path / "found")

    moved, line, force = whole(model, pd.read_csv(model / "all.csv", dtype=str), forces)
    for name in ("converter_1", "converter_4", "bolster_front_left"):
        assert 1e3 * body.points[name].shape[:3] @ x[at.flex] == pytest.approx(moved[name], rel=1e-5, abs=1e-9), name
    alone = Path(shutil.copytree(folder, tmp_path / "alone"))
    pd.DataFrame({"mode": [1], "frequency_hz": [10.0], "damping_ratio": [0.015]}).to_csv(alone / "modes.csv")
    table = pd.DataFrame({"weld": "hanger", "node": line, "mode": 1}).join(pd.DataFrame(force, columns=FORCES))
    table.to_parquet(alone / "nodal_forces.parquet", index=False)
    case = (alone / "case.toml").read_text()
    only = [text for text in case.splitlines() if not text.startswith(("interface_shapes", "flexibility"))]
    (alone / "case.toml").write_text("\n".join(only) + "\n")
    expected = ranges(alone, {"time_s": time_s, "q_1": swing}, tmp_path / "expected")

    assert expected.max() > 0.1
    assert found.to_numpy() == pytest.approx(expected.to_numpy(), rel=1e-4, abs=1e-4 * expected.max())
