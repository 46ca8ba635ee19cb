"""Bulk data in all its spellings, coordinate systems, sections, sets and markers."""

import random
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf

NASTRAN = Path("data/nastran")
PLATE = """\
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,1.,0.
GRID,4,,0.,1.,0.
PSHELL,1,1,2.,1,,1
"""
QUAD = PLATE + "CQUAD4,1,1,1,2,3,4\n"


@pytest.fixture
def read(tmp_path):
    """Read bulk data given as text."""

    def reader(text):
        path = tmp_path / "a.bdf"
        path.write_text(text)
        return read_bdf(path)

    return reader


def test_real_files():
    """An element zoo with INCLUDE, tabs and layered sections; a wing box of 2464 shells in fixed fields."""
    zoo = read_bdf(NASTRAN / "modes_elements.bdf")
    assert zoo.mesh.element.size == 17
    assert zoo.mesh.thickness[zoo.mesh.pid == 6].tolist() == [1.0] * 3
    assert zoo.mesh.thickness[zoo.mesh.pid == 7].tolist() == [1.5] * 3
    assert set(zoo.unconfirmed_sections) == {6, 7, 9}
    assert zoo.marker_edges["PLOTEL"].tolist() == [[1, 23]]
    quad8 = zoo.mesh.mid[zoo.mesh.element == 60][0]
    assert zoo.mesh.node[quad8[1:]].tolist() == [63, 62, 65]
    assert quad8[0] == -1
    box = read_bdf(NASTRAN / "wingbox_stitched_together-000.bdf")
    assert (box.mesh.node.size, box.mesh.element.size) == (2675, 2464)
    assert box.other_cards == {"CBUSH": 193, "RBE2": 1}


@pytest.mark.parametrize(
    "card",
    [
        "GRID,9,,1.5+1,-2.5-1,3.D0",
        "GRID           9           1.5+1  -2.5-1    3.D0",
        "GRID*                  9                           1.5+1          -2.5-1*A\n*A                  3.D0",
        "grid*,9,,15.,-0.25,*B\n*B,3.0",
        "GRID    9               15.     -.25    +3.E0   $ comment",
        "GRID\t9\t\t15.\t-.25\t3.",
        "GRID,9,,15,-.25,3",
        "GRID,9,,+1.5e1,-25-2,+3",
    ],
)
def test_spellings_of_a_card(read, card):
    """Small, large and free fields, FORTRAN exponents, tabs, comments, continuations."""
    mesh = read(QUAD + card + "\n").mesh
    assert mesh.xyz[mesh.node == 9].tolist() == [[15.0, -0.25, 3.0]]


def test_coordinate_systems(read):
    """Positions and displacement frames in rectangular, cylindrical and spherical systems, nested and by grids."""
    model = read(
        PLATE
        + "CORD2C,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
        + "CORD2S,6,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
        + "CORD2R,7,5,1.,90.,0.,1.,90.,1.\n,2.,90.,0.\n"
        + "CORD1R,8,1,2,3\n"
        + "GRID,11,5,2.,90.,3.,5\n"
        + "GRID,12,6,2.,90.,90.,6\n"
        + "GRID,13,7,1.,0.,0.,7\n"
        + "GRID,14,8,0.,0.,1.,8\n"
        + "CQUAD4,1,1,1,2,3,4\n"
    )
    at = dict(zip(model.mesh.node.tolist(), model.mesh.xyz, strict=True))
    assert np.allclose([at[n] for n in (11, 12, 13, 14)], [[0, 2, 3], [0, 2, 0], [0, 2, 0], [1, 0, 0]], atol=1e-12)
    axes = dict(zip(model.frame_node.tolist(), model.frame, strict=True))
    assert np.allclose(axes[11], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-12)
    assert np.allclose(axes[12], [[0, 1, 0], [0, 0, -1], [-1, 0, 0]], atol=1e-12)
    assert np.allclose(axes[13], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-12)
    assert np.allclose(axes[14][2], [1, 0, 0], atol=1e-12)


def test_default_frames_of_grids(read):
    """GRDSET supplies the systems that GRID leaves out."""
    model = read("GRDSET,,5,,,,5\nCORD2C,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n" + QUAD.replace("GRID,1,,", "GRID,1,0,"))
    assert model.frame_node.tolist() == [1, 2, 3, 4]


@pytest.mark.parametrize(
    ("section", "thickness", "offset", "doubt"),
    [
        ("PSHELL,1,1,2.,1,,1", 2.0, 0.0, ""),
        ("PSHELL,1,1,2.,-1", 2.0, 0.0, ""),
        ("PSHELL,1,1,2.", 2.0, 0.0, "materials of its own"),
        ("PSHELL,1,1,2.,1,30.,1", 2.0, 0.0, "30 of another section"),
        ("PCOMP,1\n,1,1.,0.,,1,,90.", 2.0, 0.0, "layered"),
        ("PCOMP,1,0.,,,,,,SYM\n,1,1.,0.,,1,2.,90.", 6.0, 3.0, "layered"),
        ("PCOMPG,1\n,1,1,.5\n,2,1,1.", 1.5, 0.0, "layered"),
        ("PCOMP,1\n,1,.5,0.,,,,90.\n,,,45.,,,,,YES", 2.0, 0.0, "layered"),  # an angle or a request alone is a ply
    ],
)
def test_sections(read, section, thickness, offset, doubt):
    """Thickness and mid-surface of plain, sandwich and layered properties."""
    model = read(QUAD.replace("PSHELL,1,1,2.,1,,1", section))
    assert (model.mesh.thickness[0], model.mesh.offset[0]) == (thickness, offset)
    assert doubt in model.unconfirmed_sections.get(1, "")
    assert bool(doubt) == (1 in model.unconfirmed_sections)


@pytest.mark.parametrize(
    ("card", "thickness", "offset", "doubtful"),
    [
        ("CQUAD4,1,1,1,2,3,4,,0.5", 2.0, 0.5, False),
        ("CQUAD4,1,1,1,2,3,4,,\n,,,3.,3.,3.,3.", 3.0, 0.0, False),
        ("CQUAD4,1,1,1,2,3,4,,\n,,1,.5,.5,.5,.5", 1.0, 0.0, False),
        ("CQUAD4,1,1,1,2,3,4,,\n,,,3.,5.,3.,5.", 4.0, 0.0, True),
        ("CTRIA3,1,1,1,2,3,,-.25,\n,,,3.,3.,3.", 3.0, -0.25, False),
        ("CTRIA6,1,1,1,2,3,,,\n,,0.1,4.,4.,4.", 4.0, 0.1, False),
        ("CQUAD8,1,1,1,2,3,4,,\n,,,4.,4.,4.,4.,,.2", 4.0, 0.2, False),
        ("CTRIAR,1,1,1,2,3", 2.0, 0.0, False),
    ],
)
def test_shells_with_their_own_thickness_and_offset(read, card, thickness, offset, doubtful):
    """Corner thicknesses, absolute or relative, and ZOFFS of every shell card."""
    model = read(PLATE + card + "\n")
    assert (model.mesh.thickness[0], model.mesh.offset[0]) == (pytest.approx(thickness), offset)
    assert (1 in model.unconfirmed_elements) == doubtful


def test_missing_property_is_a_doubt(read):
    """A shell without PSHELL has no thickness, and says why."""
    model = read(QUAD.replace("PSHELL,1,", "PSHELL,2,"))
    assert np.isnan(model.mesh.thickness[0])
    assert "not a PSHELL" in model.unconfirmed_sections[1]


def test_sets_and_markers(read):
    """SETs of case control with ranges and exceptions, SET1, PLOTEL and bars."""
    model = read(
        "SOL 103\nCEND\nSET 1 = 1 THRU 3, 9\nSET 2 = ALL\nSET 3 = 1 THRU 6 EXCEPT 4,\n 5, 8\nBEGIN BULK\n"
        + QUAD
        + "SET1,4,1,THRU,3\nPLOTEL,5,1,2,,6,2,3\nCBAR,7,9,3,4\nCBUSH,8,9,1,2\n"
    )
    assert {key: ids.tolist() for key, ids in model.node_sets.items()} == {
        1: [1, 2, 3, 9],
        3: [1, 2, 3, 6, 8],
        4: [1, 2, 3],
    }
    assert {key: pairs.tolist() for key, pairs in model.marker_edges.items()} == {
        "PLOTEL": [[1, 2], [2, 3]],
        "CBAR": [[3, 4]],
    }
    assert model.other_cards == {"CBAR": 1, "CBUSH": 1}


@pytest.mark.parametrize(
    ("card", "count"),
    [
        ("GRID,1,,0.,0.,0.\n", 1),
        ("GRID,2,0,+1.0,,\n", 1),
        ("GRID*,3,0,1.D0,10.-1\n*,\n", 1),
        ("CQUAD4         1       1       1       2       3       4\nGRID,4,,0.,1.,0.\n", 2),
        ("PSHELL,1,1,2.0,1,,1\n", 1),
        ("CORD2R,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,5,0,,,,,,1.\n,1.\n", 1),
        ("GRID,9,,.333333,0.,0.\nGRID,9,,0.3333333333,0.,0.\n", 1),
    ],
)
def test_the_same_card_twice(read, card, count):
    """Equal content, in whatever form, is taken once, and a warning counts it."""
    (warning,) = read(QUAD + card).warnings
    assert (warning.code, warning.count) == ("twice", count)


def test_blank_systems_of_a_grid_written_twice_are_those_of_grdset(read):
    """A GRDSET anywhere in the deck makes a blank CP other than 0."""
    text = QUAD + "CORD2R,5,,1.,0.,0.,1.,0.,1.\n,2.,0.,0.\nGRID,2,5,1.,0.,0.\n"
    with pytest.raises(DataError, match="grid 2 is already defined"):
        read(text)
    assert read(text + "GRDSET,,5\n").warnings[0].code == "twice"


@pytest.mark.parametrize("x", ["1.4", "1.000001", "1.00001-0", "0.9", ""])
def test_a_grid_elsewhere_is_another(read, x):
    """A short number is exact: nothing near it is the same grid."""
    with pytest.raises(DataError, match=r"grid 2 is already defined at .*line 2"):
        read(QUAD + f"GRID,2,,{x},0.,0.\n")


def test_the_finer_of_two_equal_grids_is_taken(read):
    """Small and large fields hold different numbers of digits of one coordinate; the order does not matter."""
    cards = ["GRID,9,,1234.568,0.,0.\n", "GRID,9,,1234.5678,0.,0.\n"]
    for text in (QUAD + "".join(cards), QUAD + "".join(cards[::-1])):
        mesh = read(text).mesh
        assert mesh.xyz[mesh.node == 9].tolist() == [[1234.5678, 0.0, 0.0]]


def test_cards_nobody_needs_are_counted(read):
    """Whatever stands on them is no reason to refuse: one warning gives name, number and first place of each."""
    model = read(
        QUAD + 'DEQATN  1       F(A,B)= A/B\nFORCE,1,x,,!!\n+,?\nforce   2\nQUAD4,7,1,1,2,3,4\nCBUSH,1,,"oops\nRBE2,5\n'
        "CBAR,77,1,1\nSET1,oops,1,2\nPLOTEL,8,a,b\nSPOINT,7,THRU,9\n"
    )
    assert model.other_cards == {"CBAR": 1, "CBUSH": 1, "RBE2": 1}
    assert [warning.code for warning in model.warnings] == ["no_mark", "no_set", "no_mark", "cards_left_out"]
    warning = model.warnings[-1]
    assert warning.count == 7
    for words in (
        "1 DEQATN (line 7)",
        "2 FORCE (line 8)",
        "1 QUAD4 (line 11)",
        "1 RBE2 (line 13)",
        "1 SPOINT (line 17)",
    ):
        assert words in warning.what


def test_shells_that_are_not_read_are_told(read):
    """Elements of other kinds and misspelt names beside plates: no weld is found at them."""
    model = read(QUAD + "CQUAD2,7,1,1,2,3,4\nCQUAD44,8,1,1,2,3,4\nCSHEAR,9,1,1,2,3,4\nCSHEAR,10,1,1,2,3,4\nCBUSH,11\n")
    (warning,) = [r for r in model.warnings if r.code == "unread_shells"]
    assert warning.where.endswith("line 7")
    assert "not read: 1 CQUAD2, 1 CQUAD44, 2 CSHEAR; no weld" in warning.what


@pytest.mark.parametrize(
    ("section", "element", "offset"),
    [
        ("PSHELL,1,1,2.,1,,1\n+,1.,-1.,,,0.3", "", 0.3),
        ("PSHELL,1,1,2.,1,,1\n+,1.,-1.,,,TOP", "", -1.0),
        ("PSHELL,1,1,2.,1,,1\n+,,,,,Bottom", "", 1.0),
        ("PSHELL,1,1,2.,1,,1\n+,,,,,0.3", "0.2", 0.2),
        ("PSHELL,1,1,2.,1,,1\n+,,,,,0.3", "0.", 0.0),
        ("PSHELL,1,1,2.,1,,1", "BOTTOM", 1.0),
        ("PSHELL,1,1,2.,1,,1", "Top\n,,,4.,4.,4.,4.", -2.0),
        ("PCOMP,1,TOP\n,1,1.,0.,,1,2.,90.", "", -1.5),
        ("PCOMP,1,BOTTOM\n,1,1.,0.,,1,2.,90.", "", 1.5),
    ],
)
def test_offsets_of_optistruct(read, section, element, offset):
    """ZOFFS of PSHELL holds where the element gives none; TOP and BOTTOM name the face that lies on the grids."""
    model = read(PLATE.replace("PSHELL,1,1,2.,1,,1", section) + f"CQUAD4,1,1,1,2,3,4,,{element}\n")
    assert model.mesh.offset[0] == offset


def test_a_thickness_of_zero_is_one_left_blank(read):
    """Its elements may give their own; one that does not has no thickness."""
    model = read(
        PLATE.replace("PSHELL,1,1,2.,", "PSHELL,1,1,0.,")
        + "CQUAD4,1,1,1,2,3,4,,,\n,,,3.,3.,3.,3.\nCQUAD4,2,1,1,2,3,4\n"
    )
    assert model.mesh.thickness[0] == 3.0
    assert np.isnan(model.mesh.thickness[1])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (PLATE, "no shell elements .*: 4 grids, no element at all"),
        (PLATE + "CQAUD4,1,1,1,2,3,4\nCBAR,2,1,1,2\nCBAR,3,1,2,3\n", "4 grids, 2 CBAR, 1 CQAUD4. Give the bulk data"),
        (QUAD + "CQUAD4,1,1,2,3,4,1\n", "used twice, the first time at .*line 6"),
        (QUAD + "CTRIA3,1,1,1,2,3\n", "used twice"),
        (PLATE + "CQUAD4,1,1,1,2,3,9\n", "grid 9 does not exist"),
        (PLATE + "CQUAD4,1,1,1,2,3,3\n", "a grid is used twice"),
        (QUAD + "GRID,1,,5.,0.,0.\n", "grid 1 is already defined"),
        (QUAD + "GRID,9,,x,0.,0.\n", "field 4 is 'X', not a number"),
        (QUAD + "GRID,9,,1_0.,0.,0.\n", "not a number of sensible size"),
        (QUAD + "GRID,9,,1e999,0.,0.\n", "sensible size"),
        (QUAD + "GRID,,,0.,0.,0.\n", "field 2 is empty"),
        (QUAD + "GRID,0,,0.,0.,0.\n", "line 7: GRID field 2 is '0', not a whole number above 0"),
        (QUAD + "CTRIA3,-4,1,1,2,3\n", "CTRIA3 field 2 is '-4', not a whole number above 0"),
        (QUAD + "GRID,9,4,0.,0.,0.\n", "coordinate system 4: it does not exist. Include the file"),
        (
            QUAD + "GRID,9,4,0.,0.,0.\nCORD3G,4,E313\n",
            "does not exist. Give it as CORD1 or CORD2; CORD3G cards are not read",
        ),
        (QUAD + "GRID,9,,0.,0.,0.,-1\n", "fluid point"),
        (QUAD + "GRID,9,,0.,0.,0.,,,5\n", "superelement 5"),
        (QUAD + "GRDSET,,,,,,,,5\n", "superelement 5"),
        (QUAD + "GRDSET,,0\nGRDSET,,,,,,0\n", "defaults of grids are already set"),
        (QUAD + "GRID,9,,0.,0.,0.,,,0,7.\n", "has 8 data fields, and a further one holds '7.'"),
        (QUAD + "CORD2R,5,,0.,0.,0.,0.,0.,1.,,1.,0.,0.\n", "has 11 data fields"),
        (QUAD + "GRID,9,,1.5,x\nGRID,10,,y\n", "'X'(.|\n)*'Y'"),
        ("SOL 103\nCEND\nBEGIN BULK\n" + QUAD + "BEGIN SUPER=1\n", "superelements"),
        (QUAD + "PSHELL,1,1,3.,1,,1\n", "property 1 is defined twice"),
        (QUAD + "PSHELL,2,1,-3.,1,,1\n", "thickness of property 2 is -3"),
        (QUAD + "CORD2R,5,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,9,5\n", "refers to itself"),
        (QUAD + "CORD2R,5,,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\nGRID,9,5\n", "lie on a line"),
        (QUAD + "CORD2R,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD1R,5,1,2,3\n", "defined twice"),
        (QUAD + "CORD1R,5,1,2,77\nGRID,9,5\n", "grid 77 of a coordinate system"),
        ("+,1,2\n" + QUAD, "continuation without a card"),
        (QUAD + "GRID    9" + " " * 63 + "+A\n+B      1\n", "follows a card that announces"),
        ("=,*1,=,*1.\n" + QUAD, "no card name"),
        (QUAD + "=,*1,=,*1.\n", "CQUAD4 field 4 is '2.0', not a whole number"),
        ("\0" + QUAD, "binary file"),
    ],
)
def test_refusals(read, text, words):
    """Every mistake is named with its place."""
    with pytest.raises(DataError, match=words):
        read(text)


def test_one_missing_system_is_one_problem(read):
    """Grids in a system whose own reference is missing all name that, and none calls it a loop."""
    cards = "CORD2R,5,4,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n" + "".join(f"GRID,{k},5\n" for k in range(10, 20))
    with pytest.raises(DataError) as error:
        read(QUAD + cards)
    assert [str(p).partition(", ")[2] for p in error.value.problems] == [
        "coordinate system 4: it does not exist. Include the file that defines it."
    ]


def test_all_mistakes_are_named(read):
    """Cards that cannot be read, points and shells are refused together, and the rest is counted."""
    with pytest.raises(DataError) as error:
        read("GRID,1,,x\nCQUAD4,1,1,1,2\nPSHELL,1,1,-2.\nCORD2R,x\n" + "".join(f"GRID,{k},7\n" for k in range(10, 14)))
    assert [p.code for p in error.value.problems] == [
        "bad_thickness",
        "bad_field",
        "bad_field",
        "no_frame",
        "bad_field",
    ]
    with pytest.raises(DataError, match="5 more problems follow"):
        read("".join(f"GRID,{k},,x\n" for k in range(15)))


def test_missing_file(tmp_path):
    """A missing file is named."""
    with pytest.raises(DataError, match=r"no\.bdf"):
        read_bdf(tmp_path / "no.bdf")


def test_damaged_text_is_refused_or_read(read):
    """Hundreds of damaged files give a model or a refusal, never a crash."""
    rng = random.Random(3)
    outcomes = set()
    for _ in range(300):
        text = list(QUAD)
        for _ in range(rng.choice([1, 3, 10])):
            text[rng.randrange(len(text))] = rng.choice("0123456789,.+-*$ \n\tEGRIDx'")
        try:
            outcomes.add(read("".join(text)).mesh.element.size)
        except DataError as error:
            outcomes.add(error.problems[0].code)
    assert len(outcomes) > 3
