"""Where a measured record lies on the simulation that it is replayed by: normalised cross-correlation."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import correlate

Floats = NDArray[np.float64]

RIVAL = 0.95  # of the largest correlation: one of the other sign that large leaves the sign open


@dataclass(frozen=True, slots=True)
class Alignment:
    """How a measured record lies on a simulated one.

    Attributes
    ----------
    lag_s : by how much the measured one is late, to parts of a sample [s]
    shift : the same in whole samples
    correlation : coefficient at that lag, of the largest size; below 0: the signs differ
    rival : the largest coefficient of the other sign within the search, by its size
    at_end : it is at an end of the search, so that a larger one may lie beyond
    """

    lag_s: float
    shift: int
    correlation: float
    rival: float
    at_end: bool

    @property
    def sign_is_open(self) -> bool:
        """Whether the other sign fits nearly as well, at another lag."""
        return self.rival > RIVAL * abs(self.correlation)


def aligned(
    measured: Floats, simulated: Floats, rate_hz: float, max_lag_s: float, kept: NDArray[np.bool_] | None = None
) -> Alignment:
    """Lag of a measured record (t,) behind a simulated one (t,) whose means are zero (measured_data 2.3).

    The lag is at the vertex of the parabola through the three largest neighbouring values. Samples that are not
    ``kept`` (t,) count on neither side. A record without content has no correlation: NaN.

    >>> t = np.arange(2000) / 200.0
    >>> found = aligned(-np.sin(9.0 * (t - 0.01)), np.sin(9.0 * t), 200.0, 0.1)
    >>> round(found.lag_s, 2), round(found.correlation, 2)
    (0.01, -1.0)
    """
    beside = simulated[: len(measured)]
    if kept is not None:
        measured, beside = np.where(kept, measured, 0.0), np.where(kept, beside, 0.0)
    norm = float(np.sqrt((measured @ measured) * (beside @ beside)))
    if norm == 0.0:
        return Alignment(0.0, 0, np.nan, np.nan, False)
    most = min(round(max_lag_s * rate_hz), len(measured) - 1)
    middle = len(simulated) - 1
    c = correlate(measured, simulated, method="fft")[middle - most : middle + most + 1] / norm
    peak = int(np.abs(c).argmax())
    sign = 1.0 if c[peak] >= 0.0 else -1.0
    at_end = peak in (0, len(c) - 1)
    part = 0.0 if at_end else _vertex(*(sign * c[peak - 1 : peak + 2]))
    rival = max(0.0, float((-sign * c).max()))
    return Alignment(float((peak - most + part) / rate_hz), peak - most, float(c[peak]), rival, at_end)


def _vertex(left: float, top: float, right: float) -> float:
    """Place of the vertex of the parabola through three values, from the middle one."""
    bend = left - 2.0 * top + right
    return 0.0 if bend == 0.0 else 0.5 * (left - right) / bend
