"""What is kept of a record that is read and not held: how far each modal coordinate goes, and its first two moments."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import first_kept

Floats = NDArray[np.float64]

STILL = 1e-12  # of the largest value: what rounding leaves of a constant
SAME = 1e-6  # of the range of a column: records in single and in double precision are the same


@dataclass(slots=True)
class _Extent:
    """Smallest and largest value of some samples."""

    low: float = np.inf
    high: float = -np.inf

    def add(self, values: NDArray[Any]) -> None:
        self.low = min(self.low, float(values.min(initial=np.inf)))
        self.high = max(self.high, float(values.max(initial=-np.inf)))


@dataclass(slots=True)
class _Column:
    """One modal coordinate: its extent as a whole and behind the start-up, its sums, its first and its last sample."""

    whole: _Extent = field(default_factory=_Extent)
    kept: _Extent = field(default_factory=_Extent)
    samples: int = 0
    sum: float = 0.0
    sum_of_squares: float = 0.0
    first: float = np.nan
    last: float = np.nan

    def add(self, values: NDArray[Any], first_kept: int) -> None:
        """Take in the next samples, kept from number ``first_kept`` of the record on."""
        if self.samples == 0:
            self.first = float(values[0])
        self.last = float(values[-1])
        self.whole.add(values)
        self.kept.add(values[max(0, first_kept - self.samples) :])
        with np.errstate(over="ignore", invalid="ignore"):
            self.sum += float(values.sum(dtype=np.float64))
            self.sum_of_squares += float(np.square(values, dtype=np.float64).sum())
        self.samples += values.size

    @property
    def moves(self) -> bool:
        """Whether it changes behind the start-up."""
        return self.kept.high - self.kept.low > STILL * max(abs(self.kept.low), abs(self.kept.high))

    @property
    def fingerprint(self) -> tuple[float, ...]:
        """Values that are the same where the samples are: extent, first, last, mean and root mean square."""
        n = self.samples
        with np.errstate(over="ignore", invalid="ignore"):
            rms = float(np.sqrt(np.float64(self.sum_of_squares) / n))
        return self.whole.low, self.whole.high, self.first, self.last, self.sum / n, rms


@dataclass(slots=True)
class RecordOutline:
    """Outline of the record of one event; ``start_s`` [s]: how much of its beginning is start-up."""

    start_s: float = 0.0
    columns: list[_Column] = field(default_factory=list)

    def add(self, mode: int, values: NDArray[Any], step: float) -> None:
        """Take in the next samples of the coordinate of number ``mode``, ``step`` [s] apart."""
        self._column(mode).add(values, first_kept(step, self.start_s) if step > 0.0 else 0)

    def add_kept(self, mode: int, values: NDArray[Any]) -> None:
        """Take in samples of a coordinate that has no start-up."""
        self._column(mode).add(values, 0)

    def _column(self, mode: int) -> _Column:
        self.columns += [_Column() for _ in range(len(self.columns), mode + 1)]
        return self.columns[mode]

    def forget(self) -> None:
        """Begin again: the record is read anew."""
        self.columns.clear()

    @property
    def moves(self) -> NDArray[np.bool_]:
        """Whether each modal coordinate changes behind the start-up, (m,)."""
        return np.array([column.moves for column in self.columns])

    def equals(self, other: "RecordOutline") -> bool:
        """Whether two records seem to have the same samples in every mode."""
        mine, its = (np.array([column.fingerprint for column in of.columns]) for of in (self, other))
        with np.errstate(over="ignore", invalid="ignore"):
            size = np.maximum(mine[:, 1] - mine[:, 0], np.abs(mine[:, 1]) * SAME)[:, np.newaxis]
            return bool(np.all((mine == its) | (np.abs(mine - its) <= SAME * size)))
