"""Modal coordinates from text tables of any layout, as SIMPACK, ADAMS or RecurDyn export them, and from Parquet.

Encoding, separator, decimal sign, title lines, names and units are recognised. Columns find their mode by the last
number in their name (``q_12``, ``.FLEX.Q12``, ``$B_Car.q(12)``), or by a map of column to mode.
"""

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.types as pt

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.naming import composed
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.foreign.histories.header import Header, read_header
from fatigue.readers.foreign.histories.number_rows import find_rows
from fatigue.readers.foreign.histories.row_values import read_values
from fatigue.readers.foreign.histories.statements import (
    normalisation_in,
    stated_length,
    statement_problems,
)
from fatigue.readers.foreign.histories.table_history import Vectors, history_of_table, with_unit
from fatigue.readers.neutral.column_values import seconds_of
from fatigue.readers.neutral.files import open_columns
from fatigue.readers.text.encoding import read_head
from fatigue.readers.text.lines import text_lines, whole_cells
from fatigue.readers.units.channel_names import Channel, channel, without_unit_one


def read_text_history(
    path: Path, columns: Mapping[str, int] | None = None, time_column: str | None = None
) -> ForeignHistory:
    """Modal coordinates of a text table; time is converted to seconds by the unit in its header.

    Parameters
    ----------
    columns : mode number of each column to take; None: all columns, by the last number in their name
    time_column : name of the time column, or its position from 1; None: the column named time, t or zeit, or the first
        of a table without names

    Raises
    ------
    DataError
        unreadable, no table of numbers, a column that does not exist, a word among the numbers, no time or several that
        differ, statements of the header that disagree with each other or with the table
    """
    text, encoding, whole = read_head(path)
    lines = whole_cells(text_lines(text, whole=whole))
    rows = find_rows(path, lines)
    header = read_header(path, lines, rows)
    names = [c.name for c in header.channels]
    table, at = read_values(path, encoding, rows, header.cells, names)
    history = history_of_table(path, header, table, at, columns, time_column)
    refuse(DataError, statement_problems(path, header.free, rows.width, history.time))
    length = stated_length(header.free)
    return replace(history, normalisation=normalisation_in(path, header.free), length=length)


def read_parquet_history(
    path: Path, columns: Mapping[str, int] | None = None, time_column: str | None = None
) -> ForeignHistory:
    """Modal coordinates of a Parquet table, as ``read_text_history`` reads a text table.

    A column of durations is time, whatever their unit; dates are refused.
    """
    opened = open_columns(path, ())
    every = [name.strip() for name in opened.names]
    wanted = None if columns is None else {composed(name) for name in (*columns, time_column or "")}
    taken = [k for k, name in enumerate(every) if _is_wanted(name, opened.kinds[k], wanted)]
    if time_column is not None and time_column.isdecimal():
        taken = list(range(len(every)))  # its position counts all columns
    names = [every[k] for k in taken]
    stated = zip(without_unit_one(names), taken, strict=True)
    channels = [_with_type(path, channel(name), opened.kinds[k], opened.units[k]) for name, k in stated]
    table = np.column_stack([_numbers(path, every[k], opened.read(k)) for k in taken])
    if table.shape[1] < 2:
        raise DataError(Problem("bad_table", str(path), "the table has one column", "Export time and coordinates"))
    return history_of_table(path, Header((tuple(names),), tuple(channels), (), ()), table, None, columns, time_column)


def _is_wanted(name: str, kind: pa.DataType, wanted: Collection[str] | None) -> bool:
    """Whether a Parquet column is read: all are, but columns of no numbers that a map of columns does not name."""
    is_number = pt.is_integer(kind) or pt.is_floating(kind) or pt.is_decimal(kind) or pt.is_duration(kind)
    return is_number or wanted is None or composed(name) in wanted or channel(name).is_time


def _with_type(path: Path, own: Channel, kind: pa.DataType, unit: str) -> Channel:
    """Channel with what the type and the metadata of a Parquet column state."""
    where = f"{path}, column {own.name!r}"
    if pt.is_timestamp(kind) or pt.is_date(kind) or pt.is_time(kind):
        what = f"the column holds dates or times of day ({kind}), where seconds from the start of the run are needed"
        raise DataError(Problem("date_column", where, what, "Write seconds as numbers, or durations"))
    if pt.is_duration(kind):
        if own.mode:
            raise DataError(Problem("bad_table", where, "a modal coordinate is a duration", "Write numbers"))
        return replace(own, is_time=True, unit="s")
    return with_unit(where, own, unit)


def _numbers(path: Path, name: str, column: pa.ChunkedArray) -> Vectors:
    """Values of a Parquet column, durations in seconds."""
    if pt.is_duration(column.type):
        return seconds_of(column)
    if not (pt.is_integer(column.type) or pt.is_floating(column.type) or pt.is_decimal(column.type)):
        what = f"a column holds no numbers ({column.type})"
        remedy = "Write columns of numbers only, or name those to take by --columns"
        raise DataError(Problem("bad_table", f"{path}, column {name!r}", what, remedy))
    return np.asarray(column.to_numpy()).astype(np.float64)
