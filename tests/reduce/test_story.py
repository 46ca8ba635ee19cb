"""A body in, a neutral folder out: that of a computation of its own, whole, the same again, and nobody else's."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.basis.story import basis
from fatigue.errors import CaseError, DataError
from fatigue.flexbody.mass import rigid_motions
from fatigue.flexbody.shell import structure
from fatigue.readers.model.read import read_model
from fatigue.reduce.bases import Recipe
from fatigue.reduce.story import reduce
from tests.reduce.small_body import FORCES, history, node_at
from tests.shell_fe import ShellModel


def shapes_at(folder, point, name="interface_shapes.csv"):
    """Shapes (d, m) of a point in the order of its directions."""
    table = pd.read_csv(folder / name)
    table = table[table["point"] == point]
    return np.stack([of["value"].to_numpy() for _, of in table.groupby("direction", sort=False)])


def test_static_load_at_the_hanger_gives_its_weld_forces(model, body):
    """The forces along the weld under a shared load are those of the whole body flying free under it.

    The oracle solves all degrees of freedom, held where nothing is felt, and balances the load by inertia of its own.
    """
    folder = body.folder
    modes, phi = pd.read_csv(folder / "modes.csv"), shapes_at(folder, "converter_1")
    q = phi / (2.0 * np.pi * modes["frequency_hz"].to_numpy()) ** 2  # per N along x, y, z
    table = pd.read_parquet(folder / "nodal_forces.parquet").set_index(["node", "mode"])[FORCES]
    forces = table.to_numpy().astype(float).reshape(3, len(modes), 6)
    found = np.einsum("dm,nmk->dnk", q, forces)

    nodes, elements = pd.read_csv(model / "nodes.csv"), pd.read_csv(model / "elements.csv")
    t = elements["pid"].map({1: 4.0, 2: 8.0}).to_numpy()
    corners = elements[["n1", "n2", "n3", "n4"]].to_numpy() - 1
    xyz = nodes[["x_mm", "y_mm", "z_mm"]].to_numpy()
    shell = ShellModel(xyz, corners, t, E=70000.0, nu=0.3)
    M = structure(read_model(model).body).M
    R = rigid_motions(np.repeat(xyz, 6, axis=0), np.tile(np.arange(6), len(xyz)))
    fixed = np.zeros((len(nodes), 6), dtype=bool)
    ends = [node_at(xyz, *at) - 1 for at in ((0.0, 0.0, 0.0), (1200.0, 0.0, 0.0), (0.0, 300.0, 0.0))]
    fixed[ends[0], :3] = fixed[ends[1], 1:3] = fixed[ends[2], 2] = True
    line, hanger = pd.read_csv(folder / "weld_nodes.csv")["node"].to_numpy() - 1, np.flatnonzero(t == 8.0)
    edge = np.flatnonzero(nodes["z_mm"] == -80.0)
    for direction in range(3):
        load = np.zeros((len(nodes), 6))
        load[edge, direction] = 1.0 / len(edge)
        balanced = load.ravel() - M @ R @ np.linalg.solve(R.T @ (M @ R), R.T @ load.ravel())
        expected = shell.side_forces(shell.solve(balanced, fixed), hanger, line)
        assert abs(expected[:, direction].sum()) == pytest.approx(1.0, rel=1e-3)
        for part in (slice(0, 3), slice(3, 6)):
            size = np.abs(expected[:, part]).max()
            np.testing.assert_allclose(found[direction][:, part], expected[:, part], rtol=0.0, atol=1e-5 * size)


def test_the_basis_has_the_flexibility_of_the_body(body):
    """A residual basis is complete at every loaded direction, and nothing is doubted."""
    assert len(body.loaded) == 15
    assert body.reduced.kept == pytest.approx(1.0, abs=1e-8)
    assert not body.warnings


def test_the_folder_is_a_case(body, tmp_path):
    """With a history and an event the written case is assessed, and ``fatigue basis`` finds its basis complete."""
    folder = tmp_path / "body"
    shutil.copytree(body.folder, folder)
    history(folder)
    case = folder / "case.toml"
    event = '[[mission.event]]\nname = "run"\nhistory = "q.parquet"\nspeed_km_h = 100.0\nshare = 1.0\n'
    case.write_text(case.read_text().replace('upsample = "auto"', "upsample = 1") + event)
    assess(case, tmp_path / "result")
    assert (pd.read_parquet(tmp_path / "result" / "nodes.parquet")["life_km"] > 0.0).all()
    found = basis(case, damage=False)
    flexible = next(finding for finding in found.findings if finding.table == "flexibility")
    assert all(row.enough for row in flexible.rows)
    assert np.array([row.ratio for row in flexible.rows]) == pytest.approx(1.0, abs=1e-6)
    assert not found.warnings


def test_twice_the_same_bytes_and_a_record_of_them(model, body):
    """A second run writes the same files, and the record has their hashes and no path of the machine."""
    before = {path.name: path.read_bytes() for path in body.folder.iterdir()}
    reduce(model, model / "interface.csv", body.folder, Recipe(cut_hz=400.0))
    assert {path.name: path.read_bytes() for path in body.folder.iterdir()} == before
    record = json.loads(before["reduce.json"])
    assert set(record["outputs"]) == set(before) - {"reduce.json"}
    assert str(model) not in before["reduce.json"].decode()
    assert record["inputs"].keys() >= {"nodes.csv", "elements.csv", "properties.csv", "interface.csv", "weld_nodes.csv"}


def test_mass_properties(body):
    """The record has the mass of plates and further mass, and the middle of a box but for the hanger."""
    box = 2 * (1200.0 * 300.0 * 2 + 300.0 * 300.0)
    hanger = 200.0 * 80.0
    of_box, of_hanger = box * (2.7e-9 * 4.0 + 1e-8), hanger * 2.7e-13 * 8.0
    assert body.rigid.mass_t == pytest.approx(of_box + of_hanger, rel=1e-12)
    height = (of_box * 150.0 - of_hanger * 40.0) / (of_box + of_hanger)
    assert body.rigid.cg_mm[[0, 2]] == pytest.approx([600.0, height], rel=1e-9)


def test_an_edited_case_stays(model, body, tmp_path):
    """A case with its missions survives another reduction, unless that is forced; other files of ours are replaced."""
    folder = tmp_path / "body"
    shutil.copytree(body.folder, folder)
    case = folder / "case.toml"
    case.write_text(case.read_text() + "\n# mine\n")
    again = reduce(model, model / "interface.csv", folder, Recipe(cut_hz=500.0))
    assert "# mine" in case.read_text()
    assert any("was edited" in note for note in again.notes)
    reduce(model, model / "interface.csv", folder, Recipe(cut_hz=300.0))
    assert "# mine" in case.read_text()
    reduce(model, model / "interface.csv", folder, Recipe(cut_hz=400.0), force=True)
    assert "# mine" not in case.read_text()


def test_files_of_others_and_inputs_stay(model, body, tmp_path):
    """What fatigue reduce did not write, or was changed since, is refused together; inputs even where it is forced."""
    folder = tmp_path / "body"
    shutil.copytree(body.folder, folder)
    (folder / "modes.csv").write_text("mode,frequency_hz\n1,2.0\n")
    (folder / "points.csv").unlink()
    (folder / "points.csv").mkdir()
    with pytest.raises(DataError) as refused:
        reduce(model, model / "interface.csv", folder)
    assert {problem.code for problem in refused.value.problems} == {"foreign_files"}
    assert len(refused.value.problems) == 2
    with pytest.raises(DataError, match="is an input"):
        reduce(model, model / "interface.csv", model, force=True)


@pytest.mark.parametrize(
    ("recipe", "said"),
    [
        (Recipe(name="rubin"), "no basis 'rubin'"),
        (Recipe(cut_hz=0.0), "no frequency"),
        (Recipe(name="kuhar"), "exact at one frequency"),
        (Recipe(kuhar_hz=8.0), "take --basis kuhar"),
    ],
)
def test_senseless_options(model, tmp_path, recipe, said):
    """Options that say nothing are refused before anything is read."""
    with pytest.raises(CaseError, match=said):
        reduce(model, model / "nothing.csv", tmp_path / "out", recipe)
    assert not (tmp_path / "out").exists()
