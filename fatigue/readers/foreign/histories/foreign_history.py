"""Modal coordinates as a foreign file gives them, and the way to the modes of the FE run and to a uniform time grid."""

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.histories.mode_frequencies import StatedFrequencies, other_mode_problems
from fatigue.readers.neutral.body import LOWEST_HZ
from fatigue.readers.units.systems import Normalisation

STEP_TOLERANCE = 1e-3  # of a step: the neutral format asks for no less
FREQUENCY_TOLERANCE = 0.01
GAP = 20.0  # usual steps; an interpolation over more is told

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
    warnings : met while reading
    unit : (m,) unit the file states for the column, empty where it states none; () where it states none at all
    resolution : (m,) half a unit of the last digit written of the frequency [Hz], NaN where it is not known
    normalisation : of the modes, where the file declares it
    length : unit of length of the system of units that the file declares, empty where it declares none
    lines : (t,) line of each sample in the file, from 1; None where it has none
    """

    source: str
    mode: NDArray[np.int64]
    frequency: NDArray[np.float64]
    name: tuple[str, ...]
    time: NDArray[np.float64]
    q: NDArray[np.floating]
    warnings: tuple[Problem, ...] = field(default=())
    unit: tuple[str, ...] = ()
    resolution: NDArray[np.float64] | None = None
    normalisation: Normalisation | None = None
    length: str = ""
    lines: NDArray[np.int64] | None = None

    def sample(self, number: int) -> str:
        """Name a sample, counted from 0, with its line in the file."""
        line = "" if self.lines is None else f", line {self.lines[number]}"
        return f"{self.source}{line}, sample {number + 1}"


def check_values(history: ForeignHistory) -> ForeignHistory:
    """Refuse values that are no numbers, and times that run backwards."""
    bad = ~np.isfinite(history.time) | ~np.isfinite(history.q).all(axis=0)
    if bad.any():
        row = int(bad.argmax())
        at = np.flatnonzero(~np.isfinite(history.q[:, row]))
        column = "time" if not np.isfinite(history.time[row]) or not at.size else f"column {history.name[at[0]]!r}"
        what = f"a value is missing or no number, in {column}"
        raise DataError(Problem("not_a_number", history.sample(row), what, "Export again"))
    if history.time.size < 2:
        raise DataError(Problem("too_short", history.source, f"{history.time.size} samples", "Export at least two"))
    back = np.flatnonzero(np.diff(history.time) < 0)
    if back.size:
        row = int(back[0])
        what = f"time goes from {history.time[row]:.9g} to {history.time[row + 1]:.9g} s"
        remedy = "Export a single run with increasing time"
        if np.isclose(history.time[row + 1], history.time[0], rtol=0, atol=abs(history.time[1] - history.time[0])):
            remedy = "Export every run to a file of its own"
        raise DataError(Problem("time_order", history.sample(row + 1), what, remedy))
    return history


def _once(history: ForeignHistory) -> tuple[ForeignHistory, list[Problem]]:
    """Keep every instant once, the later sample of those that share it."""
    keep = np.append(np.diff(history.time) > 0, True)
    if keep.all():
        return history, []
    first, count = int((~keep).argmax()), int(np.count_nonzero(~keep))
    what = f"time stands still at {history.time[first]:.9g} s; the later sample of every instant is kept"
    what += f" ({count} left out)"
    warning = Problem("instant_twice", history.sample(first + 1), what, "Export every instant once to avoid it", count)
    lines = None if history.lines is None else history.lines[keep]
    return replace(history, time=history.time[keep], q=history.q[:, keep], lines=lines), [warning]


def uniform(history: ForeignHistory, resample_s: float | None) -> ForeignHistory:
    """Keep a uniform time grid, or interpolate onto one by cubic splines if ``resample_s`` is given.

    Of an instant that is written twice, as solvers do at events, the later sample counts in the interpolation.

    Raises
    ------
    DataError
        time stands still, or the steps differ by more than 1e-3, and no step is given; or it is coarser than the file's
        own
    """
    if resample_s is None:
        still = np.flatnonzero(np.diff(history.time) <= 0)
        if still.size:
            row = int(still[0])
            what = f"time goes from {history.time[row]:.9g} to {history.time[row + 1]:.9g} s, it stands still"
            more = f" (and at {still.size - 1} more samples)" if still.size > 1 else ""
            remedy = "Export every instant once, or resample with --resample, which keeps the later sample"
            raise DataError(Problem("time_order", history.sample(row + 1), what + more, remedy))
        steps = np.diff(history.time)
        mean = float((history.time[-1] - history.time[0]) / steps.size)
        worst = int(np.argmax(np.abs(steps - mean)))
        if abs(steps[worst] - mean) > STEP_TOLERANCE * mean:
            raise DataError(
                Problem(
                    "uneven_step",
                    history.sample(worst + 1),
                    f"the time step is {steps[worst]:.6g} s where the mean is {mean:.6g} s",
                    f"Export at a constant step, or resample, for instance with a step of {np.median(steps):.6g} s",
                )
            )
        return history
    history, twice = _once(history)
    if history.time.size < 2:
        raise DataError(Problem("too_short", history.source, "time stands still", "Export at least two instants"))
    steps = np.diff(history.time)
    count = (history.time[-1] - history.time[0]) / resample_s if resample_s > 0 else np.inf
    if not (resample_s > 0 and 1 <= count < 1e8):
        raise DataError(
            Problem("bad_step", history.source, f"a step of {resample_s:g} s is impossible", "Give another")
        )
    time = history.time[0] + resample_s * np.arange(int(count + 1e-9) + 1)
    q = CubicSpline(history.time, history.q, axis=1)(np.minimum(time, history.time[-1]))
    warnings = [
        *twice,
        Problem(
            "resampled",
            history.source,
            f"{history.time.size} samples with steps from {steps.min():.6g} to {steps.max():.6g} s were resampled to "
            f"{resample_s:.6g} s",
            "Export at a constant step to avoid it",
        ),
    ]
    longest = int(np.argmax(steps))
    if steps[longest] > GAP * max(float(np.median(steps)), resample_s):
        what = f"a gap of {steps[longest]:.6g} s from {history.time[longest]:.9g} s was filled by interpolation"
        warnings.append(Problem("gap", history.sample(longest + 1), what, "Check that no samples were lost there"))
    if resample_s > 1.001 * float(np.median(steps)):
        warnings.append(
            Problem("coarser", history.source, "the new step is coarser than the file's usual one", "Use a finer step")
        )
    return replace(history, time=time, q=q, lines=None, warnings=(*history.warnings, *warnings))


def matched(
    history: ForeignHistory, mode: NDArray[np.int64], frequency: NDArray[np.float64], match: Match
) -> ForeignHistory:
    """Give every column the number of an FE mode.

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
    """Give the columns the FE modes one after the other."""
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
    return replace(history, mode=mode.copy())


def with_own_frequencies(
    history: ForeignHistory, mode: NDArray[np.int64], frequency: NDArray[np.float64]
) -> ForeignHistory:
    """Refuse columns whose frequency fits another FE mode than their own better.

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
