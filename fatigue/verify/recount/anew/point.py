"""One point of a weld once more: every event counted by itself, then the mission."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.curve import RecountCurve, ratio_factor
from fatigue.verify.recount.anew.cycles import RecountCycles, count_cycles
from fatigue.verify.recount.anew.record import RecountRecord, SpectrumRules, welch_moments
from fatigue.verify.recount.anew.spectral import dirlik, tovo_benasciutti

Floats = NDArray[np.float64]
Values = dict[str, Any]

NEARLY_ALL = 0.9  # of the damage from above the upper frequency: no life from the spectrum
NEGLIGIBLE_OUTSIDE = 1e-4  # of the variance above the upper frequency: not counted among the peaks


@dataclass(frozen=True, slots=True, eq=False)
class RecountPoint:
    """Stress per unit modal coordinate at one face, (m,) each [MPa], the curve there and the plate thickness [mm].

    ``membrane`` and ``bending`` of this face, ``in_plane`` and ``twist`` shear likewise.
    """

    membrane: Floats
    bending: Floats
    in_plane: Floats
    twist: Floats
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

    ``rows`` is the table of cycles; ``ranges`` and ``counts`` repeat the equivalent range and the count of every cycle
    on a curve that bends, and are empty on a straight one.
    """

    quantities: Values
    ranges: Floats
    counts: Floats
    rows: dict[str, Floats]


@dataclass(frozen=True, slots=True)
class RecountEvent:
    """How long one pass is [km], None for an event counted by number, and how often it happens per km."""

    name: str
    length_km: float | None
    passes_per_km: float


def point_of(components: Floats, surface: str, curve: RecountCurve, thickness: float) -> RecountPoint:
    """One face of a station, whose five stress components are (m, 5)."""
    side = 1.0 if surface == "top" else -1.0
    return RecountPoint(
        components[:, 0], side * components[:, 1], components[:, 2], side * components[:, 3], curve, thickness
    )


def one_pass(point: RecountPoint, record: RecountRecord, rules: SpectrumRules, mean_stress: MeanStress) -> OnePass:
    """One pass of an event at a point, counted, and estimated from its spectrum."""
    curve, size = point.curve, point.curve.size_factor(point.thickness)
    modal_stress = record.factor * np.stack([point.membrane, point.bending, point.in_plane, point.twist])
    m_kept, b_kept, t_m, t_b = modal_stress @ record.kept
    m, b = (m_kept, b_kept) if record.counted is record.kept else modal_stress[:2] @ record.counted
    kept, s = m_kept + b_kept, m + b

    one_ratio = _ratio(float(np.std(m_kept)), float(np.std(b_kept)))
    I_one = _factor(np.array([0.0 if np.isnan(one_ratio) else one_ratio]), curve)[0]
    cycles = count_cycles(s, recurs=record.recurs)
    rows = _cycle_rows(cycles, m, b, record)
    S, n = rows["range_MPa"], rows["count"]
    f_M = _mean_stress_factor(s[cycles.start], s[cycles.end], mean_stress.yield_MPa)
    x = S * size / _factor(rows["bending_ratio"], curve)
    dS = x / f_M if mean_stress.counts else x
    damage = float(n @ curve.damage(dS))
    largest = int(np.argmax(S)) if len(S) else None
    k = curve.slopes[0]

    moments = welch_moments(kept, record.step, rules)
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
        "mean_stress_MPa": float(kept.mean()),
        "kurtosis": _kurtosis(s),
        "outside_share": outside,
        "irregularity": _quotient(m2, (m0 * m4) ** 0.5),
        "peaks_per_s": peaks,
        "samples_per_peak": _quotient(1.0 / record.fine_step, peaks),
        "shear_ratio": _quotient(float(np.std(t_m + t_b)), float(np.std(kept))),
        "power_sum": float(n @ S**k),
        "R_largest": np.nan if largest is None else _stress_ratio(s[cycles.start[largest]], s[cycles.end[largest]]),
        "with_mean_stress": np.nan if mean_stress.yield_MPa is None else float(n @ curve.damage(x / f_M)),
        "with_shear": damage * _shear_factor(kept, t_m, t_b, I_one, curve) ** k if damage > 0 else 0.0,
    }
    rows |= {"equivalent_range_dS": dS, "damage": n * curve.damage(dS)}
    kept_cycles = slice(0) if curve.is_straight else slice(None)
    return OnePass(values, dS[kept_cycles], n[kept_cycles], rows)


def point_values(
    passes: Sequence[OnePass],
    raw_damage: Sequence[float],
    events: Sequence[RecountEvent],
    mission: Mapping[str, Any],
    curve: RecountCurve,
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
        "load_factor": _load_factor(passes, weights * target / limit, curve, utilisation),
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


def _cycle_rows(cycles: RecountCycles, m: Floats, b: Floats, record: RecountRecord) -> dict[str, Floats]:
    """Ranges of every cycle between its own two instants."""
    i, j = cycles.start, cycles.end
    s = m + b
    dm, db = np.abs(m[j] - m[i]), np.abs(b[j] - b[i])
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


def _load_factor(passes: Sequence[OnePass], weights: Floats, curve: RecountCurve, utilisation: float) -> float:
    """Scale on all ranges at which all cycles together just meet the target, by bisection where the curve bends."""
    if curve.is_straight:
        return float(utilisation ** (-1 / curve.slopes[0])) if utilisation > 0 else np.inf
    x = np.concatenate([one.ranges for one in passes])
    n = np.concatenate([weight * one.counts for weight, one in zip(weights, passes, strict=True)])
    if not x[n > 0].max(initial=0.0) > 0.0:
        return np.inf
    low, high = -60.0, 60.0  # of ln(factor)
    for _ in range(60):
        middle = (low + high) / 2
        above = n @ curve.damage(x * np.exp(middle)) > 1.0
        low, high = (low, middle) if above else (middle, high)
    return float(np.exp(low))


def _shear_factor(kept: Floats, t_m: Floats, t_b: Floats, I_one: float, curve: RecountCurve) -> float:
    """Factor of ASME VIII-2 5.5.5.3 on the range: principal variances of the path in the plane (sigma, sqrt(3) tau)."""
    ratio = _ratio(float(np.std(t_m)), float(np.std(t_b)))
    I_t = _factor(np.array([0.0 if np.isnan(ratio) else ratio]), curve)[0]
    path = np.stack([kept / I_one, np.sqrt(3.0) * (t_m + t_b) / I_t])
    covariance = np.cov(path, bias=True)
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


def _factor(r: Floats, curve: RecountCurve) -> Floats:
    return ratio_factor(r) if curve.on_equivalent else np.ones_like(r)


def _kurtosis(s: Floats) -> float:
    deviation = s - s[0]  # first, so that a stress that stands still has none
    deviation -= deviation.mean()
    return _quotient(float(np.mean(deviation**4)), float(np.mean(deviation**2) ** 2))


def _stress_ratio(a: float, b: float) -> float:
    return min(a, b) / max(a, b) if max(a, b) != 0 else np.nan


def _ratio(membrane: float, bending: float) -> float:
    return _quotient(bending, membrane + bending)


def _life(damage: float, limit: float) -> float:
    if np.isnan(damage):
        return np.nan
    return limit / damage if damage > 0 else np.inf


def _quotient(a: float, b: float) -> float:
    return a / b if b > 0 else np.nan
