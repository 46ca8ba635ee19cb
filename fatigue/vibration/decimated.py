"""A record at a lower sampling rate: what hunting is looked for in needs some 200 Hz, files have up to some kHz."""

import numpy as np
from numpy.typing import NDArray
from scipy import signal

SLOW_HZ = 200.0  # enough for bands up to some 20 Hz
SAMPLES_PER_PERIOD = 10  # of the highest frequency of the band that stays


def decimated(values: NDArray[np.float64], step: float, upper_hz: float) -> tuple[NDArray[np.float64], float]:
    """Samples and step [s] of a record thinned to no less than 200 Hz and ten samples per period of ``upper_hz``.

    The filter is linear-phase and without delay: the first sample stays where it is. A record that is slow already is
    given back as it is. The line through its ends is kept apart, so constants and drifts leave no transient.
    """
    factor = int(1 / (step * max(SLOW_HZ, SAMPLES_PER_PERIOD * upper_hz)) * (1 + 1e-9))
    if factor < 2:
        return values, step
    return np.asarray(signal.resample_poly(values, 1, factor, padtype="line")), step * factor
