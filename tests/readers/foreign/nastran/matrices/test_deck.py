"""DMIG bulk data: small, large and free fields, either triangle, displacement frames; refusals with their line."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.matrices.deck import read_dmig

DOFS = [(1, 1), (1, 2), (1, 3), (7, 1), (7, 2), (7, 3), (7, 5)]
K = np.diag([4.0, 5, 6, 7, 8, 9, 1e7]) + np.diag([-1.0, 0, 0.5, 0, 2, 3], 1) + np.diag([-1.0, 0, 0.5, 0, 2, 3], -1)
M = np.diag([1e-3, 1e-3, 1e-3, 2e-3, 2e-3, 2e-3, 4.0])
GRIDS = "GRID,1,,0.,0.,0.\nGRID,7,,10.,20.,30.\n"


def dmig(name, matrix, dofs=DOFS, form=6, kind=2, layout="large", triangle=np.tril):
    """A matrix as DMIG."""
    head = {"free": f"DMIG,{name},0,{form},{kind},0,,,{len(dofs)}"}.get(layout)
    lines = [head or f"DMIG    {name:8s}{0:8d}{form:8d}{kind:8d}{0:8d}{'':16s}{len(dofs):8d}"]
    kept = triangle(matrix)
    for j, (grid, component) in enumerate(dofs):
        rows = np.flatnonzero(kept[:, j])
        if not rows.size:
            continue
        if layout == "large":
            lines.append(f"DMIG*   {name:16s}{grid:16d}{component:16d}{'':16s}")
            lines += [f"*       {dofs[i][0]:16d}{dofs[i][1]:16d}{kept[i, j]:16.9E}".replace("E", "D") for i in rows]
        elif layout == "free":
            entries = [f"{dofs[i][0]},{dofs[i][1]},{kept[i, j]},0.0" for i in rows]
            lines.append(f"DMIG,{name},{grid},{component},,{entries[0]}")
            lines += ["," + ",".join(entries[k : k + 2]) for k in range(1, len(entries), 2)]
        else:
            fields = [f"{dofs[i][0]:8d}{dofs[i][1]:8d}{kept[i, j]:<8.2e}{'':8s}" for i in rows]
            lines.append(f"DMIG    {name:8s}{grid:8d}{component:8d}{'':8s}" + fields[0])
            lines += ["        " + "".join(fields[k : k + 2]) for k in range(1, len(fields), 2)]
    return "\n".join(lines) + "\n"


def read(tmp_path, text):
    """What a file of this text holds."""
    (tmp_path / "body.pch").write_text(text)
    return read_dmig(tmp_path / "body.pch")


@pytest.mark.parametrize("layout", ["large", "free", "small"])
@pytest.mark.parametrize("triangle", [np.tril, np.triu])
def test_matrices_are_read(tmp_path, layout, triangle):
    """The same from every form of field and either triangle, rows in the order of grids."""
    text = "$ PUNCH\n" + dmig("KAAX", K, layout=layout, triangle=triangle) + dmig("MAAX", M, layout=layout) + GRIDS
    found = read(tmp_path, text)
    np.testing.assert_allclose(found.K.toarray(), K, rtol=1e-2 if layout == "small" else 1e-9)
    np.testing.assert_allclose(found.M.toarray(), M, rtol=1e-9)
    assert found.names == ("KAAX", "MAAX")
    assert list(zip(found.node.tolist(), (found.direction + 1).tolist(), strict=True)) == DOFS
    assert found.xyz[7].tolist() == [10.0, 20.0, 30.0]


def test_square_form_and_both_triangles(tmp_path):
    """Form 1 is taken as it stands; a pair that form 6 gives twice counts once. Damping is passed over."""
    text = dmig("KAAX", K, form=1, triangle=np.asarray) + dmig("MAAX", M, triangle=np.asarray)
    text += dmig("K4AAX", K) + dmig("K2PP", K) + GRIDS
    found = read(tmp_path, text)
    np.testing.assert_allclose(found.K.toarray(), K, rtol=1e-9)
    np.testing.assert_allclose(found.M.toarray(), M, rtol=1e-9)


def test_displacement_frames_are_turned(tmp_path):
    """A grid whose frame has x along basic y, y along -x: rows are in basic axes afterwards."""
    frame = "CORD2R,5,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n"
    grids = "GRID,1,,0.,0.,0.,5\nGRID,7,,10.,20.,30.\n"
    found = read(tmp_path, dmig("KAAX", K) + dmig("MAAX", M) + frame + grids)
    turn = np.eye(7)
    turn[:3, :3] = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
    np.testing.assert_allclose(found.K.toarray(), turn.T @ K @ turn, atol=1e-9)
    with pytest.raises(DataError, match="grid 7 has a displacement frame of its own, and not all three components"):
        read(tmp_path, dmig("KAAX", K) + dmig("MAAX", M) + frame + grids.replace("30.", "30.,5"))


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        (dmig("KAAX", K), "no_matrix", "0 matrices may be the mass matrix; DMIG here: KAAX"),
        (dmig("K1", K) + dmig("K2", K) + dmig("MAAX", M), "two_matrices", "2 matrices may be the stiffness matrix"),
        (dmig("KAAX", K) * 2, "matrix_twice", "KAAX begins again"),
        (dmig("KAAX", K, kind=4), "bad_matrix", "KAAX is complex"),
        (dmig("KAAX", K, form=2), "bad_matrix", "KAAX is rectangular"),
        (dmig("KAAX", K, [*DOFS[:6], (101, 0)]), "scalar_point", "point 101 with component 0"),
        ("DMIG,KAAX,1,1,,1,1,4.0\n", "no_header", "a column of KAAX stands here"),
        ("DMIG,KAAX,0,6,2,0,,,7\nDMIG,KAAX,1,1,,1,1,4.0,,+\n,7,1,x\n", "bad_field", "'X'"),
        (dmig("KAAX", K * 0) + dmig("MAAX", M * 0), "empty_matrix", "have no entries"),
        ("hello\n", "no_matrix", "DMIG here: none"),
    ],
)
def test_what_is_no_matrix_is_refused(tmp_path, text, code, said):
    """One line with the place."""
    with pytest.raises(DataError) as error:
        read(tmp_path, text + GRIDS)
    assert code in [problem.code for problem in error.value.problems]
    assert said in str(error.value)


def test_a_pair_with_two_values_is_refused(tmp_path):
    """Where both triangles are given and do not agree."""
    other = K.copy()
    other[0, 1] = -2.0
    with pytest.raises(DataError, match="twice with two values"):
        read(tmp_path, dmig("KAAX", other, triangle=np.asarray) + dmig("MAAX", M) + GRIDS)
