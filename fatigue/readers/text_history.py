"""Modal coordinates from text tables of any layout, as SIMPACK, ADAMS or RecurDyn export them.

Separator (comma, semicolon, tab, blanks), decimal comma, title lines and a line of units are recognised. Columns find
their mode by the last number in their name (``q_12``, ``.FLEX.Q12``, ``$B_Car.q(12)``), or by a map of column to mode.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.naming import composed
from fatigue.readers.files import open_columns
from fatigue.readers.foreign_history import ForeignHistory, check_values

Vectors = NDArray[np.float64]

_HEAD_LINES = 500
_SEPARATORS = ("\t", ";", ",", None)  # None: blanks
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[ED][+-]?\d+)?\Z", re.IGNORECASE | re.ASCII)
_NUMBER_COMMA = re.compile(r"[+-]?(?:\d+,?\d*|,\d+)(?:[ED][+-]?\d+)?\Z", re.IGNORECASE | re.ASCII)
_TIME = re.compile(r"(time|t|zeit)\b", re.IGNORECASE)
_FREQUENCY = re.compile(r"([\d.]+(?:E[+-]?\d+)?)\s*Hz", re.IGNORECASE | re.ASCII)
_UNIT = re.compile(r"\[[^\]]*[^\W\d_][^\]]*\]")


@dataclass(frozen=True, slots=True)
class _Layout:
    """Where the numbers begin and how they are written."""

    first_row: int
    separator: str | None
    decimal: str
    names: tuple[str, ...]


def read_text_history(
    path: Path, columns: Mapping[str, int] | None = None, time_column: str | None = None
) -> ForeignHistory:
    """Read a table of time and modal coordinates.

    Parameters
    ----------
    columns : mode number of each column to take; None: all columns, by the last number in their name
    time_column : name of the time column; None: the column named time or t, else the first

    Raises
    ------
    DataError : unreadable, no table of numbers, a column that does not exist, a word among the numbers
    """
    layout = _layout(path)
    try:
        table = pd.read_csv(
            path,
            sep=layout.separator or r"\s+",
            decimal=layout.decimal,
            skiprows=layout.first_row,
            header=None,
            dtype=np.float64,
            encoding="utf-8",
            encoding_errors="replace",
            skip_blank_lines=True,
        ).to_numpy()
    except (ValueError, pd.errors.ParserError, OSError) as error:
        reason = str(error).splitlines()[0]
        raise DataError(
            Problem(
                "bad_table",
                f"{path}, from line {layout.first_row + 1}",
                f"the table does not hold numbers only: {reason}",
                "Export plain columns of numbers below one line of names",
            )
        ) from error
    names = list(layout.names) if layout.names else [""] * table.shape[1]
    return _history(path, names, table, columns, time_column)


def read_parquet_history(
    path: Path, columns: Mapping[str, int] | None = None, time_column: str | None = None
) -> ForeignHistory:
    """Read a Parquet table of time and modal coordinates, as ``read_text_history`` reads a text table."""
    opened = open_columns(path, ())
    try:
        table = np.column_stack([opened.read(k).to_numpy().astype(np.float64) for k in range(len(opened.names))])
    except (TypeError, ValueError) as error:
        raise DataError(
            Problem("bad_table", str(path), f"a column holds no numbers ({error})", "Write columns of numbers only")
        ) from error
    return _history(path, list(opened.names), table, columns, time_column)


def _history(
    path: Path, names: list[str], table: Vectors, columns: Mapping[str, int] | None, time_column: str | None
) -> ForeignHistory:
    """Pick time and modal coordinates out of a table (t, c); columns without a name have an empty one."""
    if table.shape[1] < len(names) or table.shape[1] < 2:
        raise DataError(
            Problem(
                "bad_table",
                str(path),
                f"{len(names)} names for {table.shape[1]} columns",
                "Export time and coordinates",
            )
        )
    names = [composed(name) for name in names]
    time_at = _time_at(path, names, None if time_column is None else composed(time_column))
    if columns is None:
        taken = [k for k in range(len(names)) if k != time_at]
        mode = np.array([_mode_number(names[k]) for k in taken], np.int64)
    else:
        absent = [name for name in columns if name not in names]
        if absent:
            raise DataError(
                Problem(
                    "no_column", str(path), f"there is no column {absent[0]!r}", f"Name some of {', '.join(names[:8])}"
                )
            )
        taken = [names.index(name) for name in columns]
        mode = np.array(list(columns.values()), np.int64)
    return check_values(
        ForeignHistory(
            str(path),
            mode,
            np.array([_frequency(names[k]) for k in taken]),
            tuple(names[k] or f"column {k + 1}" for k in taken),
            table[:, time_at].copy(),
            np.ascontiguousarray(table[:, taken].T),
        )
    )


def _layout(path: Path) -> _Layout:
    """Find the first row of numbers and the names above it."""
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            lines = [line.rstrip("\r\n") for line in islice(file, _HEAD_LINES)]
    except OSError as error:
        raise DataError(Problem("unreadable", str(path), f"it cannot be read ({error})", "Check the path")) from error
    for row, line in enumerate(lines):
        for separator in _SEPARATORS:
            if separator is not None and separator not in line:
                continue
            fields = _fields(line, separator)
            for decimal, pattern in ((".", _NUMBER), (",", _NUMBER_COMMA)):
                if decimal == separator or len(fields) < 2 or not all(pattern.match(f) for f in fields):
                    continue
                return _Layout(row, separator, decimal, _names(lines[:row], separator, len(fields)))
    raise DataError(
        Problem(
            "no_table",
            str(path),
            f"no row of numbers in the first {min(len(lines), _HEAD_LINES)} lines",
            "Export time and modal coordinates as columns of text",
        )
    )


def _fields(line: str, separator: str | None) -> list[str]:
    """Fields of a line without quotation marks; a separator at its end is no field."""
    text = line.strip() if separator is None else line.rstrip().removesuffix(separator)
    return [field.strip().strip("\"'") for field in text.split(separator)]


def _names(head: list[str], separator: str | None, count: int) -> tuple[str, ...]:
    """Find the column names: the first of the lines right above the numbers with as many fields; units may follow."""
    names: tuple[str, ...] = ()
    for line in reversed(head):
        fields = _fields(line.lstrip("#%! "), separator)
        if len(fields) != count:
            break
        if len(set(fields)) == count:
            names = tuple(fields)
    return names


def _time_at(path: Path, names: list[str], wanted: str | None) -> int:
    if wanted is None:
        return next((k for k, name in enumerate(names) if _TIME.match(name)), 0)
    if wanted not in names:
        raise DataError(
            Problem("no_column", str(path), f"there is no time column {wanted!r}", f"Name one of {names[:8]}")
        )
    return names.index(wanted)


def _mode_number(name: str) -> int:
    """Last whole number in a column name, its unit left out; 0 if there is none."""
    numbers = re.findall(r"\d{1,9}", _UNIT.sub("", _FREQUENCY.sub("", name)), re.ASCII)
    return int(numbers[-1]) if numbers else 0


def _frequency(name: str) -> float:
    found = _FREQUENCY.search(name)
    try:
        return float(found[1]) if found else float("nan")
    except ValueError:
        return float("nan")
