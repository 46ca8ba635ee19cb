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
from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.tally import SurfaceCycles, cycle_stress, plain
from fatigue.life.rule import CycleRule, factor_of_stress_ratio

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


class Trials(NamedTuple):
    """Factors ``first exp(i step)`` on all stresses of some points and their damage.

    ``first`` and ``step`` (n, 2) of top and bottom surface, 0: not wanted; ``damage`` (n, 2, g) at the g factors.
    """

    first: Floats
    step: Floats
    damage: Floats

    def at(self, some: slice) -> "Trials":
        """Take some points."""
        return Trials(self.first[some], self.step[some], self.damage[some])


def trials(first: Floats, step: Floats, factors: int) -> Trials:
    """So many factors from ``first`` on (n, 2), nothing counted yet."""
    return Trials(np.ascontiguousarray(first), np.ascontiguousarray(step), np.zeros((*first.shape, factors)))


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


def add_trials(cycles: SurfaceCycles, stress: BlockStress, rule: CycleRule, tried: Trials) -> None:
    """Add cycles to the damage of their points, of which ``stress`` and ``tried`` are, under each factor."""
    first = tried.first.reshape(-1)[cycles.surface]
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):  # of ranges that are 0, or infinite
        of = cycle_stress(cycles, stress, rule, first)
        f_M = factor_of_stress_ratio(np.where(of.minimum > 0.0, of.minimum / of.maximum, 0.0))
    surfaces, factors = tried.damage.shape[0] * 2, tried.damage.shape[2]
    begin = np.searchsorted(cycles.surface, np.arange(surfaces + 1))
    limit = float(rule.yield_MPa) if rule.mean_stress and rule.yield_MPa is not None else math.inf
    law = rule.law
    curve = plain(law.slopes), plain(law.log_constants), plain(law.knees), float(law.cutoff)
    work = np.empty(factors), np.empty((len(law.slopes), factors)), np.empty(len(law.slopes))
    step, damage = tried.step.reshape(-1), tried.damage.reshape(surfaces, factors)
    sizes = cycles.weight, of.range, of.minimum, of.maximum, of.equivalent, f_M
    tally_trials(begin, sizes, step, limit, *curve, *work, damage)


@compiled()
def add_stretch(
    n: float,
    x: float,
    begin: int,
    end: int,
    factors: Floats,
    powers: Floats,
    slopes: Floats,
    log_constants: Floats,
    knees: Floats,
    cutoff: float,
    damage: Floats,
    whole: Floats,
) -> None:
    """Add n cycles of the equivalent range x under a stretch of the factors.

    ``whole`` (s,) sums up, for each segment, cycles that stay on it under all factors: most of them.
    """
    at = max(begin, first_at_least(x, factors, cutoff, begin))
    for j in range(slopes.size - 1, -1, -1):
        leaves = end if j == 0 else min(end, first_at_least(x, factors, knees[j - 1], at))
        if at < leaves:
            of_one = n * math.exp(slopes[j] * math.log(x) - log_constants[j])
            if leaves - at == factors.size:
                whole[j] += of_one
            else:
                for i in range(at, leaves):
                    damage[i] += of_one * powers[j, i]
            at = leaves


@compiled()
def tally_trials(
    begin: Indices,
    sizes: tuple[Floats, ...],
    step: Floats,
    yield_MPa: float,
    slopes: Floats,
    log_constants: Floats,
    knees: Floats,
    cutoff: float,
    factors: Floats,
    powers: Floats,
    whole: Floats,
    damage: Floats,
) -> None:
    """Add cycles to the damage (s, g) of each surface under the factors; see ``tally`` for the formulas.

    Those of a surface lie between ``begin`` (s + 1,); ``sizes`` are weight, range, least and largest stress, equivalent
    range and f_M of each. ``factors``, ``powers`` and ``whole`` are work space.
    """
    weight, S, minimum, maximum, equivalent, f_M = sizes
    every = damage.shape[1]
    for surface in range(begin.size - 1):
        if begin[surface] == begin[surface + 1]:
            continue
        for i in range(every):  # over the first factor, which is in the stresses
            factors[i] = math.exp(i * step[surface])
            for j in range(slopes.size):
                powers[j, i] = math.exp(slopes[j] * i * step[surface])
        for j in range(slopes.size):
            whole[j] = 0.0
        for c in range(begin[surface], begin[surface + 1]):
            n, x = weight[c], equivalent[c]
            if S[c] == 0.0:
                continue
            begins = ends = every
            if minimum[c] > 0.0 and yield_MPa < math.inf:
                begins = first_at_least(minimum[c] + maximum[c], factors, yield_MPa, 0)
                ends = first_at_least(S[c], factors, np.nextafter(2.0 * yield_MPa, math.inf), 0)
                ends = min(ends + 1, every) if ends > 0 else 0
            curve = factors, powers, slopes, log_constants, knees, cutoff, damage[surface], whole
            if begins >= ends:
                begins = ends = every
            add_stretch(n, x, 0, begins, *curve)
            add_stretch(n, x / f_M[c], begins, ends, *curve)
            add_stretch(n, x, ends, every, *curve)
        for j in range(slopes.size):
            for i in range(every):
                damage[surface, i] += whole[j] * powers[j, i]
