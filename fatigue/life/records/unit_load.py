"""One unit load of one event: where it comes from, and its value at any instant of a uniform grid.

Between its samples a load is read by its trigonometric interpolant: of the record as it stands where that is one period
of the event, else of its mirrored extension. Both are exact for records without content above half their sampling rate.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.chirp import fourier_sum

Interpolation = Literal["fourier", "linear"]
Floats = NDArray[np.float64]

SAME = 1e-3  # of a step: instants of two grids that are the same


@dataclass(frozen=True, slots=True)
class LoadSource:
    """Where an event has one unit load from.

    Attributes
    ----------
    name, unit : of the unit load
    way : a column of the event's own record, a file of its own, values of a static load case, a constant; or missing
    column : of the record or the file, ``path`` the file
    scale : factor on all values; ``shift_s`` is added to the times of the file [s]
    interpolation : how a file is read between its samples
    constant : of a constant load, scaled; 0 of every other
    values : of a static load case, scaled
    """

    name: str
    way: Literal["column", "file", "values", "constant", "missing"]
    column: str = ""
    path: Path | None = None
    scale: float = 1.0
    shift_s: float = 0.0
    interpolation: Interpolation = "fourier"
    constant: float = 0.0
    values: tuple[float, ...] = ()
    unit: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class UniformGrid:
    """Instants ``start + step i`` [s] of so many samples."""

    start: float
    step: float
    samples: int

    @property
    def end(self) -> float:
        """The last instant [s]."""
        return self.start + self.step * (self.samples - 1)

    @property
    def duration(self) -> float:
        """Samples times step [s]: of a block that repeats."""
        return self.step * self.samples

    def finer(self, factor: int, *, repeats: bool) -> "UniformGrid":
        """The grid that upsampling by a factor makes of it."""
        samples = self.samples * factor if repeats else (self.samples - 1) * factor + 1
        return UniformGrid(self.start, self.step / factor, samples)


@dataclass(frozen=True, slots=True, eq=False)
class LoadRecord:
    """Samples of a unit load over file time of its event.

    Attributes
    ----------
    values : (n,) samples
    grid : their instants
    interpolation : how the load is read between them
    periodic : whether they are exactly one period of an event that repeats
    """

    values: NDArray[np.floating]
    grid: UniformGrid
    interpolation: Interpolation
    periodic: bool

    def within(self, kept: UniformGrid, *, repeats: bool) -> "LoadRecord":
        """The load in an event that repeats or not, whose kept record has these instants."""
        h = self.grid.step
        starts, lasts = abs(self.grid.start - kept.start), abs(self.grid.duration - kept.duration)
        return replace(self, periodic=repeats and starts <= SAME * h and lasts <= SAME * h)

    def covers(self, kept: UniformGrid) -> bool:
        """Whether it reaches from the first instant to the last one, within half a step of its own."""
        half = (0.5 + SAME) * self.grid.step
        return self.periodic or (self.grid.start <= kept.start + half and self.grid.end >= kept.end - half)

    def refinement(self, step: float) -> int:
        """Smallest power of 2 by which a step has to be divided so as not to be above that of the load."""
        factor = 1
        while step / factor > self.grid.step * (1.0 + SAME):
            factor *= 2
        return factor

    def same_instants(self, wanted: UniformGrid) -> slice | None:
        """The samples that stand at the wanted instants, within 1e-3 of a step; None where others do."""
        first = round((wanted.start - self.grid.start) / self.grid.step)
        own = UniformGrid(self.grid.start + first * self.grid.step, self.grid.step, wanted.samples)
        apart = max(abs(own.start - wanted.start), abs(own.end - wanted.end))
        if first < 0 or first + wanted.samples > self.grid.samples or apart > SAME * wanted.step:
            return None
        return slice(first, first + wanted.samples)

    def at(self, wanted: UniformGrid) -> NDArray[np.floating]:
        """Values at the wanted instants, (t,): samples that stand there as they are, else between the samples."""
        if (found := self.same_instants(wanted)) is not None:
            return self.values[found]
        first, rate = (wanted.start - self.grid.start) / self.grid.step, wanted.step / self.grid.step
        values = self.values.astype(np.float64)
        if self.interpolation == "linear":
            ring = np.append(values, values[0]) if self.periodic else values
            place = first + rate * np.arange(wanted.samples)
            if self.periodic:
                place %= values.size
            return np.asarray(np.interp(place, np.arange(ring.size), ring))
        if not self.periodic:
            values = np.concatenate([values, values[-2:0:-1]])
        return trigonometric_interpolant(values, first, rate, wanted.samples)

    def overshoot(self, found: NDArray[np.floating]) -> float:
        """How far values lie outside those that were sampled, relative to the range of these."""
        low, high = float(self.values.min()), float(self.values.max())
        if high == low:
            return 0.0
        return max(low - float(found.min()), float(found.max()) - high, 0.0) / (high - low)


def trigonometric_interpolant(period: Floats, first: float, rate: float, samples: int) -> Floats:
    """Values of the trigonometric interpolant of one period (p,) at the places ``first + rate i`` of its samples, (t,).

    ``x(s) = Re sum over k of w_k X_k exp(2 pi i k s / p) / p`` with weights 2, but 1 for the mean and, where p is even,
    for the line at half the sampling rate, which stands for both +f and -f.
    """
    p = period.size
    mean = float(period.mean())
    lines = np.fft.rfft(period - mean) * (2.0 / p)
    lines[0] *= 0.5
    if p % 2 == 0:
        lines[-1] *= 0.5
    return mean + fourier_sum(lines, first / p, rate / p, samples).real
