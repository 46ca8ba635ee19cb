"""Proven upper bounds of the damage, for points that need no counting.

Cut a history into its rises and falls. Rainflow gives every piece of them to one cycle: a cycle from v up to p takes
one rise and one fall through [v, p], a half cycle one of the two. So for any rising function f the counted cycles
satisfy ``sum n (f(p) - f(v)) = TV(f(s)) / 2``, TV the total variation of the counted history (that of a recurring block
contains the step from its last sample to its first). With ``f(s) = s |s|^(q-1)``, s without its mean,

    f(p) - f(v) >= 2^(1-q) (p - v)^q,   hence   sum n S^q <= 2^(q-2) TV(s |s|^(q-1)),

an equality for q = 1. With the largest factor g from S to the equivalent range x (r = 0), no cycle larger than the
range R, and d(x) / x^q never falling, as on every S-N curve with slopes of q and more, whatever its knees or cutoff,

    D = sum n d(x) <= d(g R) / (g R)^q * sum n (g S)^q.

The smallest of the bounds for q = 1, 2, 3 is taken. For q = 1 this is Markov's inequality, for q equal to the slope the
crossing bound of Rychlik (1993). The bounds hold for the record that is counted (upsampled or not) and for shapes that
contain the event's stress factor. Range and sums come without a loop over time from `extent_bound`, or with one but
without counting from `rainflow_fast.stress_extent`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.damage import cycle_damage, ratio_factor
from fatigue.life.history import Residue

Floats = NDArray[np.float64]

ROUNDING = 1e-9  # all bounds are raised by this much
SINGULAR = 1e-10  # directions with less of the largest variance are bounded by their largest value
_AT_ONCE = 8192  # samples


@dataclass(frozen=True, slots=True, eq=False)
class ModalExtent:
    """How far and how much the modal coordinates of one record move; see `modal_extent`.

    Attributes
    ----------
    mean : (m,)
    variances : (m, m) covariance
    covariance : (m, m) the same in the directions that it spans well
    reach : largest sqrt(q' C^-1 q) over time, q without its mean
    remainder : (m, m) projector on the other directions, of coordinates over ``deviation``
    deviation : (m,) standard deviations
    remainder_reach : largest length of q / deviation in these directions
    ranges, variations : (m,) range and total variation of each coordinate
    samples, steps : how many there are
    step_products : (m, m) sum of dq dq' over the steps
    """

    mean: Floats
    variances: Floats
    covariance: Floats
    reach: float
    remainder: Floats
    deviation: Floats
    remainder_reach: float
    ranges: Floats
    variations: Floats
    samples: int
    steps: int
    step_products: Floats


def modal_extent(q: NDArray[np.floating], residue: Residue) -> ModalExtent:
    """Prepare the bounds of all stresses of a record of modal coordinates (m, t), once per event."""
    modes, samples = q.shape
    mean = q.mean(axis=1, dtype=np.float64)
    pieces = [slice(first, first + _AT_ONCE) for first in range(0, samples, _AT_ONCE)]
    covariance = np.zeros((modes, modes))
    step_products = np.zeros((modes, modes))
    variations = np.zeros(modes)
    last = q[:, -1:] if residue == "repeat" else q[:, :1]  # a block that recurs steps back to its first sample
    for piece in pieces:
        x = q[:, piece].astype(np.float64)
        step = np.diff(np.concatenate([last, x], axis=1), axis=1)
        last = x[:, -1:]
        x -= mean[:, None]
        covariance += x @ x.T / samples
        step_products += step @ step.T
        variations += np.abs(step).sum(axis=1)

    deviation = np.sqrt(np.diagonal(covariance))
    deviation = np.where(deviation > 0.0, deviation, 1.0)
    values, directions = np.linalg.eigh(covariance / np.outer(deviation, deviation))
    spanned = values > SINGULAR * max(values[-1], np.finfo(np.float64).tiny)
    inside, outside = directions[:, spanned], directions[:, ~spanned]
    reach = remainder_reach = 0.0
    for piece in pieces:
        x = (q[:, piece] - mean[:, None]) / deviation[:, None]
        along = inside.T @ x / np.sqrt(values[spanned])[:, None]
        reach = max(reach, float(np.sqrt((along**2).sum(axis=0).max())))
        remainder_reach = max(remainder_reach, float(np.sqrt(((outside.T @ x) ** 2).sum(axis=0).max())))
    return ModalExtent(
        mean=mean,
        variances=covariance,
        covariance=np.outer(deviation, deviation) * ((inside * values[spanned]) @ inside.T),
        reach=reach,
        remainder=outside @ outside.T,
        deviation=deviation,
        remainder_reach=remainder_reach,
        ranges=np.ptp(q, axis=1).astype(np.float64),
        variations=variations,
        samples=samples,
        steps=samples if residue == "repeat" else samples - 1,
        step_products=step_products,
    )


def extent_bound(S: Floats, extent: ModalExtent) -> tuple[Floats, Floats]:
    """Bound range (n,) and sum n S^q, q = 1 and 2, (2, n) of the stresses S @ q, S (n, m), without a loop over time.

    With q = p + o, p in the directions that the covariance C spans and o in the others, and Cauchy-Schwarz twice,
    ``|w'p| <= sqrt(w'C w) sqrt(p'C^-1 p)`` and ``sum |w'dq| <= sqrt(steps) sqrt(sum (w'dq)^2)``; the sums over the
    coordinates, ``sum |w| range(q)`` and ``sum |w| TV(q)``, are taken where they are smaller. R <= TV in any history.
    From ``|a |a| - b |b|| <= (|a| + |b|) |a - b|`` follows ``TV(s |s|) <= sqrt(4 sum s^2) sqrt(sum ds^2)``.
    """
    weights = np.abs(S)
    variance = _quadratic(S, extent.variances)
    squared_steps = _quadratic(S, extent.step_products)
    inside = np.sqrt(_quadratic(S, extent.covariance)) * extent.reach
    outside = np.sqrt(_quadratic(S * extent.deviation, extent.remainder)) * extent.remainder_reach
    variation = np.minimum(np.sqrt(extent.steps * squared_steps), weights @ extent.variations)
    largest = np.minimum(np.minimum(2.0 * (inside + outside), weights @ extent.ranges), variation)
    sums = np.stack([0.5 * variation, 2.0 * np.sqrt(extent.samples * variance * squared_steps)])
    return largest * (1.0 + ROUNDING), sums * (1.0 + ROUNDING)


def damage_bound(
    stress_range: Floats, power_sums: Floats, size: Floats, law: DamageLaw, *, uses_bending_ratio: bool
) -> tuple[Floats, Floats]:
    """Bound the damage of one pass and the largest equivalent range, both (n,).

    ``stress_range`` (n,) [MPa] and ``power_sums`` (p, n) [MPa^q] bound range and sum n S^q, q = 1 ... p; ``size`` (n,)
    is that of `rainflow.count_block`. The bound of the damage is infinite for a law with a slope below 1, for which
    there is none. It does not contain the mean-stress factor f_M: see `may_need_mean_stress`.
    """
    g = size / (ratio_factor(np.zeros(())) if uses_bending_ratio else 1.0)
    largest = g * stress_range
    # Raised a little, so that neither rounding nor the choice between two segments at a knee matters.
    worst = cycle_damage(largest * (1.0 + ROUNDING), law)
    damage = np.full_like(largest, np.inf)
    for q, power_sum in enumerate(power_sums, start=1):
        if law.slopes.min() >= q:
            damage = np.minimum(damage, worst * power_sum / np.where(stress_range > 0.0, stress_range, 1.0) ** q)
    return damage * (1.0 + ROUNDING), largest


def may_need_mean_stress(mean: Floats, stress_range: Floats, yield_MPa: float) -> NDArray[np.bool_]:
    """Whether any cycle of a point can reach the tension at which f_M of ASME VIII-2 5.5.5.2 begins.

    f_M is 1 unless min + max of a cycle reaches the yield stress; no stress is above mean + R. All arrays (n,) [MPa].
    """
    return np.asarray(2.0 * (mean + stress_range) * (1.0 + ROUNDING) >= yield_MPa)


def _quadratic(S: Floats, A: Floats) -> Floats:
    """Evaluate w'A w of every row w of S, a form that is never negative, with its largest rounding error added."""
    rounding = 4.0 * len(A) * np.finfo(np.float64).eps * (np.abs(S) @ np.sqrt(np.diagonal(A))) ** 2
    return np.asarray(np.maximum(((S @ A) * S).sum(axis=1), 0.0) + rounding)
