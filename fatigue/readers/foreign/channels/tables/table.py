"""All columns of a table as channels: text of any layout, Parquet, and ANSYS files of modal coordinates."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.channels.own_time import with_own_time
from fatigue.readers.foreign.histories.header import read_header
from fatigue.readers.foreign.histories.mcf import read_mcf
from fatigue.readers.foreign.histories.number_rows import find_rows
from fatigue.readers.foreign.histories.row_values import read_values
from fatigue.readers.neutral.column_values import seconds_of
from fatigue.readers.neutral.files import open_columns
from fatigue.readers.text.encoding import read_head
from fatigue.readers.text.lines import text_lines, whole_cells
from fatigue.readers.units.channel_names import channel

_NO_TIME = "none of its columns is named time"


def read_text_channels(path: Path) -> tuple[ChannelGroup, ...]:
    """All columns of a text table, as ``read_text_history`` recognises them.

    Raises
    ------
    DataError : no table of numbers, a word among the numbers
    """
    text, encoding, whole = read_head(path)
    lines = whole_cells(text_lines(text, whole=whole))
    rows = find_rows(path, lines)
    header = read_header(path, lines, rows)
    table, _ = read_values(path, encoding, rows, header.cells, [one.name for one in header.channels])
    named = tuple(
        RecordedChannel("time_s" if one.is_time and not one.name else one.name or f"column {k + 1}", one.unit)
        for k, one in enumerate(header.channels)
    )
    return (_timed(named, table.T),)


def read_parquet_channels(path: Path) -> tuple[ChannelGroup, ...]:
    """All columns of numbers of a Parquet table, durations in seconds.

    Raises
    ------
    DataError : a damaged file
    """
    opened = open_columns(path, ())
    numbers = [k for k, kind in enumerate(opened.kinds) if _is_number(kind)]
    named = tuple(RecordedChannel(opened.names[k].strip(), opened.units[k]) for k in numbers)

    def values(at: Sequence[int]) -> NDArray[np.floating]:
        return np.stack([_column(opened.read(numbers[k]), opened.kinds[numbers[k]]) for k in at])

    rest = [name for k, name in enumerate(opened.names) if k not in numbers]
    what = f"columns that hold no numbers are left out: {', '.join(map(repr, rest[:8]))}"
    remedy = "Write them as numbers if they are wanted, times in seconds"
    warnings = (Problem("no_numbers", str(path), what, remedy),) if rest else ()
    return (with_own_time(ChannelGroup("", named, opened.rows, None, values, _NO_TIME, warnings)),)


def read_mcf_channels(path: Path) -> tuple[ChannelGroup, ...]:
    """Modal coordinates of an ANSYS file; see ``read_mcf``."""
    history = read_mcf(path)
    named = tuple(RecordedChannel(f"q_{mode}") for mode in history.mode.tolist())
    return (ChannelGroup("", named, history.time.size, history.time, partial(_rows, history.q)),)


def _timed(named: tuple[RecordedChannel, ...], table: NDArray[np.float64]) -> ChannelGroup:
    """Group of a table (c, t); columns named time again before every curve are one."""
    times = [k for k, one in enumerate(named) if channel(one.name).is_time]
    again = [k for k in times[1:] if np.array_equal(table[k], table[times[0]])]
    kept = [k for k in range(len(named)) if k not in again]
    rows = table[kept]
    group = ChannelGroup("", tuple(named[k] for k in kept), rows.shape[1], None, partial(_rows, rows), _NO_TIME)
    found = with_own_time(group)
    return replace(found, without_time=found.without_time if found.time is None else "")


def _is_number(kind: pa.DataType) -> bool:
    return bool(pt.is_integer(kind) or pt.is_floating(kind) or pt.is_decimal(kind) or pt.is_duration(kind))


def _column(column: pa.ChunkedArray, kind: pa.DataType) -> NDArray[np.float64]:
    if pt.is_duration(kind):
        return seconds_of(column)
    return np.asarray(column.to_numpy()).astype(np.float64)


def _rows(table: NDArray[np.floating], at: Sequence[int]) -> NDArray[np.floating]:
    return table[list(at)]
