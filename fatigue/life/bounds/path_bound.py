"""A bound of the damage that any path of normal and shear stress does by the ranges of its half cycles.

With c the largest factor from a distance R in the plane of ``(normal, sqrt(beta) shear)`` to the equivalent range,

    x_k <= c R_k <= c L_k,    sum over k of L_k = Lambda,    x_k <= xh = c sqrt(D(s)^2 + beta D(tau)^2),

L_k the length of the path that belongs to half cycle k, Lambda that of the whole path (closed where it recurs), D the
range of a stress over the record. d(x) / x never falls on a curve with slopes of 1 and more, whatever its knees or
cut-off, so

    sum 0.5 d(x_k) <= 0.5 c Lambda d(xh) / xh.

It holds for the path range alone: not for path length or moment, and not where the damage contains f_M.
"""

import numpy as np
from numpy.typing import NDArray

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


def _largest_factor(size: Floats, rule: CycleRule) -> Floats:
    """``c = size / I(0)``: I(r)^(1/m) is smallest in pure membrane; 1 on a curve in plain ranges."""
    return np.asarray(size / rule.ratio_factor(np.zeros(())))
