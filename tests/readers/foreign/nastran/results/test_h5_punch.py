"""MSC HDF5 and punch files: the same rows as OP2, and their refusals."""

import builtins
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.foreign.nastran.results.h5 import read_h5, read_h5_model
from fatigue.readers.foreign.nastran.results.op2 import read_op2
from fatigue.readers.foreign.nastran.results.punch import read_punch
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


def static_subcases(file):
    """Turn the three modes of the file into unit-load subcases 11 to 13, with loads at grids of their own."""
    h5py = pytest.importorskip("h5py")
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
    """Two static subcases and a mode: named as interface modes they are read with it."""
    path, file = h5
    static_subcases(file)
    change(file, "NASTRAN/RESULT/DOMAINS", "ANALYSIS", 2, 5)
    change(file, "NASTRAN/RESULT/DOMAINS", "MODE", 3, 5)
    file.close()
    assert read_h5(path).mode.tolist() == [3]
    assert read_h5(path, interface=(11, 12)).mode.tolist() == [3, 11, 12]
    assert read_h5(path, 11).analysis == "static"


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
    h5py = pytest.importorskip("h5py")
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


def test_punch_unit_loads(tmp_path):
    """Static subcases with loads at grids of their own."""
    path = tmp_path / "a.pch"
    lines = []
    for subcase, grid in ((3, 1), (8, 2)):
        lines += ["$GRID POINT FORCE BALANCE", "$REAL OUTPUT", f"$SUBCASE ID = {subcase:11d}"]
        for node, element, kind in ((grid, "", "APP-LOAD"), (1, 5, "QUAD4"), (2, 5, "QUAD4")):
            lines.append(f"{node:10d}{element:>18}        {kind:8s}")
            lines += ["-CONT-".ljust(18) + f"{subcase + k:18.6E}" * 3 for k in (0, 1)]
    path.write_text("".join(f"{line:<72}\n" for line in lines))
    found = read_punch(path)
    assert (found.analysis, found.mode.tolist()) == ("static", [3, 8])
    assert found.element.tolist() == [5, 5, 0, 0]
    assert found.force[1, 0].tolist() == [8, 8, 8, 9, 9, 9]


@pytest.mark.parametrize("line", ["$TIME       =   1.0", "$FREQUENCY =   2.0", "$LOAD FACTOR =  0.5"])
def test_punch_of_other_solutions(tmp_path, line):
    """Time steps, frequencies and load factors are no modes."""
    path = tmp_path / "a.pch"
    path.write_text(punch(tee().results).replace("$EIGENVALUE =", line + "\n$EIGENVALUE ="))
    with pytest.raises(DataError, match=line[1:5].lower()):
        read_punch(path)


def test_punch_of_load_factors(tmp_path):
    """Modes below 1 Hz only may be buckling shapes, which a punch file does not tell: a doubt, not a refusal."""
    text = punch(replace(tee().results, frequency=np.array([0.1, 0.2, 0.3, 0.4, 0.5])))
    path = tmp_path / "a.pch"
    path.write_text(text)
    assert "no mode is above 0.5 Hz" in read_punch(path).remarks[-1].what
    path.write_text(punch(tee().results))
    assert not read_punch(path).remarks
    path.write_text(text.replace("MODE =     3", "MODE =      "))
    with pytest.raises(DataError, match="the eigenvalue or the mode is no number"):
        read_punch(path)


def test_punch_without_frequencies(tmp_path):
    """Eigenvalues of zero in all modes are none."""
    text = punch(tee().results)
    for k in range(5):
        eigenvalue = (2 * np.pi * tee().results.frequency[k]) ** 2
        text = text.replace(f"{eigenvalue:15.7E}", f"{0.0:15.7E}")
    path = tmp_path / "a.pch"
    path.write_text(text)
    assert np.isnan(read_punch(path).frequency).all()
