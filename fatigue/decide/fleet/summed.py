"""A fleet summed up: the damage of every unit at every weld, percentiles over the units, and variance shares."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.fleet.conditions import Points
from fatigue.decide.fleet.distances import Distances, covariance, covariance_of_units
from fatigue.decide.fleet.units import WorstOfWelds, life_in_years, worst_of_welds
from fatigue.decide.fleet.variance import Variance, variance_of_damage

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Scatter:
    """What is known of how sure the numbers are.

    Attributes
    ----------
    correlation : (c, c) of the distances of a unit
    damage_cv : (p, c) relative standard error of the damage of each condition, 0 where none is known
    same : (c,) conditions of one number share event and result, and so the error of their damage
    is_known : whether anything is said: deviations of distances or errors of damage
    """

    correlation: Floats
    damage_cv: Floats
    same: NDArray[np.int64]
    is_known: bool


@dataclass(frozen=True, slots=True, eq=False)
class Summed:
    """A fleet summed up.

    Attributes
    ----------
    points, distances : what it is summed of
    worst : of every weld and unit
    utilisation : (w, u) damage in a year over the damage limit of the weld
    life : (w, u) years
    at_most : (w, u) years that the worst counted point lives, no less than ``life``
    governing : (u,) weld with the shortest life of each unit
    """

    points: Points
    distances: Distances
    worst: WorstOfWelds
    utilisation: Floats
    life: Floats
    at_most: Floats
    governing: NDArray[np.int64]

    @property
    def worst_of_units(self) -> NDArray[np.int64]:
        """Worst point (u,) of each unit."""
        return self.worst.point[self.governing, np.arange(len(self.governing))]


def summed(points: Points, distances: Distances) -> Summed:
    """Worst points and lives of every weld and unit."""
    toe = points.key["toe"].to_numpy(np.bool_)
    worst = worst_of_welds(points.damage, points.is_bound, toe, points.weld, distances.distance)
    limit = np.broadcast_to(points.limit[:, None], worst.damage.shape)
    utilisation = worst.damage / limit
    return Summed(
        points=points,
        distances=distances,
        worst=worst,
        utilisation=utilisation,
        life=life_in_years(worst.damage, limit),
        at_most=life_in_years(worst.counted, limit),
        governing=utilisation.argmax(axis=0),
    )


@dataclass(frozen=True, slots=True, eq=False)
class PointVariance:
    """Variance of the damage at a point: over all units (``unit`` None), or of one unit by its number."""

    unit: int | None
    point: int
    variance: Variance


def variances(of: Summed, scatter: Scatter) -> Iterator[PointVariance]:
    """Variance over the units at the worst point of every weld, and of every unit at its worst; shortest lives first.

    The worst point of a weld is here that of the mean unit. What does not vary is left out.
    """
    if len(of.distances.units) > 1:
        cov, mean = covariance_of_units(of.distances.distance), of.distances.distance.mean(axis=0, keepdims=True)
        toe = of.points.key["toe"].to_numpy(np.bool_)
        at = worst_of_welds(of.points.damage, of.points.is_bound, toe, of.points.weld, mean)
        for weld in np.argsort(-at.damage[:, 0] / of.points.limit, kind="stable"):
            point = int(at.point[weld, 0])
            yield from _varying(None, point, variance_of_damage(of.points.damage[point], mean[0], cov))
    if scatter.is_known:
        for unit in np.argsort(of.life.min(axis=0), kind="stable").tolist():
            point = int(of.worst.point[of.governing[unit], unit])
            yield from _varying(unit, point, variance_of_unit(of, scatter, unit, point))


def variance_of_unit(of: Summed, scatter: Scatter, unit: int, point: int) -> Variance:
    """Variance of the damage of one unit at a point, from what is said of its distances and of the damage."""
    damage, deviation = of.points.damage[point], of.distances.deviation
    given = np.zeros_like(damage) if deviation is None else deviation[unit]
    cov = covariance(given, scatter.correlation)
    error = (scatter.damage_cv[point] * damage) ** 2
    return variance_of_damage(damage, of.distances.distance[unit], cov, error, scatter.same)


def _varying(unit: int | None, point: int, variance: Variance) -> Iterator[PointVariance]:
    if variance.total > 0.0:
        yield PointVariance(unit, point, variance)


def largest_part(damage: Floats, distance: Floats, names: Sequence[str]) -> tuple[str, float]:
    """Condition with the largest part of a damage, and its share; none where nothing damages.

    >>> largest_part(np.array([1e-7, 3e-7]), np.array([1e5, 1e5]), ["new", "worn"])
    ('worn', 0.75)
    """
    parts = damage * distance
    total = float(parts.sum())
    if not total > 0.0:
        return "", np.nan
    most = int(parts.argmax())
    return names[most], float(parts[most]) / total
