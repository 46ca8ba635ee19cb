"""Channels of an Excel workbook, a sheet a group, read with the package python_calamine.

The numbers of a sheet are the longest run of rows of numbers; names stand above it, and units between both.
"""

import datetime
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.channels.own_time import with_own_time
from fatigue.readers.foreign.channels.quiet import quietly
from fatigue.readers.units.channel_names import seconds_per
from fatigue.readers.units.coordinate_units import parse_unit, states_no_unit

_DATES = (datetime.date, datetime.time, datetime.timedelta)


def read_workbook(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels of every sheet that has a table of numbers.

    Raises
    ------
    DataError : a damaged or protected workbook, text or dates among the numbers, no table of numbers
    """
    import python_calamine  # noqa: PLC0415 - the package of this format alone

    with quietly(path, "python_calamine", "workbook_damaged"):
        book = python_calamine.CalamineWorkbook.from_path(path)
        sheets = [(name, book.get_sheet_by_name(name).to_python(skip_empty_area=False)) for name in book.sheet_names]
    groups = [group for name, rows in sheets if (group := _group(path, name, rows, len(sheets))) is not None]
    if not groups:
        what = f"none of its sheets ({', '.join(name for name, _ in sheets)}) has a table of numbers"
        raise DataError(Problem("no_channels", str(path), what, "Write time and channels in columns, names above them"))
    return tuple(groups)


def _group(path: Path, name: str, rows: Sequence[Sequence[Any]], sheets: int) -> ChannelGroup | None:
    """Channels of one sheet, None without a table of numbers."""
    numbers = [sum(_is_number(cell) for cell in row) for row in rows]
    begin = next((k for k in range(len(rows)) if numbers[k] >= 2 and all(n >= 1 for n in numbers[k : k + 2])), None)
    if begin is None or len(rows) - begin < 2:
        return None
    used = [k for k, cell in enumerate(rows[begin]) if _is_number(cell)]
    end = max(k for k in range(len(rows)) if numbers[k]) + 1
    table = np.full((len(used), end - begin), np.nan)
    for row in range(begin, end):
        for place, column in enumerate(used):
            cell = rows[row][column] if column < len(rows[row]) else ""
            table[place, row - begin] = _number(f"{path}, sheet {name!r}, cell {_cell(row, column)}", cell)
    channels = _names(rows[:begin], used)
    values = partial(_values, table)
    without = "none of its columns is named time"
    group = ChannelGroup(name if sheets > 1 else "", channels, end - begin, None, values, without)
    return with_own_time(group)


def _names(above: Sequence[Sequence[Any]], used: Sequence[int]) -> tuple[RecordedChannel, ...]:
    """Names of the columns from the row above the numbers, or above a row of units."""
    texts = [[str(row[k]).strip() if k < len(row) and isinstance(row[k], str) else "" for k in used] for row in above]
    filled = [row for row in texts if any(row)]
    units = [""] * len(used)
    if len(filled) > 1 and all(not cell or _is_unit(cell) for cell in filled[-1]) and any(filled[-1]):
        units = [cell.strip("[]()") for cell in filled.pop()]
        units = ["" if states_no_unit(unit) else unit for unit in units]
    names = filled[-1] if filled else [""] * len(used)
    return tuple(
        RecordedChannel(name or f"column {_letters(k)}", unit) for name, unit, k in zip(names, units, used, strict=True)
    )


def _is_unit(cell: str) -> bool:
    bare = cell.strip("[]()")
    return states_no_unit(bare) or seconds_per(bare) is not None or parse_unit(bare) is not None


def _is_number(cell: Any) -> bool:
    return isinstance(cell, int | float) and not isinstance(cell, bool)


def _number(where: str, cell: Any) -> float:
    """Value of a cell, NaN if it is empty.

    Raises
    ------
    DataError : a date or a text
    """
    if _is_number(cell):
        return float(cell)
    if cell == "" or cell is None:
        return float("nan")
    if isinstance(cell, _DATES):
        raise DataError(Problem("date_column", where, f"{cell} is a date or a time of day", "Write seconds as numbers"))
    what = f"{cell!r} stands among the numbers"
    raise DataError(Problem("not_a_number", where, what, "Write numbers, not text that looks like them"))


def _cell(row: int, column: int) -> str:
    return f"{_letters(column)}{row + 1}"


def _letters(column: int) -> str:
    text, rest = "", column + 1
    while rest:
        rest, digit = divmod(rest - 1, 26)
        text = chr(ord("A") + digit) + text
    return text


def _values(table: NDArray[np.float64], at: Sequence[int]) -> NDArray[np.floating]:
    """Samples (k, t) of some columns."""
    return table[list(at)]
