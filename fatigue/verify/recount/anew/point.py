"""One point of a weld once more: every event counted by itself, then the mission."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.curve import RecountCurve, ratio_factor
from fatigue.verify.recount.anew.cycles import RecountCycles, count_cycles
from fatigue.verify.recount.anew.record import RecountRecord, SpectrumRules, welch_moments
from fatigue.verify.recount.anew.rounding import (
    SAMPLES_AT_ONCE,
    Bounds,
    Counted,
    cycle_bounds,
    pass_bounds,
    point_bounds,
    stress_bound,
)
from fatigue.verify.recount.anew.spectral import NEARLY_ALL, dirlik, tovo_benasciutti

Floats = NDArray[np.float64]
Values = dict[str, Any]

NEGLIGIBLE_OUTSIDE = 1e-4  # of the variance above the upper frequency: not counted among the peaks


@dataclass(frozen=True, slots=True, eq=False)
class RecountPoint:
    """Stress per unit modal coordinate at one face, (m,) each [MPa], the curve there and the plate thickness [mm].

    ``membrane`` and ``bending`` of this face, ``in_plane`` and ``twist`` shear likewise; ``largest`` stress anywhere
    along the line.
    """

    membrane: Floats
    bending: Floats
    in_plane: Floats
    twist: Floats
    largest: Floats
    curve: RecountCurve
    thickness: float


@dataclass(frozen=True, slots=True)
class MeanStress:
    """Yield stress [MPa], None where none is given, and whether the mean stress counts."""

    yield_MPa: float | None  # noqa: N815 - the unit keeps its spelling
    counts: bool


@dataclass(frozen=True, slots=True, eq=False)
class OnePass:
    """One pass of an event at a point: its quantities by the name of their column, and its cycles.

    ``rows`` is the table of cycles. ``ranges``, ``counts``, ``low`` and ``high`` are the equivalent range of each cycle
    without mean stress, its count and its two stresses, and empty where damage scales with one power of the load.
    ``bounds`` are what rounding may do to the quantities, ``cycle_bounds`` to the largest cycle.
    """

    quantities: Values
    ranges: Floats
    counts: Floats
    low: Floats
    high: Floats
    rows: dict[str, Floats]
    bounds: Bounds
    cycle_bounds: Bounds


@dataclass(frozen=True, slots=True)
class RecountEvent:
    """How long one pass is [km], None for an event counted by number, and how often it happens per km."""

    name: str
    length_km: float | None
    passes_per_km: float


def point_of(components: Floats, largest: Floats, surface: str, curve: RecountCurve, thickness: float) -> RecountPoint:
    """One face of a station, whose five stress components are (m, 5); ``largest`` along its line, (m,)."""
    side = 1.0 if surface == "top" else -1.0
    return RecountPoint(
        components[:, 0],
        side * components[:, 1],
        components[:, 2],
        side * components[:, 3],
        largest,
        curve,
        thickness,
    )


def one_pass(point: RecountPoint, record: RecountRecord, rules: SpectrumRules, mean_stress: MeanStress) -> OnePass:
    """One pass of an event at a point, counted, and estimated from its spectrum."""
    curve, size = point.curve, point.curve.size_factor(point.thickness)
    modal_stress = record.factor * np.stack([point.membrane, point.bending, point.in_plane, point.twist])
    kept = _stress(modal_stress, record.kept)
    s = kept if record.counted is record.kept else _stress(modal_stress, record.counted)
    covariance = _covariance(modal_stress, record.kept)
    deviation = np.sqrt(np.diag(covariance))

    one_ratio = _ratio(*deviation[:2])
    I_one = _factor(np.array([0.0 if np.isnan(one_ratio) else one_ratio]), curve)[0]
    cycles = count_cycles(s, recurs=record.recurs)
    rows = _cycle_rows(cycles, modal_stress, s, record)
    S, n = rows["range_MPa"], rows["count"]
    level = float((modal_stress[0] + modal_stress[1]) @ record.offset)
    rows["mean_MPa"] += level
    a, b = s[cycles.start] + level, s[cycles.end] + level
    f_M = _mean_stress_factor(a, b, mean_stress.yield_MPa)
    x = S * size / _factor(rows["bending_ratio"], curve)
    dS = x / f_M if mean_stress.counts else x
    damage = float(n @ curve.damage(dS))
    largest = int(np.argmax(S)) if len(S) else None
    k = curve.slopes[0]

    moments = welch_moments(kept, record.step, rules) if record.has_spectrum else None
    nothing = moments is None
    band, whole = (np.full(4, np.nan),) * 2 if moments is None else moments
    to_equivalent = (size / I_one) ** 2
    m0, _, m2, m4 = band
    outside = 1.0 - _quotient(m0, whole[0])
    peaks = _quotient(*((whole if outside >= NEGLIGIBLE_OUTSIDE else band)[[3, 2]])) ** 0.5
    values: Values = {
        "damage_per_pass": damage,
        "damage_same_ratio_per_pass": float(n @ curve.damage(S * size / I_one)),
        "damage_dirlik_per_pass": np.nan if nothing else record.duration * dirlik(band * to_equivalent, curve),
        **{
            name: np.nan if nothing else record.duration * tovo_benasciutti(m * to_equivalent, curve)
            for name, m in (("damage_tb_per_pass", band), ("damage_tb_whole_per_pass", whole))
        },
        "cycles_per_pass": float(n.sum()),
        "max_range_MPa": 0.0 if largest is None else float(S[largest]),
        "max_equivalent_range_dS": float(dS.max(initial=0.0)),
        "bending_ratio": one_ratio,
        "mean_stress_MPa": float(kept.mean()) + level,
        "kurtosis": _kurtosis(s),
        "outside_share": outside,
        "irregularity": _quotient(m2, (m0 * m4) ** 0.5),
        "peaks_per_s": peaks,
        "samples_per_peak": _quotient(1.0 / record.fine_step, peaks),
        "shear_ratio": _quotient(deviation[5], deviation[4]),
        "power_sum": float(n @ S**k),
        "R_largest": np.nan if largest is None else _stress_ratio(a[largest], b[largest]),
        "with_mean_stress": float(n @ curve.damage(x / f_M)) if _is_known(mean_stress, curve) else np.nan,
        "with_shear": float(n @ curve.damage(dS * np.nan_to_num(_shear_factor(covariance, I_one, curve), nan=1.0))),
    }
    rows |= {"equivalent_range_dS": dS, "damage": n * curve.damage(dS)}
    kept_cycles = slice(0) if curve.is_straight and not mean_stress.counts else slice(None)
    low, high = np.minimum(a, b), np.maximum(a, b)
    counted = Counted(
        delta=stress_bound(point.largest, record.peak, record.factor),
        delta_level=stress_bound(point.largest, record.peak + np.abs(record.offset), record.factor),
        level=level,
        stress=s,
        deviation=float(deviation[4]),
        parts=float(deviation[0] + deviation[1]),
        ranges=S,
        equivalent=dS,
        same_ratio=S * size / I_one,
        counts=n,
        R=_stress_ratios(a, b),
        reversals=s[np.unique(np.concatenate([cycles.start, cycles.end]))],
        size=size,
        band=band,
        whole=whole,
        upper_hz=rules.upper_hz,
        half_rate_hz=0.5 / record.step,
        duration=record.duration,
        mean_stress=mean_stress.counts,
    )
    x, n, low, high = (of_all[kept_cycles] for of_all in (x, n, low, high))
    return OnePass(values, x, n, low, high, rows, pass_bounds(counted, values, curve), cycle_bounds(counted, curve))


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
    limit, target = mission.get("damage_limit", 1.0), mission["target_km"]
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
    misses = 1.0 - _quotient(D_tb, D_whole) > NEARLY_ALL
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
        "dirlik_ratio": _quotient(D_dirlik, D_same),
        "max_range_MPa": float(per_pass["max_range_MPa"].max()),
        "equivalent_range_2e6_MPa": (weights @ per_pass["power_sum"] * target / 2e6) ** (1 / curve.slopes[0]),
        "mean_stress_MPa": of_governing("mean_stress_MPa"),
        "R_largest_cycle": float(per_pass["R_largest"][per_pass["max_range_MPa"].argmax()]),
        "damage_factor_if_mean_stress": _quotient(float(weights @ per_pass["with_mean_stress"]), damage),
        "shear_ratio": of_governing("shear_ratio"),
        "damage_factor_if_shear": _quotient(float(weights @ per_pass["with_shear"]), damage),
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


def _pieces(modal_stress: Floats, q: Floats) -> Iterator[Floats]:
    """Stresses (4, u) of some samples after the other: histories of all of them would be four times the record."""
    for first in range(0, q.shape[1], SAMPLES_AT_ONCE):
        yield modal_stress @ q[:, first : first + SAMPLES_AT_ONCE]


def _stress(modal_stress: Floats, q: Floats) -> Floats:
    """Sum of membrane and bending stress, (t,)."""
    s, first = np.empty(q.shape[1]), 0
    for m, b in _pieces(modal_stress[:2], q):
        s[first : first + len(m)] = m + b
        first += len(m)
    return s


def _covariance(modal_stress: Floats, q: Floats) -> Floats:
    """Covariance (6, 6) of membrane, bending, shear in the plane and by twist, and of the sums of either two."""

    def six() -> Iterator[Floats]:
        return (np.stack([*s, s[0] + s[1], s[2] + s[3]]) for s in _pieces(modal_stress, q))

    mean = sum(s.sum(axis=1, keepdims=True) for s in six()) / q.shape[1]
    return np.asarray(sum((s - mean) @ (s - mean).T for s in six()) / q.shape[1])


def _cycle_rows(cycles: RecountCycles, modal_stress: Floats, s: Floats, record: RecountRecord) -> dict[str, Floats]:
    """Ranges of every cycle between its own two instants."""
    i, j = cycles.start, cycles.end
    dm, db = np.abs(modal_stress[:2] @ record.counted[:, j] - modal_stress[:2] @ record.counted[:, i])
    return {
        "start_s": record.start + record.fine_step * i,
        "end_s": record.start + record.fine_step * j,
        "range_MPa": np.abs(s[j] - s[i]),
        "mean_MPa": (s[i] + s[j]) / 2,
        "count": cycles.count,
        "membrane_range_MPa": dm,
        "bending_range_MPa": db,
        "bending_ratio": np.divide(db, dm + db, out=np.zeros_like(db), where=dm + db > 0),
    }


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
        f_M = _mean_stress_factor(f * low, f * high, mean_stress.yield_MPa) if mean_stress.counts else 1.0
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


def _shear_factor(of_stresses: Floats, I_one: float, curve: RecountCurve) -> float:
    """Factor of ASME VIII-2 5.5.5.3 on the range: principal variances of the path in the plane (sigma, sqrt(3) tau)."""
    ratio = _ratio(*np.sqrt(np.diag(of_stresses)[2:4]))
    I_t = _factor(np.array([0.0 if np.isnan(ratio) else ratio]), curve)[0]
    scale = np.array([1.0 / I_one, np.sqrt(3.0) / I_t])
    covariance = of_stresses[4:, 4:] * np.outer(scale, scale)
    largest = np.linalg.eigvalsh(covariance)[-1]
    total = np.trace(covariance)
    if not covariance[0, 0] > 0:
        return np.nan
    return float(np.sqrt(total / covariance[0, 0]) * np.sqrt(total / largest))


def _mean_stress_factor(a: Floats, b: Floats, yield_MPa: float | None) -> Floats:
    """``f_M`` of ASME VIII-2 5.5.5.2 of cycles between two stresses."""
    low, high = np.minimum(a, b), np.maximum(a, b)
    factor = np.ones(len(a))
    if yield_MPa is not None:
        tension = ((low + high) / 2 >= yield_MPa / 2) & (low > 0) & (high - low <= 2 * yield_MPa)
        factor[tension] = (1 - low[tension] / high[tension]) ** (1 / 3.6)
    return factor


def _is_known(mean_stress: MeanStress, curve: RecountCurve) -> bool:
    """Whether there is something to say of mean stress: a yield stress, and a curve in dS."""
    return mean_stress.yield_MPa is not None and curve.on_equivalent


def _factor(r: Floats, curve: RecountCurve) -> Floats:
    return ratio_factor(r) if curve.on_equivalent else np.ones_like(r)


def _kurtosis(s: Floats) -> float:
    def deviations(of: float) -> Iterator[Floats]:  # from the first, so that a stress that stands still has none
        return (s[i : i + SAMPLES_AT_ONCE] - s[0] - of for i in range(0, len(s), SAMPLES_AT_ONCE))

    mean = sum(d.sum() for d in deviations(0.0)) / len(s)
    second, fourth = (float(sum((d**power).sum() for d in deviations(mean))) / len(s) for power in (2, 4))
    return _quotient(fourth, second**2)


def _stress_ratio(a: float, b: float) -> float:
    return min(a, b) / max(a, b) if max(a, b) != 0 else np.nan


def _stress_ratios(a: Floats, b: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.minimum(a, b) / np.maximum(a, b))


def _ratio(membrane: float, bending: float) -> float:
    return _quotient(bending, membrane + bending)


def _life(damage: float, limit: float) -> float:
    if np.isnan(damage):
        return np.nan
    return limit / damage if damage > 0 else np.inf


def _quotient(a: float, b: float) -> float:
    return a / b if b > 0 else np.nan
