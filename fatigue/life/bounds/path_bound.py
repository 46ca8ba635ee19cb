"""A bound of the damage that any path of normal and shear stress does by the ranges of its half cycles.

With c the largest factor from a distance R in the plane of ``(normal, sqrt(beta) shear)`` to the equivalent range,

    x_k <= c R_k <= c L_k,    sum over k of L_k = Lambda,    x_k <= xh = c sqrt(D(s)^2 + beta D(tau)^2),

L_k the length of the path that belongs to half cycle k, Lambda that of the whole path (closed where it recurs), D the
range of a stress over the record. d(x) / x never falls on a curve with slopes of 1 and more, whatever its knees or
cut-off, so

    sum 0.5 d(x_k) <= 0.5 c Lambda d(xh) / xh.

It holds for the path range alone: not for path length or moment, and not where the damage contains f_M.

Higher powers are closer. A half cycle from P to Q takes the pieces of the path on which the distance r from P is as
large as never before; so r takes every value from 0 to R there once, and pieces of two half cycles never overlap. Let x
be the path seen from any fixed point, its time mean for one. As |x| >= ||P| - r| and |dx| >= dr,

    int over the pieces of q |x|^(q-1) |dx|  >=  int from 0 to R of q ||P| - r|^(q-1) dr  >=  2^(1-q) R^q,

which is |P|^q + (R - |P|)^q with R >= |P|, smallest at |P| = R / 2, and |P|^q - (|P| - R)^q >= R^q else. Hence

    sum 0.5 R_k^q <= 2^(q-2) int over the whole path of q |x|^(q-1) |dx|,

as in ``screening`` for one stress, and Lambda / 2 for q = 1. ``screening.damage_bound`` makes a bound of the damage of
these sums. Between two samples |x|^2 is a parabola, so q = 3 is integrated exactly; |x|^3 is convex, so q = 4 is not
above the mean of both ends.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.screening import PowerSums, damage_bound
from fatigue.life.records.history import Residue
from fatigue.life.rule import CycleRule, cycle_damage

Floats = NDArray[np.float64]

ROUNDING = 1e-9  # the bound is raised by this much


def path_length(normal: Floats, shear: Floats, beta: float, residue: Residue) -> Floats:
    """Length Lambda (...) of the paths of normal and shear stress (..., t) [MPa]; of a recurring block, closed."""
    steps = [np.diff(x, axis=-1, append=x[..., :1] if residue == "repeat" else x[..., -1:]) for x in (normal, shear)]
    return np.asarray(np.hypot(steps[0], np.sqrt(beta) * steps[1]).sum(axis=-1))


def path_length_bound(normal: Floats, shear: Floats, beta: float, step_products: Floats, steps: int) -> Floats:
    """Bound of the length (...) by normal and shear stress per unit coordinate (..., m), without their histories.

    ``step_products`` (m, m) is the sum of dq dq' over the steps of the coordinates, of a recurring block also the one
    from its last sample to its first. By Cauchy-Schwarz, ``Lambda <= sqrt(steps (w_s'G w_s + beta w_tau'G w_tau))``.
    """
    squares = [np.einsum("...i,ij,...j->...", w, step_products, w) for w in (normal, shear)]
    return np.asarray(np.sqrt(steps * np.maximum(squares[0] + beta * squares[1], 0.0)))


def largest_combined_range(
    normal_range: Floats, shear_range: Floats, size: Floats, beta: float, rule: CycleRule
) -> Floats:
    """Equivalent range xh that no pair of instants exceeds, from the ranges of both stresses over the record [MPa]."""
    return np.asarray(_largest_factor(size, rule) * np.hypot(normal_range, np.sqrt(beta) * shear_range))


def path_bound(length: Floats, xh: Floats, size: Floats, rule: CycleRule) -> Floats:
    """Bound ``0.5 c Lambda d(xh) / xh`` of the damage of one record, its path as long and its ranges as given.

    Raises
    ------
    ValueError : the damage contains f_M, for which nothing is proven
    """
    if rule.mean_stress:
        raise ValueError("the bound holds without f_M only")
    largest = np.asarray(xh) * (1.0 + ROUNDING)
    per_range = np.divide(cycle_damage(largest, rule.law), largest, out=np.zeros_like(largest), where=largest > 0.0)
    return np.asarray(0.5 * (1.0 + ROUNDING) * _largest_factor(size, rule) * length * per_range)


def power_integrals(path: Floats) -> Floats:
    """Integrals of ``3 |x|^2 |dx|`` and ``4 |x|^3 |dx|`` (2, ...) along paths x (2, ..., t) of two coordinates.

    The latter from above; infinite, which bounds nothing, where a power of the stress exceeds double precision.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        square = path[0] ** 2 + path[1] ** 2
        step = np.diff(path[0]) ** 2 + np.diff(path[1]) ** 2
        length, cube = np.sqrt(step), square * np.sqrt(square)
        third = length * (1.5 * (square[..., :-1] + square[..., 1:]) - 0.5 * step)
        fourth = 2.0 * length * (cube[..., :-1] + cube[..., 1:])
        both = np.stack([third.sum(axis=-1), fourth.sum(axis=-1)])
    return np.where(np.isnan(both), np.inf, both)


def power_bound(length: Floats, integrals: Floats, largest_range: Floats, size: Floats, rule: CycleRule) -> Floats:
    """Bound the damage of one record, by path range, by the ``power_integrals`` (2, ...) of its whole path as well.

    ``largest_range`` bounds the distance R of any two of its points [MPa].

    Raises
    ------
    ValueError : the damage contains f_M, for which nothing is proven
    """
    if rule.mean_stress:
        raise ValueError("the bound holds without f_M only")
    sums: PowerSums = {1: 0.5 * length, 3: 2.0 * integrals[0], 4: 4.0 * integrals[1]}
    with np.errstate(over="ignore", invalid="ignore"):
        raised = {q: (1.0 + ROUNDING) * power_sum for q, power_sum in sums.items()}
        bound = damage_bound((1.0 + ROUNDING) * largest_range, raised, size, rule)[0]
    return np.where(np.isnan(bound), np.inf, bound)


def _largest_factor(size: Floats, rule: CycleRule) -> Floats:
    """``c = size / I(0)``: I(r)^(1/m) is smallest in pure membrane; 1 on a curve in plain ranges."""
    return np.asarray(size / rule.ratio_factor(np.zeros(())))
