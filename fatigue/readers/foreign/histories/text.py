"""Modal coordinates from text tables of any layout, as SIMPACK, ADAMS or RecurDyn export them, and from Parquet.

Encoding, separator, decimal sign, title lines, names and units are recognised. Columns find their mode by the last
number in their name (``q_12``, ``.FLEX.Q12``, ``$B_Car.q(12)``), or by a map of column to mode.
"""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.naming import composed
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory, check_values
from fatigue.readers.foreign.histories.header import Header, header_frequencies, read_header
from fatigue.readers.foreign.histories.rows import find_rows, read_values
from fatigue.readers.foreign.histories.statements import (
    normalisation_in,
    stated_length,
    stated_time_unit,
    statement_problems,
)
from fatigue.readers.neutral.column_values import seconds_of
from fatigue.readers.neutral.files import open_columns
from fatigue.readers.text.encoding import read_head
from fatigue.readers.text.lines import text_lines, whole_cells
from fatigue.readers.units.channel_names import Channel, channel, seconds_per, unit_of_time, without_unit_one

_COUNT_NAME = re.compile(
    r"\s*(?:unnamed: \d+|index|idx|#|n[or]\.?|(?:lfd|lfd\.)[ _]?nr\.?|(?:sample|row|point|record|step|zeile|punkt)s?"
    r"(?:[ _]?(?:no\.?|nr\.?|number|index|count))?|__index_level_\d+__)\s*\Z",
    re.IGNORECASE,
)

Vectors = NDArray[np.float64]


def read_text_history(
    path: Path, columns: Mapping[str, int] | None = None, time_column: str | None = None
) -> ForeignHistory:
    """Read a table of time and modal coordinates; time is converted to seconds by the unit in its header.

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
    history = _history(path, header, table, at, columns, time_column)
    refuse(DataError, statement_problems(path, header.free, rows.width, history.time))
    length = stated_length(header.free)
    return replace(history, normalisation=normalisation_in(path, header.free), length=length)


def read_parquet_history(
    path: Path, columns: Mapping[str, int] | None = None, time_column: str | None = None
) -> ForeignHistory:
    """Read a Parquet table of time and modal coordinates, as ``read_text_history`` reads a text table.

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
    return _history(path, Header((tuple(names),), tuple(channels), (), ()), table, None, columns, time_column)


def _is_wanted(name: str, kind: pa.DataType, wanted: Collection[str] | None) -> bool:
    """Whether a Parquet column is read: all are, but columns of no numbers that a map of columns does not name."""
    is_number = pt.is_integer(kind) or pt.is_floating(kind) or pt.is_decimal(kind) or pt.is_duration(kind)
    return is_number or wanted is None or composed(name) in wanted or channel(name).is_time


def _with_type(path: Path, own: Channel, kind: pa.DataType, unit: str) -> Channel:
    """Add what the type and the metadata of a Parquet column state."""
    where = f"{path}, column {own.name!r}"
    if pt.is_timestamp(kind) or pt.is_date(kind) or pt.is_time(kind):
        what = f"the column holds dates or times of day ({kind}), where seconds from the start of the run are needed"
        raise DataError(Problem("date_column", where, what, "Write seconds as numbers, or durations"))
    if pt.is_duration(kind):
        if own.mode:
            raise DataError(Problem("bad_table", where, "a modal coordinate is a duration", "Write numbers"))
        return replace(own, is_time=True, unit="s")
    if unit and own.unit and unit.lower() != own.unit.lower():
        what = f"its name states {own.unit}, its metadata {unit}"
        raise DataError(Problem("header", where, what, "Correct one of them"))
    return replace(own, unit=own.unit or unit)


def _numbers(path: Path, name: str, column: pa.ChunkedArray) -> Vectors:
    """Values of a Parquet column, durations in seconds."""
    if pt.is_duration(column.type):
        return seconds_of(column)
    if not (pt.is_integer(column.type) or pt.is_floating(column.type) or pt.is_decimal(column.type)):
        what = f"a column holds no numbers ({column.type})"
        remedy = "Write columns of numbers only, or name those to take by --columns"
        raise DataError(Problem("bad_table", f"{path}, column {name!r}", what, remedy))
    return np.asarray(column.to_numpy()).astype(np.float64)


def _history(
    path: Path,
    header: Header,
    table: Vectors,
    lines: NDArray[np.int64] | None,
    columns: Mapping[str, int] | None,
    time_column: str | None,
) -> ForeignHistory:
    """Pick time and modal coordinates out of a table (t, c)."""
    channels, kept, remarks = _filled(path, header.channels, table)
    header = replace(header, channels=tuple(channels), names=tuple(tuple(n[k] for k in kept) for n in header.names))
    table = table[:, kept]
    if len(kept) < 2:
        raise DataError(Problem("bad_table", str(path), "a single column", "Export time and coordinates"))
    mapped = None if columns is None else [_column(path, header, name) for name in columns]
    times = _times(path, header, time_column)
    seconds = _seconds(path, header, channels, times, table, lines)
    taken = [k for k in range(len(channels)) if k not in times] if mapped is None else mapped
    mode = np.array([channels[k].mode for k in taken] if columns is None else list(columns.values()), np.int64)
    listed = header_frequencies(header.free)
    frequency, resolution = _frequencies(path, [channels[k] for k in taken], mode, listed)
    return check_values(
        ForeignHistory(
            str(path),
            mode,
            frequency,
            tuple(channels[k].name or f"column {k + 1}" for k in taken),
            seconds,
            np.ascontiguousarray(table[:, taken].T),
            remarks,
            unit=tuple(channels[k].unit for k in taken),
            resolution=resolution,
            lines=lines,
        )
    )


def _filled(
    path: Path, channels: Sequence[Channel], table: Vectors
) -> tuple[list[Channel], list[int], tuple[Problem, ...]]:
    """Leave out columns without a name that hold nothing, as spreadsheets leave them, and counts of the rows."""
    count = np.arange(len(table))
    timed, kept, remarks = any(c.is_time for c in channels), [], []
    for k, own in enumerate(channels):
        empty = np.isnan(table[:, k]).all()
        if (own.name and not _COUNT_NAME.match(own.name)) or not (timed or (empty and not own.name)):
            kept.append(k)
        elif own.name or not empty:
            if not (np.array_equal(table[:, k], count) or np.array_equal(table[:, k], count + 1)):
                kept.append(k)
                continue
            named = f"is named {own.name!r}" if own.name else "has no name"
            what = f"column {k + 1} {named} and counts the rows; it is left out"
            remarks.append(Problem("row_count", str(path), what, "Export without it"))
    return [channels[k] for k in kept], kept, tuple(remarks)


def _times(path: Path, header: Header, wanted: str | None) -> list[int]:
    """Positions of the columns of time: that which is wanted, those with a name of time, or the first of nameless."""
    channels = header.channels
    if wanted is not None:
        if (
            all(wanted not in names for names in header.names)
            and wanted.isdecimal()
            and 1 <= int(wanted) <= len(channels)
        ):
            return [int(wanted) - 1]
        return [_column(path, header, wanted, "time column")]
    named = [k for k, c in enumerate(channels) if c.is_time]
    if named or not header.names:
        return named or [0]
    shown = ", ".join(repr(c.name) for c in channels[:8])
    raise DataError(
        Problem(
            "no_time",
            str(path),
            f"no column is named time; the columns are {shown}",
            "Name it, or its position from 1, with --time-column",
        )
    )


def _column(path: Path, header: Header, name: str, what: str = "column") -> int:
    """Position of a named column; its unit may be left out where that is clear."""
    name = composed(name)
    bases = tuple(c.base for c in header.channels)
    for written in (*header.names, bases):
        names = [composed(other) for other in written]
        if names.count(name) > 1:
            raise DataError(
                Problem("column_twice", str(path), f"{names.count(name)} columns are named {name!r}", "Rename them")
            )
        if name in names:
            return names.index(name)
    shown = ", ".join(c.name for c in header.channels[:8])
    raise DataError(Problem("no_column", str(path), f"there is no {what} {name!r}", f"Name some of {shown}"))


def _seconds(
    path: Path,
    header: Header,
    channels: Sequence[Channel],
    times: Sequence[int],
    table: Vectors,
    lines: NDArray[np.int64] | None,
) -> Vectors:
    """Convert times to seconds by the unit that names, rows of units or free text state."""
    stated = stated_time_unit(path, header.free)
    found = []
    for k in times:
        own = channels[k]
        unit = own.unit if own.is_time else unit_of_time(own.name) or own.unit
        factor = seconds_per(unit) if unit else None
        if unit and factor is None:
            where, what = f"{path}, column {own.name!r}", f"{unit!r} is no unit of time"
            raise DataError(Problem("time_unit", where, what, "Write s, ms, us, min or h"))
        if stated is not None and factor is not None and factor != seconds_per(stated[1]):
            what = f"two statements of the header disagree: time in {stated[1]}, and {own.name!r} in {unit}"
            raise DataError(Problem("header", f"{path}, line {stated[0]}", what, "Correct one of them"))
        factor = factor or (seconds_per(stated[1]) if stated else None) or Fraction(1)
        found.append(table[:, k] * factor.numerator / factor.denominator)
    for k, other in zip(times[1:], found[1:], strict=True):
        if not np.allclose(other, found[0], rtol=1e-9, atol=0.0):
            row = int(np.argmax(~np.isclose(other, found[0], rtol=1e-9, atol=0.0)))
            place = f", line {lines[row]}" if lines is not None else ""
            what = f"time is repeated before every curve, and differs: {found[0][row]:.9g} s in column {times[0] + 1}, "
            what += f"{other[row]:.9g} s in column {k + 1}"
            remedy = "Export all curves at the same instants, with one column of time"
            raise DataError(Problem("several_times", f"{path}{place}, sample {row + 1}", what, remedy))
    return np.array(found[0])


def _frequencies(
    path: Path, channels: Sequence[Channel], mode: NDArray[np.int64], listed: Mapping[int, tuple[int, float, float]]
) -> tuple[Vectors, Vectors]:
    """Frequencies (m,) that names and header state, and half a unit of their last digits [Hz]."""
    frequency = np.array([c.frequency for c in channels])
    resolution = np.array([c.resolution for c in channels])
    for k, m in enumerate(mode.tolist()):
        if m not in listed:
            continue
        line, value, half = listed[m]
        if np.isfinite(frequency[k]) and abs(frequency[k] - value) > resolution[k] + half:
            what = f"two statements of the header disagree: {value:g} Hz for mode {m}, and {channels[k].name!r}"
            raise DataError(Problem("header", f"{path}, line {line}", what, "Correct one of them"))
        if not np.isfinite(frequency[k]):
            frequency[k], resolution[k] = value, half
    return frequency, resolution
