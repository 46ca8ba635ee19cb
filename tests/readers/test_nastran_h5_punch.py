"""MSC HDF5 and punch files: the same rows as OP2, and their refusals."""

import builtins
import shutil
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.audit import audit
from fatigue.readers.nastran_bdf import read_bdf
from fatigue.readers.nastran_h5 import read_h5, read_h5_model
from fatigue.readers.nastran_op2 import read_op2
from fatigue.readers.nastran_punch import read_punch
from tests.readers.tee_model import tee

NASTRAN = Path("data/nastran")
H5 = NASTRAN / "modes_elements.h5"


@pytest.fixture
def h5(tmp_path):
    """A copy of the real file to be changed."""
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "a.h5"
    shutil.copy(H5, path)
    with h5py.File(path, "r+") as file:
        yield path, file


def test_rows_are_those_of_the_op2_file():
    """The same model run by two solvers: equal rows; each balances to its own precision."""
    pytest.importorskip("h5py")
    double, single = read_h5(H5), read_op2(NASTRAN / "modes_elements.op2")
    for name in ("mode", "node", "element", "kind"):
        assert np.array_equal(getattr(double, name), getattr(single, name))
    assert double.force.dtype == np.float64
    report = {row.check: row.value for row in audit(double, read_h5_model(H5)).rows}
    assert report["element balance"] < 1e-12
    assert report["sign"] == pytest.approx(-1)


def test_model_is_that_of_the_bulk_data():
    """Geometry from the HDF5 file equals that from the bulk data."""
    pytest.importorskip("h5py")
    ours, theirs = read_h5_model(H5), read_bdf(NASTRAN / "modes_elements.bdf")
    for name in ("node", "xyz", "element", "corner", "mid", "pid", "thickness", "offset"):
        assert np.array_equal(getattr(ours.mesh, name), getattr(theirs.mesh, name))
    assert {6, 7, 9} <= set(ours.section_doubt)


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
    assert "bending" in model.section_doubt[4]
    assert model.frame_node.tolist() == [1]
    assert model.mesh.thickness[model.mesh.element == rows["EID"][0]] == pytest.approx(0.3)
    assert int(rows["EID"][1]) in model.element_doubt
    assert "not a PSHELL" in model.section_doubt[77]


def test_missing_h5py_is_told(monkeypatch):
    """Without h5py the message says what to install."""
    plain = builtins.__import__

    def without(name, *args, **kwargs):
        if name == "h5py":
            raise ImportError
        return plain(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(DataError, match=r'Run: pip install "h5py>=[\d.]+"'):
        read_h5(H5)


def punch(results):
    """Punch file text of FeResults."""
    lines = []
    for k, mode in enumerate(results.mode.tolist()):
        eigenvalue = (2 * np.pi * results.frequency[k]) ** 2
        lines += ["$TITLE   = T", "$SUBTITLE=", "$LABEL   =", "$GRID POINT FORCE BALANCE", "$REAL OUTPUT"]
        lines += ["$SUBCASE ID =           1", f"$EIGENVALUE ={eigenvalue:15.7E}  MODE ={mode:6d}"]
        for node, element, kind, force in zip(
            results.node, results.element, results.kind, results.force[k], strict=True
        ):
            lines.append(f"{node:10d}{element or '':>18}        {kind:8s}")
            lines += ["-CONT-".ljust(18) + "".join(f"{x:18.6E}" for x in force[a : a + 3]) for a in (0, 3)]
    return "".join(f"{line:<72}{number:8d}\n" for number, line in enumerate(lines, start=1))


def test_punch_rows(tmp_path):
    """A punch file gives the rows to its six digits, and the frequencies."""
    wanted = tee().results
    path = tmp_path / "a.pch"
    path.write_text(punch(wanted))
    found = read_punch(path)
    for name in ("mode", "node", "element", "kind"):
        assert np.array_equal(getattr(found, name), getattr(wanted, name))
    assert np.allclose(found.force, wanted.force, rtol=1e-6, atol=0)
    assert np.allclose(found.frequency, wanted.frequency, rtol=1e-6)
    assert np.isnan(found.modal_mass).all()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("$GRID POINT FORCE BALANCE", "$DISPLACEMENTS", "no block begins"),
        ("$REAL OUTPUT", "$REAL-IMAGINARY OUTPUT", "complex"),
        ("$REAL OUTPUT", "$POINT ID = 3", "SORT2"),
        ("$SUBCASE ID", "$SUBCASE XX", "no line"),
        ("-CONT-", "-XXXX-", "two -CONT- lines"),
        ("E+0", "E*0", "is no number"),
    ],
)
def test_punch_refusals(tmp_path, old, new, words):
    """Every damage of the text is refused with its line."""
    text = punch(tee().results)
    path = tmp_path / "a.pch"
    path.write_text(text.replace(old, new))
    with pytest.raises(DataError, match=words):
        read_punch(path)


def test_punch_cut_short(tmp_path):
    """A file cut in the middle, and one that is not there."""
    path = tmp_path / "a.pch"
    text = punch(tee().results)
    path.write_text(text[: len(text) // 2])
    with pytest.raises(DataError, match="line"):
        read_punch(path)
    with pytest.raises(DataError, match="cannot be read"):
        read_punch(tmp_path / "none.pch")


def test_punch_ids(tmp_path):
    """A word where an id should stand is refused."""
    text = punch(tee().results).splitlines(keepends=True)
    text[7] = "     x" + text[7][6:]
    path = tmp_path / "a.pch"
    path.write_text("".join(text))
    with pytest.raises(DataError, match="is no id"):
        read_punch(path)
