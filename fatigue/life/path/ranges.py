"""From the half cycles of a path to combined equivalent ranges and damage."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.path.count import COUNT, PathCycles
from fatigue.life.rule import CycleRule, bending_ratio, cycle_damage

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class EndRanges:
    """What lies between the two ends of each half cycle, (h,) each.

    Attributes
    ----------
    normal, shear : range of the normal and of the shear stress at the face [MPa]
    bending_ratio : bending / (membrane + bending) range
    shear_bending_ratio : twist / (in-plane + twist) range
    """

    normal: Floats
    shear: Floats
    bending_ratio: Floats
    shear_bending_ratio: Floats


@dataclass(frozen=True, slots=True)
class PathDamage:
    """Miner sums of a record by three equivalent ranges: x, p x and (1 + alpha g) x; ``mlp`` is NaN without alpha."""

    range: float
    length: float
    mlp: float


def between_ends(values: Floats, cycles: PathCycles) -> Floats:
    """Difference (..., h) of histories (..., t) between the ends of half cycles, linear between samples.

    Behind the last sample of a recurring block follows its first one.
    """
    return at_instants(values, cycles.end) - at_instants(values, cycles.start)


def end_ranges(
    cycles: PathCycles, membrane: Floats, bending: Floats, in_plane: Floats, twist: Floats, side: float
) -> EndRanges:
    """Ranges between the ends of half cycles of histories (t,) [MPa]; ``side`` is 1 at the top face, -1 at the bottom.

    Transverse shear vanishes at a face and is no part of the shear there.
    """
    d_m, d_b, d_tau_m, d_tau_b = between_ends(np.stack([membrane, bending, in_plane, twist]), cycles)
    return EndRanges(
        normal=np.abs(d_m + side * d_b),
        shear=np.abs(d_tau_m + side * d_tau_b),
        bending_ratio=bending_ratio(d_m, d_b),
        shear_bending_ratio=bending_ratio(d_tau_m, d_tau_b),
    )


def combined_range(ranges: EndRanges, size: float, beta: float, rule: CycleRule) -> Floats:
    """``x = size sqrt((ds / I)^2 + beta (dt / I_tau)^2)`` of each half cycle, each stress with its own I(r)^(1/m).

    After ASME VIII-2 5.5.5.3 with beta = 3, its effective range before the division by F. On a curve in plain ranges
    both I are 1.
    """
    I_s, I_t = rule.ratio_factor(ranges.bending_ratio), rule.ratio_factor(ranges.shear_bending_ratio)
    return np.asarray(size * np.hypot(ranges.normal / I_s, np.sqrt(beta) * ranges.shear / I_t))


def path_damage(cycles: PathCycles, x: Floats, law: DamageLaw, alpha: float | None = None) -> PathDamage:
    """Miner sums ``sum 0.5 d(x)`` of half cycles with the equivalent ranges x (h,), by range, length and moment.

    Length and moment carry what noise does to them, see the head of this room; the range is the robust one.
    """

    def miner(equivalent: Floats) -> float:
        return float(COUNT * cycle_damage(equivalent, law).sum())

    mlp = np.nan if alpha is None else miner((1.0 + alpha * cycles.moment) * x)
    return PathDamage(miner(x), miner(cycles.factor * x), mlp)


def at_instants(values: Floats, t: Floats) -> Floats:
    """Values (..., h) of histories at sample indices with a fraction."""
    samples = values.shape[-1]
    before = np.floor(t).astype(np.intp)
    fraction = t - before
    following = (before + 1) % max(samples, 1)
    return values[..., before] * (1.0 - fraction) + values[..., following] * fraction
