"""Proven upper bounds of the damage, for points that need no counting.

Cut a history into its rises and falls. Rainflow gives every bit of them to one cycle: a cycle from v up to p takes
one rise and one fall through [v, p], a half cycle one of the two. So for any rising function f the counted cycles
satisfy ``sum n (f(p) - f(v)) = TV(f(s)) / 2``, TV the total variation of the counted history (a recurring block also
steps from its last sample to its first). With ``f(s) = s |s|^(q-1)``, s without its mean,

    f(p) - f(v) >= 2^(1-q) (p - v)^q,   hence   sum n S^q <= 2^(q-2) TV(s |s|^(q-1)),

an equality for q = 1. With the largest factor g from S to the equivalent range x (r = 0), no cycle larger than the
range R, and d(x) / x^q never falling, as on every S-N curve with slopes of q and more, whatever its knees or cutoff,

    D = sum n d(x) <= d(g R) / (g R)^q * sum n (g S)^q.

For q = 1 this is Markov's inequality, for q equal to the slope the crossing bound of Rychlik (1993). A slope k between
two powers needs no range: ``sum n S^k <= (sum n S^q)^((p-k)/(p-q)) (sum n S^p)^((k-q)/(p-q))`` (Hoelder), and a curve
that is steeper for smaller ranges lies nowhere above the straight continuation of any of its segments. The smallest of
all these bounds is taken. They hold for the record that is counted (upsampled or not) and for modal stress that
contains the event's stress factor. Range and sums come without a loop over time from ``extent_bound``, and much closer,
with a loop but without counting, from ``weld_basis.reduced_bound``.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.bounds.forms import FormPair, face_forms, form_pair
from fatigue.life.records.history import Residue, cached_chunks, mean_and_covariance
from fatigue.life.records.spool import Samples
from fatigue.life.rule import CycleRule, cycle_damage, equivalent_range

Floats = NDArray[np.float64]
PowerSums = Mapping[int, Floats]  # bounds of sum n S^q [MPa^q] by q

ROUNDING = 1e-9  # all bounds are raised by this much
RIDGE = 1e-10  # added to the variance in every direction, over the variance of the coordinates


@dataclass(frozen=True, slots=True, eq=False)
class ModalExtent:
    """How far and how much the modal coordinates of one record move; see ``modal_extent``.

    Attributes
    ----------
    mean : (m,)
    covariance : (m, m)
    products : the covariance beside the sum of dq dq' over the steps
    reach : largest sqrt(q' P^-1 q) over time, q without its mean, P the covariance with ``RIDGE``
    ranges, variations : (m,) range and total variation of each coordinate
    samples, steps : how many there are; as many steps as samples where the record recurs
    """

    mean: Floats
    covariance: Floats
    products: FormPair
    reach: float
    ranges: Floats
    variations: Floats
    samples: int
    steps: int


def modal_extent(q: Samples, residue: Residue, known: tuple[Floats, Floats] | None = None) -> ModalExtent:
    """Prepare the bounds of all stresses of a record of modal coordinates (m, t), once per event.

    ``known`` are their mean and covariance, see ``mean_and_covariance``, where somebody has computed them before.
    """
    modes, samples = q.shape
    mean, covariance = mean_and_covariance(q) if known is None else known
    deviation = np.sqrt(np.diagonal(covariance))
    deviation = np.where(deviation > 0.0, deviation, 1.0)
    values, directions = np.linalg.eigh(covariance / np.outer(deviation, deviation))
    whitening = (directions / np.sqrt(np.maximum(values, 0.0) + RIDGE)).T / deviation

    reach = 0.0
    step_products = np.zeros((modes, modes))
    variations = np.zeros(modes)
    highest, lowest = np.full(modes, -np.inf), np.full(modes, np.inf)
    before = samples - 1 if residue == "repeat" else 0  # what recurs steps from its last sample to its first one
    last = q[:, before : before + 1].astype(np.float64)
    for chunk in cached_chunks(q):
        x = np.concatenate([last, chunk], axis=1)
        last = x[:, -1:].copy()
        highest, lowest = np.maximum(highest, x.max(axis=1)), np.minimum(lowest, x.min(axis=1))
        step = np.diff(x, axis=1)
        step_products += step @ step.T
        variations += np.abs(step, out=step).sum(axis=1)
        x -= mean[:, None]
        white = whitening @ x
        reach = max(reach, float(np.einsum("mt,mt->t", white, white).max()) ** 0.5)
    return ModalExtent(
        mean=mean,
        covariance=covariance,
        products=form_pair(covariance, step_products),
        reach=reach,
        ranges=highest - lowest,
        variations=variations,
        samples=samples,
        steps=samples if residue == "repeat" else samples - 1,
    )


def extent_bound(S_m: Floats, S_b: Floats, forms: Floats, extent: ModalExtent) -> tuple[Floats, PowerSums]:
    """Bound range (n, 2) and sum n S^q, q = 1 and 2, (n, 2) each, of top and bottom stress without a loop over time.

    Modal stress S_m, S_b (n, m) as in ``BlockStress``, ``forms`` (2, n, 2) their ``face_forms`` for
    ``extent.products``.

    With Cauchy-Schwarz twice, ``|w'q| <= sqrt(w'P w) sqrt(q'P^-1 q)`` for any P that is positive definite, and
    ``sum |w'dq| <= sqrt(steps) sqrt(sum (w'dq)^2)``; the sums over the coordinates, ``sum |w| range(q)`` and
    ``sum |w| TV(q)``, are taken where they are smaller. R <= TV in any history. From ``|a |a| - b |b|| <= (|a| + |b|)
    |a - b|`` follows ``TV(s |s|) <= sqrt(4 sum s^2) sqrt(sum ds^2)``.
    """
    deviations = np.sqrt(np.diagonal(extent.covariance))
    limits = np.stack([extent.variations, extent.ranges, deviations, extent.products.size])
    variations, ranges, modal, size = _of_modal_stresses(S_m, S_b, limits)
    variance, of_steps = _safe(forms, size, extent.products)
    variation = np.minimum(np.sqrt(extent.steps * of_steps), variations)
    largest = np.minimum(np.minimum(2.0 * _peak(variance, modal, extent), ranges), variation)
    squares = 2.0 * np.sqrt(extent.samples * variance * of_steps)
    return largest * (1.0 + ROUNDING), {1: 0.5 * variation * (1.0 + ROUNDING), 2: squares * (1.0 + ROUNDING)}


def size_bound(S_m: Floats, S_b: Floats, extent: ModalExtent) -> tuple[Floats, Floats, Floats]:
    """Bound max |s|, sqrt(sum s^2) and sqrt(sum ds^2) of top and bottom stress, s without its mean, each (n, 2)."""
    limits = np.stack([np.sqrt(np.diagonal(extent.covariance)), extent.products.size])
    modal, size = _of_modal_stresses(S_m, S_b, limits)
    variance, of_steps = _safe(face_forms(S_m, S_b, extent.products), size, extent.products)
    return _peak(variance, modal, extent), np.sqrt(extent.samples * variance), np.sqrt(of_steps)


def damage_bound(stress_range: Floats, power_sums: PowerSums, size: Floats, rule: CycleRule) -> tuple[Floats, Floats]:
    """Bound the damage of one pass (Eq. 22) and the largest equivalent range of some points, arrays of any one shape.

    ``stress_range`` [MPa] and ``power_sums`` bound range and sum n S^q; ``size``, of a shape that fits, is as in
    ``BlockStress``. The bound of the damage is infinite for a law with a slope below every q: there is none
    then. It does not contain the mean-stress factor f_M: see ``may_need_mean_stress``.
    """
    law, I = rule.law, rule.ratio_factor(np.zeros(()))  # noqa: E741 - the symbol of the standard
    g = equivalent_range(1.0, size, I, 1.0)
    largest = g * stress_range
    # Raised a little, so that neither rounding nor the choice between two segments at a knee matters.
    worst = cycle_damage(largest * (1.0 + ROUNDING), law)
    damage = np.full_like(largest, np.inf)
    for q, power_sum in power_sums.items():
        if law.slopes.min() >= q:
            damage = np.minimum(damage, worst * power_sum / np.where(stress_range > 0.0, stress_range, 1.0) ** q)
    if (np.diff(law.slopes) >= 0.0).all():  # steeper for smaller ranges
        for (q, smaller), (p, larger) in combinations(sorted(power_sums.items()), 2):
            for k, log_constant in zip(law.slopes, law.log_constants, strict=True):
                if q < k < p:
                    power_sum = smaller ** ((p - k) / (p - q)) * larger ** ((k - q) / (p - q))
                    damage = np.minimum(damage, g**k * np.exp(-log_constant) * power_sum)
    return damage * (1.0 + ROUNDING), largest


def may_need_mean_stress(mean: Floats, stress_range: Floats, yield_MPa: float) -> NDArray[np.bool_]:
    """Whether any cycle of a point can reach the tension at which f_M of ASME VIII-2 5.5.5.2 begins.

    f_M is 1 unless min + max of a cycle reaches the yield stress; no stress is above mean + R. All arrays (n,) [MPa].
    """
    return np.asarray(2.0 * (mean + stress_range) * (1.0 + ROUNDING) >= yield_MPa)


def _of_modal_stresses(S_m: Floats, S_b: Floats, limits: Floats) -> Floats:
    """Sum the sizes of the modal stresses of top and bottom times each of the limits (l, m): (l, n, 2)."""
    sums = np.empty((len(limits), len(S_m), 2))
    _sum_sizes(S_m, S_b, limits, sums)
    return sums


@compiled("reassoc", "contract")
def _sum_sizes(S_m: Floats, S_b: Floats, limits: Floats, sums: Floats) -> None:
    """``sum over k of limits_k |S_m,k + S_b,k|`` at the top, with a minus at the bottom."""
    for i in range(len(S_m)):
        for row in range(len(limits)):
            top = bottom = 0.0
            for k in range(S_m.shape[1]):
                top += limits[row, k] * abs(S_m[i, k] + S_b[i, k])
                bottom += limits[row, k] * abs(S_m[i, k] - S_b[i, k])
            sums[row, i, 0], sums[row, i, 1] = top, bottom


def _peak(variance: Floats, modal: Floats, extent: ModalExtent) -> Floats:
    """Bound max |s| by its variance and the sum of the deviations of its modal stresses."""
    return np.asarray(extent.reach * np.sqrt(variance + RIDGE * modal**2))


def _safe(forms: Floats, size: Floats, pair: FormPair) -> Floats:
    """Add their largest rounding errors to both forms of a pair, (2, n, 2); ``size`` (n, 2) belongs to the faces."""
    of_parts = size.sum(axis=1)  # not below the size of |S_m| + |S_b|
    return np.asarray(forms + pair.rounding[:, None, None] * of_parts[:, None] ** 2)
