"""Channels of an Excel workbook, a sheet a group, read with the package python_calamine.

The numbers of a sheet are the longest run of rows of numbers. What stands above it is read as above a text table:
names, units, numbers and frequencies of modes, one for every column. Hidden sheets are left out.
"""

import datetime
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.channels.own_time import with_own_time
from fatigue.readers.foreign.channels.quiet import quietly
from fatigue.readers.foreign.channels.tables.sheet_area import refuse_far_cells
from fatigue.readers.foreign.histories.header import Header, read_header
from fatigue.readers.foreign.histories.number_rows import NumberRows
from fatigue.readers.text.numbers import is_gap, is_number
from fatigue.readers.units.channel_names import Channel

Cells: TypeAlias = Sequence[Any]
_DATES = (datetime.date, datetime.time, datetime.timedelta)


@dataclass(frozen=True, slots=True)
class _Place:
    """Where the numbers of a sheet stand: rows ``first`` to before ``end``, and columns, all counted from 0."""

    first: int
    end: int
    columns: tuple[int, ...]


def read_workbook(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels of every visible sheet that has a table of numbers.

    Raises
    ------
    DataError
        a damaged or protected workbook, text or dates among the numbers, no table of numbers; whatever ``read_header``
        refuses of the rows above it
    """
    import python_calamine  # noqa: PLC0415 - the package of this format alone

    refuse_far_cells(path)
    visible = python_calamine.SheetVisibleEnum.Visible
    with quietly(path, "python_calamine", "workbook_damaged"):
        book = python_calamine.CalamineWorkbook.from_filelike(BytesIO(path.read_bytes()))  # not told by its name
        sheets = [
            (one.name, book.get_sheet_by_name(one.name).to_python(skip_empty_area=False))
            for one in book.sheets_metadata
            if one.visible == visible and one.typ == python_calamine.SheetTypeEnum.WorkSheet
        ]
        hidden = [one.name for one in book.sheets_metadata if one.visible != visible]
    groups = [group for name, rows in sheets if (group := _group(path, name, rows, len(sheets))) is not None]
    if not groups:
        named = ", ".join(repr(name) for name, _ in sheets) or "all of them hidden"
        what = f"none of its sheets ({named}) has a table of numbers"
        raise DataError(Problem("no_channels", str(path), what, "Write time and channels in columns, names above them"))
    if hidden:
        what = f"hidden sheets are left out: {', '.join(map(repr, hidden))}"
        left_out = Problem("channels_left_out", str(path), what, "Show them in Excel if they hold channels")
        groups = [replace(group, warnings=(*group.warnings, left_out)) for group in groups]
    return tuple(groups)


def _group(path: Path, name: str, rows: Sequence[Cells], sheets: int) -> ChannelGroup | None:
    """Channels of one sheet, None without a table of numbers."""
    found = _place(rows)
    if found is None:
        return None
    sheet = Path(f"{path}, sheet {name!r}")  # as messages call it
    remarks = [k for k in found.columns if not any(_is_number(_cell(row, k)) for row in rows[found.first : found.end])]
    _refuse_numbers_as_text(sheet, rows, found, remarks)
    place = replace(found, columns=tuple(k for k in found.columns if k not in remarks))
    table = np.array(
        [
            [
                _number(f"{sheet}, cell {_letters(k)}{row + 1}", _cell(rows[row], k))
                for row in range(place.first, place.end)
            ]
            for k in place.columns
        ]
    )
    header = _header(sheet, rows, place)
    nameless = not header.names and _is_even(table[0])
    channels = tuple(
        _recorded(one, "time_s" if nameless and k == 0 else f"column {_letters(column)}")
        for k, (one, column) in enumerate(zip(header.channels, place.columns, strict=True))
    )
    warnings = tuple(
        Problem(
            "channels_left_out", f"{sheet}, column {_letters(k)}", "it holds text", "Nothing to do if it is a remark"
        )
        for k in remarks
    )
    without = "none of its columns is named time"
    group = ChannelGroup(
        name if sheets > 1 else "", channels, table.shape[1], None, partial(_values, table), without, warnings
    )
    return with_own_time(group)


def _place(rows: Sequence[Cells]) -> _Place | None:
    """Place of the longest run of rows of numbers; None where no two follow each other.

    A row of numbers behind a word, above numbers alone, belongs to the names: it states modes or frequencies.
    """
    counts = [sum(_is_number(cell) for cell in row) for row in rows]
    runs: list[tuple[int, int]] = []
    for k, count in enumerate(counts):
        if count and runs and runs[-1][1] == k:
            runs[-1] = runs[-1][0], k + 1
        elif count:
            runs.append((k, k + 1))
    if not runs:
        return None
    first, end = max(runs, key=lambda run: run[1] - run[0])
    while first + 1 < end and _is_labelled(rows[first], rows[first + 1]):
        first += 1
    end = max(k for k, count in enumerate(counts) if count) + 1  # a gap in the numbers is told, not left out
    if end - first < 2 or max(counts[first:end]) < 2:
        return None
    width = max(len(row) for row in rows[first:end])
    return _Place(
        first, end, tuple(k for k in range(width) if any(not _is_empty(_cell(r, k)) for r in rows[first:end]))
    )


def _is_labelled(row: Cells, below: Cells) -> bool:
    """Whether the first number below a row stands below a text."""
    begin = next((k for k, cell in enumerate(below) if _is_number(cell)), None)
    return begin is not None and isinstance(_cell(row, begin), str) and not _is_empty(_cell(row, begin))


def _header(sheet: Path, rows: Sequence[Cells], place: _Place) -> Header:
    """What the rows above the numbers state; above an empty row there is nothing but free text."""
    empty = [k for k, row in enumerate(rows[: place.first]) if all(_is_empty(cell) for cell in row)]
    lines = []
    for k, row in enumerate(rows[: place.first]):
        own = [_written(_cell(row, column)) for column in place.columns]
        numbers = sum(is_number(cell, ".") for cell in own)
        is_alone = 0 < numbers < len(own) - 1 and sum(map(bool, own)) < len(own)  # as "Run | 7"
        is_free = not any(own) or is_alone or (empty and k < empty[-1])
        lines.append(" ".join(filter(None, map(_written, row))) if is_free else "\t".join(own))
    width = len(place.columns)
    return read_header(sheet, lines, NumberRows(place.first, "\t", ".", width, width))


def _recorded(one: Channel, otherwise: str) -> RecordedChannel:
    return RecordedChannel(one.name or otherwise, one.unit, one.mode, one.frequency, one.resolution)


def _refuse_numbers_as_text(sheet: Path, rows: Sequence[Cells], place: _Place, remarks: Sequence[int]) -> None:
    """Refuse a column that holds text alone where a text is a number: it would be lost."""
    for column in remarks:
        for row in range(place.first, place.end):
            cell = _cell(rows[row], column)
            if not isinstance(cell, str) or is_number(cell.strip(), ".") or is_number(cell.strip(), ","):
                _number(f"{sheet}, cell {_letters(column)}{row + 1}", cell)


def _is_number(cell: Any) -> bool:
    return isinstance(cell, int | float) and not isinstance(cell, bool)


def _is_empty(cell: Any) -> bool:
    return cell is None or (isinstance(cell, str) and not cell.strip())


def _cell(row: Cells, column: int) -> Any:
    return row[column] if column < len(row) else ""


def _written(cell: Any) -> str:
    """Cell of the header as text, on one line."""
    if isinstance(cell, float) and cell.is_integer():
        cell = int(cell)
    return " ".join(str("" if cell is None else cell).split())


def _number(where: str, cell: Any) -> float:
    """Value of a cell, NaN if it is empty.

    Raises
    ------
    DataError : a date or a text
    """
    if _is_number(cell):
        return float(cell)
    if _is_empty(cell) or (isinstance(cell, str) and is_gap(cell.strip())):
        return float("nan")
    if isinstance(cell, _DATES):
        raise DataError(Problem("date_column", where, f"{cell} is a date or a time of day", "Write seconds as numbers"))
    what = f"{cell!r} stands among the numbers"
    raise DataError(Problem("not_a_number", where, what, "Write numbers, not text that looks like them"))


def _is_even(values: NDArray[np.float64]) -> bool:
    """Whether values rise in even steps, as time does."""
    steps = np.diff(values)
    return bool(
        values.size > 2 and np.isfinite(values).all() and (np.abs(steps - steps.mean()) < 1e-3 * steps.mean()).all()
    )


def _letters(column: int) -> str:
    text, rest = "", column + 1
    while rest:
        rest, digit = divmod(rest - 1, 26)
        text = chr(ord("A") + digit) + text
    return text


def _values(table: NDArray[np.float64], at: Sequence[int]) -> NDArray[np.floating]:
    """Samples (k, t) of some columns."""
    return table[list(at)]
