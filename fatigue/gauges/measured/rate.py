"""A record brought to the rate of another one, by the exact ratio of the two."""

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray
from scipy.signal import resample_poly

Floats = NDArray[np.float64]

LARGEST_FACTOR = 1000  # of up and down
MOST_SLIP = 0.01  # of a sample over the whole record


def exact_ratio(rate_hz: float, wanted_hz: float, samples: int) -> Fraction | None:
    """``up / down`` that takes a record of so many samples to the rate that is wanted; None: there is no such ratio.

    Rates come from times in a file. A ratio is exact if over the whole record it slips by less than ``MOST_SLIP``.

    >>> exact_ratio(250.0, 200.0, 15000), exact_ratio(250.0, 200.01, 15000)
    (Fraction(4, 5), None)
    """
    wanted = wanted_hz / rate_hz
    ratio = Fraction(wanted).limit_denominator(LARGEST_FACTOR)
    if not 0 < ratio.numerator <= LARGEST_FACTOR:
        return None
    slip = abs(float(ratio) / wanted - 1.0) * samples
    return ratio if slip <= MOST_SLIP else None


def at_ratio(x: Floats, ratio: Fraction) -> Floats:
    """Samples (t,) at ``ratio`` times their rate, behind an anti-aliasing filter (measured_data 2.3)."""
    if ratio == 1:
        return x
    return np.asarray(resample_poly(x, ratio.numerator, ratio.denominator, padtype="line"))
