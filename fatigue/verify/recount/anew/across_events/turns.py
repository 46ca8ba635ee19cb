"""What a pass of an event leaves for the count of several in a row at a point: its turning points and its cycles."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.cycles import RecountCycles

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Turns:
    """One pass without the samples between its turning points.

    Attributes
    ----------
    event : number of the event
    membrane, bending : (r,) stresses, with what is constant [MPa]
    time : (r,) file time [s]
    cycles : those of the pass by itself, by places among the turning points
    recurs : whether these are of a block that repeats
    """

    event: int
    membrane: Floats
    bending: Floats
    time: Floats
    cycles: RecountCycles
    recurs: bool

    @property
    def stress(self) -> Floats:
        """Sum of both, (r,) [MPa]."""
        return self.membrane + self.bending


def turning_points(stress: Floats, cycles: RecountCycles) -> Counts:
    """Samples of a pass that may begin or end a cycle whatever comes before and after it, ascending.

    These are the first and the last one, the last one of each level stretch behind which the stress turns or begins to
    move, and those between which its own cycles run.
    """
    step = np.diff(stress)
    leaves = np.flatnonzero(step)  # last samples of their level
    turns = np.flatnonzero(np.signbit(step[leaves][1:]) != np.signbit(step[leaves][:-1])) + 1
    ends = np.array([0, len(stress) - 1])
    return np.unique(np.concatenate([ends, leaves[:1], leaves[turns], cycles.start, cycles.end]))


def of_places(cycles: RecountCycles, samples: Counts) -> RecountCycles:
    """Cycles between samples as cycles between the places of these in a list."""
    start, end = np.searchsorted(samples, cycles.start), np.searchsorted(samples, cycles.end)
    return RecountCycles(start, end, cycles.count)
