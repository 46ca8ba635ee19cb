"""Columns of shear at a toe point: the passes of all events weighted with the mission, and what they amount to."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.mean_stress import MeanStress
from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import OnePass, RecountPoint, Values
from fatigue.verify.recount.anew.record import RecountRecord
from fatigue.verify.recount.anew.rounding import Bounds, root_bound
from fatigue.verify.recount.anew.shear.passes import ShearPass, path_rounding
from fatigue.verify.recount.anew.shear.rounding import spread_of_largest

PATHS = ("range", "length", "mlp")
SUMS = tuple(f"utilisation_path_{one}" for one in PATHS)
DECIDING = ("multiaxial_bound", "utilisation_asme", *SUMS)  # about status and verdict
NO_SHEAR: Values = {
    "shear_required": None,
    "multiaxial_status": "",
    "multiaxial_verdict": "",
    **dict.fromkeys(("multiaxial_bound", "utilisation_asme", *(f"utilisation_path_{one}" for one in PATHS)), np.nan),
    **dict.fromkeys(("path_factor_largest", "path_moment_largest"), np.nan),
}
EQUAL = 1.0 - 1e-9  # ranges that only rounding tells apart
ROUNDING = 1e-9  # by which bounds are raised
CLOSE = 1e-6  # to a limit: rounding decides on which side


@dataclass(frozen=True, slots=True)
class ShearExtent:
    """One pass at a point: range of the normal stress and of the shear [MPa], and the length of their path [MPa].

    ``rounding`` is how far a point of the path may be from where it is [MPa], ``steps`` how many there are. ``cubed``
    and ``fourth`` are the integrals of 3 x^2 and, from above, of 4 x^3 along the path, x its distance from the mean.
    """

    normal: float
    shear: float
    length: float
    rounding: float
    steps: int
    cubed: float
    fourth: float

    def grown(self) -> Self:
        """The largest that rounding may make of it."""
        by = 2.0 * self.rounding
        return replace(self, normal=self.normal + by, shear=self.shear + by, length=self.length + self.steps * by)


def shear_extent(point: RecountPoint, record: RecountRecord, beta: float) -> ShearExtent:
    """How far and how long the path of a point is in one pass, closed where the record recurs."""
    s, tau = (
        record.factor * parts @ record.counted
        for parts in (point.membrane + point.bending, point.in_plane + point.twist)
    )
    steps = [np.diff(np.append(x, x[0]) if record.recurs else x) for x in (s, tau)]
    length = float(np.sqrt(steps[0] ** 2 + beta * steps[1] ** 2).sum())
    mean = record.kept.mean(axis=1)
    x, y = (
        record.factor * parts @ (record.counted - mean[:, None])
        for parts in (point.membrane + point.bending, np.sqrt(beta) * (point.in_plane + point.twist))
    )
    z = x + 1j * y
    z = np.append(z, z[0]) if record.recurs else z
    size, step = np.abs(z), np.abs(np.diff(z))
    middle = np.abs(0.5 * (z[1:] + z[:-1]))  # Simpson's rule is exact for a parabola
    cubed = float(np.sum(0.5 * step * (size[1:] ** 2 + 4.0 * middle**2 + size[:-1] ** 2)))
    fourth = float(np.sum(2.0 * step * (size[1:] ** 3 + size[:-1] ** 3)))
    rounding = path_rounding(point, record, beta)
    return ShearExtent(float(np.ptp(s)), float(np.ptp(tau)), length, rounding, len(steps[0]), cubed, fourth)


def path_bound(extent: ShearExtent, curve: RecountCurve, size: float, beta: float) -> float:
    """Damage of a pass that half cycles by range cannot exceed: all of its length in cycles of the largest range.

    Damage and largest range are raised by ``ROUNDING``. Infinite on slopes below 1, where nothing is proven.
    """
    if min(curve.slopes) < 1.0:
        return np.inf
    c = size / float(curve.bending_factor(np.zeros(1))[0])
    largest = (1.0 + ROUNDING) * c * float(np.hypot(extent.normal, np.sqrt(beta) * extent.shear))
    damage = float(curve.damage(np.array([largest]))[0])
    return float(0.5 * (1.0 + ROUNDING) * c * extent.length * damage / largest) if largest > 0.0 else 0.0


def closer_path_bound(extent: ShearExtent, curve: RecountCurve, size: float, beta: float) -> float:
    """The smallest bound of the kind by the powers 1, 3 and 4 of half cycles, and by powers between them."""
    c = size / float(curve.bending_factor(np.zeros(1))[0])
    range_ = (1.0 + ROUNDING) * float(np.hypot(extent.normal, np.sqrt(beta) * extent.shear))
    sums = {1.0: 0.5 * extent.length, 3.0: 2.0 * extent.cubed, 4.0: 4.0 * extent.fourth}
    if range_ == 0.0:
        return 0.0
    damage = float(curve.damage(np.array([(1.0 + ROUNDING) * c * range_]))[0])
    bounds = [damage * of_power / range_**q for q, of_power in sums.items() if min(curve.slopes) >= q]
    between = ((1.0, 3.0), (1.0, 4.0), (3.0, 4.0)) if (np.diff(curve.slopes) >= 0.0).all() else ()
    for k, (log_n, log_s) in zip(curve.slopes, curve.points, strict=True):  # no slope, continued, is below the curve
        of_1_MPa = float(np.exp(k * (np.log(c) - log_s) - log_n))
        for q, p in between:
            if q < k < p:
                share = (p - k) / (p - q)
                bounds.append(of_1_MPa * sums[q] ** share * sums[p] ** (1.0 - share))
    return min(bounds, default=np.inf)


@dataclass(frozen=True, slots=True, eq=False)
class AtPoint:
    """What is known of a toe point: all passes by normal stress, how far each goes, and its paths where counted.

    Attributes
    ----------
    point : its stresses and curve
    passes, extents : of every event
    paths : of every event; None where they were not counted again
    mean_stress : what the case says of it
    stored_bound : bound in the table, from which follows what is settled where the paths were not counted
    has_sums : whether the table has sums of the paths
    """

    point: RecountPoint
    passes: Sequence[OnePass]
    extents: Sequence[ShearExtent]
    paths: Sequence[ShearPass] | None
    mean_stress: MeanStress
    stored_bound: float
    has_sums: bool


def shear_values(
    of: AtPoint, normal: Values, events: Sequence[RecountEvent], mission: Mapping[str, Any], beta: float
) -> Values:
    """Columns of shear of a toe point whose columns by the normal stress are ``normal``.

    The bound is that of the exact path, infinite where f_M may apply; the stored one may be larger where the paths
    were not counted.
    """
    of_target: float = mission["target_km"] / of.point.curve.limit(mission)
    weights = of_target * np.array([event.passes_per_km for event in events])
    across = of_target * float(np.nan_to_num(normal["damage_per_km_transitions"]))
    curve = of.point.curve
    size = of.point.size

    def summed(of_events: Sequence[float]) -> float:
        return float(weights @ np.array(of_events)) + across

    asme = summed([one.quantities["with_shear"] for one in of.passes])
    bound = np.inf if _may_need_mean_stress(of) else summed([path_bound(one, curve, size, beta) for one in of.extents])
    if of.paths is None and of.stored_bound <= 1.0 < bound < np.inf:  # settled by the closer one, if at all
        bound = min(bound, summed([closer_path_bound(one, curve, size, beta) for one in of.extents]))
    largest = max(one.quantities["max_range_MPa"] for one in of.passes)
    values = NO_SHEAR | {
        "shear_required": bool(max(extent.shear for extent in of.extents) > largest / 3.0),
        "utilisation_asme": asme,
        "multiaxial_bound": bound,
    }
    if of.paths is None:
        values["multiaxial_status"] = _status(normal["utilisation"], of.stored_bound, asme, np.nan)
    else:
        sums = (
            [one.by_range for one in of.paths],
            [one.by_length for one in of.paths],
            [one.by_moment for one in of.paths],
        )
        values |= {f"utilisation_path_{name}": summed(each) for name, each in zip(PATHS, sums, strict=True)}
        widest = [one for one in of.paths if one.range >= EQUAL * max(other.range for other in of.paths) > 0.0]
        if widest:  # else the path does not move
            values["path_factor_largest"] = max(one.factor for one in widest)
            values["path_moment_largest"] = max(one.moment for one in widest)
        values["multiaxial_bound"] = max(bound, values["utilisation_path_range"])  # nothing below would be a bound
        top = summed([one.top_pair for one in of.paths])
        values["multiaxial_status"] = _status(normal["utilisation"], bound, asme, top)
    values["multiaxial_verdict"] = _verdict(values)
    return values


def _may_need_mean_stress(of: AtPoint) -> bool:
    """Whether a cycle may reach the tension from which on f_M is below 1: no stress is above mean and range."""
    if not of.mean_stress.counts or of.mean_stress.yield_MPa is None:
        return False
    means = [one.quantities["mean_stress_MPa"] for one in of.passes]
    highest = max(mean + extent.normal for mean, extent in zip(means, of.extents, strict=True))
    return bool(2.0 * highest * (1.0 + ROUNDING) >= of.mean_stress.yield_MPa)


def shear_bounds(
    of: AtPoint,
    normal: Values,
    normal_bounds: Mapping[str, float],
    values: Values,
    events: Sequence[RecountEvent],
    mission: Mapping[str, Any],
    beta: float,
) -> dict[str, float]:
    """What rounding may do to the columns of shear: what is close to a limit, or nothing but rounding, says nothing."""
    weights = mission["target_km"] / of.point.curve.limit(mission) * np.array([one.passes_per_km for one in events])
    of_normal = normal_bounds["utilisation"]

    def summed(of_events: Sequence[float]) -> float:
        with np.errstate(invalid="ignore"):
            return of_normal + float(np.nansum(weights * np.array(of_events)))

    curve, size = of.point.curve, of.point.size
    of_bound = [path_bound(one.grown(), curve, size, beta) - path_bound(one, curve, size, beta) for one in of.extents]
    bounds = {
        "multiaxial_bound": summed(of_bound) if np.isfinite(values["multiaxial_bound"]) else of_normal,
        "utilisation_asme": summed([one.bounds["with_shear"] for one in of.passes]),
        **_path_bounds(of.paths or (), values, summed),
    }
    stands_still = values["multiaxial_bound"] <= bounds["multiaxial_bound"]  # rounding is not close to a limit
    sums = [(normal["utilisation"], of_normal), (of.stored_bound, 0.0)]
    sums += [(values[name], 0.0 if stands_still else bounds[name]) for name in DECIDING]
    is_close = any(abs(value - 1.0) <= max(CLOSE, bound) for value, bound in sums if np.isfinite(value))
    is_open = of.paths is None and of.has_sums and values["multiaxial_status"] in ("fails", "counted")
    is_settled = normal["utilisation"] - of_normal > 1.0 + CLOSE  # by normal stress, whatever else
    unsure = np.inf if (is_close or is_open) and not is_settled else 0.0
    of_shear = abs(max(extent.shear for extent in of.extents) * 3.0 / (normal["max_range_MPa"] or 1.0) - 1.0)
    return {
        **bounds,
        "shear_required": np.inf if of_shear <= CLOSE or normal_bounds["shear_ratio"] == np.inf else 0.0,
        "multiaxial_status": unsure,
        "multiaxial_verdict": unsure,
    }


def _path_bounds(
    paths: Sequence[ShearPass], values: Values, summed: Callable[[Sequence[float]], float]
) -> dict[str, float]:
    """What rounding may do to what is said of the paths of all events, nothing where they were not counted."""
    bounds = {
        name: summed([one.bounds[key] for one in paths]) if paths else 0.0
        for name, key in zip(SUMS, ("by_range", "by_length", "by_moment"), strict=True)
    }
    ranges = np.array([one.range for one in paths])
    rho = max((one.bounds["range"] for one in paths), default=0.0)
    for name in ("factor", "moment"):
        of_largest = np.inf if rho > 0.0 else 0.0
        if ranges.max(initial=0.0) > 0.0:
            of_each, own = (
                np.array(each) for each in ([getattr(one, name) for one in paths], [one.bounds[name] for one in paths])
            )
            value, pairs = values[f"path_{name}_largest"], np.arange(len(ranges))
            of_largest = spread_of_largest(value, of_each, own, ranges, pairs, rho)
        bounds[f"path_{name}_largest"] = of_largest
    return bounds


def decided(
    values: Values, by_method: float, mission: Mapping[str, Any], curve: RecountCurve, *, scales: bool
) -> Values:
    """Columns of a toe point whose sum by the method that the case names is ``by_method``: the larger sum decides.

    ``scales``: damage follows the load with one power, so that the load factor is known.
    """
    used = max(values["utilisation"], float(np.nan_to_num(by_method)))
    changed: Values = {}
    if used > values["utilisation"]:
        limit = curve.limit(mission)
        damage = used * limit / mission["target_km"]
        changed = {"damage_per_km": damage, "life_km": limit / damage}
        changed["life_years"] = changed["life_km"] / mission["km_per_year"]
    load_factor = np.nan
    if scales:
        load_factor = used ** (-1.0 / curve.slopes[0]) if used > 0.0 else np.inf
    return values | changed | {"utilisation": used, "fulfilled": used <= 1.0, "load_factor": load_factor}


def decided_bounds(
    bounds: Bounds, used: float, by_method: float, mission: Mapping[str, Any], curve: RecountCurve
) -> Bounds:
    """What rounding may do to the columns of a toe point of the utilisation ``used`` that the larger sum decides.

    ``bounds`` are those by normal stress, ``by_method`` that of the sum by the method that the case names.
    """
    of_used = max(bounds["utilisation"], by_method)
    of_life = of_used / mission["target_km"]
    root = root_bound(used, of_used, 1.0 / curve.slopes[0]) if np.isfinite(of_used) else np.inf
    return bounds | {
        "utilisation": of_used,
        "damage_per_km": of_life * curve.limit(mission),
        "life_km": of_life,
        "life_years": of_life * mission["km_per_year"],
        "fulfilled": np.inf if abs(used - 1.0) <= of_used else 0.0,
        "load_factor": max(bounds["load_factor"], root),
    }


def _status(normal: float, bound: float, asme: float, top: float) -> str:
    if normal > 1.0:
        return "settled_fails"
    if bound <= 1.0 and asme <= 1.0:
        return "settled_passes"
    return "fails" if top > 1.0 else "counted"


def _verdict(values: Values) -> str:
    """Verdict by what was counted, else by what settled it."""
    status, by_range = values["multiaxial_status"], values["utilisation_path_range"]
    if status == "settled_fails" or np.isnan(by_range):
        return status if status in ("settled_fails", "settled_passes") else ""
    others = [values[f"utilisation_path_{name}"] for name in PATHS[1:]] + [values["utilisation_asme"]]
    if by_range > 1.0:
        return "fails"
    return "model_dependent" if any(value > 1.0 for value in others) else "passes"
