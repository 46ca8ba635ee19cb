"""Histories of modal coordinates in the neutral format: ``time_s`` and one column ``q_<mode>`` for every mode."""

import re
from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.life.history import ModalHistory
from fatigue.readers.tables import Table, open_table

STEP_TOLERANCE = 1e-3  # of a step


def read_history(
    path: Path, event: str, modes: NDArray[np.int64], ignore_modes: Collection[int], *, strict: bool
) -> tuple[ModalHistory, list[Problem]]:
    """Read the whole record of one event, (m, t) in the order of ``modes``; float32 where the file has float32.

    The step is (last time - first time) / (samples - 1).

    Raises
    ------
    DataError
        a mode of the body without column or the reverse, unless it is ignored; fewer than 2 samples; steps that differ
        by more than 1e-3; a value that is no finite number
    """
    table = open_table(path)
    names = _mode_columns(table, modes, ignore_modes)
    ignored = [name for name in table.position if (_mode_of(name) in ignore_modes)]
    table.expect(("time_s", *names), ignored, strict=strict)
    table.refuse()
    time = table.numbers("time_s").astype(np.float64)
    table.refuse()
    step = _step(table, time)
    q = np.empty((modes.size, table.rows), dtype=np.float32 if table.single_precision(names) else np.float64)
    for row, name in zip(q, names, strict=True):
        row[:] = table.numbers(name)
    table.refuse()
    return ModalHistory(event=event, mode=modes, q=q, step=step, start=float(time[0])), table.warnings


def _mode_of(column: str) -> int | None:
    """Mode id of a column ``q_<mode>``; None for any other column."""
    return int(column[2:]) if re.fullmatch(r"q_-?\d+", column) else None


def _mode_columns(table: Table, modes: NDArray[np.int64], ignore_modes: Collection[int]) -> list[str]:
    """Names of the columns of the modes; modes and columns have to match."""
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


def _step(table: Table, time: NDArray[np.float64]) -> float:
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
