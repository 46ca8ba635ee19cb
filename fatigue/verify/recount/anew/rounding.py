"""How far two right programs may differ where stress vanishes to rounding: absolute bounds, each with its reason.

A stress is a sum over the modes, ``s = sum_k sigma_k q_k``. Computed in double precision in any order it is off by at
most ``m u sum_k |sigma_k q_k|``, with m modes and u = 2^-53 (Higham, Accuracy and Stability of Numerical Algorithms,
2002, 3.1). The modal stress itself is off by some u of the largest along the line, times the condition of the line
system, and an interpolation by FFT by some u of the largest sample. Together
``delta = (m + 100) u sum_k max|sigma_k| max|q_k|``, the first maximum along the line, the second over the record. Where
faces or modes cancel, where a record stands still or
varies little about a large static part, whole columns are made of nothing else. What ``delta`` may do to each column
follows from its formula; a bound is infinite where the column says nothing any more.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.spectral import NEARLY_ALL

Floats = NDArray[np.float64]
Bounds = dict[str, float]

UNIT = 2.0**-53
CONDITION = 100.0  # of the line system, where neighbouring edges differ tenfold in length
SAMPLES_AT_ONCE = 1 << 16  # beside a whole record
LOST = 0.1  # of a value: a bound as large as this leaves nothing of a ratio
MASTER_RATIO = 2.0  # d(dS) / dS over d(range) / range, with the part through the bending ratio


@dataclass(frozen=True, slots=True, eq=False)
class Counted:
    """What bounds of one pass follow from.

    Attributes
    ----------
    delta : bound on the rounding of a stress [MPa], and ``delta_level`` with what is constant
    level : constant stress [MPa]
    stress : (u,) counted stress, without it [MPa]
    deviation : standard deviation of the kept stress [MPa]
    parts : standard deviations of membrane and bending together [MPa]
    ranges, equivalent, same_ratio : (c,) of every cycle [MPa, dS, dS], and ``counts``
    R : (c,) stress ratio of every cycle
    reversals : (r,) stresses at which cycles begin and end [MPa]
    size : factor of the plate thickness
    band, whole : (4,) spectral moments 0, 1, 2, 4 of the stress up to ``upper_hz``, and of all of it; NaN without
        a spectrum
    upper_hz, half_rate_hz : highest frequency of each [Hz]
    duration : of the pass [s]
    mean_stress : whether the equivalent range has the factor of the mean stress
    """

    delta: float
    delta_level: float
    level: float
    stress: Floats
    deviation: float
    parts: float
    ranges: Floats
    equivalent: Floats
    same_ratio: Floats
    counts: Floats
    R: Floats
    reversals: Floats
    size: float
    band: Floats
    whole: Floats
    upper_hz: float
    half_rate_hz: float
    duration: float
    mean_stress: bool


def stress_bound(largest: Floats, peak: Floats, factor: float) -> float:
    """``delta`` [MPa] from the largest stress of each mode along the line and its largest coordinate, (m,) each."""
    return float((len(peak) + CONDITION) * UNIT * abs(factor) * (largest @ peak))


def pass_bounds(of: Counted, values: Mapping[str, float], curve: RecountCurve) -> Bounds:
    """Bounds on the columns of one pass, by the names of its quantities."""
    rho, k = 2.0 * of.delta, curve.slopes[0]
    d_dS = _equivalent_bound(of, rho)
    samples, noise = len(of.stress), relative_bound(of.delta, of.deviation)
    of_band = _spectral_noise(of.delta, of.band, of.upper_hz)
    of_whole = _spectral_noise(of.delta, of.whole, of.half_rate_hz)
    dirlik, tb, tb_whole = (values[f"damage_{name}_per_pass"] for name in ("dirlik", "tb", "tb_whole"))
    damage = damage_bound(of.equivalent, of.counts, d_dS, samples, curve)
    largest = of.ranges >= of.ranges.max(initial=0.0) - 2.0 * rho
    return {
        "damage_per_pass": damage,
        "damage_same_ratio_per_pass": damage_bound(of.same_ratio, of.counts, d_dS, samples, curve),
        "damage_dirlik_per_pass": _estimate_bound(of, dirlik, of_band, of.band, of.upper_hz, curve),
        "damage_tb_per_pass": _estimate_bound(of, tb, of_band, of.band, of.upper_hz, curve),
        "damage_tb_whole_per_pass": _estimate_bound(of, tb_whole, of_whole, of.whole, of.half_rate_hz, curve),
        "cycles_per_pass": float(of.counts[of.ranges <= 2.0 * rho].sum() + _standing(of.stress, rho)),
        "max_range_MPa": rho,
        "max_equivalent_range_dS": d_dS,
        "bending_ratio": _lost(relative_bound(2.0 * of.delta, of.parts)),
        "mean_stress_MPa": of.delta_level,
        "kurtosis": _lost(8.0 * noise) * values["kurtosis"] if noise < LOST else np.inf,
        "outside_share": _lost(2.0 * of_whole),
        "irregularity": _lost(4.0 * of_band),
        "peaks_per_s": _lost(2.0 * of_whole) * of.half_rate_hz,
        "samples_per_peak": _times(_lost(4.0 * of_whole), values["samples_per_peak"]),
        "shear_ratio": _times(_lost(2.0 * noise), 1.0 + values["shear_ratio"]),
        "power_sum": float(of.counts @ ((of.ranges + rho) ** k - of.ranges**k) + samples * rho**k),
        "R_largest": ratio_bound(
            of.R[largest], values["R_largest"], relative_bound(2.0 * of.delta_level, values["max_range_MPa"])
        ),
        "with_mean_stress": _times(damage, 1.0 + values["with_mean_stress"] / max(values["damage_per_pass"], 1e-300)),
        "with_shear": _times(_lost(4.0 * k * noise), values["with_shear"]),
    }


def point_bounds(
    quantities: Sequence[Mapping[str, float]],
    passes: Sequence[Mapping[str, float]],
    raw_damage: Sequence[float],
    weights: Floats,
    values: Mapping[str, float],
    mission: Mapping[str, float],
    curve: RecountCurve,
) -> Bounds:
    """Bounds on the columns of a point; of lives on their inverse.

    Parameters
    ----------
    quantities : of one pass of each event, and ``passes``: their bounds
    raw_damage : bounds on the damage of one pass of each event without end treatment
    weights : (e,) passes per km
    values : the columns of the point
    mission : ``target_km``, ``km_per_year`` and, where it is not 1, ``damage_limit``
    """
    limit, target, k = curve.limit(mission), mission["target_km"], curve.slopes[0]
    of = {name: np.array([bounds[name] for bounds in passes]) for name in passes[0]}

    def summed(name: str) -> float:
        with np.errstate(invalid="ignore"):
            return float(np.nansum(weights * of[name]))

    def per_km(name: str) -> float:
        return float(np.nansum(weights * [one[f"damage_{name}_per_pass"] for one in quantities]))

    damage = summed("damage_per_pass")
    shares = weights * [one["damage_per_pass"] for one in quantities]
    used = damage * target / limit
    governing = int(shares.argmax())
    own = weights * of["damage_per_pass"]
    rivals = np.count_nonzero(shares + own >= shares[governing] - own[governing])
    is_open = damage > 0.0 and (rivals > 1 or values["damage_per_km"] <= damage)

    def of_governing(name: str) -> float:
        return np.inf if is_open else float(of[name][governing])

    relative = _lost(relative_bound(damage, values["damage_per_km"]))
    estimates = {name: summed(f"damage_{name}_per_pass") for name in ("dirlik", "tb", "same_ratio")}
    of_ratio = [relative_bound(estimates[name], per_km(name)) for name in ("dirlik", "same_ratio")]
    lives = {f"life_km_{name}": bound / limit for name, bound in estimates.items()}
    margin = abs(per_km("tb") - (1.0 - NEARLY_ALL) * per_km("tb_whole"))
    if estimates["tb"] + summed("damage_tb_whole_per_pass") > margin:
        lives |= {"life_km_dirlik": np.inf, "life_km_tb": np.inf}  # there or not, as rounding will have it
    blocks = float(weights @ of["power_sum"]) * target / 2e6
    root = max(1.0 / slope for slope in curve.slopes), min(1.0 / slope for slope in curve.slopes)
    least = min([*curve.knees, *([curve.cutoff] if curve.cutoff else [])], default=np.inf)
    factor = max(root_bound(values["utilisation"], used, power) for power in root)
    factor = max(factor, float(of["max_equivalent_range_dS"].max()) / least)
    return {
        "damage_per_km": damage,
        "life_km": damage / limit,
        "life_years": damage / limit * mission["km_per_year"],
        "utilisation": used,
        "fulfilled": np.inf if abs(values["utilisation"] - 1.0) <= used else 0.0,
        "load_factor": factor,
        **lives,
        "dirlik_ratio": _times(_lost(max(of_ratio) * 2.0), values["dirlik_ratio"]),
        "max_range_MPa": float(of["max_range_MPa"].max()),
        "equivalent_range_2e6_MPa": root_bound(values["equivalent_range_2e6_MPa"] ** k, blocks, 1.0 / k),
        "mean_stress_MPa": of_governing("mean_stress_MPa"),
        "R_largest_cycle": float(of["R_largest"].max()),
        "damage_factor_if_mean_stress": _times(2.0 * relative, values["damage_factor_if_mean_stress"]),
        "shear_ratio": of_governing("shear_ratio"),
        "damage_factor_if_shear": relative_bound(summed("with_shear"), values["damage_per_km"])
        + _times(2.0 * relative, values["damage_factor_if_shear"]),
        "governing_event": np.inf if is_open else 0.0,
        "bending_ratio": of_governing("bending_ratio"),
        "life_km_raw_end": float(np.nansum(weights * np.array(raw_damage))) / limit,
    }


def cycle_bounds(of: Counted, curve: RecountCurve) -> Bounds:
    """Bounds on the columns of the largest cycle of a pass, and under ``delta`` the bound on its stress.

    ``ties`` is how many neighbours among the reversals rounding may swap: of equal peaks any may begin a cycle.
    """
    rho = 2.0 * of.delta
    d_dS = _equivalent_bound(of, rho)
    top = np.array([of.equivalent.max(initial=0.0)])
    return {
        "delta": of.delta,
        "delta_level": of.delta_level,
        "ties": float(np.count_nonzero(np.diff(np.sort(of.reversals)) <= rho)) if rho > 0.0 else 0.0,
        "range_MPa": rho,
        "equivalent_range_dS": d_dS,
        "damage": float((curve.damage(top + d_dS) - curve.damage(np.maximum(top - d_dS, 0.0)))[0]),
    }


def _standing(stress: Floats, rho: float) -> int:
    """How many steps from sample to sample are no larger than rounding."""
    some = (stress[first : first + SAMPLES_AT_ONCE + 1] for first in range(0, len(stress), SAMPLES_AT_ONCE))
    return sum(int(np.count_nonzero(np.abs(np.diff(part)) <= rho)) for part in some)


def _equivalent_bound(of: Counted, rho: float) -> float:
    """Bound on the equivalent range of a pass."""
    highest = float(max(of.stress.max() + of.level, -of.stress.min() - of.level))
    return equivalent_bound(of.size, rho, max(rho, 2.0 * of.delta_level), highest if of.mean_stress else 0.0)


def equivalent_bound(size: float, rho: float, rho_level: float, highest: float) -> float:
    """Bound on the equivalent range: the range, and in dS the bending ratio; and what f_M makes of the least cycle.

    ``f_M = (1 - R)^(1/3.6)`` vanishes with the range of a cycle about a high mean: ``x / f_M`` of a range ``rho_level``
    is ``rho_level^(1 - 1/3.6) s_max^(1/3.6)``; ``highest`` is that stress, 0 where the mean does not count.
    """
    bound = MASTER_RATIO * size * rho
    return bound * (highest / rho_level) ** (1.0 / 3.6) if rho > 0.0 and highest > rho_level else bound


def damage_bound(x: Floats, n: Floats, bound: float, samples: int, curve: RecountCurve) -> float:
    """Damage of all cycles grown by the bound, and of as many cycles of nothing but rounding as there are samples."""
    if bound == 0.0:
        return 0.0
    grown, shrunk = curve.damage(x + bound), curve.damage(np.maximum(x - bound, 0.0))
    return float(n @ (grown - shrunk) + samples * curve.damage(np.array([bound]))[0])


def _spectral_noise(delta: float, moments: Floats, highest_hz: float) -> float:
    """Relative bound on the spectral moments of what lies below a frequency.

    The root of a moment is a norm of the stress. That of rounding is at most ``2 delta highest_hz^(p/2)``: the Hann
    window raises what stands at its middle by 8/3 in power.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        noise = 2.0 * delta * highest_hz ** (np.array([0.0, 1.0, 2.0, 4.0]) / 2.0) / np.sqrt(moments)
    return 0.0 if delta == 0.0 else float(2.0 * np.nan_to_num(noise, nan=np.inf, posinf=np.inf).max())


def _estimate_bound(
    of: Counted, damage: float, noise: float, moments: Floats, highest_hz: float, curve: RecountCurve
) -> float:
    """Bound on a damage from spectral moments: relative where they are known, else all that such moments can do."""
    if np.isnan(damage) or noise == 0.0:
        return 0.0
    spread = np.sqrt(2.0) * 2.0 * (np.sqrt(max(moments[0], 0.0)) + 2.0 * of.delta) * of.size
    most = 4.0 * of.duration * highest_hz * curve.mean_damage(float(spread), 1.0) + damage
    return min(damage * noise * (4.0 * max(curve.slopes) + 20.0), most) if noise < LOST**2 else most


def ratio_bound(candidates: Floats, used: float, noise: float) -> float:
    """Bound on the stress ratio of the largest cycle, of several equal ones whichever that is."""
    if noise >= LOST or not np.isfinite([used, *candidates]).all():
        return np.inf
    return float(np.abs(candidates - used).max(initial=0.0) + 4.0 * noise * max(1.0, used**2))


def root_bound(value: float, bound: float, power: float) -> float:
    """Bound on the power below 1 of a value that has a bound."""
    return float(max((value + bound) ** power - value**power, value**power - max(value - bound, 0.0) ** power))


def relative_bound(bound: float, value: float) -> float:
    """Bound relative to a value; nothing is lost of nothing."""
    if bound == 0.0:
        return 0.0
    return bound / value if value > 0.0 else np.inf


def _lost(relative: float) -> float:
    """Relative bound, infinite where it leaves nothing."""
    return relative if relative < LOST else np.inf


def _times(bound: float, value: float) -> float:
    """Bound times a value, infinite where it is, and nothing where there is no value."""
    return bound if bound == np.inf else bound * float(np.nan_to_num(value))
