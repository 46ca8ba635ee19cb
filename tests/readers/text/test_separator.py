"""The sign that divides the cells of a table."""

from pathlib import Path

import pytest

from fatigue.errors import DataError
from fatigue.readers.text.separator import cell_count, declared_separator, separator_of


@pytest.mark.parametrize(
    ("line", "rows", "separator"),
    [
        ("a;b", ["1,5;2,5"], ";"),
        ("a, unit;b, unit", ["1,5;2,5", "1;2"], ";"),  # commas divide too, but the rows otherwise than the names
        ("a  b", ["1 2", "3   4"], None),
        ("a b", ["1 2 3"], ","),  # one column whose name has a blank
        ("a", ["1"], ","),
    ],
)
def test_names_and_rows_alike(line, rows, separator):
    """The sign that divides the names and most rows into as many cells."""
    assert separator_of(Path("t.csv"), 0, line, rows, None) == separator


def test_a_declared_separator():
    """It counts, unless the names are divided by another one."""
    assert declared_separator('"sep=;"') == ";"
    assert declared_separator("separator;x") is None
    assert separator_of(Path("t.csv"), 1, "a|b,c", [], "|") == "|"
    with pytest.raises(DataError, match=r"t\.csv: line 2: the file declares sep=;, and .* separated by ','"):
        separator_of(Path("t.csv"), 1, "a,b", [], ";")


def test_empty_cells_count():
    """Also at the end of a line, and not within quotation marks."""
    assert cell_count('"a,b",,', ",") == 3
