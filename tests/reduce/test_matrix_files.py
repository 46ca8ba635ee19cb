"""A body given as a NASTRAN file, and one whose stiffness matrix has few digits."""

import numpy as np
import pandas as pd
import pytest
from scipy import sparse
from scipy.io import mmwrite

from fatigue.flexbody.shell import structure
from fatigue.reduce.bases import Recipe
from fatigue.reduce.story import reduce
from tests.flexbody.shells import plate
from tests.readers.foreign.nastran.matrices.test_deck import dmig
from tests.readers.model.test_read import dof, written

MESH = plate(6, 4)
QUICK = Recipe(cut_hz=300.0)


@pytest.fixture(scope="module")
def body():
    """A plate."""
    return structure(MESH)


@pytest.fixture
def interface(tmp_path):
    """Its corners as points."""
    corners = {"name": ["a", "b", "c", "d"], "node": [1, 5, 31, 35], "side": "external", "components": "123"}
    pd.DataFrame(corners).to_csv(tmp_path / "interface.csv", index=False)
    return tmp_path / "interface.csv"


def by_files(folder, body, digits):
    """K, M and dof of a body."""
    folder.mkdir()
    mmwrite(folder / "K.mtx", sparse.coo_array(body.K), precision=digits)
    mmwrite(folder / "M.mtx", sparse.coo_array(body.M), precision=16)
    return written(folder, {"dof": dof(body)})


def test_a_nastran_file_gives_the_same_basis(tmp_path, body, interface):
    """As K and M of Matrix Market: alone, or in a folder; messages name its matrices."""
    dofs = list(zip(body.node.tolist(), (body.direction + 1).tolist(), strict=True))
    grids = "".join(f"GRID,{node},,{x},{y},{z}\n" for node, (x, y, z) in zip(MESH.node, MESH.xyz, strict=True))
    deck = tmp_path / "deck" / "body.pch"
    deck.parent.mkdir()
    text = [dmig(name, matrix.toarray(), dofs, layout="free") for name, matrix in (("KAAX", body.K), ("MAAX", body.M))]
    deck.write_text("".join(text) + grids)
    known = reduce(by_files(tmp_path / "files", body, 16), interface, tmp_path / "known", QUICK)
    for model in (deck, deck.parent):
        done = reduce(model, interface, tmp_path / "out", QUICK)
        assert [problem.code for problem in done.warnings] == ["no_weld_forces"]
        assert done.warnings[0].what.startswith("KAAX of body.pch and MAAX of body.pch have no elements")
        np.testing.assert_allclose(done.reduced.basis.frequency, known.reduced.basis.frequency, rtol=1e-6)


def test_few_digits_are_told(tmp_path, body, interface):
    """Six digits of K leave its lowest frequency open; sixteen do not."""
    done = reduce(by_files(tmp_path / "six", body, 5), interface, tmp_path / "out", QUICK)
    assert [problem.code for problem in done.warnings] == ["few_digits", "no_weld_forces"]
    assert done.warnings[0].where == "K of six"


def test_places_that_nothing_says_come_from_the_stiffness(tmp_path, body, interface):
    """The same basis as with places, and a warning that says from which node they are measured."""
    known = reduce(by_files(tmp_path / "files", body, 16), interface, tmp_path / "known", QUICK)
    bare = by_files(tmp_path / "bare", body, 16)
    (table,) = bare.glob("dof.*")
    written(bare, {"dof": dof(body)[["row", "node", "component"]]})
    assert "x_mm" not in table.read_text()
    done = reduce(bare, interface, tmp_path / "out", QUICK)
    (told,) = (problem for problem in done.warnings if problem.code == "places_from_stiffness")
    assert "measured from node" in told.what
    np.testing.assert_allclose(done.reduced.basis.frequency, known.reduced.basis.frequency, rtol=1e-6)
