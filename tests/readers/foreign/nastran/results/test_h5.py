"""MSC HDF5 files: the same rows as OP2, and their refusals."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.foreign.fe.static_case import Heading
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.foreign.nastran.results.op2 import read_op2

h5py = pytest.importorskip("h5py")

from fatigue.readers.foreign.nastran.results.h5 import read_h5, read_h5_model  # noqa: E402 (needs h5py)

NASTRAN = Path("data/nastran")
H5 = NASTRAN / "modes_elements.h5"


@pytest.fixture
def h5(tmp_path):
    """A copy of the real file to be changed."""
    path = tmp_path / "a.h5"
    shutil.copy(H5, path)
    with h5py.File(path, "r+") as file:
        yield path, file


def test_rows_are_those_of_the_op2_file():
    """The same model run by two solvers: equal rows; each balances to its own precision."""
    double, single = read_h5(H5), read_op2(NASTRAN / "modes_elements.op2")
    for name in ("mode", "node", "element", "kind"):
        assert np.array_equal(getattr(double, name), getattr(single, name))
    assert double.force.dtype == np.float64
    report = {row.check: row.value for row in audit(double, read_h5_model(H5)).rows}
    assert report["element balance"] < 1e-12
    assert report["sign"] == pytest.approx(-1)


def test_model_is_that_of_the_bulk_data():
    """Geometry from the HDF5 file equals that from the bulk data."""
    ours, theirs = read_h5_model(H5), read_bdf(NASTRAN / "modes_elements.bdf")
    for name in ("node", "xyz", "element", "corner", "mid", "pid", "thickness", "offset"):
        assert np.array_equal(getattr(ours.mesh, name), getattr(theirs.mesh, name))
    assert {6, 7, 9} <= set(ours.unconfirmed_sections)


def change(file, name, column, value, row=slice(None)):
    """Overwrite a column of a table."""
    rows = file[name][:]
    rows[column][row] = value
    file[name][:] = rows


@pytest.mark.parametrize(
    ("table", "column", "value", "words"),
    [
        ("RESULT/DOMAINS", "ANALYSIS", 5, "analysis type 5"),
        ("RESULT/DOMAINS", "SE", 7, "superelement 7"),
        ("RESULT/DOMAINS", "ID", 99, "the table of domains lacks it"),
        ("RESULT/NODAL/GRID_FORCE", "F1", np.nan, "no number"),
        ("RESULT/NODAL/GRID_FORCE", "EID", 0, "no force row of an element"),
    ],
)
def test_h5_refusals(h5, table, column, value, words):
    """Other analyses, superelements and impossible values."""
    path, file = h5
    change(file, f"NASTRAN/{table}", column, value)
    file.close()
    with pytest.raises(DataError, match=words):
        read_h5(path)


def test_h5_without_tables(h5, tmp_path):
    """A missing table is named with what to request; no HDF5 file is told."""
    path, file = h5
    del file["NASTRAN/RESULT/NODAL/GRID_FORCE"]
    file.close()
    with pytest.raises(DataError, match="there is no table NASTRAN/RESULT/NODAL/GRID_FORCE"):
        read_h5(path)
    (tmp_path / "b.h5").write_bytes(H5.read_bytes()[:5000])
    with pytest.raises(DataError, match="no sound MSC HDF5 file"):
        read_h5(tmp_path / "b.h5")


@pytest.mark.parametrize(
    ("table", "column", "value", "words"),
    [("NODE/GRID", "SEID", 3, "superelements"), ("NODE/GRID", "CP", 44, "coordinate system 44")],
)
def test_h5_model_refusals(h5, table, column, value, words):
    """Superelement grids and missing systems."""
    path, file = h5
    change(file, f"NASTRAN/INPUT/{table}", column, value)
    file.close()
    with pytest.raises(DataError, match=words):
        read_h5_model(path)


def test_h5_sections_and_frames(h5):
    """Bending factors, own thicknesses and displacement frames of the HDF5 model."""
    path, file = h5
    change(file, "NASTRAN/INPUT/PROPERTY/PSHELL", "BK", 5.0, 0)
    change(file, "NASTRAN/INPUT/NODE/GRID", "CD", 1, 0)
    rows = file["NASTRAN/INPUT/ELEMENT/CQUAD4"][:]
    rows["T"][0] = [0.3, 0.3, 0.3, 0.3]
    rows["T"][1] = [0.3, 0.4, 0.3, 0.4]
    rows["PID"][1] = 77
    file["NASTRAN/INPUT/ELEMENT/CQUAD4"][:] = rows
    file.close()
    model = read_h5_model(path)
    assert "bending" in model.unconfirmed_sections[4]
    assert model.frame_node.tolist() == [1]
    assert model.mesh.thickness[model.mesh.element == rows["EID"][0]] == pytest.approx(0.3)
    assert int(rows["EID"][1]) in model.unconfirmed_elements
    assert "not a PSHELL" in model.unconfirmed_sections[77]


def test_h5_without_rows_of_forces(h5):
    """A table that is there and empty is no damage, and holds no forces."""
    path, file = h5
    name = "NASTRAN/RESULT/NODAL/GRID_FORCE"
    rows = file[name][:0]
    del file[name]
    file[name] = rows
    file.close()
    with pytest.raises(DataError, match=r"table of grid point forces is empty. Request GPFORCE"):
        read_h5(path)


@pytest.mark.parametrize("blank", [0.0, 1.7368e-18])
def test_h5_thickness_left_blank(h5, blank):
    """Elements of the property may give their own; one that does not has no thickness."""
    path, file = h5
    change(file, "NASTRAN/INPUT/PROPERTY/PSHELL", "T", blank, 0)
    rows = file["NASTRAN/INPUT/ELEMENT/CQUAD4"][:]
    rows["T"][0] = 0.3
    file["NASTRAN/INPUT/ELEMENT/CQUAD4"][:] = rows
    file.close()
    mesh = read_h5_model(path).mesh
    of = dict(zip(mesh.element.tolist(), mesh.thickness.tolist(), strict=True))
    assert of[int(rows["EID"][0])] == pytest.approx(0.3)
    assert np.isnan(of[int(rows["EID"][1])])


def static_subcases(file):
    """Turn the three modes of the file into unit-load subcases 11 to 13, with loads at grids of their own."""
    change(file, "NASTRAN/RESULT/DOMAINS", "ANALYSIS", 1, slice(3, 6))
    change(file, "NASTRAN/RESULT/DOMAINS", "SUBCASE", [11, 12, 13], slice(3, 6))
    change(file, "NASTRAN/RESULT/DOMAINS", "MODE", 0, slice(3, 6))
    nodal = file["NASTRAN/RESULT/NODAL"]
    rows = nodal["GRID_FORCE"][:]
    rows["EID"][rows["ELNAME"] == b"*TOTALS*"] = 4  # left over
    loads = rows[[0, 0]]
    loads["ELNAME"], loads["ID"], loads["EID"], loads["DOMAIN_ID"] = b"APP-LOAD", [3, 9], [77, 0], [4, 6]
    del nodal["GRID_FORCE"]
    nodal.create_dataset("GRID_FORCE", data=np.concatenate([loads[1:], rows, loads[:1]]))
    nodal.move("EIGENVECTOR", "DISPLACEMENT")
    assert isinstance(file, h5py.File)


def test_h5_unit_loads(h5):
    """Static subcases with loads of their own, ids left over and displacements: element rows as before, no Hz."""
    path, file = h5
    wanted = read_h5(H5)
    static_subcases(file)
    file.close()
    found = read_h5(path)
    assert (found.analysis, found.mode.tolist()) == ("static", [11, 12, 13])
    assert np.isnan(found.frequency).all()
    assert np.array_equal(found.force[:, found.of_element], wanted.force[:, wanted.of_element])
    assert np.array_equal(found.shape, wanted.shape)
    loads = found.kind == "APP-LOAD"
    assert found.node[loads].tolist() == [3, 9]
    assert np.isfinite(found.force[:, loads, 0]).tolist() == [[True, False], [False, False], [False, True]]
    lights = {row.check: row.light for row in audit(found, read_h5_model(H5)).rows}
    assert "frequencies" not in lights
    assert lights["sign"] == "green"


def test_h5_unit_loads_beside_a_mode(h5):
    """Two static subcases and a mode: named as interface modes, or as loads beside it, they are read with it."""
    path, file = h5
    static_subcases(file)
    name = "NASTRAN/INPUT/PARAMETER/CASECC/SUBCASE"
    change(file, name, "SID", 11)
    change(file, name, "SUBTITLE", b"PULL")
    change(file, "NASTRAN/RESULT/DOMAINS", "ANALYSIS", 2, 5)
    change(file, "NASTRAN/RESULT/DOMAINS", "MODE", 3, 5)
    file.close()
    assert read_h5(path).mode.tolist() == [3]
    assert read_h5(path, interface=(11, 12)).mode.tolist() == [3, 11, 12]
    assert read_h5(path, 11).analysis == "static"
    beside = read_h5(path, loads=None)
    assert beside.mode.tolist() == [3, 11, 12]
    assert [(case.subcase, case.heading) for case in beside.static_cases] == [
        (11, Heading(subtitle="PULL")),
        (12, Heading()),
    ]


@pytest.mark.parametrize(
    ("analysis", "words"), [(8, "buckling .post-buckling.*SOL 103"), (7, "pre-buckling"), (9, "complex")]
)
def test_h5_buckling(h5, analysis, words):
    """Buckling shapes are refused as what they are; the static subcase beside them can be named."""
    path, file = h5
    change(file, "NASTRAN/RESULT/DOMAINS", "ANALYSIS", [1, analysis, analysis], slice(3, 6))
    change(file, "NASTRAN/RESULT/DOMAINS", "SUBCASE", [1, 2, 2], slice(3, 6))
    file.close()
    with pytest.raises(DataError, match=rf"subcase 2 mode 2 .*{words}.*name the subcase to use: \[1\]"):
        read_h5(path)
    assert read_h5(path, 1).mode.tolist() == [1]


def test_h5_without_summary(h5):
    """Eigenvalues stand in the table of domains, too; without any the frequencies are unknown and red."""
    path, file = h5
    del file["NASTRAN/RESULT/SUMMARY/EIGENVALUE"]
    file.close()
    found = read_h5(path)
    assert np.isnan(found.frequency).all()
    rows = {row.check: row for row in audit(found, read_h5_model(H5)).rows}
    assert rows["frequencies"].light == "red"
    with h5py.File(path, "r+") as again:
        change(again, "NASTRAN/RESULT/DOMAINS", "TIME_FREQ_EIGR", [1.0, 4.0, 9.0], slice(3, 6))
    assert read_h5(path).frequency == pytest.approx(np.array([1, 2, 3]) / (2 * np.pi))


def test_h5_complex_forces(h5):
    """Complex grid point forces stand in a table of their own."""
    path, file = h5
    file["NASTRAN/RESULT/NODAL"].move("GRID_FORCE", "GRID_FORCE_CPLX")
    file.close()
    with pytest.raises(DataError, match="complex"):
        read_h5(path)
