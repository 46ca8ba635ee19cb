"""A flagged record cut into segments, each counted alone, and the line that carries a filter over what was cut out."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.gauges.measured.flags import Mask, runs

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Cut:
    """A channel between its flagged samples.

    Attributes
    ----------
    x : (t,) samples, straight lines where they are flagged: filters and changes of rate see no step there
    segments : first and last sample of each stretch that is kept and counted
    bridged : samples of short gaps that a line stands for, and that are counted
    """

    x: Floats
    segments: tuple[tuple[int, int], ...]
    bridged: int

    @property
    def kept(self) -> Mask:
        """Samples (t,) in the segments."""
        return mask_of(self.segments, len(self.x))


def cut_at(x: Floats, flagged: Mask, bridge: int = 0) -> Cut:
    """Cut samples (t,) at those that are flagged; gaps of at most ``bridge`` samples become a line instead.

    Nothing is extrapolated: before the first and behind the last good sample the value of that sample is held, and
    never kept.
    """
    good = np.flatnonzero(~flagged)
    if not good.size:
        return Cut(np.zeros(len(x)), (), 0)
    left, bridged = flagged.copy(), 0
    for first, last in runs(flagged):
        if last - first + 1 <= bridge and first > 0 and last < len(x) - 1:
            left[first : last + 1] = False
            bridged += last - first + 1
    line = np.interp(np.arange(len(x)), good, x[good])
    return Cut(np.where(flagged, line, x), tuple(runs(~left)), bridged)


def at_rate(segments: tuple[tuple[int, int], ...], up: int, down: int) -> tuple[tuple[int, int], ...]:
    """The samples of a record at ``up / down`` times the rate that lie inside its segments.

    >>> at_rate(((0, 9), (11, 11)), 4, 5)
    ((0, 7),)
    """
    moved = ((-(-first * up // down), last * up // down) for first, last in segments)
    return tuple((first, last) for first, last in moved if last >= first)


def mask_of(segments: tuple[tuple[int, int], ...], samples: int) -> Mask:
    """Mask (t,) of the samples in segments."""
    mask = np.zeros(samples, dtype=np.bool_)
    for first, last in segments:
        mask[first : last + 1] = True
    return mask
