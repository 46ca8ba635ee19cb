"""Histories of modal coordinates in the neutral format: ``time_s`` and one column ``q_<mode>`` for every mode.

Columns ``u_<name>`` are unit loads, further coordinates behind the modes.

A short record is read column by column, a long one block of rows after block, see ``long_history``.
"""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.life.records.history import ModalHistory
from fatigue.life.records.spool import Samples, SpoolWriter, create_spool
from fatigue.readers.neutral.long_history import Irregular, Times, blocks, is_long, long_table
from fatigue.readers.neutral.record_outline import RecordOutline
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.readers.units.channel_names import channel

STEP_TOLERANCE = 1e-3  # of a step


@dataclass(frozen=True, slots=True)
class TimeGrid:
    """Times of a record: number of samples, time step [s], file time of the first sample [s]."""

    samples: int
    step: float
    start: float


def read_history(
    path: Path,
    event: str,
    modes: NDArray[np.int64],
    ignore_modes: Collection[int],
    *,
    strict: bool,
    scratch: Path | None = None,
    loads: Sequence[str | None] = (),
    single: bool = True,
    beside: Collection[str] = (),
) -> tuple[ModalHistory, list[Problem]]:
    """Read the whole record of one event, (c, t) in the order of ``modes``; float32 where the file has float32.

    The step is (last time - first time) / (samples - 1). The samples go to the file ``scratch``, if one is given.
    Behind the modes comes a row for each of ``loads``: a column of the file, or zeros for None. Not ``single``: in
    double precision whatever the file has. Columns ``beside`` these are known, and not read here.

    Raises
    ------
    DataError
        a mode of the body without column or the reverse, unless it is ignored; fewer than 2 samples; steps that differ
        by more than 1e-3; a value that is no finite number; no room for ``scratch``
    """
    if is_long(path):
        try:
            return _read_long(path, event, modes, ignore_modes, strict, scratch, loads, single, beside)
        except Irregular:
            pass  # what is wrong is told below
    table, names, grid = _open(path, modes, ignore_modes, strict, _given(loads), beside)
    kind, shape = _precision(table, names, single), (modes.size + len(loads), grid.samples)
    q: Samples = np.zeros(shape, dtype=kind) if scratch is None else create_spool(scratch, shape, kind)
    for i, name in zip(_rows(modes.size, loads), names, strict=True):
        q[i : i + 1, :] = table.numbers(name)[None]
    table.refuse()
    return ModalHistory(event, coordinate_numbers(modes, len(loads)), q, grid.step, grid.start), table.warnings


def check_history(
    path: Path,
    modes: NDArray[np.int64],
    ignore_modes: Collection[int],
    *,
    strict: bool,
    outline: RecordOutline,
    loads: Sequence[str | None] = (),
    beside: Collection[str] = (),
) -> tuple[TimeGrid, list[Problem]]:
    """Times of a record that is read, checked and not kept; raises what ``read_history`` raises.

    ``outline`` takes in the samples, all of a mode or some of all modes at a time; ``loads`` and ``beside`` are as
    there, and of loads that are None nothing is taken in.
    """
    rows = _rows(modes.size, loads)
    if is_long(path):
        try:
            table, names = _long(path, modes, ignore_modes, strict, _given(loads), beside)
            times = Times()
            for block in blocks(table, names, _precision(table, names)):
                times.add(block.time)
                for i, samples in zip(rows, block.q, strict=True):
                    outline.add(i, samples, times.mean_step)
            return TimeGrid(times.samples, times.step(STEP_TOLERANCE), times.first), table.warnings
        except Irregular:
            outline.forget()  # what is wrong is told below
    table, names, grid = _open(path, modes, ignore_modes, strict, _given(loads), beside)
    for i, name in zip(rows, names, strict=True):
        outline.add(i, table.numbers(name), grid.step)
    table.refuse()
    return grid, table.warnings


def _read_long(
    path: Path,
    event: str,
    modes: NDArray[np.int64],
    ignore_modes: Collection[int],
    strict: bool,
    scratch: Path | None,
    loads: Sequence[str | None],
    single: bool,
    beside: Collection[str],
) -> tuple[ModalHistory, list[Problem]]:
    """Read a long record block by block."""
    table, names = _long(path, modes, ignore_modes, strict, _given(loads), beside)
    kind, times = _precision(table, names, single), Times()
    rows, count = _rows(modes.size, loads), modes.size + len(loads)
    if scratch is None:
        parts = []
        for block in blocks(table, names, kind):
            times.add(block.time)
            parts.append(_spread(block.q, rows, count))
        q: Samples = np.concatenate(parts, axis=1)
    else:
        with SpoolWriter(scratch, count, kind) as writer:
            for block in blocks(table, names, kind):
                times.add(block.time)
                writer.append(_spread(block.q, rows, count))
        q = writer.spool()
    history = ModalHistory(event, coordinate_numbers(modes, len(loads)), q, times.step(STEP_TOLERANCE), times.first)
    return history, table.warnings


def _given(loads: Sequence[str | None]) -> list[str]:
    """Names of the columns of unit loads that are read."""
    return [name for name in loads if name is not None]


def _rows(modes: int, loads: Sequence[str | None]) -> list[int]:
    """Rows of q that columns are read for: those of all modes, and those of unit loads with a column."""
    return [*range(modes), *(modes + i for i, name in enumerate(loads) if name is not None)]


def coordinate_numbers(modes: NDArray[np.int64], loads: int) -> NDArray[np.int64]:
    """Ids of the modes, and numbers for unit loads behind them, as in ``Coordinates``."""
    return np.concatenate([modes, modes.max() + 1 + np.arange(loads)]) if loads else modes


def _spread(q: NDArray[np.floating], rows: Sequence[int], count: int) -> NDArray[np.floating]:
    """Rows at their places among so many, the others zero."""
    if len(rows) == count:
        return q
    spread = np.zeros((count, q.shape[1]), q.dtype)
    spread[rows] = q
    return spread


def _long(
    path: Path,
    modes: NDArray[np.int64],
    ignore_modes: Collection[int],
    strict: bool,
    loads: Sequence[str],
    beside: Collection[str],
) -> tuple[Table, list[str]]:
    """Open a long table and match its columns with the modes; what is not right is left to ``_open``."""
    table = long_table(path)
    names = _columns(table, modes, ignore_modes, strict, loads, beside)
    if table.problems:
        raise Irregular
    return table, names


def _precision(table: Table, names: Collection[str], single: bool = True) -> np.dtype[np.floating]:
    """Single precision where all columns are in it."""
    return np.dtype(np.float32) if single and table.single_precision(names) else np.dtype(np.float64)


def _open(
    path: Path,
    modes: NDArray[np.int64],
    ignore_modes: Collection[int],
    strict: bool,
    loads: Sequence[str],
    beside: Collection[str],
) -> tuple[Table, list[str], TimeGrid]:
    """Open a table, match its columns with the modes, and check its times."""
    table = open_table(path)
    names = _columns(table, modes, ignore_modes, strict, loads, beside)
    table.refuse()
    time = table.numbers("time_s").astype(np.float64)
    table.refuse()
    return table, names, TimeGrid(table.rows, uniform_step(table, time), float(time[0]))


def _columns(
    table: Table,
    modes: NDArray[np.int64],
    ignore_modes: Collection[int],
    strict: bool,
    loads: Sequence[str],
    beside: Collection[str],
) -> list[str]:
    """Names of the columns of modes and unit loads; what is wrong with the head of the table is noted."""
    _check_statements(table)
    names = [*_mode_columns(table, modes, ignore_modes), *loads]
    ignored = [name for name in table.position if (_mode_of(name) in ignore_modes)]
    table.expect(("time_s", *names), (*ignored, *beside), strict=strict)
    return names


def _check_statements(table: Table) -> None:
    """Note where names of columns contradict the neutral format: time in s, q in N, mm, t, s."""
    for name in table.position:
        own = channel(name)
        if own.is_time and name != "time_s" and "time_s" not in table.position:
            what = f"this seems to be time, {f'in {own.unit}' if own.unit else 'in a unit that is not stated'}"
            remedy = "Give seconds in a column time_s, or bring the file in by `fatigue convert`"
            table.problems.append(Problem("time_unit", table.where(name), what, remedy))
        elif own.unit and not own.is_time and re.match(r"q_?-?\d+\W", name):
            what = f"the name states the unit {own.unit}; neutral coordinates are in N, mm, t, s"
            remedy = f"Convert them and name the column q_{own.mode}, or bring the file in by `fatigue convert`"
            table.problems.append(Problem("unit", table.where(name), what, remedy))


def _mode_of(column: str) -> int | None:
    """Mode id of a column ``q_<mode>``; None of any other column."""
    return int(column[2:]) if re.fullmatch(r"q_-?\d+", column) else None


def _mode_columns(table: Table, modes: NDArray[np.int64], ignore_modes: Collection[int]) -> list[str]:
    """Names of the columns of the modes; what has no partner is noted."""
    columns: dict[int, str] = {}
    for name in table.position:
        if (mode := _mode_of(name)) is None:
            continue
        if mode in columns:
            table.problems.append(
                Problem(
                    "duplicate_column",
                    table.where(name),
                    f"mode {mode} has the column {columns[mode]} already",
                    "Remove one of them",
                )
            )
        columns[mode] = name
    wanted = set(modes.tolist())
    extra, absent = sorted(columns.keys() - wanted - set(ignore_modes)), sorted(wanted - columns.keys())
    if extra:
        table.problems.append(
            Problem(
                "unknown_id",
                table.path.name,
                f"modes {', '.join(map(str, extra))} are in the history and not in the table of modes",
                "Add them there, or list them under ignore_modes",
            )
        )
    if absent:
        table.problems.append(
            Problem(
                "missing_mode",
                table.path.name,
                f"modes {', '.join(map(str, absent))} are in the table of modes and not in the history",
                f"Add the columns {', '.join(f'q_{mode}' for mode in absent)}, or list the modes under ignore_modes",
            )
        )
    return [columns[mode] for mode in modes.tolist() if mode in columns]


def uniform_step(table: Table, time: NDArray[np.float64]) -> float:
    """Uniform time step [s]."""
    if time.size < 2:
        raise DataError(Problem("few_samples", table.path.name, "the history has one sample", "Give at least 2"))
    step = float((time[-1] - time[0]) / (time.size - 1))
    steps = np.diff(time)
    uneven = (steps <= 0) | (np.abs(steps - step) > STEP_TOLERANCE * step)
    if uneven.any():
        row = int(uneven.argmax()) + 1
        single = " and store time_s in double precision" if table.single_precision(["time_s"]) else ""
        raise DataError(
            Problem(
                "uneven_step",
                table.where("time_s", row),
                f"the time goes from {time[row - 1]:.9g} to {time[row]:.9g} s, a step of {steps[row - 1]:.6g} s where "
                f"the mean is {step:.6g} s ({np.count_nonzero(uneven)} of {steps.size} steps differ by more than 1e-3)",
                f"Write the history at a constant step{single}",
            )
        )
    return step
