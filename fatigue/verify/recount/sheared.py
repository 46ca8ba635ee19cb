"""Shear at some points: the columns it has, and what a method that the case names makes of the others."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import Values
from fatigue.verify.recount.anew.rounding import Bounds
from fatigue.verify.recount.anew.shear.columns import (
    NO_SHEAR,
    AtPoint,
    decided,
    decided_bounds,
    shear_bounds,
    shear_values,
)
from fatigue.verify.recount.counted import Passes, mean_stress_of, treated_point
from fatigue.verify.recount.inputs.case import RecountInputs
from fatigue.verify.recount.layout import Layout
from fatigue.verify.recount.stored.rows import Station
from fatigue.verify.recount.stored.shear import DECIDING, StoredShear

PATH_SAMPLES = 300_000  # of paths that are counted where points are drawn: some ten seconds


@dataclass(frozen=True, slots=True, eq=False)
class Sheared:
    """Columns of shear of a point, what rounding may do to them, and whether its bound is that of its exact path."""

    values: Values
    bounds: Bounds
    exact_bound: bool
    toe: bool


def paths_to_count(
    shear: StoredShear | None, points: NDArray[np.int64], samples: int, *, everything: bool
) -> frozenset[int]:
    """Points whose paths are counted: those with half cycles in the table, then others with sums of their paths."""
    if shear is None:
        return frozenset()
    some = [point for point in points.tolist() if point in shear.half_cycles]
    some += [point for point in points.tolist() if shear.counted[point] and point not in shear.half_cycles]
    return frozenset(some if everything else some[: max(2, PATH_SAMPLES // samples)])


def shear_of(
    inputs: RecountInputs,
    body: Layout,
    stations: Mapping[int, Station],
    passes: Mapping[int, Passes],
    events: Sequence[RecountEvent],
    values: Mapping[int, Values],
    bounds: Mapping[int, Bounds],
    shear: StoredShear | None,
) -> dict[int, Sheared]:
    """Columns of shear of some points, whose columns by normal stress are ``values``; nothing without shear."""
    if shear is None:
        return {}
    found, mean_stress = {}, mean_stress_of(inputs)
    for point, station in stations.items():
        of, surface = passes[point], body.key(point)[3]
        if surface not in station.weld.toes:
            found[point] = Sheared(NO_SHEAR, {}, exact_bound=False, toe=False)
            continue
        at = AtPoint(
            point=treated_point(station, surface),
            passes=of.treated[: len(of.extents)],
            extents=of.extents,
            paths=of.paths or None,
            mean_stress=mean_stress,
            stored_bound=float(shear.bound[point]),
            has_sums=bool(shear.counted[point]),
        )
        common = events[: len(of.extents)], inputs.case["mission"], shear.rules.beta
        own = shear_values(at, values[point], *common)
        rounding = shear_bounds(at, values[point], bounds[point], own, *common)
        found[point] = Sheared(own, rounding, exact_bound=at.paths is not None, toe=True)
    return found


def decided_by_method(
    inputs: RecountInputs,
    stations: Mapping[int, Station],
    values: Mapping[int, Values],
    bounds: Mapping[int, Bounds],
    sheared: Mapping[int, Sheared],
    shear: StoredShear | None,
) -> tuple[dict[int, Values], dict[int, Bounds]]:
    """Columns of some points by the larger one of two sums, where the case names the method of the other one.

    With them what rounding may do to them.

    Where the paths of a point were not counted again the sum in the table is believed.
    """
    if shear is None or shear.rules.method not in DECIDING:
        return dict(values), dict(bounds)
    method, f_M, mission = shear.rules.method, mean_stress_of(inputs).counts, inputs.case["mission"]
    name = f"utilisation_{method}" if method == "asme" else f"utilisation_path_{method}"
    found, rounding = dict(values), dict(bounds)
    for point in (point for point in values if sheared[point].toe):
        own, curve = sheared[point], stations[point].weld.curve
        by_method = float(own.values.get(name, np.nan))
        if np.isnan(by_method):
            by_method = float(shear.by_method[point])
        scales = curve.is_straight and not f_M
        found[point] = decided(values[point], by_method, mission, curve, scales=scales)
        used = found[point]["utilisation"]
        rounding[point] = decided_bounds(bounds[point], used, own.bounds[name], mission, curve)
    return found, rounding
