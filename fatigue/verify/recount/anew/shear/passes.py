"""One pass of an event at a point with its shear: half cycles of its path, and their damage by three ranges."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.mean_stress import MeanStress
from fatigue.verify.recount.anew.point import RecountPoint
from fatigue.verify.recount.anew.record import RecountRecord
from fatigue.verify.recount.anew.rounding import Bounds, equivalent_bound, stress_bound
from fatigue.verify.recount.anew.shear.path import HalfCycles, half_cycles
from fatigue.verify.recount.anew.shear.rounding import bound_of_largest, sums_bounds

Floats = NDArray[np.float64]

EQUAL = 1.0 - 1e-9  # ranges that only rounding tells apart


@dataclass(frozen=True, slots=True)
class ShearRules:
    """What the case says of shear: its method, and the weights of the square of the shear and of the path moment."""

    method: str
    beta: float
    alpha: float | None


@dataclass(frozen=True, slots=True, eq=False)
class ShearPass:
    """One pass of an event at a point.

    Attributes
    ----------
    by_range, by_length, by_moment : Miner sums of its half cycles; the last NaN without alpha
    top_pair : damage of the most distant pair alone: one cycle of what recurs, else half a cycle
    range : of the largest half cycle [MPa], and its ``factor`` and ``moment``; of equal ones the largest
    rows : the half cycles by the columns of their table
    bounds : what rounding may do to the numbers, by their names
    """

    by_range: float
    by_length: float
    by_moment: float
    top_pair: float
    range: float
    factor: float
    moment: float
    rows: dict[str, Floats]
    bounds: Bounds


def shear_pass(point: RecountPoint, record: RecountRecord, rules: ShearRules, mean_stress: MeanStress) -> ShearPass:
    """One pass with the half cycles of its path, each with the ranges between its own two ends."""
    curve = point.curve
    parts = record.factor * np.stack([point.membrane, point.bending, point.in_plane, point.twist]) @ record.counted
    s, tau = parts[0] + parts[1], parts[2] + parts[3]
    e = path_rounding(point, record, rules.beta)
    path = half_cycles(np.stack([s, np.sqrt(rules.beta) * tau], axis=1), recurs=record.recurs, rounding=e)
    a, b = (_at(parts, t) for t in (path.start, path.end))
    d = b - a
    normal, shear = np.abs(d[0] + d[1]), np.abs(d[2] + d[3])
    r, r_shear = (_share(np.abs(d[i]), np.abs(d[i + 1])) for i in (0, 2))
    x = point.size * np.sqrt(
        (normal / curve.bending_factor(r)) ** 2 + rules.beta * (shear / curve.bending_factor(r_shear)) ** 2
    )
    level = float(record.factor * (point.membrane + point.bending) @ record.offset)
    ends = a[0] + a[1] + level, b[0] + b[1] + level
    x = x / curve.stress_ratio_factor(*ends)
    if mean_stress.counts:
        x = x / mean_stress.factor(*ends)
    p, g = np.maximum(path.length / path.range, 1.0), path.moment
    damage = curve.damage(x)
    top = path.range >= EQUAL * path.range.max(initial=0.0)
    rho, level_bound = 2.0 * e, stress_bound(point.largest, np.abs(record.offset), record.factor)
    highest = float(np.maximum(*ends).max(initial=0.0)) if mean_stress.counts else 0.0
    d_x = equivalent_bound(point.size, rho, rho + 2.0 * level_bound, highest)
    factor, moment = float(p[top].max(initial=0.0)), float(g[top].max(initial=0.0))
    bounds = {
        "range": rho,
        "factor": bound_of_largest(factor, p, (path.length_bound + rho * p) / path.range, path, rho),
        "moment": bound_of_largest(moment, g, path.moment_bound, path, rho),
        **sums_bounds(path, x, d_x, rho, len(s), rules.alpha, curve),
    }
    return ShearPass(
        by_range=float(damage.sum()) / 2.0,
        by_length=float(curve.damage(p * x).sum()) / 2.0,
        by_moment=np.nan if rules.alpha is None else float(curve.damage((1.0 + rules.alpha * g) * x).sum()) / 2.0,
        top_pair=float(damage[top].max(initial=0.0)) * (1.0 if record.recurs else 0.5),
        range=float(path.range.max(initial=0.0)),
        factor=factor,
        moment=moment,
        bounds=bounds,
        rows=_rows(path, record)
        | {
            "path_factor": p,
            "normal_range_MPa": normal,
            "shear_range_MPa": shear,
            "bending_ratio": r,
            "shear_bending_ratio": r_shear,
            "equivalent_range_dS": x,
            "damage": damage / 2.0,
        },
    )


def path_rounding(point: RecountPoint, record: RecountRecord, beta: float) -> float:
    """How far a point of the path may be from where it is, in the plane of normal stress and weighted shear [MPa]."""
    return float(np.sqrt(1.0 + beta)) * stress_bound(point.largest, record.peak, record.factor)


def _rows(path: HalfCycles, record: RecountRecord) -> dict[str, Floats]:
    return {
        "start_s": record.start + record.fine_step * path.start,
        "end_s": record.start + record.fine_step * path.end,
        "range_MPa": path.range,
        "path_moment": path.moment,
    }


def _at(parts: Floats, t: Floats) -> Floats:
    """Stresses (4, h) at sample indices with a fraction; behind the last sample follows the first."""
    k = np.floor(t).astype(np.intp)
    share = t - k
    return np.asarray((1.0 - share) * parts[:, k] + share * parts[:, (k + 1) % parts.shape[1]])


def _share(membrane: Floats, bending: Floats) -> Floats:
    total = membrane + bending
    return np.divide(bending, total, out=np.zeros_like(total), where=total > 0.0)
