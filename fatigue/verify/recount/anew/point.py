"""One point of a weld once more: one pass of an event counted by itself."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.across_events.turns import Turns, of_places, turning_points
from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.cycles import RecountCycles, count_cycles, in_pieces
from fatigue.verify.recount.anew.mean_stress import MeanStress, stress_ratio, stress_ratios
from fatigue.verify.recount.anew.record import RecountRecord, SpectrumRules, welch_moments
from fatigue.verify.recount.anew.rounding import (
    SAMPLES_AT_ONCE,
    Bounds,
    Counted,
    cycle_bounds,
    pass_bounds,
    stress_bound,
)
from fatigue.verify.recount.anew.spectral import dirlik, tovo_benasciutti
from fatigue.verify.recount.anew.vertex import Vertices, vertices

Floats = NDArray[np.float64]
Values = dict[str, Any]

SAME_INSTANT = 1e-6  # of a step: of a vertex that lies on a sample
NEGLIGIBLE_OUTSIDE = 1e-4  # of the variance above the upper frequency: not counted among the peaks


@dataclass(frozen=True, slots=True, eq=False)
class RecountPoint:
    """Stress per unit modal coordinate at one face, (m,) each [MPa], the curve there and the plate.

    ``membrane`` and ``bending`` of this face, ``in_plane`` and ``twist`` shear likewise; ``largest`` stress anywhere
    along the line. ``thickness`` of the plate and length of the ``attachment`` on it are in mm.
    """

    membrane: Floats
    bending: Floats
    in_plane: Floats
    twist: Floats
    largest: Floats
    curve: RecountCurve
    thickness: float
    attachment: float = np.inf

    @property
    def size(self) -> float:
        """Factor of plate, attachment and curve on every range."""
        return self.curve.size_factor(self.thickness, self.attachment)


@dataclass(frozen=True, slots=True, eq=False)
class OnePass:
    """One pass of an event at a point: its quantities by the name of their column, and its cycles.

    ``rows`` is the table of cycles. ``ranges``, ``counts``, ``low`` and ``high`` are the equivalent range of each cycle
    without mean stress, its count and its two stresses, and empty where damage scales with one power of the load.
    ``bounds`` are what rounding may do to the quantities, ``cycle_bounds`` to the largest cycle. ``turns`` are what
    counting several passes in a row needs, where somebody does. ``pieces`` are the damage of a pass by parts of time.
    """

    quantities: Values
    ranges: Floats
    counts: Floats
    low: Floats
    high: Floats
    rows: dict[str, Floats]
    bounds: Bounds
    cycle_bounds: Bounds
    turns: Turns | None = None
    pieces: Floats = field(default_factory=lambda: np.zeros(0))


def point_of(
    components: Floats, largest: Floats, surface: str, curve: RecountCurve, thickness: float, attachment: float = np.inf
) -> RecountPoint:
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
        attachment,
    )


def one_pass(
    point: RecountPoint, record: RecountRecord, rules: SpectrumRules, mean_stress: MeanStress, event: int | None = None
) -> OnePass:
    """One pass of an event at a point, counted, and estimated from its spectrum.

    ``event`` is its number where its passes are counted in a row with others.
    """
    curve, size = point.curve, point.size
    modal_stress = record.factor * np.stack([point.membrane, point.bending, point.in_plane, point.twist])
    kept = _stress(modal_stress, record.kept)
    s = kept if record.counted is record.kept else _stress(modal_stress, record.counted)
    kurtosis = _kurtosis(s)
    delta = stress_bound(point.largest, record.peak, record.factor)
    read = vertices(s, record, 2.0 * delta)
    s, delta = read.moved(s), delta + read.doubt
    covariance = _covariance(modal_stress, record.kept)
    deviation = np.sqrt(np.diag(covariance))

    one_ratio = _ratio(*deviation[:2])
    I_one = curve.bending_factor(np.array([0.0 if np.isnan(one_ratio) else one_ratio]))[0]
    cycles = count_cycles(s, recurs=record.recurs)
    rows = _cycle_rows(cycles, modal_stress, s, record, read)
    S, n = rows["range_MPa"], rows["count"]
    level = float((modal_stress[0] + modal_stress[1]) @ record.offset)
    rows["mean_MPa"] += level
    a, b = s[cycles.start] + level, s[cycles.end] + level
    f_M = mean_stress.factor(a, b)
    x = S * size / curve.bending_factor(rows["bending_ratio"]) / curve.stress_ratio_factor(a, b)
    dS = x / f_M if mean_stress.counts else x
    damage = float(n @ curve.damage(dS))
    largest = int(np.argmax(S)) if len(S) else None
    k = curve.slopes[0]

    moments = welch_moments(kept, record.step, rules) if record.has_spectrum else None
    nothing = moments is None
    band, whole = (np.full(4, np.nan),) * 2 if moments is None else moments
    to_equivalent = (size / I_one) ** 2
    m0, _, m2, m4 = band
    outside = 1.0 - quotient(m0, whole[0])
    peaks = quotient(*((whole if outside >= NEGLIGIBLE_OUTSIDE else band)[[3, 2]])) ** 0.5
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
        "kurtosis": kurtosis,
        "outside_share": outside,
        "irregularity": quotient(m2, (m0 * m4) ** 0.5),
        "peaks_per_s": peaks,
        "samples_per_peak": quotient(1.0 / record.fine_step, peaks),
        "shear_ratio": quotient(deviation[5], deviation[4]),
        "power_sum": float(n @ S**k),
        "R_largest": np.nan if largest is None else stress_ratio(a[largest], b[largest]),
        "with_mean_stress": float(n @ curve.damage(x / f_M)) if mean_stress.is_known(curve) else np.nan,
        "with_shear": float(n @ curve.damage(dS * np.nan_to_num(_shear_factor(covariance, I_one, curve), nan=1.0))),
    }
    rows |= {"equivalent_range_dS": dS, "damage": n * curve.damage(dS)}
    kept_cycles = slice(0) if curve.is_straight and not mean_stress.counts else slice(None)
    low, high = np.minimum(a, b), np.maximum(a, b)
    counted = Counted(
        delta=delta,
        delta_level=delta + stress_bound(point.largest, np.abs(record.offset), record.factor),
        level=level,
        stress=s,
        deviation=float(deviation[4]),
        parts=float(deviation[0] + deviation[1]),
        ranges=S,
        equivalent=dS,
        same_ratio=S * size / I_one,
        counts=n,
        R=stress_ratios(a, b),
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
    turns = None if event is None else _turns(event, cycles, modal_stress, s, record, read)
    bounds = pass_bounds(counted, values, curve), cycle_bounds(counted, curve)
    bounds[1]["instant"] = SAME_INSTANT * record.fine_step
    pieces = in_pieces(cycles, rows["damage"], len(s))
    return OnePass(values, x, n, low, high, rows, *bounds, turns, pieces)


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


def _cycle_rows(
    cycles: RecountCycles, modal_stress: Floats, s: Floats, record: RecountRecord, read: Vertices
) -> dict[str, Floats]:
    """Ranges of every cycle between its own two instants."""
    i, j = cycles.start, cycles.end
    dm, db = np.abs(np.subtract(*(read.parts(modal_stress[:2], record.counted, at) for at in (j, i))))
    return {
        "start_s": record.start + record.fine_step * (i + read.shift_of(i)),
        "end_s": record.start + record.fine_step * (j + read.shift_of(j)),
        "range_MPa": np.abs(s[j] - s[i]),
        "mean_MPa": (s[i] + s[j]) / 2,
        "count": cycles.count,
        "membrane_range_MPa": dm,
        "bending_range_MPa": db,
        "bending_ratio": np.divide(db, dm + db, out=np.zeros_like(db), where=dm + db > 0),
    }


def _turns(
    event: int, cycles: RecountCycles, modal_stress: Floats, s: Floats, record: RecountRecord, read: Vertices
) -> Turns:
    """Turning points of a pass, with what is constant."""
    at = turning_points(s, cycles)
    membrane, bending = read.parts(modal_stress[:2], record.counted, at) + (modal_stress[:2] @ record.offset)[:, None]
    time = np.asarray(record.start + record.fine_step * (at + read.shift_of(at)), dtype=np.float64)
    return Turns(event, membrane, bending, time, of_places(cycles, at), record.recurs)


def _shear_factor(of_stresses: Floats, I_one: float, curve: RecountCurve) -> float:
    """Factor of ASME VIII-2 5.5.5.3 on the range: principal variances of the path in the plane (sigma, sqrt(3) tau)."""
    ratio = _ratio(*np.sqrt(np.diag(of_stresses)[2:4]))
    I_t = curve.bending_factor(np.array([0.0 if np.isnan(ratio) else ratio]))[0]
    scale = np.array([1.0 / I_one, np.sqrt(3.0) / I_t])
    covariance = of_stresses[4:, 4:] * np.outer(scale, scale)
    largest = np.linalg.eigvalsh(covariance)[-1]
    total = np.trace(covariance)
    if not covariance[0, 0] > 0:
        return np.nan
    return float(np.sqrt(total / covariance[0, 0]) * np.sqrt(total / largest))


def _kurtosis(s: Floats) -> float:
    def deviations(of: float) -> Iterator[Floats]:  # from the first, so that a stress that stands still has none
        return (s[i : i + SAMPLES_AT_ONCE] - s[0] - of for i in range(0, len(s), SAMPLES_AT_ONCE))

    mean = sum(d.sum() for d in deviations(0.0)) / len(s)
    second, fourth = (float(sum((d**power).sum() for d in deviations(mean))) / len(s) for power in (2, 4))
    return quotient(fourth, second**2)


def _ratio(membrane: float, bending: float) -> float:
    return quotient(bending, membrane + bending)


def quotient(a: float, b: float) -> float:
    """``a / b``, NaN where there is nothing to divide by."""
    return a / b if b > 0 else np.nan
