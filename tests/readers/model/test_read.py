"""A finite element body from a folder: shells, matrices in every format and unit system, what is refused."""

import numpy as np
import pandas as pd
import pytest
from scipy import sparse
from scipy.io import mmwrite

from fatigue.errors import CaseError, DataError
from fatigue.flexbody.shell import structure
from fatigue.flexbody.structure import Structure
from fatigue.readers.model.read import read_model
from fatigue.readers.units.systems import SYSTEMS
from tests.flexbody.shells import plate, together
from tests.readers.foreign.nastran.matrices.test_deck import dmig
from tests.readers.foreign.nastran.matrices.test_op4 import op4

MESH = together(plate(2, 1), plate(1, 1, triangles=True), [400.0, 0, 0])


def tables(mesh=MESH):
    """Nodes, elements and properties; node 9999 belongs to no element."""
    x, y, z = np.vstack([mesh.xyz, [1.0, 2, 3]]).T
    node = np.append(mesh.node, 9999)
    nodes = pd.DataFrame({"node": node, "x_mm": x, "y_mm": y, "z_mm": z})
    corners = pd.DataFrame(mesh.node[mesh.corners], columns=["n1", "n2", "n3", "n4"], dtype="Int64")
    corners.loc[mesh.is_triangle, "n4"] = pd.NA
    elements = pd.concat([pd.DataFrame({"element": mesh.element, "pid": 3}), corners], axis=1)
    properties = pd.DataFrame(
        {"pid": [9, 3], "thickness_mm": [1.0, 4.0], "E_MPa": 210000.0, "nu": 0.3, "rho_t_mm3": 7.85e-9}
    )
    return {"nodes": nodes, "elements": elements, "properties": properties}


def written(folder, frames, ending="csv"):
    """A folder with these tables."""
    for name, frame in frames.items():
        if ending == "csv":
            frame.to_csv(folder / f"{name}.csv", index=False)
        else:
            frame.to_parquet(folder / f"{name}.parquet", index=False)
    return folder


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_shells_are_read(tmp_path, ending):
    """Quads and triangles with their properties; a node without element is left out."""
    model = read_model(written(tmp_path, tables(), ending))
    assert model.warnings == ()
    for name in ("node", "xyz", "element", "corners", "thickness", "bending_thickness", "E", "nu", "rho", "nsm"):
        np.testing.assert_array_equal(getattr(model.body, name), getattr(MESH, name), err_msg=name)
    assert 9999 in model.mesh.node
    assert [path.stem for path in model.files] == ["nodes", "elements", "properties"]


def test_thickness_of_elements_goes_first(tmp_path):
    """Their own thickness bends too, unless the property has a bending thickness."""
    given = tables()
    given["elements"]["thickness_mm"] = [7.0] + [None] * (len(MESH.element) - 1)
    body = read_model(written(tmp_path, given)).body
    assert body.thickness.tolist()[:2] == [7.0, 4.0]
    assert body.bending_thickness.tolist()[:2] == [7.0, 4.0]
    given["properties"]["bending_thickness_mm"] = [None, 50.0]
    given["properties"]["nsm_t_mm2"] = [None, 1e-8]
    body = read_model(written(tmp_path, given)).body
    assert set(body.bending_thickness.tolist()) == {50.0}
    assert set(body.nsm.tolist()) == {1e-8}


def dof(body, places=True):
    """The table of rows, from the last to the first."""
    frame = pd.DataFrame({"row": np.arange(len(body.node)) + 1, "node": body.node, "component": body.direction + 1})
    frame[["x_mm", "y_mm", "z_mm"]] = body.xyz
    return (frame if places else frame[["row", "node", "component"]])[::-1]


def given_in(body, system):
    """K and M of a body in other units."""
    units = SYSTEMS[system]
    length = sparse.diags_array(np.where(body.direction > 2, 1.0 / units.length, 1.0))
    K = length @ body.K @ length * (units.length / units.force)
    return sparse.csc_array(K), sparse.csc_array(length @ body.M @ length / units.mass)


@pytest.mark.parametrize("ending", ["mtx", "npz", "op4"])
@pytest.mark.parametrize("system", list(SYSTEMS))
def test_matrices_are_read(tmp_path, ending, system):
    """In every format and system the same structure in N, mm, t."""
    body = structure(MESH)
    for name, matrix in zip("KM", given_in(body, system), strict=True):
        path = tmp_path / f"{name}.{ending}"
        if ending == "mtx":
            mmwrite(path, sparse.coo_array(matrix), precision=16)
        elif ending == "npz":
            sparse.save_npz(path, matrix)
        else:
            path.write_text(op4(matrix.toarray(), 6, 2, "ANY", "two words", 3, 23))
    written(tmp_path, {"dof": dof(body)})
    model = read_model(tmp_path, units=system)
    same(model.body, body)
    assert model.mesh is None
    assert [path.name for path in model.files] == [f"K.{ending}", f"M.{ending}", "dof.csv"]


def same(found, body):
    """One structure is the other within the digits of a file."""
    assert isinstance(found, Structure)
    for name in ("node", "direction"):
        assert getattr(found, name).tolist() == getattr(body, name).tolist()
    np.testing.assert_allclose(found.xyz, body.xyz, atol=1e-9)
    for name in ("K", "M"):
        ours, theirs = getattr(found, name), getattr(body, name)
        assert abs(ours - theirs).max() < 1e-8 * abs(theirs).max()


@pytest.mark.parametrize("system", ["mm-t-s", "m-kg-s"])
def test_a_file_of_dmig_is_read(tmp_path, system):
    """Alone, in a folder, with grids of its own in its unit of length, or with a table of nodes in mm."""
    body = structure(MESH)
    K, M = given_in(body, system)
    dofs = list(zip(body.node.tolist(), (body.direction + 1).tolist(), strict=True))
    text = dmig("KAAX", K.toarray(), dofs, layout="free") + dmig("MAAX", M.toarray(), dofs, layout="free")
    places = MESH.xyz / SYSTEMS[system].length
    grids = "".join(f"GRID,{node},,{x},{y},{z}\n" for node, (x, y, z) in zip(MESH.node, places, strict=True))
    (tmp_path / "body.pch").write_text(text + grids)
    same(read_model(tmp_path / "body.pch", units=system).body, body)
    same(read_model(tmp_path, units=system).body, body)
    (tmp_path / "body.pch").write_text(text)
    with pytest.raises(DataError, match=r"nothing says where grid 1 is \(and \d+ more\)"):
        read_model(tmp_path)
    same(read_model(written(tmp_path, {"nodes": tables()["nodes"]}), units=system).body, body)


def test_rows_without_stiffness_and_mass_are_left_out(tmp_path):
    """As rotations of nodes of solids are; places come from the table of nodes."""
    body = structure(MESH)
    keep = sparse.diags_array((body.direction < 3).astype(float))
    for name, matrix in (("K", body.K), ("M", body.M)):
        sparse.save_npz(tmp_path / f"{name}.npz", sparse.csc_array(keep @ matrix @ keep))
    found = read_model(written(tmp_path, {"dof": dof(body, places=False), "nodes": tables()["nodes"]}))
    assert set(found.body.direction.tolist()) == {0, 1, 2}
    assert len(found.body.node) == 3 * len(MESH.node)
    assert found.mesh is not None


def damaged(change):
    """Tables with something changed."""
    given = tables()
    change(given)
    return given


def set_to(table, column, value):
    """Set the first row of a column to a value."""

    def change(given):
        given[table][column] = given[table][column].astype(object)
        given[table].loc[given[table].index[-1], column] = value

    return change


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (set_to("elements", "pid", 77), "element 1002: its property 77 is not in properties.csv"),
        (set_to("properties", "E_MPa", 0.0), "properties.csv: column E_MPa, row 2: 0 is not above 0"),
        (set_to("properties", "nu", 0.5), "properties.csv: column nu, row 2: 0.5 is not below 0.5"),
        (set_to("properties", "rho_t_mm3", -1.0), "rho_t_mm3, row 2: -1 is below 0"),
        (set_to("properties", "thickness_mm", None), "element 1: it has no thickness_mm, nor has its property 3"),
        (set_to("properties", "pid", 9), "pid"),
        (lambda g: g["properties"].pop("nu"), "properties.csv: column nu"),
        (lambda g: g["elements"].insert(2, "n5", 1), "element 1: it has mid-side nodes (and 3 more)"),
        (lambda g: g.pop("properties"), "properties.csv is missing"),
        (lambda g: g.clear(), "nodes.csv, elements.csv, properties.csv are missing"),
    ],
)
def test_what_is_no_shell_body_is_refused(tmp_path, change, said):
    """With file, column and row, or the element."""
    with pytest.raises(DataError) as error:
        read_model(written(tmp_path, damaged(change)))
    assert said in str(error.value)


def test_models_of_two_kinds_are_refused(tmp_path):
    """It is not guessed which one is meant."""
    folder = written(tmp_path, tables())
    sparse.save_npz(folder / "K.npz", structure(MESH).K)
    with pytest.raises(DataError, match=r"properties\.csv is here, and K\.npz too"):
        read_model(folder)
    (folder / "properties.csv").unlink()
    with pytest.raises(DataError, match=r"M\.mtx, dof\.csv are missing"):
        read_model(folder)
    (folder / "K.npz").unlink()
    for name in ("a.pch", "b.bdf"):
        (folder / name).write_text("DMIG,KAAX,0,6,2,0,,,1\n")
    with pytest.raises(DataError, match=r"a\.pch is here, and b\.bdf too"):
        read_model(folder)
    (folder / "nodes.parquet").write_bytes(b"")
    with pytest.raises(DataError, match=r"nodes\.parquet and nodes\.csv are both here"):
        read_model(folder)


def test_matrices_of_two_sizes_are_refused(tmp_path):
    """And a folder or unit system that is none."""
    body = structure(MESH)
    sparse.save_npz(tmp_path / "K.npz", body.K)
    sparse.save_npz(tmp_path / "M.npz", sparse.csc_array(body.M[:6, :6]))
    written(tmp_path, {"dof": dof(body)})
    with pytest.raises(DataError, match=r"M\.npz: 6 rows, and K\.npz has"):
        read_model(tmp_path)
    (tmp_path / "M.npz").unlink()
    (tmp_path / "M.op4").write_text(op4(np.eye(3), 6, name="A") + op4(np.eye(3), 6, name="B"))
    with pytest.raises(DataError, match=r"M\.op4: it has A, B, and 0 of these names begin with M"):
        read_model(tmp_path)
    with pytest.raises(DataError, match="nowhere"):
        read_model(tmp_path / "nowhere")
    with pytest.raises(CaseError, match="cgs"):
        read_model(tmp_path, units="cgs")


@pytest.mark.parametrize(("component", "said"), [(7, "7 is no component"), (0, "0 is no component"), (2, "row")])
def test_components_are_told(tmp_path, component, said):
    """Numbers 1 to 6, each once at a node."""
    body = structure(MESH)
    for name in "KM":
        sparse.save_npz(tmp_path / f"{name}.npz", getattr(body, name))
    rows = dof(body)
    rows.loc[0, "component"] = component
    with pytest.raises(DataError, match=said):
        read_model(written(tmp_path, {"dof": rows}))
