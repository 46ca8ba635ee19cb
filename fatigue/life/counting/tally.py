"""What is kept of cycles: their damage and what goes with it, summed up for one surface of one point."""

import math
from dataclasses import fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled, inlined
from fatigue.life import allowances
from fatigue.life import rule as master
from fatigue.life.counting.block import BINS_PER_DECADE, HISTOGRAM_BINS, BlockCount, BlockStress
from fatigue.life.counting.reversals import Buffers
from fatigue.life.counting.signal import not_finite
from fatigue.life.curves import DamageLaw
from fatigue.life.rule import CycleRule

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_SCALARS = tuple(field.name for field in fields(BlockCount) if field.name != "histogram")


class CompiledRule(NamedTuple):
    """A ``CycleRule`` in a form that compiled code can read, its law among it: see ``compiled_rule``.

    ``ratio_level`` is the level of f(R), 0 without it.
    """

    slopes: Floats
    log_constants: Floats
    knees: Floats
    cutoff: float
    uses_bending_ratio: bool
    yield_MPa: float  # noqa: N815
    mean_stress: bool
    allows_for_bending: bool
    ratio_level: float


class Surface(NamedTuple):
    """One surface of one point, ``side`` +1 or -1: its stresses (t,), and what is its own in the damage of a cycle."""

    membrane: Floats
    bending: Floats
    side: float
    size: float
    same_ratio: float
    shear_factor: float
    offset: float


def compiled_rule(rule: CycleRule) -> CompiledRule:
    """Put a rule into the form for compiled code; without a yield stress it is infinite, so that f_M is 1."""
    law, yield_MPa = rule.law, math.inf if rule.yield_MPa is None else float(rule.yield_MPa)
    curve = (plain(law.slopes), plain(law.log_constants), plain(law.knees), float(law.cutoff))
    allowed = rule.bending_factor != "none", allowances.RATIO_LEVELS.get(rule.stress_ratio, 0.0)
    return CompiledRule(*curve, rule.uses_bending_ratio, yield_MPa, rule.mean_stress, *allowed)


def nothing_counted(
    points: int, law: DamageLaw, *, surfaces: int = 2, ranges: bool = False
) -> tuple[NDArray[np.void], Floats]:
    """Totals and histogram of a block before its first cycle; with ``ranges`` any law has bins of dS, and of S too.

    With ``ranges`` the damage with shear and that with one bending ratio are left out. One of the ``surfaces`` is the
    top.
    """
    totals = np.zeros((points, surfaces), dtype=[(name, np.float64) for name in _SCALARS])
    bins = 2 * HISTOGRAM_BINS if ranges else 0 if law.is_straight else HISTOGRAM_BINS
    return totals, np.zeros((points, surfaces, bins, 2))


def own_of(stress: BlockStress) -> tuple[Floats, Floats]:
    """Shear factor, 1 where none is wanted, and offset [MPa] of each point and surface, (n, 2) each."""
    factor = np.ones((len(stress), 2)) if stress.shear_factor is None else stress.shear_factor
    return plain(factor), plain(stress.level)


def no_pieces(points: int) -> Floats:
    """Damage of a block in no piece of time: not wanted."""
    return np.zeros((points, 2, 0))


def block_count(totals: NDArray[np.void], histogram: Floats, rule: CycleRule, offset: Floats) -> BlockCount:
    """Give the totals of a block their names; the mean of its samples gets the ``offset`` (n, 2)."""
    totals["mean"] += offset
    if rule.yield_MPa is None:
        totals["damage_mean_stress"] = np.nan
    return BlockCount(**{name: totals[name].copy() for name in _SCALARS}, histogram=histogram)


def refuse_not_finite(membrane: Floats, bending: Floats) -> None:
    """Refuse a block with a row in which a sample is NaN or infinite."""
    with np.errstate(invalid="ignore", over="ignore"):
        row_sum = membrane.sum(axis=1) + bending.sum(axis=1)
    if not np.isfinite(row_sum).all():
        raise not_finite(f"row {np.flatnonzero(~np.isfinite(row_sum))[0]} of the block")


def plain(array: Floats) -> Floats:
    """Float64, contiguous and writable, so that one compiled version serves all callers."""
    return np.require(array, np.float64, ["C", "W"])


# The formulas as they are written down, for one cycle.
ratio_factor = compiled()(master.ratio_factor)
has_mean_stress = compiled()(master.has_mean_stress)
factor_of_stress_ratio = compiled()(master.factor_of_stress_ratio)
equivalent_range = compiled()(master.equivalent_range)
segment = inlined(master.segment)
damage_on_segment = compiled()(master.damage_on_segment)
bending_allowance = compiled()(allowances.bending_allowance)
stress_ratio_factor = compiled()(allowances.stress_ratio_factor)


@compiled()
def bending_factor(r: float, uses_bending_ratio: bool, allows_for_bending: bool) -> float:
    """What the bending ratio of a cycle divides its range by: I(r)^(1/m), the allowance of the curve, or 1."""
    if uses_bending_ratio:
        return float(ratio_factor(r))
    return float(bending_allowance(r)) if allows_for_bending else 1.0


@compiled()
def mean_stress_factor(minimum: float, maximum: float, yield_MPa: float) -> float:
    """f_M of a cycle between two stresses, 1 where it does not apply."""
    if has_mean_stress(minimum, maximum, yield_MPa):
        return float(factor_of_stress_ratio(minimum / maximum))
    return 1.0


@compiled()
def cycle_damage(x: float, rule: CompiledRule) -> float:
    """Damage d = 1 / N of one cycle of the equivalent range x, 0 below the cut-off."""
    if x < rule.cutoff or x == 0.0:
        return 0.0
    j = segment(x, rule.knees)
    return float(damage_on_segment(x, rule.slopes[j], rule.log_constants[j]))


@compiled()
def add_to_bin(n: float, x: float, power: float, histogram: Floats) -> None:
    """Add n cycles of the range x to sum n and sum n x^k of its bin; ``power`` is x^k."""
    decades = math.log10(max(x, 1e-3)) + 3.0
    bin_ = min(int(decades * BINS_PER_DECADE), HISTOGRAM_BINS - 1)
    histogram[bin_, 0] += n
    histogram[bin_, 1] += n * power


@compiled()
def tally(
    point: Surface, total: NDArray[np.void], histogram: Floats, rule: CompiledRule, buffers: Buffers, cycles: int
) -> None:
    """Add cycles of one point and surface to its totals and its histogram: ``sum n d(dS)``, ``sum n S^k`` and the rest.

    A cycle between the instants i and j has the range ``S = |ds|``, ``r = |db| / (|dm| + |db|)`` (Eq. 7) and
    ``dS = S size / (I(r)^(1/m) f_M)`` (Eq. 8), with the allowances of the curve in the places of I and f_M where it has
    some; the damage is their Miner sum (Eq. 12). The range is that of the samples to the last bit, whatever the offset.
    """
    membrane, bending, side, size = point.membrane, point.bending, point.side, point.size
    k = rule.slopes[0]
    I_same = bending_factor(point.same_ratio, rule.uses_bending_ratio, rule.allows_for_bending)
    same_scale = equivalent_range(1.0, size, I_same, 1.0)
    for c in range(cycles):
        i, j, n = buffers.start[c], buffers.end[c], buffers.weight[c]
        s_i, s_j = membrane[i] + side * bending[i], membrane[j] + side * bending[j]
        S = max(s_i, s_j) - min(s_i, s_j)
        minimum, maximum = min(s_i, s_j) + point.offset, max(s_i, s_j) + point.offset
        dm, db = abs(membrane[j] - membrane[i]), abs(bending[j] - bending[i])
        bends = rule.uses_bending_ratio, rule.allows_for_bending
        I = bending_factor(db / (dm + db), bends[0], bends[1])  # noqa: E741 - the symbol of the standard
        f_R = stress_ratio_factor(minimum, maximum, rule.ratio_level) if rule.ratio_level > 0.0 else 1.0
        x = equivalent_range(S, size, I, f_R)
        f_M = mean_stress_factor(minimum, maximum, rule.yield_MPa)
        dS = x / f_M if rule.mean_stress else x
        damage = cycle_damage(dS, rule)
        buffers.damage[c] = n * damage
        total["damage"] += n * damage
        total["damage_mean_stress"] += n * (damage if f_M == 1.0 else cycle_damage(x / f_M, rule))
        total["cycles"] += n
        power = math.exp(k * math.log(S))  # faster than pow
        total["power_sum"] += n * power
        total["max_equivalent_range"] = max(total["max_equivalent_range"], dS)
        if total["max_range"] < S:
            total["max_range"] = S
            total["r_largest"] = minimum / maximum if maximum != 0.0 else math.nan
        if histogram.shape[0] > 0:
            add_to_bin(n, dS, math.exp(k * math.log(dS)), histogram[:HISTOGRAM_BINS])
        if histogram.shape[0] == HISTOGRAM_BINS:
            total["damage_same_ratio"] += n * cycle_damage(S * same_scale, rule)
            total["damage_with_shear"] += n * cycle_damage(dS * point.shear_factor, rule)
        elif histogram.shape[0] > HISTOGRAM_BINS:  # of points that have been counted before: only their ranges are new
            add_to_bin(n, S, power, histogram[HISTOGRAM_BINS:])
    if histogram.shape[0] == 0:  # d(a S) = d(a) S**k of a straight law
        total["damage_same_ratio"] = cycle_damage(same_scale, rule) * total["power_sum"]


@compiled()
def lay_halves(start: Indices, end: Indices, damage: Floats, cycles: int, samples: int, laid: Floats) -> None:
    """Add half of the damage of each cycle to the bin of either instant, of the equal bins of a record of ``samples``.

    So the bins add up to the damage, that of cycles from one to another and across the end of the record included.
    """
    for c in range(cycles):
        half = 0.5 * damage[c]
        laid[start[c] * laid.size // samples] += half
        laid[end[c] * laid.size // samples] += half
