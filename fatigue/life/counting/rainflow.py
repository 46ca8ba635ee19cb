"""Rainflow counting of one signal: every cycle with its range, mean, count and the instants of its reversals."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fatigue.life.counting.reversals import cycles_of
from fatigue.life.counting.signal import middle, recurs, samples_of
from fatigue.life.records.history import Residue

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class Cycles:
    """The rainflow cycles of one signal, in the order in which they close.

    Attributes
    ----------
    range, mean : (c,) in the unit of the signal
    count : (c,) 1.0 for a closed cycle, 0.5 for a half cycle
    start, end : (c,) sample indices of the two reversals, of a plateau the last sample; ``end < start``: the cycle runs
        across the end of the block
    """

    range: Floats
    mean: Floats
    count: Floats
    start: Indices
    end: Indices


def rainflow(signal: ArrayLike, residue: Residue) -> Cycles:
    """Count the rainflow cycles of a signal (t,), an array, list or series of whole or real numbers.

    ``half`` counts what does not close as half cycles (ASTM E1049-85, 5.4.4). ``repeat`` takes the signal as a block
    that recurs for ever: every cycle closes (ASTM E1049-85, 5.4.5; the doubled residue of ISO 12110-2). A signal that
    never changes has no cycles.

    Raises
    ------
    CaseError : another residue
    DataError : not one-dimensional, or no numbers; NumericalError : a sample is not finite, or their range overflows

    Examples
    --------
    >>> cycles = rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2], "half")
    >>> cycles.range
    array([3., 4., 4., 8., 9., 8., 6.])
    >>> cycles.count
    array([0.5, 0.5, 1. , 0.5, 0.5, 0.5, 0.5])
    """
    block, s = recurs(residue), samples_of(signal)
    start, end, weight, _ = cycles_of(s[None], recurs=block)
    return Cycles(np.abs(s[end] - s[start]), middle(s[start], s[end]), weight, start, end)
