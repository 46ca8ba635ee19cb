"""Models and interfaces that cannot be reduced: one clear line each, with the place and what to do."""

import numpy as np
import pandas as pd
import pytest
from scipy import sparse

from fatigue.errors import DataError
from fatigue.flexbody.shell import structure
from fatigue.readers.model.read import read_model
from fatigue.reduce.bases import Recipe
from fatigue.reduce.story import reduce
from tests.reduce.small_body import interface, properties, write_model

QUICK = Recipe(cut_hz=300.0)


def changed(folder, table, change):
    """Change a table of a model in place."""
    path = folder / f"{table}.csv"
    frame = pd.read_csv(path, dtype={"components": str, "pattern": str})
    change(frame).to_csv(path, index=False)


def cell(row, column, value):
    """Function that sets one cell of a table."""

    def change(frame):
        frame = frame.astype({column: object})
        frame.loc[row, column] = value
        return frame

    return change


def more(**row):
    """Function that adds a row to a table."""
    return lambda frame: pd.concat([frame, pd.DataFrame([row])], ignore_index=True)


def times(column, factor):
    """Function that multiplies columns of a table."""
    return lambda frame: frame.assign(**{name: frame[name] * factor for name in np.atleast_1d(column)})


@pytest.mark.parametrize(
    ("table", "change", "said"),
    [
        ("interface", cell(1, "node", 9999), r"interface.csv: bolster_front_right, column node: node 9999 is not in"),
        ("interface", cell(4, "pattern", "1 9998 9999"), r"column node, row 5: node \d+ is none of its pattern"),
        ("interface", cell(4, "node", 1), r"node 1 is none of its pattern"),
        ("interface", cell(1, "name", "bolster_front_left"), r"name bolster_front_left repeats row 1"),
        (
            "interface",
            lambda f: cell(1, "node", f.loc[0, "node"])(f),
            r"loads the same nodes as bolster_front_left in row 1",
        ),
        ("interface", cell(0, "components", "124x"), r"row 1: '124x' are no components.*123 or 123456"),
        ("interface", cell(0, "components", "113"), r"'113' are no components"),
        ("interface", cell(0, "side", "outer"), r"'outer' is not one of external, internal, observed"),
        ("interface", cell(4, "pattern", "12 ab"), r"'12 ab' is no list of nodes"),
        ("interface", lambda f: f.assign(side="observed"), r"no point is external or internal"),
        ("interface", lambda f: f.drop(columns="side"), r"column side"),
        ("properties", lambda f: f[f["pid"] == 1], r"property 2 is not in properties.csv"),
        ("properties", cell(1, "thickness_mm", -8.0), r"thickness_mm, row 2: -8 is not above 0"),
        ("properties", times("E_MPa", 1e6), r"property 1: E is 7e\+10 MPa, stiffer than diamond: it looks like Pa"),
        ("properties", times("E_MPa", 1e-3), r"property 1: E is 70 MPa.*it looks like GPa"),
        ("properties", times("rho_t_mm3", 1e12), r"2700 t/mm3, denser than osmium: it looks like kg/m3"),
        ("properties", times("rho_t_mm3", 1e9), r"looks like g/cm3"),
        ("properties", times(["rho_t_mm3", "nsm_t_mm2"], 0.0), r"no element has mass"),
        ("properties", cell(0, "nu", 0.5), r"0.5 is not below 0.5"),
        ("nodes", times(["x_mm", "y_mm", "z_mm"], 1e-3), r"in a box of 1.2 x 0.3 x 0.38 mm are heavier than osmium"),
        ("weld_nodes", cell(1, "node", 9999), r"weld hanger: no element of the mesh has node 9999"),
        ("weld_elements", cell(0, "element", 9999), r"weld hanger: the mesh has no element 9999"),
        ("weld_elements", lambda f: f.iloc[:1], r"none of its elements touches node \d+ of the line"),
        ("elements", lambda f: f.assign(n5=f["n1"]), r"it has mid-side nodes"),
        ("elements", lambda f: cell(0, "n2", f.loc[0, "n1"])(f), r"element 1: a node is there twice"),
        (
            "elements",
            lambda f: f.rename(columns={"n2": "n3", "n3": "n2"}),
            r"and \d+ more: its corners lie on a line",
        ),
        (
            "nodes",
            lambda f: f.assign(x_mm=f["x_mm"].where(f["node"] != 20, 420.0)),
            r"corners do not run around it, or one of them points inwards",
        ),
        ("elements", cell(3, "n1", 9999), r"node 9999 is not in nodes.csv"),
    ],
)
def test_mistake_in_a_table(tmp_path, table, change, said):
    """A mistake in one of the tables is told with its place."""
    folder = write_model(tmp_path / "model")
    changed(folder, table, change)
    with pytest.raises(DataError, match=said):
        reduce(folder, folder / "interface.csv", tmp_path / "out", QUICK)
    assert not (tmp_path / "out").exists()


def test_several_mistakes_are_told_together(tmp_path):
    """All that is wrong with the interface is told at once."""
    folder = write_model(tmp_path / "model")
    changed(folder, "interface", lambda f: cell(1, "side", "x")(cell(0, "components", "7")(cell(2, "pattern", "a")(f))))
    with pytest.raises(DataError) as refused:
        reduce(folder, folder / "interface.csv", tmp_path / "out", QUICK)
    assert len(refused.value.problems) == 3


def test_a_loose_plate_is_named(tmp_path):
    """A part that hangs on nothing is told with nodes of it."""
    folder = write_model(tmp_path / "model")
    far = pd.DataFrame({"node": range(901, 905), "x_mm": [0, 10, 10, 0], "y_mm": [0, 0, 10, 10], "z_mm": 999})
    changed(folder, "nodes", lambda f: pd.concat([f, far]))
    changed(folder, "elements", more(element=901, pid=1, n1=901, n2=902, n3=903, n4=904))
    with pytest.raises(DataError, match=r"node 901: the body is in 2 parts that nothing joins.* has 4 of its nodes"):
        reduce(folder, folder / "interface.csv", tmp_path / "out", QUICK)


def test_an_interface_node_of_no_element(tmp_path):
    """A node of the table of nodes that no element has cannot bear a load."""
    folder = write_model(tmp_path / "model")
    changed(folder, "nodes", more(node=901, x_mm=0.0, y_mm=0.0, z_mm=0.0))
    changed(folder, "interface", cell(0, "node", 901))
    with pytest.raises(DataError, match="node 901 is not in the model"):
        reduce(folder, folder / "interface.csv", tmp_path / "out", QUICK)


def test_masters_that_do_not_hold_the_body(tmp_path):
    """Two points with displacements leave the body free to turn about their line; residual needs no support."""
    folder = write_model(tmp_path / "model")
    changed(folder, "interface", lambda f: f.iloc[:2])
    with pytest.raises(DataError, match="the external points hold only 5 of the 6 rigid motions"):
        reduce(folder, folder / "interface.csv", tmp_path / "out", Recipe("weak", 300.0))
    with pytest.raises(DataError, match="the loaded points hold only 5"):
        reduce(folder, folder / "interface.csv", tmp_path / "out", Recipe("guyan"))
    assert reduce(folder, folder / "interface.csv", tmp_path / "out", QUICK).reduced.kept.min() > 0.999


def test_no_external_point_for_a_weak_basis(tmp_path):
    """A weak basis without external points is refused by name."""
    folder = write_model(tmp_path / "model")
    changed(folder, "interface", lambda f: f.assign(side=f["side"].replace("external", "internal")))
    with pytest.raises(DataError, match="there are none"):
        reduce(folder, folder / "interface.csv", tmp_path / "out", Recipe("weak", 300.0))


def test_tables_of_welds_are_all_there_or_none(tmp_path):
    """One missing table of welds is a mistake; none at all is a note: there are then no forces and no case."""
    folder = write_model(tmp_path / "model")
    (folder / "weld_elements.csv").rename(tmp_path / "weld_elements.csv")
    with pytest.raises(DataError, match=r"welds.csv and weld_nodes.csv is here, and no weld_elements"):
        reduce(folder, folder / "interface.csv", tmp_path / "out", QUICK)
    for name in ("welds.csv", "weld_nodes.csv"):
        (folder / name).rename(tmp_path / name)
    done = reduce(folder, folder / "interface.csv", tmp_path / "out", QUICK)
    assert [problem.code for problem in done.warnings] == ["no_weld_forces"]
    assert not {"case.toml", "nodal_forces.parquet"} & set(done.files)
    with_welds = reduce(folder, folder / "interface.csv", tmp_path / "out", QUICK, welds=tmp_path)
    assert {"case.toml", "nodal_forces.parquet"} <= set(with_welds.files)


def test_models_that_are_no_folder(tmp_path):
    """A deck, a folder without a model and a missing folder are told apart."""
    deck = tmp_path / "body.bdf"
    deck.write_text("BEGIN BULK\n")
    table = tmp_path / "interface.csv"
    interface().to_csv(table, index=False)
    with pytest.raises(DataError, match="a NASTRAN deck"):
        reduce(deck, table, tmp_path / "out")
    with pytest.raises(DataError, match="there is no"):
        reduce(tmp_path / "nowhere", table, tmp_path / "out")
    (tmp_path / "empty").mkdir()
    with pytest.raises(DataError, match=r"nodes.csv, elements.csv, properties.csv are missing"):
        reduce(tmp_path / "empty", table, tmp_path / "out")


def matrices(folder, units=1.0):
    """Write K, M and dof of the small body into a folder; M times ``units``."""
    model = write_model(folder / "shells")
    body = structure(read_model(model).body)
    sparse.save_npz(folder / "K.npz", body.K)
    sparse.save_npz(folder / "M.npz", body.M * units)
    places = {f"{a}_mm": body.xyz[:, k] for k, a in enumerate("xyz")}
    rows = {"row": np.arange(1, len(body.node) + 1), "node": body.node, "component": body.direction + 1}
    pd.DataFrame(rows | places).to_csv(folder / "dof.csv", index=False)
    return body


def test_matrices_give_the_same_basis_without_weld_forces(tmp_path, body):
    """K and M of the same body give the same modes, shapes and flexibility, and a note that forces need elements."""
    matrices(tmp_path)
    done = reduce(tmp_path, tmp_path / "shells" / "interface.csv", tmp_path / "out", Recipe(cut_hz=400.0))
    assert [problem.code for problem in done.warnings] == ["no_weld_forces"]
    assert "K.npz and M.npz have no elements" in done.warnings[0].what
    for name in ("modes.csv", "interface_shapes.csv", "flexibility.csv"):
        one, other = pd.read_csv(tmp_path / "out" / name), pd.read_csv(body.folder / name)
        numbers = one.select_dtypes("number").columns
        np.testing.assert_allclose(one[numbers], other[numbers], rtol=1e-6, atol=1e-9)
    assert "case.toml" not in done.files
    assert "no case" in done.as_text()


def test_matrices_in_si(tmp_path, body):
    """K in N/m, N, N m and M in kg, kg m, kg m2 are the same body, where their units are named."""
    given = matrices(tmp_path)
    D = sparse.diags_array(np.sqrt(np.where(given.direction < 3, 1e3, 1e-3)))
    for name, matrix in (("K", given.K), ("M", given.M)):
        sparse.save_npz(tmp_path / f"{name}.npz", sparse.csc_array(D @ matrix @ D))
    recipe = Recipe(cut_hz=400.0)
    done = reduce(tmp_path, tmp_path / "shells" / "interface.csv", tmp_path / "out", recipe, units="m-kg-s")
    assert done.rigid.mass_t == pytest.approx(body.rigid.mass_t, rel=1e-9)
    assert done.reduced.static == pytest.approx(body.reduced.static, rel=1e-6)


def coupled(M, i, j):
    """Mass matrix with more between two rows than they have themselves."""
    size = 10.0 * M[i, i]
    return M + sparse.csc_array(([size, size], ([i, j], [j, i])), shape=M.shape)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (
            lambda K, M: (K + sparse.csc_array(([1e5], ([3], [40])), shape=K.shape), M),
            r"K.npz: row 4, column 41: .* not symm",
        ),
        (lambda K, M: (K, -M), "below 0"),
        (lambda K, M: (K, coupled(M, 60, 240)), r"node 11, x with node 41, x: .* negative mass"),
        (lambda K, M: (K, 1e6 * M), "heavier than osmium"),
        (lambda K, M: (K + sparse.diags_array(np.full(K.shape[0], 50.0)), M), "resists a rigid motion"),
        (lambda K, M: (K, M[:-1, :-1]), "rows, and K.npz has"),
    ],
    ids=["unsymmetric", "negative mass", "negative motion", "units", "held", "sizes"],
)
def test_matrices_that_cannot_be(tmp_path, spoil, said):
    """Matrices of no free body in mm and t are refused with the place and the size of what is wrong."""
    body = matrices(tmp_path)
    K, M = (sparse.csc_array(matrix) for matrix in spoil(body.K, body.M))
    sparse.save_npz(tmp_path / "K.npz", K)
    sparse.save_npz(tmp_path / "M.npz", M)
    with pytest.raises(DataError, match=said):
        reduce(tmp_path, tmp_path / "shells" / "interface.csv", tmp_path / "out", QUICK)


def test_matrices_in_two_parts(tmp_path):
    """Two bodies in one pair of matrices are told by a node."""
    body = matrices(tmp_path)
    for name, matrix in (("K", body.K), ("M", body.M)):
        sparse.save_npz(tmp_path / f"{name}.npz", sparse.csc_array(sparse.block_diag([matrix, matrix])))
    rows = pd.read_csv(tmp_path / "dof.csv")
    other = rows.assign(row=rows["row"] + len(rows), node=rows["node"] + 1000, x_mm=rows["x_mm"] + 2000.0)
    pd.concat([rows, other]).to_csv(tmp_path / "dof.csv", index=False)
    with pytest.raises(DataError, match=r"node \d+: the body is in 2 parts that nothing joins"):
        reduce(tmp_path, tmp_path / "shells" / "interface.csv", tmp_path / "out", QUICK)


def test_directions_that_the_matrices_do_not_have(tmp_path):
    """Rotations of a model of solids are refused by point."""
    body = matrices(tmp_path)
    kept = np.flatnonzero(body.direction < 3)
    sparse.save_npz(tmp_path / "K.npz", body.K[kept][:, kept])
    sparse.save_npz(tmp_path / "M.npz", body.M[kept][:, kept])
    changed(tmp_path, "dof", lambda f: f.iloc[kept].assign(row=np.arange(1, len(kept) + 1)))
    with pytest.raises(DataError, match=r"roof_mid, column components: the model has no rows of rx, ry, rz"):
        reduce(tmp_path, tmp_path / "shells" / "interface.csv", tmp_path / "out", QUICK)


def test_doubts_are_warnings(tmp_path):
    """A moment at a single shell node, two tables with two thicknesses, columns left out: told, not refused."""
    folder = write_model(tmp_path / "model")
    changed(folder, "interface", cell(0, "components", "123456"))
    changed(folder, "elements", lambda f: f.assign(thickness_mm=f["pid"].map({1: 4.0, 2: 9.0})))
    changed(folder, "weld_nodes", lambda f: f.assign(thickness_mm=9.0))
    done = reduce(folder, folder / "interface.csv", tmp_path / "out", Recipe(cut_hz=300.0, keep_hz=500.0))
    codes = {problem.code: problem for problem in done.warnings}
    assert {"moment_at_node", "other_thickness_of_property", "columns_dropped", "stiff_points"} == set(codes)
    assert "bolster_front_left" in codes["moment_at_node"].what
    assert codes["other_thickness_of_property"].count == 2


def test_properties_of_a_variant(tmp_path):
    """Other properties go before those of the folder, and their thickness before that of the elements."""
    folder = write_model(tmp_path / "model")
    changed(folder, "elements", lambda f: f.assign(thickness_mm=f["pid"].map({1: 4.0, 2: 8.0})))
    stiff = tmp_path / "stiff.csv"
    properties().assign(E_MPa=140000.0).to_csv(stiff, index=False)
    soft, hard = (
        reduce(folder, folder / "interface.csv", tmp_path / name, QUICK, properties=table)
        for name, table in (("soft", None), ("hard", stiff))
    )
    assert hard.reduced.basis.frequency[0] == pytest.approx(np.sqrt(2.0) * soft.reduced.basis.frequency[0], rel=1e-9)
    thick = tmp_path / "thick.csv"
    properties().assign(thickness_mm=[5.0, 8.0]).to_csv(thick, index=False)
    done = reduce(folder, folder / "interface.csv", tmp_path / "thick", QUICK, properties=thick)
    assert done.rigid.mass_t > 1.1 * soft.rigid.mass_t
    assert set(pd.read_parquet(tmp_path / "thick" / "elements.parquet")["thickness_mm"]) == {5.0, 8.0}
    assert not done.warnings
