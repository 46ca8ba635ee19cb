"""Names that look alike and count as different."""

import unicodedata

import pytest

from fatigue.files.look_alike import name_warnings, skeleton

ALIKE = [
    ("Weld A", "weld a"),
    ("Weld A", "Weld\u00a0A"),
    ("Weld A", "Weld  A"),
    ("Weld A", "Weld\u2009A"),
    ("Weld A", "W\u0435ld A"),  # Cyrillic e
    ("K1", "\u041a1"),  # Cyrillic Ka
    ("Nu", "\u039du"),  # Greek Nu
    ("rho", "rh\u03bf"),
    ("seam", "sea\u200bm"),
    ("seam", "seam\u200e"),
    ("seam", "seam\ufe0f"),
    ("W-1", "W\u20131"),
    ("W-1", "W\u2011\u0031"),
    ("W1", "\uff371"),  # full width
    ("Träger", "TRÄGER"),
    ("straße", "STRASSE"),
    ("x" * 3000 + "A" + "y" * 2000, "x" * 3000 + "a" + "y" * 2000),
]


@pytest.mark.parametrize(("one", "other"), ALIKE)
def test_look_alikes_are_told_with_what_differs(one, other):
    """One warning, in ASCII, short, in which the two names are not the same."""
    (problem,) = [p for p in name_warnings("welds.csv: column weld", [one, "bracket", other], "welds")
                  if p.code == "similar_names"]  # fmt: skip
    assert problem.count == 1
    assert problem.what.isascii()
    assert len(problem.what) < 250
    first, second = problem.what.split(": ", 1)[1].split(" and ")[-2:]
    assert first != second


@pytest.mark.parametrize(
    "names",
    [
        ("W1", "W2", "W10", "W11"),
        ("W1", "WI", "Wl"),  # easily confused, and common
        ("A_1", "A-1", "A 1"),
        ("Träger", "Trager"),
        ("seam left", "seam right"),
        ("роспуск", "тележка"),  # Cyrillic names among themselves
        ("", "a"),
    ],
)
def test_other_names_pass(names):
    """Names that differ in a letter or a sign that is seen are no look-alikes."""
    assert name_warnings("", names, "welds") == []


def test_composed_and_decomposed_letters():
    """A letter and its accent apart look the same."""
    assert skeleton(unicodedata.normalize("NFD", "Träger")) == skeleton("Träger")


def test_many_groups_are_one_warning():
    """The first groups are named, the others counted."""
    (problem,) = name_warnings("", [name for i in range(50) for name in (f"w{i}", f"W{i}")], "welds")
    assert problem.count == 50
    assert "and 47 more such groups" in problem.what


def test_characters_that_are_not_seen():
    """A name that turns the text around is told, its character spelled out."""
    (problem,) = name_warnings("case.toml", ["A\u202eB", "C"], "events")
    assert problem.code == "unseen_character"
    assert r"'A\u202eB'" in problem.what
