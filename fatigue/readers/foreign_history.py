"""Modal coordinates as a foreign file gives them, and the way to the modes of the FE run and to a uniform time grid."""

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from fatigue.errors import DataError, Problem

STEP_TOLERANCE = 1e-3  # of a step: the neutral format asks for no less
FREQUENCY_TOLERANCE = 0.01

Match = Literal["id", "frequency", "order"]
"""How columns find their modes: by mode number, by nearest frequency, or one after the other."""


@dataclass(frozen=True, slots=True, eq=False)
class ForeignHistory:
    """Modal coordinates of one run, in the file's own units.

    Attributes
    ----------
    source : file
    mode : (m,) mode numbers of the simulation, 0 where the file gives none
    frequency : (m,) frequency of the mode [Hz], NaN where the file gives none
    name : (m,) name of the column
    time : (t,) [s]
    q : (m, t)
    remarks : doubts met while reading
    """

    source: str
    mode: NDArray[np.int64]
    frequency: NDArray[np.float64]
    name: tuple[str, ...]
    time: NDArray[np.float64]
    q: NDArray[np.floating]
    remarks: tuple[Problem, ...] = field(default=())


def check_values(history: ForeignHistory) -> ForeignHistory:
    """Refuse values that are no numbers, and times that stand still or run backwards."""
    bad = ~np.isfinite(history.time) | ~np.isfinite(history.q).all(axis=0)
    if bad.any():
        row = int(bad.argmax())
        raise DataError(
            Problem(
                "not_a_number", f"{history.source}, sample {row + 1}", "a value is missing or no number", "Export again"
            )
        )
    if history.time.size < 2:
        raise DataError(Problem("too_short", history.source, f"{history.time.size} samples", "Export at least two"))
    back = np.flatnonzero(np.diff(history.time) <= 0)
    if back.size:
        row = int(back[0])
        raise DataError(
            Problem(
                "time_order",
                f"{history.source}, sample {row + 2}",
                f"time goes from {history.time[row]:.9g} to {history.time[row + 1]:.9g} s",
                "Export a single run with increasing time, one sample at every instant",
            )
        )
    return history


def uniform(history: ForeignHistory, resample_s: float | None) -> ForeignHistory:
    """Keep a uniform time grid, or interpolate onto one by cubic splines if ``resample_s`` is given.

    Raises
    ------
    DataError : the steps differ by more than 1e-3 and no step is given, or it is coarser than the file's own
    """
    steps = np.diff(history.time)
    mean = float((history.time[-1] - history.time[0]) / steps.size)
    if resample_s is None:
        worst = int(np.argmax(np.abs(steps - mean)))
        if abs(steps[worst] - mean) > STEP_TOLERANCE * mean:
            raise DataError(
                Problem(
                    "uneven_step",
                    f"{history.source}, sample {worst + 2}",
                    f"the time step is {steps[worst]:.6g} s where the mean is {mean:.6g} s",
                    f"Export at a constant step, or resample, for instance with a step of {np.median(steps):.6g} s",
                )
            )
        return history
    count = (history.time[-1] - history.time[0]) / resample_s if resample_s > 0 else np.inf
    if not (resample_s > 0 and 1 <= count < 1e8):
        raise DataError(
            Problem("bad_step", history.source, f"a step of {resample_s:g} s is impossible", "Give another")
        )
    time = history.time[0] + resample_s * np.arange(int(count + 1e-9) + 1)
    q = CubicSpline(history.time, history.q, axis=1)(np.minimum(time, history.time[-1]))
    remarks = [
        Problem(
            "resampled",
            history.source,
            f"{history.time.size} samples with steps from {steps.min():.6g} to {steps.max():.6g} s were resampled to "
            f"{resample_s:.6g} s",
            "Export at a constant step to avoid it",
        )
    ]
    if resample_s > 1.001 * float(np.median(steps)):
        remarks.append(
            Problem("coarser", history.source, "the new step is coarser than the file's usual one", "Use a finer step")
        )
    return replace(history, time=time, q=q, remarks=(*history.remarks, *remarks))


def matched(
    history: ForeignHistory, mode: NDArray[np.int64], frequency: NDArray[np.float64], match: Match
) -> ForeignHistory:
    """Give every column the number of an FE mode.

    Parameters
    ----------
    mode, frequency : (k,) numbers and frequencies [Hz] of the FE modes

    Raises
    ------
    DataError : a column without a mode or a mode claimed twice; no frequencies to match by
    """
    if match == "order":
        if history.mode.size != mode.size:
            raise DataError(
                Problem(
                    "column_count",
                    history.source,
                    f"{history.mode.size} columns for {mode.size} modes",
                    "Export one column for every mode, or match by number",
                )
            )
        return replace(history, mode=mode.copy())
    found = history.mode if match == "id" else _by_frequency(history, mode, frequency)
    nameless = np.flatnonzero(found <= 0)
    if nameless.size:
        raise DataError(
            Problem(
                "nameless_column",
                history.source,
                f"column {history.name[nameless[0]]!r} names no mode",
                "Name columns by mode number, map them with a file of the columns 'column,mode', or match by order",
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
    return replace(history, mode=found)


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
