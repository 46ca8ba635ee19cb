"""Node sets of case control and of bulk data."""

import pytest

from fatigue.readers.foreign.nastran.deck.card import Card
from fatigue.readers.foreign.nastran.deck.sets import case_sets, joined_sets, set_members, set_on_card


def sets(text: str) -> dict[int, list[int]]:
    """SETs of some lines of case control."""
    return case_sets([("a", n, line) for n, line in enumerate(text.split("\n"), 1)])[0]


@pytest.mark.parametrize(
    ("words", "members"),
    [
        ("1 THRU X", None),
        ("THRU 4", None),
        ("1 THRU 999999999", None),
        ("7 THRU 3", None),
        ("1 THRU 9 BY 0", None),
        ("7 EXCEPT 7", [7, 7]),
        ("1 THRU 6 EXCEPT 4 5 8", [1, 2, 3, 6, 8]),
        ("1 THRU 10 EXCEPT 3 THRU 5 20", [1, 2, 6, 7, 8, 9, 10, 20]),
        ("1 THRU 6 EXCEPT 2 ENDTHRU 2 30", [1, 3, 4, 5, 6, 2, 30]),
        ("20 THRU 30 BY 5 EXCEPT 25", [20, 30]),
        ("29 32 THRU 34 61 THRU 63", [29, 32, 33, 34, 61, 62, 63]),
        ("ALL", None),
    ],
)
def test_set_expressions(words, members):
    """Ranges with steps and exceptions; words that are no integer sets give none."""
    assert set_members(words.split()) == members


def test_sets_of_case_control():
    """Continued lines, any case and spacing; a set that subcases define differently is a warning and the last holds."""
    assert sets("SET A = 1\nSET 2 = 5") == {2: [5]}
    assert sets("set 3=1,2,\n  5 thru 7,\n 9\nDISP = 3") == {3: [1, 2, 5, 6, 7, 9]}
    lines = [("a", 1, "SET 5 = 1, 2"), ("a", 2, "SET 5 = 2,1"), ("a", 9, "SET 5 = 3,"), ("a", 10, "4")]
    found, warnings = case_sets(lines)
    assert found == {5: [3, 4]}
    assert [(r.where, r.code) for r in warnings] == [("a, line 9", "set_twice")]


def test_sets_of_both_sections():
    """Case control wins over bulk data, and a difference is told."""
    found, warnings = joined_sets({1: [1], 2: [2, 3]}, [("a", 1, "SET 2 = 2,3"), ("a", 2, "SET 1 = 5")])
    assert found == {1: [5], 2: [2, 3]}
    assert [r.where for r in warnings] == ["a, case control"]


@pytest.mark.parametrize(
    ("name", "fields", "expected", "codes"),
    [
        ("SET1", "4 1 THRU 3 - 8", {4: [1, 2, 3, 8]}, []),
        ("SET3", "33 GRID 20 THRU 22", {33: [20, 21, 22]}, []),
        ("SET3", "33 ELEM 20 THRU 22", {}, []),
        ("SET", "56 GRID LIST - - - - - 88 93 17 THRU 19", {56: [88, 93, 17, 18, 19]}, []),
        ("SET", "56 ELEM LIST - - - - - 88 93", {}, []),
        ("SET1", "4 ALL", {}, ["no_set"]),
        ("SET1", "NAME 1 2", {}, ["no_set"]),
        ("SET1", "7 1 2", {7: [1, 2]}, ["set_twice"]),
    ],
)
def test_sets_of_bulk_data(name, fields, expected, codes):
    """SET1, SET3 and SET of OptiStruct; a set nobody can read is a warning and no refusal."""
    known = {7: [5]} if expected == {7: [1, 2]} else {}
    card = Card(name, tuple(word.replace("-", "") for word in fields.split()), "a", 3)
    assert [warning.code for warning in set_on_card(known, card)] == codes
    assert known == expected
