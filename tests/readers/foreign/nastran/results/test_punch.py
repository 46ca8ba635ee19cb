"""NASTRAN punch files: the same rows as OP2, and their refusals."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.fe.static_case import Heading
from fatigue.readers.foreign.nastran.results.punch import read_punch
from tests.readers.tee_model import tee


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


def test_punch_unit_loads(tmp_path):
    """Static subcases with loads at grids of their own."""
    path = tmp_path / "a.pch"
    lines = []
    for subcase, grid, name in ((3, 1, "pull = 1"), (8, 2, "")):
        lines += ["$TITLE   = A RUN", f"$SUBTITLE= {name}", "$LABEL   ="]
        lines += ["$GRID POINT FORCE BALANCE", "$REAL OUTPUT", f"$SUBCASE ID = {subcase:11d}"]
        for node, element, kind in ((grid, "", "APP-LOAD"), (1, 5, "QUAD4"), (2, 5, "QUAD4")):
            lines.append(f"{node:10d}{element:>18}        {kind:8s}")
            lines += ["-CONT-".ljust(18) + f"{subcase + k:18.6E}" * 3 for k in (0, 1)]
    path.write_text("".join(f"{line:<72}\n" for line in lines))
    found = read_punch(path)
    assert (found.analysis, found.mode.tolist()) == ("static", [3, 8])
    assert found.element.tolist() == [5, 5, 0, 0]
    assert found.force[1, 0].tolist() == [8, 8, 8, 9, 9, 9]
    assert [case.heading for case in found.static_cases] == [Heading("A RUN", "pull = 1"), Heading("A RUN")]


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
    assert "no mode is above 0.5 Hz" in read_punch(path).warnings[-1].what
    path.write_text(punch(tee().results))
    assert not read_punch(path).warnings
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
