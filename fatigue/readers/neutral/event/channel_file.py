"""One channel beside the coordinates of an event: ``time_s`` and its column, on the grid of its own file."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.life.records.unit_load import UniformGrid
from fatigue.readers.neutral.event.load_units import stated_unit
from fatigue.readers.neutral.history import STEP_TOLERANCE, uniform_step
from fatigue.readers.neutral.long_history import Irregular, Times, blocks, is_long, long_table
from fatigue.readers.neutral.tables import open_table

_SPELLINGS = {"m/s2": ("m/s2", "m/s/s", "ms-2", "m/sec2"), "g": ("g", "gn", "g0"), "-": ()}


@dataclass(frozen=True, slots=True, eq=False)
class ChannelSamples:
    """Samples of a channel as its file has them, (n,), and their instants in the time of the file."""

    values: NDArray[np.float64]
    grid: UniformGrid


def read_channel(path: Path, column: str, unit: str, *, converted: bool = False) -> ChannelSamples:
    """Samples of one column of a file; the others are not read.

    ``unit`` is what the case says of the column; a file that states another one is
    refused, unless the case says that the values are ``converted``, by a scale.

    Raises
    ------
    DataError : no such column, fewer than 2 samples, steps that differ by more than 1e-3, a value that is not finite,
        another unit
    """
    _refuse_unit(path, column, unit, converted=converted)
    if is_long(path):
        try:
            return _read_long(path, column)
        except Irregular:
            pass  # what is wrong is told below
    table = open_table(path)
    table.expect(("time_s", column), table.position, strict=False)
    time, values = table.numbers("time_s").astype(np.float64), table.numbers(column).astype(np.float64)
    table.refuse()
    grid = UniformGrid(float(time[0]), uniform_step(table, time), table.rows)
    return ChannelSamples(values, grid)


def time_grid(path: Path) -> UniformGrid:
    """Instants of a history, nothing else of which is read.

    Raises
    ------
    DataError : as ``read_channel``
    """
    table = open_table(path)
    table.expect(("time_s",), table.position, strict=False)
    time = table.numbers("time_s").astype(np.float64)
    table.refuse()
    return UniformGrid(float(time[0]), uniform_step(table, time), table.rows)


def _read_long(path: Path, column: str) -> ChannelSamples:
    """A column of a long file, block by block."""
    table, times = long_table(path), Times()
    if {"time_s", column} - table.position.keys():
        raise Irregular
    parts = []
    for block in blocks(table, [column], np.dtype(np.float64)):
        times.add(block.time)
        parts.append(block.q[0].astype(np.float64, copy=False))
    return ChannelSamples(np.concatenate(parts), UniformGrid(times.first, times.step(STEP_TOLERANCE), times.samples))


def _refuse_unit(path: Path, column: str, unit: str, *, converted: bool) -> None:
    """Refuse a column whose file states another unit than the case."""
    stated = _plain(stated_unit(path, column))
    if stated in ("", "-", "1") or unit == "-" or converted or stated in _SPELLINGS[unit]:
        return
    what = f"the unit is {stated_unit(path, column)}, and the case says {unit!r}"
    remedy = "Correct the unit of the channel, or convert the values by its scale"
    raise DataError(Problem("unit", f"{path.name}: column {column}", what, remedy))


def _plain(unit: str) -> str:
    """A unit in small letters without brackets, blanks and signs of powers and products.

    >>> _plain("[m/s²]"), _plain("m/s^2"), _plain("m*s**-2")
    ('m/s2', 'm/s2', 'ms-2')
    """
    plain = unit.lower().replace("²", "2").replace("⁻", "-")
    return "".join(letter for letter in plain if letter not in " []()<>^*·⋅")
