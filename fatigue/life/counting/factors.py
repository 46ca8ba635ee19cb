"""Damage of a pass under many factors on all stresses at once, from one count: what a load factor is found with.

Rainflow finds the same cycles at any scale of the stress. A cycle of the equivalent range x does the damage

    d(f x) = f^k x^k / A

at the factor f, with the slope k of the segment that f x lies on, and none below the cut-off. With mean stress x is
divided by f_M for all factors at which ``f (min + max) >= yield`` and ``f S <= 2 yield``: the offset is a stress and
scales as all do, so that R, and f_M or f(R) with it, does not depend on f. So every cycle has few stretches of
ascending factors, on each of which its damage is a constant times f^k. Each damage is that of the cycle itself; nothing
is sorted into classes.

Damage rises with the factor, but for cycles that leave f_M behind at twice the yield stress. These keep it for one
factor more. So the damage found at a factor is never below the damage anywhere between this factor and the one before.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.reversals import Buffers
from fatigue.life.counting.tally import (
    CompiledRule,
    Surface,
    bending_factor,
    factor_of_stress_ratio,
    stress_ratio_factor,
)

Floats = NDArray[np.float64]


class Trials(NamedTuple):
    """Factors ``first exp(i step)`` on all stresses of some points and their damage.

    ``first`` and ``step`` (n, 2) of top and bottom surface, 0: not wanted; ``damage`` (n, 2, g) at the g factors; for
    g = 0 the stresses are counted as they are.
    """

    first: Floats
    step: Floats
    damage: Floats


def trials(first: Floats, step: Floats, factors: int) -> Trials:
    """So many factors from ``first`` on (n, 2), nothing counted yet."""
    return Trials(np.ascontiguousarray(first), np.ascontiguousarray(step), np.zeros((*first.shape, factors)))


def no_trials(points: int) -> Trials:
    """None: for counting as the stresses are."""
    return trials(np.zeros((points, 2)), np.zeros((points, 2)), 0)


@compiled()
def first_at_least(x: float, factors: Floats, bound: float, begin: int) -> int:
    """Index of the first of some ascending factors, from ``begin`` on, at which ``factor x`` reaches a bound."""
    low, high = begin, factors.size
    if low < high and x * factors[low] >= bound:
        return low
    if low < high and x * factors[high - 1] < bound:
        return high
    while low < high:
        middle = (low + high) // 2
        if x * factors[middle] >= bound:
            high = middle
        else:
            low = middle + 1
    return low


@compiled()
def add_stretch(
    n: float,
    x: float,
    stretch: tuple[int, int],
    factors: Floats,
    powers: Floats,
    rule: CompiledRule,
    damage: Floats,
    whole: Floats,
) -> None:
    """Add n cycles of the equivalent range x under a stretch of the factors.

    ``whole`` (s,) sums up, for each segment, cycles that stay on it under all factors: most of them.
    """
    at, end = max(stretch[0], first_at_least(x, factors, rule.cutoff, stretch[0])), stretch[1]
    last = rule.slopes.size - 1
    for j in range(last, -1, -1):
        leaves = end if j == 0 else min(end, first_at_least(x, factors, rule.knees[j - 1], at))
        if at < leaves:
            of_one = n * math.exp(rule.slopes[j] * math.log(x) - rule.log_constants[j])
            if leaves - at == factors.size:
                whole[j] += of_one
            else:
                for i in range(at, leaves):
                    damage[i] += of_one * powers[j, i]
            at = leaves


@compiled()
def tally_trials(
    point: Surface, first: float, step: float, damage: Floats, rule: CompiledRule, buffers: Buffers, cycles: int
) -> None:
    """Add cycles of one point and surface to its damage under each factor; see ``tally`` for the formulas."""
    if first == 0.0:
        return
    membrane, bending, side = point.membrane, point.bending, point.side
    every = damage.size
    factors, powers = np.empty(every), np.empty((rule.slopes.size, every))  # over ``first``, which is in the stresses
    for i in range(every):
        factors[i] = math.exp(i * step)
        for j in range(rule.slopes.size):
            powers[j, i] = math.exp(rule.slopes[j] * i * step)
    whole = np.zeros(rule.slopes.size)
    for c in range(cycles):
        i, j, n = buffers.start[c], buffers.end[c], buffers.weight[c]
        s_i, s_j = first * (membrane[i] + side * bending[i]), first * (membrane[j] + side * bending[j])
        S = max(s_i, s_j) - min(s_i, s_j)
        minimum, maximum = min(s_i, s_j) + first * point.offset, max(s_i, s_j) + first * point.offset
        if S == 0.0:
            continue
        dm, db = abs(membrane[j] - membrane[i]), abs(bending[j] - bending[i])
        x = S * point.size / bending_factor(db / (dm + db), rule.uses_bending_ratio, rule.allows_for_bending)
        if rule.ratio_level > 0.0:
            x /= stress_ratio_factor(minimum, maximum, rule.ratio_level)
        begins = ends = every
        if rule.mean_stress and minimum > 0.0:
            begins = first_at_least(minimum + maximum, factors, rule.yield_MPa, 0)
            ends = first_at_least(S, factors, np.nextafter(2.0 * rule.yield_MPa, math.inf), 0)
            ends = min(ends + 1, every) if ends > 0 else 0
        if begins >= ends:
            add_stretch(n, x, (0, every), factors, powers, rule, damage, whole)
            continue
        f_M = factor_of_stress_ratio(minimum / maximum)
        add_stretch(n, x, (0, begins), factors, powers, rule, damage, whole)
        add_stretch(n, x / f_M, (begins, ends), factors, powers, rule, damage, whole)
        add_stretch(n, x, (ends, every), factors, powers, rule, damage, whole)
    for j in range(rule.slopes.size):
        for i in range(every):
            damage[i] += whole[j] * powers[j, i]
