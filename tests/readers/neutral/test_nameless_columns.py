"""Columns without a name, as spreadsheets and data frames write them."""

import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.forces.sorted_copy import sorted_copy
from fatigue.readers.neutral.forces.weld_codes import weld_codes
from fatigue.readers.neutral.tables import Table, open_table
from tests.readers import neutral_tables as neutral


def opened(tmp_path, text: str, *, strict: bool) -> Table:
    """A table of the columns a and b, c where present."""
    path = tmp_path / "t.csv"
    path.write_text(text, encoding="utf-8")
    table = open_table(path)
    table.expect(("a", "b"), ("c",), strict=strict)
    assert table.integers("a").tolist() == [1, 3]
    return table


@pytest.mark.parametrize(
    "text", ["a,b,,\n1,2,,\n3,4,,\n", "a,b,,c\n1,2,,5\n3,4,,6\n", ",a,b\n,1,2\n,3,4\n", "a,b, ,\n1,2, ,\n3,4,,\n"]
)
def test_empty_columns_are_nothing(tmp_path, text):
    """Empty cells behind, before and between the columns."""
    table = opened(tmp_path, text, strict=True)
    table.refuse()
    assert not table.warnings


@pytest.mark.parametrize(
    ("text", "where"),
    [
        (",a,b\n0,1,2\n1,3,4\n", "column 1: the column has no name and is not read, it holds '0'"),
        ("a,b,\n1,2,\n3,4,by hand\n", "column 3: the column has no name and is not read, it holds 'by hand'"),
    ],
)
def test_filled_columns_are_said(tmp_path, text, where):
    """An index or a note is not read in silence; where all is to be known it is refused."""
    assert [str(warning) for warning in opened(tmp_path, text, strict=False).warnings] == [
        f"t.csv: {where}. Give it a name, or remove it."
    ]
    with pytest.raises(DataError, match="has no name"):
        opened(tmp_path, text, strict=True).refuse()


def test_the_names_in_a_message_are_those_that_are_there(tmp_path):
    """A missing column is told with the named ones alone."""
    path = tmp_path / "t.csv"
    path.write_text("a,,\n1,,\n")
    with pytest.raises(DataError, match=r"Add it; the columns are a\.$"):
        open_table(path).expect(("a", "b"), (), strict=False)


@pytest.mark.parametrize("text", ["a,b\n1,2\n3,4\n,\n,\n", "a;b;;\n1;2;;\n ; ;;\n3;4;;\n;;;\n"])
def test_rows_of_empty_cells_are_no_rows(tmp_path, text):
    """Cells that once held something and were cleared; rows keep the numbers they have in the file."""
    table = opened(tmp_path, text, strict=True)
    table.refuse()
    assert table.row_name(1) == ("row 2" if text.startswith("a,b") else "row 3")


def test_rows_of_empty_cells_in_forces_that_are_sorted(tmp_path):
    """A table that is read in pieces has none either."""
    columns = neutral.nodal_forces()
    path = neutral.write(tmp_path / "f.csv", columns)
    path.write_text(path.read_text() + "," * (len(columns) - 1) + "\n")
    source = sorted_copy(path, weld_codes([("seam", "ring")]), tmp_path / "scratch")
    assert sum(source.rows) == len(columns["weld"])
