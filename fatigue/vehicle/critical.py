"""Where a vehicle gains or loses stability: crossings over conicity at a speed, over speed at a conicity.

A vehicle is stable where the largest real part of all its roots is negative. That real part is followed over a grid.
Where it changes sign the crossing is found by Brent's method; where it comes closest to zero between points of the grid
without passing it there, its extremum is searched, so that a window narrower than the grid is found too.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

from fatigue.vehicle.assembly import SuspendedVehicle
from fatigue.vehicle.roots import Root, largest_real_part, least_stable

Floats = NDArray[np.float64]
Change: TypeAlias = Literal["gains", "loses"]

CONICITIES = (0.01, 1.2)  # range that is looked at
SPEEDS_KM_H = (60.0, 700.0)
POINTS = 40  # of the grid: conicities at even ratios, speeds at even steps
CLOSE = 1e-7  # of a crossing: how closely it is found
SEARCHED = 1e-3  # of the step of the grid: how closely an extremum is searched
NEAR = 0.5  # an extremum is searched where it lies below this share of the larger neighbour: the others are too far off


@dataclass(frozen=True, slots=True, eq=False)
class Crossing:
    """A conicity or speed [km/h] ``at`` which the vehicle gains or loses stability as it grows, and by which root."""

    at: float
    change: Change
    root: Root


def conicity_crossings(
    of: SuspendedVehicle, speed_km_h: float, between: tuple[float, float] = CONICITIES, points: int = POINTS
) -> list[Crossing]:
    """Conicities at which the vehicle gains or loses stability at a speed, in ascending order.

    Raises
    ------
    CaseError : no speed
    """
    grid = np.geomspace(*between, points)
    found = crossings(lambda conicity: largest_real_part(of.state_matrix(speed_km_h, conicity)), grid)
    return [Crossing(at, change, least_stable(of.at(speed_km_h, at))) for at, change in found]


def speed_crossings(
    of: SuspendedVehicle, conicity: float, between: tuple[float, float] = SPEEDS_KM_H, points: int = POINTS
) -> list[Crossing]:
    """Speeds [km/h] at which the vehicle gains or loses stability at a conicity, in ascending order."""
    grid = np.linspace(*between, points)
    found = crossings(lambda speed: largest_real_part(of.state_matrix(speed, conicity)), grid)
    return [Crossing(at, change, least_stable(of.at(at, conicity))) for at, change in found]


def stable_ranges(
    crossed: list[Crossing], between: tuple[float, float], *, stable_at_first: bool
) -> list[tuple[float, float]]:
    """Ranges without an unstable root, from the crossings between two ends.

    >>> stable_ranges([], (0.01, 1.2), stable_at_first=True)
    [(0.01, 1.2)]
    """
    ends = [between[0]] if stable_at_first else []
    ends += [crossing.at for crossing in crossed]
    ends += [between[1]] if len(ends) % 2 else []
    return list(zip(ends[::2], ends[1::2], strict=True))


def crossings(margin: Callable[[float], float], grid: Floats) -> list[tuple[float, Change]]:
    """Where a margin passes zero between the ends of a grid, ascending; it ``gains`` where the margin falls.

    >>> [(round(at, 6), change) for at, change in crossings(lambda x: (x - 0.5) ** 2 - 1e-4, np.linspace(0, 1, 6))]
    [(0.49, 'gains'), (0.51, 'loses')]
    """
    values = [margin(float(point)) for point in grid]
    places = [float(point) for point in grid]
    between = [extremum for k in range(len(grid)) if (extremum := _passed(margin, places, values, k)) is not None]
    sampled = sorted(zip(places + [at for at, _ in between], values + [value for _, value in between], strict=True))
    found: list[tuple[float, Change]] = []
    for (a, at_a), (b, at_b) in pairwise(sampled):
        if (at_a < 0.0) != (at_b < 0.0):
            at = float(brentq(margin, a, b, xtol=CLOSE * max(abs(a), abs(b))))
            found.append((at, "gains" if at_b < 0.0 else "loses"))
    return found


def _passed(
    margin: Callable[[float], float], places: list[float], values: list[float], k: int
) -> tuple[float, float] | None:
    """Extremum of the margin about a point of the grid, if it lies beyond zero while the points around it do not."""
    left, right = max(k - 1, 0), min(k + 1, len(values) - 1)
    here, neighbours = values[k], [values[at] for at in (left, right) if at != k]
    sign = -1.0 if here < 0.0 else 1.0
    if any((value < 0.0) != (here < 0.0) or abs(value) < abs(here) for value in neighbours):
        return None
    if abs(here) > NEAR * max(map(abs, neighbours)):
        return None
    ends = (places[left], places[right])
    searched = minimize_scalar(
        lambda at: sign * margin(at), bounds=ends, method="bounded", options={"xatol": SEARCHED * (ends[1] - ends[0])}
    )
    value = sign * float(searched.fun)
    return (float(searched.x), value) if (value < 0.0) != (here < 0.0) else None
