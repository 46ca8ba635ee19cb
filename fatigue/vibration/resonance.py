"""Does a mode follow its load, or does it swing: classes by what its excitation and its response are like."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

CLASSES = ("quasi_static", "resonant", "inertial", "not_assessed")

DYNAMIC = 0.5  # share from which a mode swings: a sine at r has r^2, and at r^2 = 0.5 answers 1 / (1 - r^2) = 2 times
AMPLIFIED = 1.0  # rms of the coordinate over that of its quasi-static part: below it the mode moves less than its load
HALF_POWER = 0.5  # of the variance of the response within f (1 +- 2 zeta): swings in resonance whatever else it does
FAR_ABOVE = 2.0  # times the highest frequency of the motion: a boundary mode, whose dynamic share is r^2 < 1/4
HIGHEST = 0.99  # of the variance of a coordinate lies below the highest frequency of its motion
OFF_RESONANCE = 0.1  # of the frequency of a mode: beyond it damping of 5 % changes the dynamic stiffness by 12 %


class Indicators(NamedTuple):
    """What the class of modes follows from; arrays (m,), NaN where a number could not be had.

    Attributes
    ----------
    frequency_hz : natural frequencies
    highest_hz : highest frequency of the motion of each
    dynamic_share : rms of the dynamic part over that of the coordinate
    amplification : rms of the coordinate over that of its quasi-static part
    response_share : variance of the coordinate within f (1 +- 2 zeta) over all of it
    """

    frequency_hz: Floats
    highest_hz: Floats
    dynamic_share: Floats
    amplification: Floats
    response_share: Floats


def mode_classes(of: Indicators) -> NDArray[np.object_]:
    """Class of each mode, (m,).

    ``quasi_static``: it follows its load, or lies above twice the highest frequency of its motion (a boundary mode).
    ``resonant``: at least half of its motion is dynamic, and it moves more than its load alone would move it, or mostly
    within its half-power band. ``inertial``: at least half is dynamic, but its loads are above its frequency, where it
    moves less. ``not_assessed``: there is no dynamic share.
    """
    swings = of.dynamic_share >= DYNAMIC
    more = (of.amplification >= AMPLIFIED) | (of.response_share >= HALF_POWER)
    found = np.full(len(of.frequency_hz), "not_assessed", dtype=object)
    found[of.dynamic_share < DYNAMIC] = "quasi_static"
    found[is_boundary(of)] = "quasi_static"
    found[swings & more] = "resonant"
    found[swings & ~more] = "inertial"
    return found


def is_boundary(of: Indicators) -> NDArray[np.bool_]:
    """Whether modes lie above twice the highest frequency of their motion, so that they can only follow it."""
    return np.asarray(of.frequency_hz > FAR_ABOVE * of.highest_hz)
