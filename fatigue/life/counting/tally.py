"""What is kept of cycles: their damage and what goes with it, summed up for each surface of some points."""

import math
from dataclasses import fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BINS_PER_DECADE, HISTOGRAM_BINS, BlockCount, BlockStress
from fatigue.life.counting.signal import not_finite
from fatigue.life.curves import DamageLaw
from fatigue.life.rule import CycleRule, bending_ratio, cycle_damage, equivalent_range, mean_stress_factor

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_SCALARS = tuple(field.name for field in fields(BlockCount) if field.name != "histogram")


class SurfaceCycles(NamedTuple):
    """Cycles of surfaces of some points, those of one surface side by side, in the order in which they close.

    Attributes
    ----------
    surface : (c,) twice the number of the point, and one more for its bottom surface; it does not fall
    membrane, bending : (2, c) membrane stress, and bending stress of the top surface, at start and end [MPa]
    weight : (c,) 1 or 0.5
    at : (2, c) samples of the start and the end
    """

    surface: Indices
    membrane: Floats
    bending: Floats
    weight: Floats
    at: Indices


class CycleStress(NamedTuple):
    """Stresses of c cycles: their range, and their least and largest stress with the offset, (c,) [MPa].

    ``equivalent`` (c,) is the equivalent range before f_M, ``f_M`` (c,) what it is to be divided by.
    """

    range: Floats
    minimum: Floats
    maximum: Floats
    equivalent: Floats
    f_M: Floats  # noqa: N815


class Counted(NamedTuple):
    """What is summed up of the cycles of n points.

    ``totals`` (n, 2) and ``histogram`` (n, 2, b, 2) are those of ``nothing_counted``; ``pieces`` (n, 2, p) is the
    damage in each of p equal pieces of the record, p 0 where it is not wanted.
    """

    totals: NDArray[np.void]
    histogram: Floats
    pieces: Floats

    def at(self, some: slice) -> "Counted":
        """Take some points."""
        return Counted(self.totals[some], self.histogram[some], self.pieces[some])


def nothing_counted(points: int, law: DamageLaw, pieces: Floats | None = None) -> Counted:
    """Count of a block before its first cycle; with ``pieces`` any law has bins of dS, and of S too.

    With ``pieces`` the damage with shear and that with one bending ratio are left out: such points were counted before,
    and only their ranges are wanted.
    """
    totals = np.zeros((points, 2), dtype=[(name, np.float64) for name in _SCALARS])
    totals["r_largest"] = math.nan
    bins = 2 * HISTOGRAM_BINS if pieces is not None else 0 if law.is_straight else HISTOGRAM_BINS
    return Counted(totals, np.zeros((points, 2, bins, 2)), np.zeros((points, 2, 0)) if pieces is None else pieces)


def block_count(counted: Counted, rule: CycleRule, offset: Floats) -> BlockCount:
    """Give the totals of a block their names; the mean of its samples gets the ``offset`` (n, 2)."""
    totals = counted.totals
    totals["mean"] += offset
    if rule.yield_MPa is None:
        totals["damage_mean_stress"] = np.nan
    return BlockCount(**{name: totals[name].copy() for name in _SCALARS}, histogram=counted.histogram)


def refuse_not_finite(membrane: Floats, bending: Floats) -> None:
    """Refuse a block with a row in which a sample is NaN or infinite."""
    with np.errstate(invalid="ignore", over="ignore"):
        row_sum = membrane.sum(axis=1) + bending.sum(axis=1)
    if not np.isfinite(row_sum).all():
        raise not_finite(f"row {np.flatnonzero(~np.isfinite(row_sum))[0]} of the block")


def plain(array: Floats) -> Floats:
    """Float64, contiguous and writable, so that one compiled version serves all callers."""
    return np.require(array, np.float64, ["C", "W"])


def cycle_stress(
    cycles: SurfaceCycles, stress: BlockStress, rule: CycleRule, scale: Floats | float = 1.0
) -> CycleStress:
    """Stresses of cycles: ``S = |ds|``, ``r = |db| / (|dm| + |db|)`` (Eq. 7), ``S size / I(r)^(1/m)`` and f_M (Eq. 8).

    The allowances of the curve stand in the places of I and f_M where it has some. ``scale`` (c,) is on all stresses,
    offset included.
    """
    point, face = cycles.surface // 2, cycles.surface % 2
    side, offset = 1.0 - 2.0 * face, scale * stress.level[point, face]
    start, end = scale * (cycles.membrane + side * cycles.bending)
    low, high = np.minimum(start, end), np.maximum(start, end)
    S, minimum, maximum = high - low, low + offset, high + offset  # the range is that of the samples to the last bit
    dm, db = np.diff(cycles.membrane, axis=0)[0], np.diff(cycles.bending, axis=0)[0]
    I = rule.ratio_factor(bending_ratio(dm, db))  # noqa: E741 - the symbol of the standard
    f_R = rule.mean_stress_factor(minimum, maximum) if rule.stress_ratio != "none" else 1.0
    f_M = np.ones_like(S) if rule.yield_MPa is None else mean_stress_factor(minimum, maximum, rule.yield_MPa)
    return CycleStress(S, minimum, maximum, equivalent_range(S, stress.size[point], I, f_R), f_M)


def tally(cycles: SurfaceCycles, stress: BlockStress, rule: CycleRule, counted: Counted, samples: int) -> None:
    """Add cycles to what is counted of their points: ``sum n d(dS)`` (Eq. 12), ``sum n S^k`` and the rest.

    ``stress`` and ``counted`` are of the same points; ``samples`` are those of the record.
    """
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):  # of ranges that are 0, or infinite
        _tally(cycles, stress, rule, counted, samples)


def _tally(cycles: SurfaceCycles, stress: BlockStress, rule: CycleRule, counted: Counted, samples: int) -> None:
    of, n, k, law = cycle_stress(cycles, stress, rule), cycles.weight, rule.law.slopes[0], rule.law
    dS = of.equivalent / of.f_M if rule.mean_stress else of.equivalent
    damage = cycle_damage(dS, law)
    without = rule.yield_MPa is None or rule.mean_stress
    with_f_M = damage if without else cycle_damage(of.equivalent / of.f_M, law)
    total = counted.totals.reshape(-1)
    added = {
        "damage": n * damage,
        "damage_mean_stress": n * with_f_M,
        "cycles": n,
        "power_sum": n * np.exp(k * np.log(of.range)),
    }
    I_same = rule.ratio_factor(stress.same_ratio)
    same_scale = equivalent_range(1.0, stress.size[:, None], I_same, 1.0).reshape(-1)
    bins = counted.histogram.shape[2]
    if bins == HISTOGRAM_BINS:
        shear = 1.0 if stress.shear_factor is None else stress.shear_factor.reshape(-1)[cycles.surface]
        added["damage_same_ratio"] = n * cycle_damage(of.range * same_scale[cycles.surface], law)
        added["damage_with_shear"] = n * cycle_damage(dS * shear, law)
    if bins:
        _add_to_bins(cycles, dS, n * np.exp(k * np.log(dS)), counted.histogram, 0)
    if bins > HISTOGRAM_BINS:
        _add_to_bins(cycles, of.range, added["power_sum"], counted.histogram, HISTOGRAM_BINS)
    for name, values in added.items():
        np.add.at(total[name], cycles.surface, values)  # one after the other: the sum of a chunk never stands alone
    if not bins:  # d(a S) = d(a) S**k of a straight law
        total["damage_same_ratio"] = cycle_damage(same_scale, law) * total["power_sum"]
    np.maximum.at(total["max_equivalent_range"], cycles.surface, dS)
    _raise_largest(total, cycles.surface, of)
    if counted.pieces.shape[2]:
        _lay_halves(cycles, n * damage, samples, counted.pieces)


def _raise_largest(total: NDArray[np.void], surface: Indices, of: CycleStress) -> None:
    """Put the largest range of each surface in place, and the stress ratio of the first cycle that has it."""
    before = total["max_range"].copy()
    np.maximum.at(total["max_range"], surface, of.range)
    now = total["max_range"]
    largest = np.flatnonzero((of.range == now[surface]) & (now > before)[surface])
    raised, first = np.unique(surface[largest], return_index=True)
    minimum, maximum = of.minimum[largest[first]], of.maximum[largest[first]]
    total["r_largest"][raised] = np.divide(minimum, maximum, out=np.full_like(maximum, math.nan), where=maximum != 0.0)


def _add_to_bins(cycles: SurfaceCycles, x: Floats, power: Floats, histogram: Floats, first: int) -> None:
    """Add cycles of the ranges x to sum n and sum n x^k of their bins, those from the ``first`` one on (n, 2, b, 2).

    ``power`` is n x^k.
    """
    decades = np.log10(np.maximum(x, 1e-3)) + 3.0
    bin_ = np.minimum((decades * BINS_PER_DECADE).astype(np.intp), HISTOGRAM_BINS - 1)
    at, sums = cycles.surface * histogram.shape[2] + first + bin_, histogram.reshape(-1, 2)
    np.add.at(sums[:, 0], at, cycles.weight)  # one index is added at ten times as fast as three
    np.add.at(sums[:, 1], at, power)


def _lay_halves(cycles: SurfaceCycles, damage: Floats, samples: int, pieces: Floats) -> None:
    """Add half of the damage of each cycle to the piece of either instant, of the equal pieces of a record.

    So the pieces add up to the damage, that of cycles from one to another and across the end of the record included.
    """
    laid, half = pieces.reshape(-1), 0.5 * damage
    for piece in cycles.at * pieces.shape[2] // samples:
        np.add.at(laid, cycles.surface * pieces.shape[2] + piece, half)
