"""Columns of modal coordinates joined with the modes of the FE run: by number, by frequency, or in order."""

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.foreign.histories.mode_frequencies import StatedFrequencies, other_mode_problems
from fatigue.readers.neutral.body.modes import LOWEST_HZ

FREQUENCY_TOLERANCE = 0.01
Match = Literal["id", "frequency", "order"]
"""How columns find their modes: by mode number, by nearest frequency, or one after the other."""


def matched(
    history: ForeignHistory, mode: NDArray[np.int64], frequency: NDArray[np.float64], match: Match
) -> ForeignHistory:
    """History whose every column has the number of an FE mode.

    Parameters
    ----------
    mode, frequency : (k,) numbers and frequencies [Hz] of the FE modes

    Raises
    ------
    DataError
        a column without a mode or a mode claimed twice; no frequencies to match by; a frequency that fits another mode
        better
    """
    if match == "order":
        return _in_order(history, mode, frequency)
    found = history.mode if match == "id" else _by_frequency(history, mode, frequency)
    nameless = np.flatnonzero(found <= 0)
    if nameless.size:
        remedy = "Name columns by mode number, map them by --columns (a file of 'column,mode'), or --match order"
        if np.isfinite(history.frequency).all():
            remedy = "Join by the frequencies in the names, --match frequency, or map columns by --columns"
        raise DataError(
            Problem(
                "nameless_column",
                history.source,
                f"column {history.name[nameless[0]]!r} names no mode",
                remedy,
            )
        )
    unique, count = np.unique(found, return_counts=True)
    if (count > 1).any():
        twice = int(unique[count.argmax()])
        names = [history.name[k] for k in np.flatnonzero(found == twice)]
        raise DataError(
            Problem(
                "mode_twice", history.source, f"mode {twice} is claimed by the columns {names}", "Map each to its mode"
            )
        )
    joined = replace(history, mode=found)
    return joined if match == "frequency" else with_own_frequencies(joined, mode, frequency)


def _in_order(history: ForeignHistory, mode: NDArray[np.int64], frequency: NDArray[np.float64]) -> ForeignHistory:
    """History whose columns have the FE modes one after the other."""
    if history.mode.size != mode.size:
        elastic = int(np.count_nonzero(~(frequency <= LOWEST_HZ)))
        remedy = "Export one column for every mode, or match by number"
        if history.mode.size == elastic:
            rigid = ",".join(str(m) for m in mode[frequency <= LOWEST_HZ])
            remedy = f"If the simulation leaves out the rigid modes, add --ignore-modes {rigid}"
        what = f"{history.mode.size} columns for {mode.size} modes"
        raise DataError(Problem("column_count", history.source, what, remedy))
    numbers = history.mode[history.mode > 0]
    twice = [name for name in history.name if history.name.count(name) > 1]
    if twice and np.unique(numbers).size < numbers.size:
        what = f"column {twice[0]!r} is there {history.name.count(twice[0])} times"
        raise DataError(Problem("mode_twice", history.source, what, "Export every mode once"))
    back = np.flatnonzero(np.diff(history.mode) < 0)
    if (history.mode > 0).all() and back.size:
        k = int(back[0])
        what = f"column {history.name[k + 1]!r} stands behind {history.name[k]!r}: which order is meant cannot be told"
        remedy = "Sort the columns by their numbers, or map each to its mode by --columns"
        raise DataError(Problem("column_order", history.source, what, remedy))
    return replace(history, mode=mode.copy())


def with_own_frequencies(
    history: ForeignHistory, mode: NDArray[np.int64], frequency: NDArray[np.float64]
) -> ForeignHistory:
    """The history, unless the frequency of a column fits another FE mode better than its own.

    Raises
    ------
    DataError : such columns, each with the mode that fits, and the way to join by frequency
    """
    columns = StatedFrequencies(history.name, history.mode, history.frequency, history.resolution)
    refuse(DataError, other_mode_problems(history.source, columns, mode, frequency))
    return history


def _by_frequency(
    history: ForeignHistory, mode: NDArray[np.int64], frequency: NDArray[np.float64]
) -> NDArray[np.int64]:
    """FE mode nearest in frequency to each column, within 1 %."""
    if not np.isfinite(history.frequency).all() or not np.isfinite(frequency).any():
        raise DataError(
            Problem(
                "no_frequencies",
                history.source,
                "columns cannot be matched by frequency: they or the FE modes have none",
                "Give a table of the simulation's modes with frequency_hz, or match by number",
            )
        )
    difference = np.abs(history.frequency[:, None] - np.nan_to_num(frequency, nan=np.inf))
    nearest = np.argmin(difference, axis=1)
    misses = difference[np.arange(nearest.size), nearest] > FREQUENCY_TOLERANCE * history.frequency
    if misses.any():
        k = int(misses.argmax())
        raise DataError(
            Problem(
                "no_such_frequency",
                history.source,
                f"column {history.name[k]!r} has {history.frequency[k]:.6g} Hz, the nearest mode, {mode[nearest[k]]}, "
                f"has {frequency[nearest[k]]:.6g} Hz",
                "Use the same modal basis on both sides, or match by number",
            )
        )
    return np.asarray(mode[nearest])
