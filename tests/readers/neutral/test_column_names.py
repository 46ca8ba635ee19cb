"""Names of columns: twice, missing, unknown, or none."""

import pyarrow as pa
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.column_names import missing_columns, nameless_columns, positions_of, unknown_columns
from fatigue.readers.neutral.columns import Columns


def columns(**values: list) -> Columns:
    """Columns in memory."""
    table = pa.table(values)
    return Columns(tuple(table.column_names), tuple(table.schema.types), table.num_rows, table.column)


def test_positions_by_trimmed_name():
    """Blanks are none of a name, and a column without a name has no position."""
    assert positions_of("t.csv", columns(**{" mode ": [1], "": [2], "node": [3]})) == {"mode": 0, "node": 2}
    with pytest.raises(DataError, match=r"t\.csv: column mode: the column appears twice"):
        positions_of("t.csv", columns(**{"mode": [1], "mode ": [2]}))


def test_missing_columns():
    """Each is named with the columns that are there."""
    (problem,) = missing_columns("t.csv", ("node",), ("node", "mode"))
    assert str(problem) == "t.csv: column mode: the column is missing. Add it; the columns are node."


def test_unknown_columns():
    """A near name that is not taken is what was meant; a taken one is not."""
    known = ("frequency_hz", "kind")
    assert [p.remedy for p in unknown_columns("", ("frequenzy_hz",), known)] == ["Rename it to 'frequency_hz'"]
    assert [p.remedy for p in unknown_columns("", ("frequency_hz", "frequenzy_hz"), known)] == ["Remove it"]


def test_nameless_columns():
    """One that holds blanks only is nothing, another one is told with its position and first value."""
    assert list(nameless_columns("t.csv", columns(**{"a": [1], " ": [" "]}))) == []
    (problem,) = nameless_columns("t.csv", columns(**{"a": [1, 2], " ": [None, "x"]}))
    assert str(problem).startswith("t.csv: column 2: the column has no name and is not read, it holds 'x'")
