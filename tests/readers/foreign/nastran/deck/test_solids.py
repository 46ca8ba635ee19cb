"""Solids of NASTRAN decks: forms of cards, mid-side grids left out, what is told and refused."""

import random

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from tests.readers.bdf_writer import FORMS, write
from tests.solid_meshes import deck, tee

CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
GRIDS = [("GRID", [str(n), "", f"{x}.", f"{y}.", f"{z}."]) for n, (x, y, z) in enumerate(CUBE, 1)]
MIDS = [("GRID", [str(n), "", f"{0.1 * n:.2f}", "9.", "9."]) for n in range(11, 31)]
EIGHT = [str(n) for n in range(1, 9)]


def read(tmp_path, text):
    """Model of a deck."""
    (tmp_path / "m.bdf").write_text(text)
    return read_bdf(tmp_path / "m.bdf")


def refusal(tmp_path, text):
    """First problem of a deck."""
    with pytest.raises(DataError) as refused:
        read(tmp_path, text)
    return refused.value.problems[0]


@pytest.mark.parametrize("form", FORMS)
def test_every_form_of_card(tmp_path, form):
    """Hexahedra of 8 and 20 grids, in fields of 8 and 16, with commas and continuations."""
    mids = [str(n) for n in range(11, 23)]
    cards = [*GRIDS, *MIDS, ("CHEXA", ["5", "7", *EIGHT]), ("CHEXA", ["6", "8", *EIGHT, *mids]), ("PSOLID", ["7", "1"])]
    solids = read(tmp_path, write(random.Random(3), cards, form)).solids
    assert solids.element.tolist() == [5, 6]
    assert solids.pid.tolist() == [7, 8]
    assert solids.node[solids.corner].tolist() == [list(range(1, 9))] * 2
    assert (solids.mid[0] == -1).all()
    assert solids.node[solids.mid[1]].tolist() == list(range(11, 23))


@pytest.mark.parametrize(("name", "corners", "mids"), [("CHEXA", 8, 12), ("CPENTA", 6, 9), ("CTETRA", 4, 6)])
def test_mid_side_grids_may_be_left_out(tmp_path, name, corners, mids):
    """Some blank, the last ones not there: -1 each, the others at their places; a blank property is the id."""
    given = ["", "12", "", "14"]
    text = write(random.Random(1), [*GRIDS, *MIDS, (name, ["9", "", *EIGHT[:corners], *given])], "free")
    solids = read(tmp_path, text).solids
    assert solids.corners.tolist() == [corners]
    assert solids.pid.tolist() == [9]
    found = [int(solids.node[n]) if n >= 0 else 0 for n in solids.mid[0]]
    assert found == [0, 12, 0, 14] + [0] * 8
    too_many = [name, *map(str, [9, 1, *EIGHT[:corners], *range(11, 11 + mids), 30])]
    cards = [*GRIDS, *MIDS, (too_many[0], too_many[1:])]
    assert refusal(tmp_path, write(random.Random(1), cards, "free")).code == "too_many_fields"


def test_a_material_system_of_optistruct_is_no_grid(tmp_path):
    """CORDM behind the grids."""
    card = ("CHEXA", ["9", "1", *EIGHT, "", "", "", "", "", "", "CORDM", "4"])
    solids = read(tmp_path, write(random.Random(1), [*GRIDS, card], "free")).solids
    assert (solids.mid == -1).all()


def test_pyramids_are_told(tmp_path):
    """They are left out, and solids beside them have a skin there."""
    cards = [*GRIDS, ("CHEXA", ["9", "1", *EIGHT]), ("CPYRAM", ["10", "1", *EIGHT[:5]])]
    model = read(tmp_path, write(random.Random(1), cards, "free"))
    told = {warning.code: warning.what for warning in model.warnings}
    assert "1 CPYRAM are not read" in told["unread_solids"]
    assert model.other_cards == {"CPYRAM": 1}


@pytest.mark.parametrize(
    ("extra", "code"),
    [
        (("CHEXA", ["9", "2", *EIGHT]), "element_twice"),
        (("CQUAD4", ["9", "2", *EIGHT[:4]]), "element_twice"),
        (("CHEXA", ["10", "2", *EIGHT[:7], "99"]), "no_grid"),
        (("CHEXA", ["10", "2", *EIGHT[:7], "7"]), "collapsed"),
        (("CHEXA", ["10", "2", *EIGHT[:7]]), "bad_field"),
        (("CHEXA", ["10", "2", *EIGHT[:7], "8.5"]), "bad_field"),
        (("CPENTA", ["10", "2", *EIGHT[:6], "-3"]), "bad_field"),
        (("PSOLID", ["3", "1", "", "", "", "", "PFLUID"]), "fluid_solid"),
    ],
)
def test_what_is_no_solid_is_refused(tmp_path, extra, code):
    """By its place."""
    found = refusal(tmp_path, write(random.Random(1), [*GRIDS, ("CHEXA", ["9", "1", *EIGHT]), extra], "free"))
    assert found.code == code


def test_one_solid_given_twice_alike(tmp_path):
    """It is taken once and told."""
    card = ("CHEXA", ["9", "1", *EIGHT])
    model = read(tmp_path, write(random.Random(1), [*GRIDS, card, card], "free"))
    assert model.solids.element.size == 1
    assert [warning.code for warning in model.warnings if warning.code == "twice"] == ["twice"]


def test_neither_shells_nor_solids(tmp_path):
    """Grids alone are refused."""
    assert refusal(tmp_path, write(random.Random(1), GRIDS, "free")).code == "no_shells"


@pytest.mark.parametrize("parabolic", [False, True])
def test_a_whole_joint(tmp_path, parabolic):
    """The deck of a joint is read as the mesh that it was written of."""
    solids = tee(wedge=4.0)
    found, wanted = read(tmp_path, deck(solids, parabolic)).solids, solids.mesh(parabolic)
    for name in ("node", "element", "corner", "mid", "pid"):
        assert np.array_equal(getattr(found, name), getattr(wanted, name))
    assert found.xyz == pytest.approx(wanted.xyz)
