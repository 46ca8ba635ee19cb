"""Replicated cards."""

import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.deck.replication import repeats, replicated

GRID = ["GRID", "1", "", "0.", "10."]


def test_fields_taken_and_added_to():
    """``=`` takes, ``*(x)`` adds in whole or real numbers, ``==`` takes all that follows."""
    assert replicated(GRID, ["=", "*(2)", "=", "*(-1.5)", "=="], "") == ["GRID", "3", "", "-1.5", "10."]
    assert replicated(GRID, ["=", "*2", "7", "="], "") == ["GRID", "3", "7", "0."]


@pytest.mark.parametrize(
    ("before", "word", "what"),
    [(GRID, "%5", "'%5' is not known here"), (GRID, "*x", "'x' cannot be added"), (GRID * 2, "=", "several lines")],
)
def test_what_cannot_be_replicated(before, word, what):
    """It is refused with the reason."""
    with pytest.raises(DataError, match=rf"deck, line 3: .*{what}"):
        replicated(before, [word], "deck, line 3")


def test_repetitions():
    """A number behind the sign, in brackets or not; none of the sign alone."""
    assert [repeats(head) for head in ("=(4)", "=12", "=", "==")] == [4, 12, None, None]
