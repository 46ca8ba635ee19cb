"""One side of a comparison, measured or simulated: band-limited strain, what of it is counted, and over how many km."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.gauges.measured.flags import Mask
from fatigue.gauges.measured.segments import mask_of
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.records.history import Residue

Floats = NDArray[np.float64]
Segments = tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Strain:
    """One record of strain, all of it at the rate of the simulation.

    Attributes
    ----------
    x : (t,) [ue]
    segments : first and last sample of each stretch that is counted
    """

    x: Floats
    segments: Segments

    @property
    def kept(self) -> Mask:
        """Samples (t,) that are counted."""
        return mask_of(self.segments, len(self.x))

    @property
    def is_whole(self) -> bool:
        """Whether nothing is cut out between its first and last counted sample."""
        return len(self.segments) == 1


class Place(NamedTuple):
    """Where a cycle is: its record, and the samples of its two reversals, earlier and later."""

    record: int
    first: int
    last: int


@dataclass(frozen=True, slots=True, eq=False)
class Counted:
    """Rainflow cycles of a side: ranges (c,) [ue], largest first, how often each occurs in a km, where the first is."""

    range: Floats
    per_km: Floats
    largest: Place | None = None

    def pseudo_damage(self, k: float) -> float:
        """``sum n range^k`` per km [ue^k/km]."""
        return float(self.per_km @ self.range**k)

    def range_exceeded(self, per_km: float) -> float:
        """Range [ue] that is reached so often in a km, linear in the logarithm of that; NaN outside the cycles.

        >>> found = Counted(np.array([9.0, 3.0]), np.array([1.0, 99.0]))
        >>> round(found.range_exceeded(10.0), 9), found.range_exceeded(0.5)
        (6.0, nan)
        """
        if not self.range.size or np.isnan(self.per_km).any():
            return np.nan
        reached = np.log(np.cumsum(self.per_km))
        return float(np.interp(np.log(per_km), reached, self.range, left=np.nan, right=np.nan))

    def reached(self, levels: Floats) -> Floats:
        """Cycles per km whose range is at least each of some levels [ue]."""
        below = np.searchsorted(self.range[::-1], levels, side="left")
        reached = np.append(np.cumsum(self.per_km)[::-1], 0.0)
        return np.asarray(reached[below])


def counted(records: tuple[Strain, ...], residue: Residue, km: float) -> Counted:
    """Cycles of the records of a side over the distance that was counted.

    A record that nothing is cut out of is counted with the residue of the event. The segments of one that is cut are
    counted alone, as single passes: what closes across a cut is not known (measured_data 2.1). Over no distance at all
    nothing is had per km: NaN.
    """
    stretches = [(i, *segment) for i, record in enumerate(records) for segment in record.segments]
    ranges, counts, largest, top = [np.zeros(0)], [np.zeros(0)], None, 0.0
    for i, first, last in stretches:
        cycles = rainflow(records[i].x[first : last + 1], residue if records[i].is_whole else "half")
        ranges.append(cycles.range)
        counts.append(cycles.count)
        if cycles.range.max(initial=0.0) > top:
            at = int(cycles.range.argmax())
            top = float(cycles.range[at])
            largest = Place(i, *sorted((first + int(cycles.start[at]), first + int(cycles.end[at]))))
    all_ranges = np.concatenate(ranges)
    order = np.argsort(-all_ranges, kind="stable")
    per_km = np.concatenate(counts)[order] / (km if km > 0.0 else np.nan)
    return Counted(all_ranges[order], per_km, largest)


def rms(records: tuple[Strain, ...]) -> float:
    """Root mean square of what is counted, about its mean [ue]; NaN of nothing."""
    kept = np.concatenate([np.zeros(0), *(record.x[record.kept] for record in records)])
    return float(kept.std()) if kept.size else np.nan
