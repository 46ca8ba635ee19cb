"""Damage of every unit: D = sum over the conditions of d times km, at every point; of a weld the worst point."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

AT_ONCE = 4_000_000  # numbers, points times units: 32 MB
ROUNDING = 1e-12  # of the parts that a sum is made of, up to which it is nothing


@dataclass(frozen=True, slots=True, eq=False)
class WorstOfWelds:
    """The worst toe point of every weld for every unit; all arrays are (w, u).

    Attributes
    ----------
    point : its number among all points
    damage : its damage in a year; an upper bound where ``is_bound``
    counted : the largest damage of a counted toe point, 0 where a weld has none: what the weld has at least
    is_bound : whether a bound stands for the damage of the worst point, in some condition that the unit meets
    """

    point: Indices
    damage: Floats
    counted: Floats
    is_bound: NDArray[np.bool_]


def damage_of_units(damage: Floats, distance: Floats) -> Floats:
    """Damage in a year (p, u) of points (p, c) [1/km] and distances in a year (u, c) [km]; rounding below 0 is 0."""
    total = damage @ distance.T
    small = np.abs(total) <= ROUNDING * (np.abs(damage) @ np.abs(distance).T)
    return np.where(small & (total < 0.0), 0.0, total)


def worst_of_welds(
    damage: Floats, is_bound: NDArray[np.bool_], toe: NDArray[np.bool_], weld: Indices, distance: Floats
) -> WorstOfWelds:
    """Worst toe points of welds 0, 1, ...

    Parameters
    ----------
    damage : (p, c) per km, or per pass
    is_bound : (p, c) whether it is an upper bound
    toe : (p,) whether there is a weld toe: others never govern
    weld : (p,) number of the weld, ascending
    distance : (u, c) km in a year, or passes
    """
    welds, units = int(weld[-1]) + 1, len(distance)
    shape = welds, units
    worst = WorstOfWelds(np.zeros(shape, np.int64), np.full(shape, -np.inf), np.zeros(shape), np.zeros(shape, np.bool_))
    runs = (distance > 0.0).astype(np.float64)
    for number, block in _blocks(weld, max(1, AT_ONCE // units)):
        total = np.where(toe[block, None], damage_of_units(damage[block], distance), -np.inf)
        bound = (is_bound[block].astype(np.float64) @ runs.T) > 0.0
        at = total.argmax(axis=0)
        largest = total[at, np.arange(units)]
        better = largest > worst.damage[number]
        worst.point[number, better] = block.start + at[better]
        worst.damage[number, better] = largest[better]
        worst.is_bound[number, better] = bound[at, np.arange(units)][better]
        counted = np.where(bound, 0.0, total).max(axis=0)
        worst.counted[number] = np.maximum(worst.counted[number], counted)
    return worst


def _blocks(weld: Indices, most: int) -> Iterator[tuple[int, slice]]:
    """Rows of one weld after the other, so many at a time."""
    ends = np.searchsorted(weld, np.arange(int(weld[-1]) + 2))
    for number, (first, end) in enumerate(pairwise(ends.tolist())):
        for start in range(first, end, most):
            yield number, slice(start, min(start + most, end))


def life_in_years(damage: Floats, limit: Floats) -> Floats:
    """Years until the damage in a year has reached its limit, of equal shape; infinite where nothing damages.

    >>> life_in_years(np.array([0.05, 0.0]), np.array([1.0, 1.0]))
    array([20., inf])
    """
    return np.divide(limit, damage, out=np.full_like(damage, np.inf), where=damage > 0.0)
