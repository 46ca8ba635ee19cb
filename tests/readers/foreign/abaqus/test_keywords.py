"""The deck language in its freedoms, and damaged decks that must cost neither memory nor a traceback."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_model

PLATE = (
    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n*ELEMENT, TYPE=S4R, ELSET=E\n1,1,2,3,4\n"
    "*SHELL SECTION, ELSET=E, MATERIAL=S\n2.,5\n"
)


def read(tmp_path, text, encoding="ascii"):
    """Mesh of a deck."""
    (tmp_path / "model.inp").write_bytes(text.encode(encoding))
    return read_model(tmp_path / "model.inp")


@pytest.mark.parametrize(
    "text",
    [
        PLATE.replace("\n", "\r\n"),
        PLATE.replace("*ELEMENT, TYPE", "* elem, Typ"),
        PLATE.replace("*SHELL SECTION, ELSET", "*ShellSect, els"),
        PLATE.replace("*SHELL SECTION", "*ELSET, ELSET=A\nE\n*SHELL SECTION").replace("ELSET=E, MAT", "ELSET=A, MAT"),
        PLATE + "*STEP\n*FREQUENCY\n10\n*ELEMENT OUTPUT, ELSET=E\nNFORC\n*NODE OUTPUT\nU\n*END STEP\n",
    ],
)
def test_words_may_be_short_and_joined(tmp_path, text):
    """As Abaqus takes them; output requests of a step are no nodes and no elements."""
    mesh = read(tmp_path, text).mesh
    assert mesh.element.tolist() == [1]
    assert mesh.thickness.tolist() == [2.0]


def test_utf_16_is_read(tmp_path):
    """As editors of Windows may write it."""
    np.testing.assert_array_equal(read(tmp_path, PLATE, "utf-16").mesh.thickness, [2.0])


def test_a_huge_range_costs_nothing(tmp_path):
    """A slip in GENERATE is no two thousand million labels in memory."""
    text = PLATE.replace("R, ELSET=E", "R").replace("*SHELL", "*ELSET, ELSET=E, GENERATE\n1, 2000000000, 1\n*SHELL", 1)
    assert read(tmp_path, text).mesh.thickness.tolist() == [2.0]


@pytest.mark.parametrize("thickness", ["<t>,5", "-2.,5", "nan,5", ""])
def test_no_thickness_is_no_number(tmp_path, thickness):
    """A parameter, a negative value, nothing: confirmed by hand."""
    model = read(tmp_path, PLATE.replace("2.,5", thickness))
    assert "has no number as its thickness" in model.unconfirmed_sections[1]
    assert np.isnan(model.mesh.thickness).all()


def test_elements_of_two_sections_are_doubtful(tmp_path):
    """The first counts, and wants a confirmation."""
    model = read(tmp_path, PLATE + "*SHELL SECTION, ELSET=E, MATERIAL=S\n3.\n")
    assert model.unconfirmed_sections == {1: "section 1 shares elements with section 2"}


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (", TYPE=S4R", "", "names no TYPE"),
        ("4,0,1,0", "4,0,1,0\n4,0,2,0", "node 4 is given twice"),
        ("4,0,1,0", "99999999999999999999,0,1,0", "a node of 4 numbers"),
        ("1,1,2,3,4", "1,1,2,3,-4", "a number that is no id"),
        ("4,0,1,0", "4,0,inf,0", "not finite"),
    ],
)
def test_damage_is_refused_by_its_line(tmp_path, old, new, said):
    """Never a traceback of an overflow."""
    with pytest.raises(DataError, match=r"model\.inp, line \d") as caught:
        read(tmp_path, PLATE.replace(old, new))
    assert said in str(caught.value)


def test_a_move_that_is_no_number_is_refused(tmp_path):
    """By its line."""
    text = f"*PART, NAME=P\n{PLATE}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n1.,x,0.\n*END INSTANCE\n"
    with pytest.raises(DataError, match=r"line 14: 'x' is no number"):
        read(tmp_path, text)
