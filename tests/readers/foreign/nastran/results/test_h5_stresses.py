"""Shell stresses of MSC HDF5 files: those of the OP2 file of the same model, and their refusals."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.results.op2_stresses import read_op2_stresses

h5py = pytest.importorskip("h5py")

from fatigue.readers.foreign.nastran.results.h5_stresses import read_h5_stresses  # noqa: E402 (needs h5py)

H5 = Path("data/nastran/modes_elements.h5")
GROUP = "NASTRAN/RESULT/ELEMENTAL/STRESS"
ALL = np.arange(1, 1000)


@pytest.fixture
def h5(tmp_path):
    """A copy of the real file to be changed."""
    path = tmp_path / "a.h5"
    shutil.copy(H5, path)
    with h5py.File(path, "r+") as file:
        yield path, file


def test_elements_and_points_are_those_of_the_op2_file():
    """The same model run by two solvers: same elements, corners and fibres; rigid modes differ in the rest."""
    ours, theirs = read_h5_stresses(H5, ALL), read_op2_stresses(H5.with_suffix(".op2"), ALL)
    found = {(b.kind, b.mode): b for b in ours.blocks}
    assert found.keys() == {(b.kind, b.mode) for b in theirs.blocks}
    for other in theirs.blocks:
        own = found[other.kind, other.mode]
        assert np.array_equal(own.element, other.element)
        assert np.array_equal(own.node, other.node)
        assert np.allclose(own.fibre, other.fibre)
        assert own.stress.dtype == np.float64
    assert set(ours.unread) == set(theirs.unread)


def test_names_of_tables(h5):
    """Quadrangles with corners are QUAD_CN in one version, QUAD4_CN in another, and QUAD4 without corners."""
    path, file = h5
    file.move(f"{GROUP}/QUAD_CN", f"{GROUP}/QUAD4_CN")
    rows = file[f"{GROUP}/TRIA3"][:]
    file.create_dataset(f"{GROUP}/QUAD4", data=rows)
    file.close()
    kinds = {(b.kind, b.has_corners) for b in read_h5_stresses(path, ALL).blocks}
    assert {("QUAD4", True), ("QUAD4", False), ("TRIA3", False)} <= kinds


def test_only_what_is_wanted(h5):
    """Rows of other elements are not kept."""
    path, file = h5
    file.close()
    blocks = read_h5_stresses(path, np.array([7])).blocks
    assert {tuple(b.element.tolist()) for b in blocks} == {(7,)}
    assert sorted(b.mode for b in blocks) == [1, 2, 3]


def test_refusals(h5):
    """Complex tables, other analyses, a domain that is missing, no stresses at all."""
    path, file = h5
    file.move(f"{GROUP}/TRIA3", f"{GROUP}/TRIA3_CPLX")
    domains = file["NASTRAN/RESULT/DOMAINS"][:]
    domains["ANALYSIS"] = 5
    file["NASTRAN/RESULT/DOMAINS"][:] = domains
    file.flush()
    found = read_h5_stresses(path, ALL)
    assert not found.blocks
    assert {problem.code for problem in found.problems} == {"complex_stresses", "wrong_analysis"}
    domains["ID"] += 100
    file["NASTRAN/RESULT/DOMAINS"][:] = domains
    file.flush()
    with pytest.raises(DataError, match="the table of domains lacks it"):
        read_h5_stresses(path, ALL)
    del file[GROUP]
    file.close()
    with pytest.raises(DataError, match=f"no stresses of these shells below {GROUP}"):
        read_h5_stresses(path, ALL)
