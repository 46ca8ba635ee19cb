"""Lines to cards: all forms of fields give the same model, and nothing is lost on the way."""

import random
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.foreign.nastran.deck.card import Card
from fatigue.readers.foreign.nastran.deck.cards import cards
from fatigue.readers.foreign.nastran.deck.notes import LeftOut
from tests.readers.bdf_writer import FORMS, Fields, spelling, write


def split(text: str, *wanted: str) -> tuple[list[Card], LeftOut, list[str]]:
    """Cards of a text, those left out, and the codes of what is wrong."""
    left_out, problems = LeftOut(), []
    lines = [("a", n, line.rstrip()) for n, line in enumerate(text.split("\n"), 1) if line.rstrip()]
    found = list(cards(lines, wanted or ("GRID", "SPC1", "CHEXA", "MATT9", "CORD2R"), left_out, problems))
    return found, left_out, [problem.code for problem in problems]


def fields(text: str) -> list[str]:
    """Data fields of the only card, without the empty ones at its end."""
    (card,), _, problems = split(text)
    assert not problems
    return " ".join(word or "-" for word in card.fields).rstrip("- ").split()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("SPC1,100,12456,1,2,3,4,5,6,7,8,9,10", "100 12456 1 2 3 4 5 6 7 8 9 10"),
        ("SPC1,100,12456,1,2,3,4,5,6,+SPC-A\n+SPC-A,7,8,9,10", "100 12456 1 2 3 4 5 6 7 8 9 10"),
        ("SPC1,100,12456,1,2,3,4,5,6,+A,+A,7,8,9,10", "100 12456 1 2 3 4 5 6 7 8 9 10"),
        ("SPC1,100,12456,1,2,3,4,5,6,+,,7,8,9,10", "100 12456 1 2 3 4 5 6 7 8 9 10"),
        ("MATT9,1101,2 ,3 ,4 ,,,,8 ,+P101\n+P101,9 ,,,,13", "1101 2 3 4 - - - 8 9 - - - 13"),
        ("MATT9,1151,2 ,3 ,4 ,,,,8\n,9 ,,,,13", "1151 2 3 4 - - - 8 9 - - - 13"),
        (
            "CHEXA,20,30,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,\n17,18, 19,20",
            "20 30 " + " ".join(map(str, range(1, 21))),
        ),
        ("SPC1,1,12,3,\n4,\n5", "1 12 3 4 5"),
        ("SPC1,1,12,3,\nTHRU,\n5", "1 12 3 THRU 5"),
        ("SPC1,1,12,3,\n,4", "1 12 3 - - - - - 4"),
        ("SPC1,1,12,3,+\n+,4", "1 12 3 - - - - - 4"),
        ("SPC1,1,12,3,4,5,6,7,8,9,10,11\n,12", "1 12 3 4 5 6 7 8 9 10 11 - - - - - 12"),
        ("CORD2R,1,0,0.,0.,0.,0.,0.,1.,+1.,0.,0.", "1 0 0. 0. 0. 0. 0. 1. +1. 0. 0."),
        ("CORD2R,1,0,0.,0.,0.,0.,0.,1.,+1.", "1 0 0. 0. 0. 0. 0. 1. +1."),
        ("CORD2R,1,0,0.,0.,0.,0.,0.,1.,+1.\n+1.,1.", "1 0 0. 0. 0. 0. 0. 1. 1."),
        ("CORD2R,1,0,0.,0.,0.,0.,0.,1.,+1\n+1,1.", "1 0 0. 0. 0. 0. 0. 1. 1."),
        ("CORD2R  1" + 47 * " " + "1." + 14 * " " + "CORD1\n+ORD1   1.", "1 - - - - - 1. - 1."),
        ("CORD2R* 1\n*\n*       7", "1 - - - - - - - 7"),
        ("GRID*,9,,1.,2.,3.", "9 - 1. 2. 3."),
        ("GRID*,9,,1.,2.,*A,*A,3.", "9 - 1. 2. 3."),
        ("GRID*   9\n*\n+       7", "9 - - - - - - - 7"),
        ("GRID  ,9,  ,  1.  ,", "9 - 1."),
        ("GRID    9\tx", "9 x"),
    ],
)
def test_where_a_line_goes_on(text, expected):
    """Field 10, long comma lines, commas at the end, marks within a line, blank lines of large fields."""
    assert fields(text) == expected.split()


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        ("+A,1", ["stray_line"]),
        ("GRID,1,,,,,,,,+A\n+B,1", ["continuation_order"]),
        ("GRID,1,,,,,,,,+A\nGRID,2,,,,,,,,+A\nMAT1,3\n+A,1\nMAT1,4\n+A,1", ["continuation_twice"]),
        ("GRID*,1,,2.,3.\n+,4.", ["half_line"]),
        ("GRID 1     2.", ["bad_card"]),
        ("GRID,1\n1.0,2.0", ["bad_card"]),
        ("GRID,1\n=3", ["replication"]),
        ("GRID,1,x\n=,*1,*1", ["replication"]),
        ("GRID,1,1.\n=,*1,*1", []),
        ("GRID,1,1.\n=,*1,%2.", ["replication"]),
        ("CHEXA,1,2,3,4,5,6,7,8\n,9,10\n=,*1,==", ["replication"]),
        ("CHEXA,1,2,3,4,5,6,7,8,+A\n=,*1,==\n+A,9", ["replication"]),
        ("=,*1,=", ["bad_card"]),
        ("MAT1,1\n=,*1,=,*1.\n=3", []),
        ("MAT1,1\n??,\n+Z,3\nPARAM POST -1\nINP= 5", []),
        ("MAT1,1,+A\n+B,1", []),
    ],
)
def test_lines_that_belong_to_nothing(text, codes):
    """What may have held data of a card that is needed is refused; of others it is not."""
    assert split(text)[2] == codes


def test_a_comma_after_column_ten_does_not_make_a_line_free():
    """Formulas and names may hold commas; such a card is counted like any other that is not needed."""
    found, left_out, problems = split(
        "DEQATN  1       F(A,B)= A/B\n        + SIN(A,B)\nDRESP2  9       D,E     1\nGRID    1       ,1.\n"
    )
    assert (left_out.count, left_out.first["DRESP2"], problems) == ({"DEQATN": 1, "DRESP2": 1}, "a, line 3", [])
    with pytest.raises(DataError, match="only a comma in the first 10 columns"):
        found[0].real(1)


def test_continuations_in_any_order():
    """Named continuations stand before their card, far behind it, and in a chain; others follow their line."""
    (chexa, grid), _, problems = split(
        "MAT1,1\nCHEXA,1,2,3,4,5,6,7,8,+C\nGRID,1,,,,,,,,+G\nMAT1,2,,,,,,,,+M\n"
        "+D,17,18\n,25\n+C,9,10,,,,,,,+D\n+G,9\n+M,1.\n"
    )
    assert not problems
    assert (chexa.name, chexa.text(8), chexa.text(9), chexa.text(16), chexa.text(24)) == (
        "CHEXA",
        "9",
        "10",
        "17",
        "25",
    )
    assert (grid.name, grid.text(8)) == ("GRID", "9")


def test_replicated_cards():
    """The manual's example in free and in fixed fields, with the increments of whole and of real numbers."""
    free = "GRID, 101, 17, 1.0, 10.5,,17,3456\n=,*1,=,*0.2, *(0.1), ==\n=3\nMAT1,1\n=,*1\n=(4)\n"
    fixed = (
        "GRID         101      17     1.0    10.5              17    3456\n"
        "=             *1       =    *0.2  *(0.1)      ==\n=(3)\n"
    )
    for text in (free, fixed):
        found, _, problems = split(text)
        assert not problems
        assert [card.integer(0) for card in found] == [101, 102, 103, 104, 105]
        assert [card.real(2) for card in found] == pytest.approx([1.0, 1.2, 1.4, 1.6, 1.8])
        assert [card.real(3) for card in found] == pytest.approx([10.5, 10.6, 10.7, 10.8, 10.9])
        assert {card.fields[4:] for card in found} == {("", "17", "3456")}
    assert split(free)[1].count == {"MAT1": 6}
    (_, second), _, _ = split("GRID,1,,3.,4.\n=,*1,=,,*-1.5-1")
    assert (second.integer(0), second.text(2), second.real(3)) == (2, "", 3.85)


def test_text_behind_the_fields_is_counted():
    """Sequence numbers, and data that slipped behind column 72, are not read; marks of all kinds are no such text."""
    row = "GRID           1              1.      2.      3.".ljust(72)
    _, left_out, _ = split(
        f"{row}0000001\n{row}+A      5.\n+A      \n{row}OLD\n+LD     \n{row}+B\n+B\n{row}\nMAT1".ljust(90) + "7"
    )
    assert (left_out.unread, left_out.first_unread) == (2, "a, line 1")


def random_model(rng: random.Random) -> list[Fields]:
    """Grids in nested systems, shells with thicknesses of their own, sections, sets and markers."""

    def real() -> str:
        return spelling(rng, rng.choice((-1, 1)) * rng.randrange(1, 10_000) / 100)

    found: list[Fields] = [
        ("CORD2R", ["5", rng.choice(("", "0")), *(spelling(rng, v) for v in (0.5, 2, 0, 0.5, 2, 3, 1.5, 2, 0))]),
        ("CORD2C", ["6", "5", "", "", "", "", "", "1.", "1.", "", ""]),
        ("PSHELL", ["1", "7", spelling(rng, 2.5), "7", "", "7", "", spelling(rng, 1.5), real()]),
        ("PSHELL", ["2", "7", "", "-1"]),
        ("PCOMP", ["3", real(), "", "", "", "", "", "SYM", "1", "1.5", "0.", "", "1", "", "90."]),
        ("SET1", ["9", "1", "THRU", "4", "7", "8", "12", "15", "16", "17", "20"]),
        ("PLOTEL", ["1001", "1", "2", "", "1002", "2", "3"]),
    ]
    grids = rng.sample(range(1, 90_000), 24)
    for grid in grids:
        found.append(
            ("GRID", [str(grid), rng.choice(("", "0", "5", "6")), real(), real(), real(), rng.choice(("", "6"))])
        )
    for element in range(1, 15):
        name = rng.choice(("CQUAD4", "CTRIA3", "CQUADR", "CTRIAR", "CQUAD8", "CTRIA6"))
        corners = 4 if "Q" in name else 3
        used = [str(g) for g in rng.sample(grids, 2 * corners)]
        thickness = [spelling(rng, rng.randrange(1, 500) / 100) for _ in range(corners)]
        head = [str(element), rng.choice("123")]
        if name == "CQUAD8":
            data = [*head, *used[:6], used[6], "", *thickness, "", real()]
        elif name == "CTRIA6":
            data = [*head, *used, "", real(), *thickness]
        else:
            own = rng.choice((thickness, [], [thickness[0]]))
            data = [
                *head,
                *used[:corners],
                "45.",
                real(),
                *([""] if corners == 3 else []),
                "",
                rng.choice(("", "0")),
                *own,
            ]
        found.append((name, data))
    rng.shuffle(found)
    return found


def same(a: FeModel, b: FeModel) -> bool:
    """Whether two models are equal to the last bit."""
    pairs = [(getattr(a.mesh, name), getattr(b.mesh, name)) for name in a.mesh.__dataclass_fields__]
    pairs += [(a.frame_node, b.frame_node), (a.frame, b.frame), (a.node_sets[9], b.node_sets[9])]
    pairs += [(a.marker_edges["PLOTEL"], b.marker_edges["PLOTEL"])]
    texts = all(getattr(a, name) == getattr(b, name) for name in ("unconfirmed_sections", "unconfirmed_elements"))
    return texts and all(np.array_equal(x, y, equal_nan=x.dtype.kind == "f") for x, y in pairs)


def test_every_form_gives_the_same_model(tmp_path):
    """Random models, each in small, large, free, long, flowing and mixed fields, continuations near and far."""
    path = tmp_path / "a.bdf"
    for seed in range(40):
        rng = random.Random(seed)
        model = random_model(rng)
        models = []
        for form in (*FORMS, None, None, None):
            path.write_text(write(rng, model, form))
            models.append(read_bdf(path))
        assert models[0].mesh.element.tolist() == list(range(1, 15))
        assert all(same(models[0], other) for other in models[1:]), seed


def test_the_model_is_the_one_written(tmp_path):
    """Every number of a random deck comes back: positions in basic components, thickness, offset, ids."""
    path = tmp_path / "a.bdf"
    for seed in range(20):
        rng = random.Random(1000 + seed)
        xyz = {g: [rng.randrange(-9999, 9999) / 100 for _ in range(3)] for g in rng.sample(range(1, 9999), 12)}
        quads = {e: (rng.sample(list(xyz), 4), rng.randrange(1, 900) / 100) for e in rng.sample(range(1, 9999), 9)}
        deck = [("PSHELL", ["4", "1", "2.25", "1"])]
        deck += [("GRID", [str(g), "", *(spelling(rng, v) for v in point)]) for g, point in xyz.items()]
        deck += [
            ("CQUAD4", [str(e), "4", *map(str, used), "", spelling(rng, t / 4), "", "", *[spelling(rng, t)] * 4])
            for e, (used, t) in quads.items()
        ]
        path.write_text(write(rng, deck))
        mesh = read_bdf(path).mesh
        assert np.allclose(mesh.xyz, [xyz[n] for n in mesh.node.tolist()], rtol=0, atol=1e-9)
        for row, element in enumerate(mesh.element.tolist()):
            used, t = quads[element]
            assert mesh.node[mesh.corner[row]].tolist() == used
            assert mesh.thickness[row] == pytest.approx(t)
            assert mesh.offset[row] == pytest.approx(t / 4)


def test_a_damaged_field_never_changes_the_model_silently(tmp_path):
    """A field that is removed, doubled or shifted in a deck of known content changes the model or is refused."""
    path = tmp_path / "a.bdf"
    outcomes = set()
    for seed in range(150):
        rng = random.Random(seed)
        lines = write(random.Random(5), random_model(random.Random(5)), "free").split("\n")
        path.write_text("\n".join(lines))
        before = read_bdf(path)
        at = rng.choice([k for k, line in enumerate(lines) if line[:4] in ("GRID", "grid")])
        parts = lines[at].split(",")
        spot = rng.randrange(1, 5)
        parts = rng.choice((parts[:spot] + parts[spot + 1 :], [*parts[:spot], "77.", *parts[spot:]]))
        lines[at] = ",".join(parts)
        path.write_text("\n".join(lines))
        try:
            outcomes.add("same" if same(before, read_bdf(path)) else "other")
        except DataError as error:
            outcomes.add(error.problems[0].code)
    assert "same" not in outcomes
    assert len(outcomes) > 1


def test_genuine_decks():
    """Solvers read a long comma line, blank reals, commas at the end and a formula; a note counts what is left out."""
    folder = Path("tests/data/nastran")
    long = read_bdf(folder / "cord2c_long_free_line.bdf")
    assert long.mesh.element.size == 12
    polar = read_bdf(folder / "cord2c_blank_reals.dat")
    assert polar.mesh.xyz[polar.mesh.node == 10706] == pytest.approx(np.array([[0, 5, 0]]), abs=1e-12)
    assert polar.frame_node.size == 50
    surface = read_bdf(folder / "bsurf_trailing_comma.bdf")
    assert (surface.mesh.element.size, surface.solids.element.size, surface.other_cards) == (414, 1137, {})
    assert "2 BSURF (line 2494)" in surface.warnings[-1].what
    formula = read_bdf(folder / "deqatn.bdf")
    assert formula.mesh.element.size == 28
    assert "1 DEQATN (line 75)" in formula.warnings[-1].what
    assert formula.warnings[-1].count == 64
