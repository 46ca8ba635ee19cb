"""Lines of bulk data in fields."""

import pytest

from fatigue.readers.foreign.nastran.deck.fields import split_line


@pytest.mark.parametrize(
    ("line", "data", "mark", "width"),
    [
        ("GRID           1       0      1.      2.", ["1", "0", "1.", "2."], "", 8),
        ("GRID*                  1               0", ["1", "0"], "", 4),
        ("GRID,1,,1.,2.", ["1", "", "1.", "2."], "", 8),
        ("GRID*,1,,1.,2.,*A", ["1", "", "1.", "2."], "*A", 4),
        ("GRID    ".ljust(72) + "+ab", [""] * 8, "+AB", 8),
    ],
)
def test_forms(line, data, mark, width):
    """Small, large and free fields, with the mark of field 10."""
    found = split_line(line)
    assert ([*found.data], found.mark, found.width) == (data, mark, width)


def test_text_behind_the_data():
    """Text in field 10 that is no mark is told, not read."""
    assert split_line("GRID           1".ljust(72) + "note").unread == "note"


def test_marks_between_two_lines():
    """A mark and its continuation within one line of commas are neither data."""
    found = split_line("SET1,1,2,3,4,5,6,7,8,+A,+A,9")
    assert found.data == [*"123456789"]


def test_a_number_in_the_place_of_the_mark():
    """It may be data, which only the next line tells."""
    assert split_line("X,1,2,3,4,5,6,7,8,+1.").unsure == "+1."
