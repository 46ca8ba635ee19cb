"""Mass matrices, what their rows are, and shapes in these rows: read in any order, refused with their place."""

import numpy as np
import pandas as pd
import pytest
from scipy import sparse
from scipy.io import mmwrite

from fatigue.errors import DataError
from fatigue.readers.neutral.body.mass_matrix import read_mass_matrix, read_mass_rows, read_mode_shapes
from fatigue.readers.neutral.body.mesh import Mesh
from tests.readers.neutral.body.test_participation import MODES

M = np.array([[2.0, 0.5, 0.0], [0.5, 3.0, 0.0], [0.0, 0.0, 4e3]])
NONE = np.zeros(0, dtype=np.int64)
MESH = Mesh(np.array([4, 8]), np.array([[0.0, 1, 2], [3.0, 4, 5]]), NONE, np.zeros((0, 8), np.int64), NONE, np.zeros(0))
ROWS = {"row": [3, 1, 2], "node": [8, 4, 4], "direction": ["rz", "x", "y"]}


def rows(tmp_path, columns=ROWS, mesh=MESH):
    """Rows of the mass matrix as a table has them."""
    pd.DataFrame(columns).to_csv(tmp_path / "rows.csv", index=False)
    return read_mass_rows(tmp_path / "rows.csv", 3, "m.mtx", mesh, strict=False)[0]


def shapes(tmp_path, table):
    """Shapes in the rows of the matrix."""
    pd.DataFrame(table).to_csv(tmp_path / "shapes.csv", index=False)
    return read_mode_shapes(tmp_path / "shapes.csv", rows(tmp_path), MODES, (), strict=False)


def words(error):
    """All refusals, and their codes."""
    return [problem.code for problem in error.value.problems], str(error.value)


@pytest.mark.parametrize("kind", ["general", "symmetric", "array", "npz", "integer"])
def test_matrices_are_read(tmp_path, kind):
    """Matrix Market of both forms and symmetries, and scipy's own file, give the same matrix."""
    expected = np.rint(M) if kind == "integer" else M
    path = tmp_path / ("m.npz" if kind == "npz" else "m.mtx")
    if kind == "npz":
        sparse.save_npz(path, sparse.coo_array(M))
    elif kind == "array":
        mmwrite(path, M)
    elif kind == "integer":
        mmwrite(path, sparse.coo_array(expected.astype(np.int64)))
    else:
        mmwrite(path, sparse.coo_array(M), symmetry=kind)
    assert read_mass_matrix(path).toarray().tolist() == expected.tolist()


@pytest.mark.parametrize(
    ("matrix", "code", "said"),
    [
        (M[:2], "bad_shape", "2 rows and 3 columns"),
        (np.triu(M), "not_symmetric", "only one of its triangles is there"),
        (M + np.diag([0.1, 0.0], 1), "not_symmetric", "row 1, column 2: the matrix is not symmetric: 0.6, and 0.5"),
        (M * np.nan, "bad_value", "nan is not finite"),
        (M * 0.0, "bad_value", "the matrix is 0"),
        (-M, "bad_value", "on the diagonal is below 0"),
        (M * 1j, "bad_value", "complex"),
    ],
)
@pytest.mark.parametrize("kind", ["mtx", "npz"])
def test_what_is_no_mass_matrix_is_refused(tmp_path, matrix, code, said, kind):
    """Each with the place and what is wrong."""
    path = tmp_path / f"m.{kind}"
    if kind == "npz":
        sparse.save_npz(path, sparse.coo_array(matrix))
    else:
        mmwrite(path, sparse.coo_array(matrix), symmetry="general")
    with pytest.raises(DataError) as error:
        read_mass_matrix(path)
    codes, text = words(error)
    assert codes == [code]
    assert said in text


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("m.mtx", b"", "damaged_file"),
        ("m.mtx", b"%%MatrixMarket matrix coordinate real general\n3 3 1\n9 9 1.0\n", "damaged_file"),
        ("m.mtx", b"row,col,value\n1,1,2\n", "damaged_file"),
        ("m.mtx", b"\xff\xfe\x00", "damaged_file"),
        ("m.npz", b"PK\x03\x04 broken", "damaged_file"),
        ("m.npz", b"", "damaged_file"),
        ("m.mat", b"MATLAB 5.0", "unknown_format"),
    ],
)
def test_damaged_files_are_refused(tmp_path, name, content, code):
    """No traceback for a file that is none."""
    (tmp_path / name).write_bytes(content)
    with pytest.raises(DataError) as error:
        read_mass_matrix(tmp_path / name)
    assert words(error)[0] == [code]


def test_a_numpy_archive_is_no_matrix(tmp_path):
    """An .npz of plain arrays is refused."""
    np.savez(tmp_path / "m.npz", M=M)
    with pytest.raises(DataError) as error:
        read_mass_matrix(tmp_path / "m.npz")
    assert words(error)[0] == ["damaged_file"]


def test_a_missing_file_is_told(tmp_path):
    """With what is like it."""
    with pytest.raises(DataError) as error:
        read_mass_matrix(tmp_path / "m.mtx")
    assert words(error)[0] == ["missing_file"]


def test_rows_in_any_order_with_the_places_of_nodes(tmp_path):
    """Rows are put in the order of the matrix; places are the mesh's, or their own."""
    found = rows(tmp_path)
    assert found.node.tolist() == [4, 4, 8]
    assert found.direction.tolist() == [0, 1, 5]
    assert found.xyz.tolist() == [[0, 1, 2], [0, 1, 2], [3, 4, 5]]
    assert not found.held.any()
    own = rows(tmp_path, ROWS | {"x_mm": [9.0, 8, 7], "y_mm": 0.0, "z_mm": 0.0, "held": [0, 1, 1]}, None)
    assert own.xyz[:, 0].tolist() == [8, 7, 9]
    assert own.held.tolist() == [True, True, False]


@pytest.mark.parametrize(
    ("change", "mesh", "code", "said"),
    [
        ({"row": [3, 1, 4]}, MESH, "unknown_id", "row 4 is none of the 3 of m.mtx"),
        ({"row": [3, 1, 0]}, MESH, "unknown_id", "Count the rows of the matrix from 1"),
        ({"row": [3, 1, 1]}, MESH, "duplicate", "row 1 repeats"),
        ({"node": [4, 4, 4], "direction": ["x", "x", "y"]}, MESH, "duplicate", "node 4, direction x repeats row 1"),
        ({"direction": ["rz", "ux", "y"]}, MESH, "bad_value", "'ux' is not one of x, y, z, rx, ry, rz"),
        ({"node": [5, 4, 4]}, MESH, "unknown_id", "node 5 is not in the nodes"),
        ({}, None, "missing_column", "nothing says where the nodes are"),
        ({"x_mm": 1.0}, MESH, "missing_value", "column y_mm"),
    ],
)
def test_wrong_rows_are_refused(tmp_path, change, mesh, code, said):
    """Each with its place."""
    with pytest.raises(DataError) as error:
        rows(tmp_path, ROWS | change, mesh)
    codes, text = words(error)
    assert code in codes
    assert said in text


def test_missing_rows_are_told(tmp_path):
    """Every row of the matrix has to be known."""
    with pytest.raises(DataError) as error:
        rows(tmp_path, {"row": [2], "node": [4], "direction": ["x"]})
    assert words(error)[0] == ["missing_id"]
    assert "row 1 of m.mtx has no line here (and 1 more)" in words(error)[1]


def table(**more):
    """Shapes of modes 7 and 1 at the nodes 4 and 8, and at one that the matrix lacks."""
    made = {"mode": [7, 7, 1, 1, 1], "node": [8, 4, 4, 8, 99]}
    for number, name in enumerate(("ux_mm", "uy_mm", "uz_mm", "rx_rad", "ry_rad", "rz_rad")):
        made[name] = [number + 0.1 * i for i in range(5)]
    return made | more


def test_shapes_in_the_rows_of_the_matrix(tmp_path):
    """Columns ascend by mode, rows are those of the matrix, other nodes are passed over."""
    found, shape, warnings = shapes(tmp_path, table())
    assert found.tolist() == [1, 7]
    assert shape == pytest.approx(np.array([[0.2, 0.1], [1.2, 1.1], [5.3, 5.0]]))
    assert warnings == []


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (
            {"node": [8, 5, 4, 8, 99]},
            "missing_id",
            "mode 7 has no row of node 4, which the mass matrix has",
        ),
        ({"mode": [7, 7, 1, 1, 3]}, "unknown_id", "mode 3 is not in the modes"),
        ({"node": [8, 8, 4, 8, 99]}, "duplicate", "mode 7, node 8 repeats row 1"),
        ({"ux_mm": [0.0, np.nan, 1.0, 1.0, 1.0]}, "missing_value", "column ux_mm, row 2"),
        ({"rz_rad": [0.0, np.inf, 1.0, 1.0, 1.0]}, "bad_value", "column rz_rad, row 2"),
    ],
)
def test_wrong_shapes_are_refused(tmp_path, change, code, said):
    """Each with its place."""
    with pytest.raises(DataError) as error:
        shapes(tmp_path, table(**change))
    codes, text = words(error)
    assert codes == [code]
    assert said in text


def test_rotations_are_asked_for_where_the_matrix_has_them(tmp_path):
    """A matrix with rotational rows needs rotations in the shapes."""
    without = {name: values for name, values in table().items() if not name.endswith("_rad")}
    with pytest.raises(DataError) as error:
        shapes(tmp_path, without)
    assert words(error)[0][0] == "missing_column"
