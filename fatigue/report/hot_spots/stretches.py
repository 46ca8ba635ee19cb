"""Connected stretches of stations that share the damage of one local maximum.

The stretch of a station is the connected run of stations around it whose damage is at least half of its own. A station
is the worst of a hot spot where nothing in its stretch is worse. Two hot spots never share a station: of two stretches
that meet, that of the smaller damage holds the other one whole, and so a station that is worse.

Half of the damage is a tenth less stress on a curve of slope 7, a fifth less on one of slope 3.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LEAST_SHARE = 0.5  # of the damage at the worst station, down to which a stretch goes


@dataclass(frozen=True, slots=True, eq=False)
class Stretches:
    """Hot spots (k,) in the order of their worst stations.

    ``worst``, ``first`` and ``last`` are stations (k,), first and last along the line; of a ``whole`` ring the stretch
    has neither beginning nor end. ``of_station`` (n,) is the hot spot that a station belongs to, -1 for none.
    """

    worst: NDArray[np.int64]
    first: NDArray[np.int64]
    last: NDArray[np.int64]
    whole: NDArray[np.bool_]
    of_station: NDArray[np.int64]


def stretches(
    damage: NDArray[np.float64],
    is_counted: NDArray[np.bool_],
    before: NDArray[np.int64],
    behind: NDArray[np.int64],
) -> Stretches:
    """Hot spots of all lines at once.

    Parameters
    ----------
    damage : of every station (n,), in any unit; NaN where there is no toe, which ends every stretch
    is_counted : (n,) False where ``damage`` is an upper bound: such a station prolongs a stretch and is no worst one
    before, behind : (n,) neighbours along the line, -1 at its ends; those of a ring go round

    Examples
    --------
    >>> damage = np.array([1.0, 4.0, 2.0, 1.4, 3.0])
    >>> line = np.arange(5)
    >>> found = stretches(damage, damage > 0.0, line - 1, np.where(line < 4, line + 1, -1))
    >>> found.worst, found.first, found.last
    (array([1, 4]), array([1, 4]), array([2, 4]))
    """
    worst = np.flatnonzero(is_counted & (damage > 0.0))
    for way in (before, behind):
        worst = worst[_reach(worst, way, damage, is_counted) >= 0]
    first, last = (_reach(worst, way, damage, is_counted) for way in (before, behind))
    of_station = _members(len(damage), worst, first, last, behind)
    whole = (first == behind[worst]) & (last == before[worst]) & (first != worst)
    return Stretches(worst, first, last, whole, of_station)


def _reach(
    worst: NDArray[np.int64], way: NDArray[np.int64], damage: NDArray[np.float64], is_counted: NDArray[np.bool_]
) -> NDArray[np.int64]:
    """Last station of each stretch in one direction; -1 where a worse one lies in it, the earlier of two equal ones."""
    end = worst.copy()
    going = np.arange(len(worst))
    while going.size:
        of, next_ = worst[going], way[end[going]]
        goes_on = (next_ >= 0) & (next_ != of) & (damage[next_] >= LEAST_SHARE * damage[of])
        going, of, next_ = going[goes_on], of[goes_on], next_[goes_on]
        is_worse = is_counted[next_] & ((damage[next_] > damage[of]) | ((damage[next_] == damage[of]) & (next_ < of)))
        end[going] = np.where(is_worse, -1, next_)
        going = going[~is_worse]
    return end


def _members(
    stations: int,
    worst: NDArray[np.int64],
    first: NDArray[np.int64],
    last: NDArray[np.int64],
    behind: NDArray[np.int64],
) -> NDArray[np.int64]:
    """Hot spot of every station; a stretch around a whole ring ends before its worst station."""
    of_station = np.full(stations, -1, dtype=np.int64)
    of_station[worst] = np.arange(len(worst))
    going, at = np.arange(len(worst)), first.copy()
    while going.size:
        of_station[at] = going
        goes_on = at != last[going]
        going, at = going[goes_on], behind[at[goes_on]]
    return of_station
