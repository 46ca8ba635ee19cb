"""One point of a weld once more: the passes of its events and loops weighted with the mission."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.mean_stress import MeanStress
from fatigue.verify.recount.anew.point import OnePass, Values, quotient
from fatigue.verify.recount.anew.rounding import Bounds, point_bounds
from fatigue.verify.recount.anew.spectral import NEARLY_ALL

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class RecountEvent:
    """How long one pass is [km], None for an event counted by number, and how often it happens per km."""

    name: str
    length_km: float | None
    passes_per_km: float


def point_values(
    passes: Sequence[OnePass],
    raw_damage: Sequence[float],
    events: Sequence[RecountEvent],
    mission: Mapping[str, Any],
    curve: RecountCurve,
    mean_stress: MeanStress,
) -> Values:
    """Columns of the table of points: one pass of every event, weighted with the mission.

    ``raw_damage`` is the damage of one pass of each event without end treatment.
    """
    weights = np.array([event.passes_per_km for event in events])
    limit, target = curve.limit(mission), mission["target_km"]
    per_pass = {key: np.array([p.quantities[key] for p in passes], dtype=float) for key in passes[0].quantities}

    share = weights * per_pass["damage_per_pass"]
    damage = float(share.sum())
    utilisation = damage * target / limit
    governing = int(share.argmax()) if damage > 0 else None
    spectral = ~np.isnan(per_pass["damage_dirlik_per_pass"])

    def of_spectra(key: str) -> float:
        return float(weights[spectral] @ per_pass[key][spectral]) if spectral.any() else np.nan

    def of_governing(key: str) -> float:
        return np.nan if governing is None else float(per_pass[key][governing])

    D_dirlik, D_tb, D_whole, D_same = (
        of_spectra(f"damage_{name}_per_pass") for name in ("dirlik", "tb", "tb_whole", "same_ratio")
    )
    misses = 1.0 - quotient(D_tb, D_whole) > NEARLY_ALL
    life = _life(damage, limit)
    return {
        "damage_per_km": damage,
        "life_km": life,
        "life_years": life / mission["km_per_year"],
        "utilisation": utilisation,
        "fulfilled": utilisation <= 1.0,
        "load_factor": _load_factor(passes, weights * target / limit, curve, mean_stress, utilisation),
        "life_km_dirlik": np.nan if misses else _life(D_dirlik, limit),
        "life_km_tb": np.nan if misses else _life(D_tb, limit),
        "life_km_same_ratio": _life(D_same, limit),
        "dirlik_ratio": quotient(D_dirlik, D_same),
        "max_range_MPa": float(per_pass["max_range_MPa"].max()),
        "equivalent_range_2e6_MPa": (weights @ per_pass["power_sum"] * target / 2e6) ** (1 / curve.slopes[0]),
        "mean_stress_MPa": of_governing("mean_stress_MPa"),
        "R_largest_cycle": float(per_pass["R_largest"][per_pass["max_range_MPa"].argmax()]),
        "damage_factor_if_mean_stress": quotient(float(weights @ per_pass["with_mean_stress"]), damage),
        "shear_ratio": of_governing("shear_ratio"),
        "damage_factor_if_shear": quotient(float(weights @ per_pass["with_shear"]), damage),
        "governing_event": "" if governing is None else events[governing].name,
        "bending_ratio": of_governing("bending_ratio"),
        "life_km_raw_end": _life(float(weights @ np.array(raw_damage)), limit),
    }


def bounds_of_point(
    passes: Sequence[OnePass],
    raw_bounds: Sequence[float],
    events: Sequence[RecountEvent],
    mission: Mapping[str, Any],
    curve: RecountCurve,
    values: Values,
) -> Bounds:
    """What rounding may do to the columns of a point.

    ``raw_bounds`` are what it may do to the damage of one pass of each event without end treatment.
    """
    weights = np.array([event.passes_per_km for event in events])
    of_passes = [one.quantities for one in passes], [one.bounds for one in passes]
    return point_bounds(*of_passes, raw_bounds, weights, values, mission, curve)


def _load_factor(
    passes: Sequence[OnePass], weights: Floats, curve: RecountCurve, mean_stress: MeanStress, utilisation: float
) -> float:
    """Scale on all stresses up to which all cycles together meet the target, by bisection unless damage scales.

    Damage rises with the load, but where a cycle comes to twice the yield stress and its mean stress does not count any
    more: so the loads at which cycles do are looked at in turn.
    """
    if curve.is_straight and not mean_stress.counts:
        return float(utilisation ** (-1 / curve.slopes[0])) if utilisation > 0 else np.inf
    n = np.concatenate([weight * one.counts for weight, one in zip(weights, passes, strict=True)])
    occurs = n > 0
    n = n[occurs]
    x, low, high = (
        np.concatenate([getattr(one, name) for one in passes])[occurs] for name in ("ranges", "low", "high")
    )
    if not x.max(initial=0.0) > 0.0:
        return np.inf

    def is_too_much(log_factor: float) -> bool:
        f = np.exp(log_factor)
        f_M = mean_stress.factor(f * low, f * high) if mean_stress.counts else 1.0
        return bool(n @ curve.damage(f * x / f_M) > 1.0)

    lower, upper = -60.0, 60.0  # of ln(factor)
    if mean_stress.counts and mean_stress.yield_MPa is not None:
        for rises_to in np.unique(np.log(2 * mean_stress.yield_MPa / (high - low)[high > low]) - 1e-12):
            if is_too_much(rises_to):
                upper = rises_to
                break
            lower = rises_to
    for _ in range(60):
        middle = (lower + upper) / 2
        lower, upper = (lower, middle) if is_too_much(middle) else (middle, upper)
    return float(np.exp(lower))


def _life(damage: float, limit: float) -> float:
    if np.isnan(damage):
        return np.nan
    return limit / damage if damage > 0 else np.inf
