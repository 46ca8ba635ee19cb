"""Modal coordinates of ANSYS: rows wrapped or not, other spellings, damage."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.histories.mcf import read_mcf
from fatigue.readers.foreign.read import read_coordinates, recognise

MCF = """\
Modal Coordinates File
Title: run 1
Number of Modes:   3
  Mode:                1              2              7
  Frequency:     0.1000000E+02  0.2000000E+02
                 0.3000000E+02
      Time          Coordinates...
 0.0000000E+00  0.1E+01  0.2E+01
                0.3E+01
 0.1000000E+00  0.4E+01  0.5E+01
                0.6E+01
"""


def test_mcf(tmp_path):
    """A wrapped file with mode numbers and frequencies; without the two lines modes count from 1."""
    path = tmp_path / "a.mcf"
    path.write_text(MCF)
    assert recognise(path).key == "mcf"
    found = read_coordinates(path, None, None)
    assert found.mode.tolist() == [1, 2, 7]
    assert found.frequency.tolist() == [10.0, 20.0, 30.0]
    assert found.q.tolist() == [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]
    lines = MCF.splitlines(keepends=True)
    path.write_text("".join(lines[:3] + lines[6:]))
    bare = read_mcf(path)
    assert bare.mode.tolist() == [1, 2, 3]
    assert np.isnan(bare.frequency).all()


def test_mcf_of_another_program(tmp_path):
    """Exponents of Fortran, UTF-16, more digits; the normalisation a header declares."""
    path = tmp_path / "a.mcf"
    path.write_bytes(MCF.replace("E+", "D+").encode("utf-16"))
    found = read_coordinates(path, None, None)
    assert found.frequency.tolist() == [10.0, 20.0, 30.0]
    assert found.resolution.tolist() == pytest.approx([5e-6] * 3)
    assert found.q.tolist() == [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]
    assert found.normalisation is None
    for words, wanted in (
        ("Mode shapes normalized to the mass matrix", "mass"),
        ("The modes are mass normalised", "mass"),
        ("Normalization: unit modal mass", "mass"),
        ("Mode shapes normalized to unity", "length"),
        ("Modes normalised to maximum displacement", "length"),
    ):
        path.write_text(MCF.replace("Title: run 1", words))
        assert read_mcf(path).normalisation == wanted
    path.write_text(MCF.replace("Title: run 1", "modes normalized to mass\nmodes normalized to unity"))
    with pytest.raises(DataError, match="lines 2 and 3: two statements of the header disagree"):
        read_mcf(path)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("Number of Modes:   3", "Number of Modes:   4", "3 mode numbers for 4 modes"),
        ("Number of Modes", "Count", "are missing"),
        ("      Time ", "      Frequency ", "harmonic response"),
        ("0.6E+01\n", "\n", "no whole number of rows"),
        ("0.6E+01", "0.6?+01", "no number"),
        ("0.3000000E+02", "0.3E+02E", "3 modes|no number"),
    ],
)
def test_mcf_refusals(tmp_path, old, new, words):
    """Cut, damaged and harmonic files."""
    path = tmp_path / "a.mcf"
    path.write_text(MCF.replace(old, new))
    with pytest.raises(DataError, match=words):
        read_mcf(path)
