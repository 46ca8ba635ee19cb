"""Modal coordinates as a foreign file gives them."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.units.systems import Normalisation


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
    """The history, unless values are no numbers, or times run backwards."""
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
