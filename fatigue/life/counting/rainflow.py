"""Rainflow counting of one signal, and of a block of structural stress histories down to their damage.

Each row goes through three plain loops: `turning_points` finds its reversals, `close_cycles` pairs them, `tally` reads
membrane and bending stress at the two instants of every cycle and sums the damage, all in float64 and with the exact
ranges. `count_block` is the seam for a faster kernel.
"""

import math
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fatigue.compiled import compiled
from fatigue.errors import CaseError, Problem
from fatigue.life.counting.signal import middle, not_finite, recurs, samples_of
from fatigue.life.curves import DamageLaw
from fatigue.life.damage import M_SS
from fatigue.life.records.history import Residue

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

BINS_PER_DECADE = 64
HISTOGRAM_EDGES: Floats = np.logspace(-3.0, 5.0, 8 * BINS_PER_DECADE + 1)
HISTOGRAM_BINS = HISTOGRAM_EDGES.size - 1
LANES, DEPTH = 8, 8  # sums side by side, and terms of each that are added up in one go


@dataclass(frozen=True, slots=True, eq=False)
class Cycles:
    """The rainflow cycles of one signal, in the order in which they close.

    Attributes
    ----------
    range, mean : (c,) in the unit of the signal
    count : (c,) 1.0 for a closed cycle, 0.5 for a half cycle
    start, end : (c,) sample indices of the two reversals, of a plateau the last sample; ``end < start``: the cycle runs
        across the end of the block
    """

    range: Floats
    mean: Floats
    count: Floats
    start: Indices
    end: Indices


@dataclass(frozen=True, slots=True, eq=False)
class BlockCount:
    """What is kept of the cycles of n points; every array is (n, 2): top surface, bottom surface.

    Attributes
    ----------
    damage : sum of n d(dS)
    damage_same_ratio : sum of n d(dS) with one bending ratio for all cycles of a point, without the mean-stress factor
    damage_mean_stress : sum of n d(dS) with the mean-stress factor; NaN without a yield stress
    cycles : sum of n
    power_sum : sum of n S**k of the structural stress ranges, k the first slope of the law [MPa**k]
    max_range : largest structural stress range [MPa]
    r_largest : stress ratio min/max of the largest cycle; NaN without a cycle or where max = 0
    max_equivalent_range : largest dS
    mean : mean of the structural stress samples [MPa]; NaN without samples
    kurtosis : fourth over squared second central moment of the samples, 3 if Gaussian; NaN of a constant row
    histogram : (n, 2, HISTOGRAM_BINS, 2) sum of n and sum of n dS**k between the `HISTOGRAM_EDGES` of dS, ranges beyond
        them in the end bins; (n, 2, 0, 2) for a straight law, where damage scales with load**k
    """

    damage: Floats
    damage_same_ratio: Floats
    damage_mean_stress: Floats
    cycles: Floats
    power_sum: Floats
    max_range: Floats
    r_largest: Floats
    max_equivalent_range: Floats
    mean: Floats
    kurtosis: Floats
    histogram: Floats


_SCALARS = tuple(field.name for field in fields(BlockCount) if field.name != "histogram")


class _Block(NamedTuple):
    """Stresses of a block and, per point and surface, what is counted: a record of `_SCALARS` and a histogram."""

    membrane: Floats
    bending: Floats
    size: Floats
    same_ratio: Floats
    totals: NDArray[np.void]
    histogram: Floats


class Rules(NamedTuple):
    """The `DamageLaw` and the choices of `count_block`, in a form compiled code can read."""

    slopes: Floats
    log_constants: Floats
    knees: Floats
    cutoff: float
    uses_bending_ratio: bool
    recurs: bool
    yield_stress: float
    mean_stress: bool


class Point(NamedTuple):
    """One surface of one point, ``side`` +1 or -1: its stresses (t,), and what is its own in the damage of a cycle."""

    membrane: Floats
    bending: Floats
    side: float
    size: float
    same_ratio: float


class Buffers(NamedTuple):
    """Work space for one signal."""

    path: Floats
    step: NDArray[np.int8]
    reversal: Indices
    start: Indices
    end: Indices
    weight: Floats


def rainflow(signal: ArrayLike, residue: Residue) -> Cycles:
    """Count the rainflow cycles of a signal (t,), an array, list or series of whole or real numbers.

    ``half`` counts what does not close as half cycles (ASTM E1049-85, 5.4.4). ``repeat`` takes the signal as a block
    that recurs for ever: every cycle closes (ASTM E1049-85, 5.4.5; the doubled residue of ISO 12110-2). A signal that
    never changes has no cycles.

    Raises
    ------
    CaseError : another residue
    DataError : not one-dimensional, or no numbers; NumericalError : a sample is not finite, or their range overflows
    """
    block, s = recurs(residue), samples_of(signal)
    buffers = buffers_for(s.size)
    cycles = find_cycles(s, block, buffers)
    start, end = buffers.start[:cycles], buffers.end[:cycles]
    return Cycles(np.abs(s[end] - s[start]), middle(s[start], s[end]), buffers.weight[:cycles], start, end)


def count_block(
    membrane: Floats,
    bending: Floats,
    size: Floats,
    same_ratio: Floats,
    law: DamageLaw,
    *,
    uses_bending_ratio: bool,
    residue: Residue,
    yield_MPa: float | None,
    mean_stress: bool,
) -> BlockCount:
    """Count the top and bottom structural stress, membrane + bending and membrane - bending, and sum the damage.

    A cycle of structural stress range S has dS = S * size / (I(r)^(1/m) f_M); its bending ratio r = db / (dm + db)
    comes from the membrane and bending ranges between its own two instants. No row depends on another.

    Parameters
    ----------
    membrane, bending : (n, t) membrane stress, and bending stress of the top surface [MPa]
    size : (n,) factor of the thickness on the range
    same_ratio : (n, 2) the one bending ratio of `BlockCount.damage_same_ratio`
    law : damage of a cycle by its dS
    uses_bending_ratio : False for a law in plain ranges, where I(r)^(1/m) is 1
    residue : as in `rainflow`
    yield_MPa : yield stress for f_M [MPa]; None: f_M is 1
    mean_stress : whether dS contains f_M

    Raises
    ------
    NumericalError : a sample is not finite; CaseError : ``mean_stress`` without a yield stress
    """
    rules = rules_of(law, uses_bending_ratio, residue, yield_MPa, mean_stress)
    refuse_not_finite(membrane, bending)
    totals, histogram = nothing_counted(len(membrane), law)
    count_rows(
        _Block(plain(membrane), plain(bending), plain(size), plain(same_ratio), totals, histogram),
        rules,
        buffers_for(membrane.shape[1]),
    )
    return block_count(totals, histogram, rules)


def rules_of(
    law: DamageLaw, uses_bending_ratio: bool, residue: Residue, yield_MPa: float | None, mean_stress: bool
) -> Rules:
    """Put a law and the choices of `count_block` into the form for compiled code."""
    if mean_stress and yield_MPa is None:
        raise CaseError(Problem("yield", "mean stress", "f_M needs the yield stress, none is given", "Give yield_MPa"))
    yield_stress = math.inf if yield_MPa is None else float(yield_MPa)
    curve = (plain(law.slopes), plain(law.log_constants), plain(law.knees), float(law.cutoff))
    return Rules(*curve, uses_bending_ratio, residue == "repeat", yield_stress, mean_stress)


def nothing_counted(points: int, law: DamageLaw) -> tuple[NDArray[np.void], Floats]:
    """Totals and histogram of a block before its first cycle."""
    totals = np.zeros((points, 2), dtype=[(name, np.float64) for name in _SCALARS])
    return totals, np.zeros((points, 2, 0 if law.is_straight else HISTOGRAM_BINS, 2))


def block_count(totals: NDArray[np.void], histogram: Floats, rules: Rules) -> BlockCount:
    """Give the totals of a block their names."""
    if rules.yield_stress == math.inf:
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


def buffers_for(samples: int) -> Buffers:
    """Room for the reversals of a signal whose first sample is repeated at its end."""
    reversal, start, end = (np.empty(samples + 2, np.intp) for _ in range(3))
    path, weight = np.empty(samples + 1), np.empty(samples + 1)
    return Buffers(path, np.empty(samples + 1, np.int8), reversal, start, end, weight)


@compiled()
def unroll(s: Floats, path: Floats) -> int:
    """Write a recurring block (t,) into ``path`` (t + 1,) from its largest sample to the next time it occurs.

    In between every cycle closes. Of a plateau, also one across the end of the block, the last sample is taken, as at
    every reversal. Returns the index of that sample.
    """
    t = s.size
    first = 0
    for i in range(1, t):
        first = i if s[i] > s[first] else first
    for _ in range(t):
        following = (first + 1) % t
        if s[following] != s[first]:
            break
        first = following
    path[: t - first] = s[first:]
    path[t - first : t] = s[:first]
    path[t] = s[first]
    return first


@compiled()
def turning_points(s: Floats, step: NDArray[np.int8], reversal: Indices) -> int:
    """Write the sample indices of the reversals of s (t,) into ``reversal`` (t + 1,) and return how many there are.

    The first and the last sample are reversals; a plateau turns at its last sample; a constant signal has none.
    """
    for i in range(1, s.size):
        step[i] = int(s[i] > s[i - 1]) - int(s[i] < s[i - 1])
    reversal[0] = 0
    n = 1
    direction = 0
    for i in range(1, s.size):
        reversal[n] = i - 1
        n += int(step[i] * direction < 0)  # adding 0 or 1 is cheaper than a branch nobody can predict
        direction = step[i] if step[i] != 0 else direction
    reversal[n] = s.size - 1
    return n + 1 if direction != 0 else 0


@compiled()
def close_cycles(s: Floats, reversals: int, recurs: bool, buffers: Buffers) -> int:
    """Pair the reversals into cycles, in the order in which they close, and return how many (ASTM E1049-85, 5.4.4).

    The latest range X closes the range Y before it if X >= Y. A Y that contains the starting point is a half cycle,
    unless the block recurs; what is left at the end is half cycles. The open reversals are a stack at the front of
    ``reversal``.
    """
    reversal, start, end, weight = buffers.reversal, buffers.start, buffers.end, buffers.weight
    cycles = 0
    base = 0
    top = -1
    for k in range(reversals):
        top += 1
        reversal[top] = reversal[k]
        while top - base >= 2:
            X = abs(s[reversal[top]] - s[reversal[top - 1]])
            Y = abs(s[reversal[top - 1]] - s[reversal[top - 2]])
            if X < Y:
                break
            start[cycles], end[cycles] = reversal[top - 2], reversal[top - 1]
            if top - base == 2 and not recurs:
                weight[cycles] = 0.5
                base += 1
            else:
                weight[cycles] = 1.0
                reversal[top - 2] = reversal[top]
                top -= 2
            cycles += 1
    for k in range(base, top):
        start[cycles], end[cycles], weight[cycles] = reversal[k], reversal[k + 1], 0.5
        cycles += 1
    return cycles


@compiled()
def find_cycles(s: Floats, recurs: bool, buffers: Buffers) -> int:
    """Write the cycles of s into ``start``, ``end`` and ``weight`` of the buffers and return how many there are."""
    if not recurs or s.size == 0:
        return close_cycles(s, turning_points(s, buffers.step, buffers.reversal), False, buffers)
    path = buffers.path
    first = unroll(s, path)
    cycles = close_cycles(path, turning_points(path, buffers.step, buffers.reversal), True, buffers)
    for c in range(cycles):
        buffers.start[c] = (buffers.start[c] + first) % s.size
        buffers.end[c] = (buffers.end[c] + first) % s.size
    return cycles


@compiled()
def mean_and_kurtosis(s: Floats) -> tuple[float, float]:
    """Mean and Pearson's kurtosis; deviations from the first sample keep a constant signal exactly constant."""
    if s.size == 0:
        return math.nan, math.nan
    sums = np.empty((3, LANES))
    offset, _, _ = sums_of_powers(s, s[0], sums)
    mean = s[0] + offset / s.size
    _, m2, m4 = sums_of_powers(s, mean, sums)
    return mean, m4 * s.size / (m2 * m2) if m2 * m2 > 0.0 else math.nan


@compiled()
def sums_of_powers(s: Floats, origin: float, sums: Floats) -> tuple[float, float, float]:
    """Sum x, x^2 and x^4 of x = s - origin; ``sums`` (3, LANES) is work space.

    The order of the sums is written out, lane by lane: left to the compiler, it is another one in the process that
    compiles than in those that read the compiled code from disk.
    """
    sums[:] = 0.0
    whole = s.size - s.size % (LANES * DEPTH)
    for first in range(0, whole, LANES * DEPTH):
        for lane in range(LANES):
            first_power = second_power = fourth_power = 0.0
            for row in range(DEPTH):
                x = s[first + LANES * row + lane] - origin
                first_power += x
                second_power += x * x
                fourth_power += (x * x) * (x * x)
            sums[0, lane] += first_power
            sums[1, lane] += second_power
            sums[2, lane] += fourth_power
    for i in range(whole, s.size):
        x = s[i] - origin
        sums[0, 0] += x
        sums[1, 0] += x * x
        sums[2, 0] += (x * x) * (x * x)
    first_power = second_power = fourth_power = 0.0
    for lane in range(LANES):
        first_power += sums[0, lane]
        second_power += sums[1, lane]
        fourth_power += sums[2, lane]
    return first_power, second_power, fourth_power


@compiled()
def ratio_factor(r: float) -> float:
    """I(r)^(1/m) of a bending ratio, load controlled (ASME VIII-2 5.5.5.2)."""
    return (1.23 - 0.364 * r - 0.17 * r**2) / (1.007 - 0.306 * r - 0.178 * r**2)


@compiled()
def mean_stress_factor(minimum: float, maximum: float, yield_stress: float) -> float:
    """f_M = (1 - R)^(1/m) of a cycle in high mean tension, else 1 (ASME VIII-2 5.5.5.2)."""
    if minimum > 0.0 and minimum + maximum >= yield_stress and maximum - minimum <= 2.0 * yield_stress:
        return math.pow(1.0 - minimum / maximum, 1.0 / M_SS)
    return 1.0


@compiled()
def cycle_damage(x: float, rules: Rules) -> float:
    """Damage d(x) of one cycle of the equivalent range x."""
    if x < rules.cutoff or x == 0.0:
        return 0.0
    j = 0
    while j < rules.knees.size and x < rules.knees[j]:
        j += 1
    return math.exp(rules.slopes[j] * math.log(x) - rules.log_constants[j])


@compiled()
def tally(
    point: Point, total: NDArray[np.void], histogram: Floats, rules: Rules, buffers: Buffers, cycles: int
) -> None:
    """Add cycles of one point and surface to its totals and its histogram."""
    membrane, bending, side, size = point.membrane, point.bending, point.side, point.size
    k = rules.slopes[0]
    same_scale = size / (ratio_factor(point.same_ratio) if rules.uses_bending_ratio else 1.0)
    for c in range(cycles):
        i, j, n = buffers.start[c], buffers.end[c], buffers.weight[c]
        s_i, s_j = membrane[i] + side * bending[i], membrane[j] + side * bending[j]
        minimum, maximum = min(s_i, s_j), max(s_i, s_j)
        S = maximum - minimum
        dm, db = abs(membrane[j] - membrane[i]), abs(bending[j] - bending[i])
        x = S * size / (ratio_factor(db / (dm + db)) if rules.uses_bending_ratio else 1.0)
        f_M = mean_stress_factor(minimum, maximum, rules.yield_stress)
        dS = x / f_M if rules.mean_stress else x
        damage = cycle_damage(dS, rules)
        total["damage"] += n * damage
        total["damage_mean_stress"] += n * (damage if f_M == 1.0 else cycle_damage(x / f_M, rules))
        total["cycles"] += n
        total["power_sum"] += n * math.exp(k * math.log(S))  # faster than pow
        total["max_equivalent_range"] = max(total["max_equivalent_range"], dS)
        if total["max_range"] < S:
            total["max_range"] = S
            total["r_largest"] = minimum / maximum if maximum != 0.0 else math.nan
        if histogram.shape[0] > 0:
            total["damage_same_ratio"] += n * cycle_damage(S * same_scale, rules)
            decades = math.log10(max(dS, 1e-3)) + 3.0
            bin_ = min(int(decades * BINS_PER_DECADE), HISTOGRAM_BINS - 1)
            histogram[bin_, 0] += n
            histogram[bin_, 1] += n * math.exp(k * math.log(dS))
    if histogram.shape[0] == 0:  # d(a S) = d(a) S**k of a straight law
        total["damage_same_ratio"] = cycle_damage(same_scale, rules) * total["power_sum"]


@compiled()
def count_rows(block: _Block, rules: Rules, buffers: Buffers) -> None:
    """Count both surfaces of every row of the block."""
    s = np.empty(block.membrane.shape[1])
    for row in range(block.membrane.shape[0]):
        for surface in range(2):
            side = 1.0 - 2.0 * surface
            for i in range(s.size):
                s[i] = block.membrane[row, i] + side * block.bending[row, i]
            total, histogram = block.totals[row, surface], block.histogram[row, surface]
            total["mean"], total["kurtosis"] = mean_and_kurtosis(s)
            total["r_largest"] = math.nan
            same_ratio = block.same_ratio[row, surface]
            point = Point(block.membrane[row], block.bending[row], side, block.size[row], same_ratio)
            tally(point, total, histogram, rules, buffers, find_cycles(s, rules.recurs, buffers))
