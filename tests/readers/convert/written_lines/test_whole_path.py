"""Two meshes of one joint, converted and assessed by the same lines and register: the same welds, the same lives."""

import re

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions, WeldSources
from fatigue.readers.convert.weld_lines import list_welds
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import Tee, _results, bulk
from tests.shell_fe import ShellModel, grid, joined

H = 0.222  # of the master curve: life goes with the stress to the power -1 / h
X = np.array([0, 11, 19, 30, 38, 52, 60, 71, 79, 90, 102, 110, 120.0])


def tee(x, y, z, seed):
    """The T joint of ``tests.readers.tee_model`` on another mesh, numbered at random, under two static loads."""
    base = grid(x, y)
    xz, quads = grid(x[(x >= 30) & (x <= 90)], z)
    upright = np.column_stack([xz[:, 0], np.full(len(xz), 40.0), xz[:, 1]]), quads
    xyz, quads = joined(base, upright)
    thickness = np.where(np.arange(len(quads)) < len(base[1]), 8.0, 6.0)
    rng = np.random.default_rng(seed)
    nodes, elements = rng.permutation(len(xyz)), rng.permutation(len(quads))
    model = ShellModel(xyz[nodes], np.argsort(nodes)[quads][elements], thickness[elements])
    fixed = np.zeros((len(xyz), 6), bool)
    fixed[(model.xyz[:, 0] < 1) | (model.xyz[:, 0] > 119)] = True
    top = np.flatnonzero(model.xyz[:, 2] > 39)
    top = top[np.argsort(model.xyz[top, 0])]
    width = np.gradient(model.xyz[top, 0])
    width[[0, -1]] /= 2
    load = np.zeros((2, len(xyz), 6))
    load[0, top, 2] = 10.0 * width
    load[1, top, 1] = 1.0 * width
    shape = np.stack([model.solve(one, fixed) for one in load])
    shape *= 1e-3
    force = np.stack([model.element_forces(u) for u in shape])
    # of unit modal mass: f . u is the square of the circular frequency
    frequency = np.sqrt(np.einsum("mij,mij->m", 1e-3 * load, shape)) / (2 * np.pi)
    turned = np.zeros(0, np.int64)
    return Tee(model, frequency, shape, force, turned, _results(model, frequency, shape, force, turned))


def halved(x):
    """Places between as well."""
    return np.sort(np.concatenate([x, (x[1:] + x[:-1]) / 2]))


@pytest.fixture(scope="module")
def lives(tmp_path_factory):
    """Nodes of both results, after one register was edited on the coarse mesh."""
    folder = tmp_path_factory.mktemp("meshes")
    y, z = np.linspace(0, 80, 9), np.linspace(0, 40, 5)
    cases = {"coarse": tee(X, y, z, 1), "fine": tee(halved(X), halved(y), halved(z), 2)}
    time = np.arange(200) / 100
    found = {}
    for name, case in cases.items():
        (folder / f"{name}.bdf").write_text(bulk(case))
        (folder / f"{name}.op2").write_bytes(modal_op2(case.results, word=8))
        rows = [f"{t:.9g},{300 * np.sin(9 * t):.12g},{200 * np.cos(5 * t):.12g}" for t in time]
        (folder / f"{name}.csv").write_text("\n".join(["time,q_1,q_2", *rows]) + "\n")
    register, lines = folder / "by_lines.csv", folder / "lines.csv"
    list_welds(folder / "coarse.bdf", WeldSources(), "mm-t-s", register, False, lines)
    text = register.read_text()
    text, edits = re.subn(r"^([^,\n]*:p1a),(?=[^,\n]*:p1a,assess)", "toe,", text, flags=re.MULTILINE)
    assert edits == 1
    register.write_text(text)
    asked = {name: WeldSources(lines=lines, register=register) for name in cases}
    for name, sources in {**asked, "detected": WeldSources()}.items():
        mesh = "fine" if name == "detected" else name
        options = ConvertOptions(
            forces=folder / f"{mesh}.op2",
            mesh=folder / f"{mesh}.bdf",
            out=folder / name,
            coordinates=(folder / f"{mesh}.csv",),
            interface_modes=(2,),
            welds=sources,
        )
        convert(options)
        assess(folder / name / "case.toml", folder / f"{name}_result")
        found[name] = pd.read_parquet(folder / f"{name}_result" / "nodes.parquet")
    return found


def test_both_results_have_the_same_welds(lives):
    """Under the names of the register."""
    assert set(lives["coarse"]["weld"]) == set(lives["fine"]["weld"])
    assert "toe" in set(lives["fine"]["weld"])


def test_lives_are_those_of_the_weld_however_it_was_found(lives):
    """By points and by detection, to the last digits, at every node and face of each side."""
    by_lines, detected = (
        some[some["weld"] != ""].groupby(["node", "surface"])["life_km"].agg(lambda x: sorted(x.fillna(-1.0)))
        for some in (lives["fine"], lives["detected"])
    )
    assert (by_lines.index == detected.index).all()
    np.testing.assert_allclose(np.stack(by_lines), np.stack(detected), rtol=1e-9)


def test_lives_of_two_meshes_differ_by_the_mesh_only(lives):
    """At the nodes that both have within the lines, by the stress that a coarse uneven mesh is wrong by."""
    coarse, fine = (lives[name].round({"x_mm": 6}) for name in ("coarse", "fine"))
    both = coarse.merge(fine, on=["weld", "surface", "x_mm"], suffixes=("_coarse", "_fine"))
    within = both[(both["x_mm"] > 45) & (both["x_mm"] < 75)]
    assert len(within) == 3 * 2 * 3  # sides, faces, nodes
    stress = (within["life_km_fine"] / within["life_km_coarse"]) ** H
    assert stress.between(0.75, 1.25).all(), stress
    upright = within["weld"].str.endswith(":p2a")
    assert stress[upright].between(0.98, 1.02).all(), stress[upright]
