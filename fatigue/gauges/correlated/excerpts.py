"""Histories around the largest cycles: one on the other where they are aligned, else each around its own."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.gauges.correlated.numbers import Side
from fatigue.gauges.correlated.sides import Place
from fatigue.gauges.measured.alignment import Alignment

Floats = NDArray[np.float64]

SHORTEST_S, LONGEST_S = 1.5, 5.0  # before and behind the middle of the cycle
BEYOND_S = 0.5  # behind its ends


class Excerpt(NamedTuple):
    """Some strain of one side: its name, time (n,) [s], strain (n,) [ue], NaN where it is cut."""

    side: str
    time: Floats
    strain: Floats


def largest_excerpt(side: Side, rate_hz: float) -> tuple[Floats, Floats] | None:
    """Time from the middle of the largest cycle [s] and strain [ue] around it; None of a side without cycles."""
    place = side.cycles.largest
    if place is None:
        return None
    at, middle = _around(place, len(side.records[place.record].x), rate_hz)
    return np.asarray((at - middle) / rate_hz, dtype=np.float64), _counted(side, place.record, at)


def aligned_excerpt(measured: Side, simulated: Side, alignment: Alignment, rate_hz: float) -> tuple[Excerpt, ...]:
    """Both sides around the largest measured cycle, the measured one moved back by its lag, in time of the record."""
    place = measured.cycles.largest or simulated.cycles.largest
    if place is None:
        return ()
    at, _ = _around(place, len(measured.records[0].x), rate_hz)
    first = Excerpt("measured", at / rate_hz - alignment.lag_s, _counted(measured, 0, at))
    inside = at - alignment.shift
    inside = inside[(inside >= 0) & (inside < len(simulated.records[0].x))]
    return first, Excerpt("simulated", inside / rate_hz, _counted(simulated, 0, inside))


def _around(place: Place, samples: int, rate_hz: float) -> tuple[NDArray[np.int64], float]:
    """Samples around a cycle, and its middle; of one across the end of a block, those around its later reversal."""
    half = 0.5 * (place.last - place.first) / rate_hz + BEYOND_S
    middle = 0.5 * (place.first + place.last) if half <= LONGEST_S else float(place.last)
    reach = rate_hz * min(max(half, SHORTEST_S), LONGEST_S)
    return np.arange(max(0, int(middle - reach)), min(samples, int(middle + reach) + 1)), middle


def _counted(side: Side, record: int, at: NDArray[np.int64]) -> Floats:
    one = side.records[record]
    return np.where(one.kept[at], one.x[at], np.nan)
