"""Frequencies that a simulation states for its modes, compared with the frequencies of the FE run mode by mode."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.units.channel_names import written

RIGID_HZ = 0.1  # below it a frequency of a rigid mode is noise on either side


@dataclass(frozen=True, slots=True, eq=False)
class StatedFrequencies:
    """Frequencies of the columns of a history.

    Attributes
    ----------
    name : (m,) of the column
    mode : (m,) FE mode it is joined with
    frequency : (m,) stated [Hz], NaN where none is
    resolution : (m,) half a unit of the last digit written [Hz], NaN where it is not known; None: of none
    """

    name: tuple[str, ...]
    mode: NDArray[np.int64]
    frequency: NDArray[np.float64]
    resolution: NDArray[np.float64] | None

    def half_digit(self, k: int) -> float:
        """Half a unit of the last digit in which the frequency of a column is written [Hz]."""
        if self.resolution is not None and np.isfinite(self.resolution[k]):
            return float(self.resolution[k])
        return written(repr(float(self.frequency[k])))[1]


def other_mode_problems(
    source: str, columns: StatedFrequencies, mode: NDArray[np.int64], frequency: NDArray[np.float64]
) -> list[Problem]:
    """Mistakes of columns whose frequency fits another FE mode better, by more than its written digits explain.

    ``mode`` and ``frequency``, (k,) [Hz], belong to the FE run. Frequencies of rigid modes are not compared.
    """
    of_mode = dict(zip(mode.tolist(), frequency.tolist(), strict=True))
    known = np.isfinite(frequency)
    problems = []
    for k, (m, f) in enumerate(zip(columns.mode.tolist(), columns.frequency.tolist(), strict=True)):
        own = of_mode.get(m, np.nan)
        if not (np.isfinite(f) and np.isfinite(own)) or max(f, own) <= RIGID_HZ:
            continue
        at = int(np.argmin(np.abs(frequency[known] - f)))
        nearest, other = float(frequency[known][at]), int(mode[known][at])
        if abs(nearest - f) < abs(own - f) and abs(f - (own + nearest) / 2) > columns.half_digit(k):
            what = f"column {columns.name[k]!r} has {f:.6g} Hz; its mode {m} has {own:.6g} Hz in the FE run, "
            what += f"mode {other} has {nearest:.6g} Hz"
            remedy = "Join by --match frequency, or use the same modal basis on both sides"
            problems.append(Problem("frequency_of_another", source, what, remedy))
    return problems
