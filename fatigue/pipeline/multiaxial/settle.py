"""Which toe points need no path counter: by normal stress alone, or by a proven bound of what shear can add.

First without a history: the path of a point is bounded by how far and how much the modal coordinates move. Only points
that this leaves are traced, chunk by chunk, and bounded once more.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.path_bound import largest_combined_range, path_bound, power_bound
from fatigue.life.bounds.path_extent import PathExtent, least_range, path_limits
from fatigue.life.bounds.screening import may_need_mean_stress
from fatigue.life.rule import CycleRule
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.multiaxial.histories import ranges, traced
from fatigue.pipeline.multiaxial.toes import Toes, weights_of

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

REQUIRED = 1.0 / 3.0  # shear over normal stress range, from which on ASME VIII-2 5.5.5.3 asks for shear


@dataclass(frozen=True, slots=True, eq=False)
class Bounded:
    """What bounds say of some stations, arrays (n, 2); everything over the limit at the target.

    ``bound`` is that of the sum by path range, cycles across events included; ``settled`` says where it is enough.
    ``shear_range`` (e, n, 2) bounds the range of the shear [MPa].
    """

    bound: Floats
    shear_range: Floats


def first_tier(
    toes: Toes, loads: Sequence[EventLoad], extents: Sequence[PathExtent], passes: Floats, beta: float
) -> Bounded:
    """Bound the paths of all stations without a history."""
    stress, total = toes.stress, toes.transitions.copy()
    shear_range = np.empty_like(toes.normal_range)
    for number, (load, extent) in enumerate(zip(loads, extents, strict=True)):
        f = load.stress_factor
        normal, shear = (stress.membrane, stress.bending), (stress.in_plane_shear, stress.twist_shear)
        limits = path_limits(normal, shear, beta, extent)
        shear_range[number] = f * limits.shear_range
        both, mean = (toes.normal_range[number], shear_range[number]), toes.normal_mean[number]
        total += passes[number] * _event_bound(f * limits.length, both, mean, stress.size[:, None], stress.rule, beta)
    return Bounded(total, shear_range)


def second_tier(
    toes: Toes, at: tuple[NDArray[np.intp], NDArray[np.intp]], loads: Sequence[EventLoad], passes: Floats, beta: float
) -> tuple[Floats, Floats]:
    """Bounds of the sum by path range at some faces, (k,) each, from their paths and the exact range of shear.

    The first is from the length of the paths, the second, which is closer, from higher powers along them as well.
    """
    total, size, rule = toes.transitions[at].copy(), toes.stress.size[at[0]], toes.stress.rule
    closer, plain = total.copy(), replace(rule, mean_stress=False)
    for number, load in enumerate(loads):
        path = traced(weights_of(toes.stress, *at, load), load.mean, load.counted.q, load.residue, beta)
        both, mean = (path.normal_range, path.shear_range), toes.normal_mean[number][at]
        damage = _event_bound(path.length, both, mean, size, rule, beta)
        by_powers = power_bound(path.length, path.integrals, np.hypot(both[0], np.sqrt(beta) * both[1]), size, plain)
        total += passes[number] * damage
        closer += passes[number] * np.where(np.isinf(damage), np.inf, by_powers)
    return total, closer


def _event_bound(
    length: Floats, both: tuple[Floats, Floats], mean: Floats, size: Floats, rule: CycleRule, beta: float
) -> Floats:
    """Bound of the damage of one pass by path range; infinite where f_M may make a cycle worse.

    ``both`` are the ranges of normal stress and shear, ``mean`` is that of the normal stress [MPa].
    """
    if rule.law.slopes.min() < 1.0:  # d(x) / x falls
        return np.full_like(length, np.inf)
    plain = replace(rule, mean_stress=False)
    damage = path_bound(length, largest_combined_range(*both, size, beta, plain), size, plain)
    if rule.yield_of_damage is None:
        return damage
    return np.where(may_need_mean_stress(mean, both[0], rule.yield_of_damage), np.inf, damage)


def shear_required(
    toes: Toes, bounded: Bounded, loads: Sequence[EventLoad], extents: Sequence[PathExtent]
) -> NDArray[np.int8]:
    """Whether the largest range of the shear is above a third of that of the normal stress, (n, 2): 1, 0, else -1.

    Bounds decide as far as they can. Of stations that were counted the others are traced; the normal stress of those
    that were not is not known.
    """
    limit = REQUIRED * toes.normal_range.max(axis=0)
    found = np.full(limit.shape, -1, dtype=np.int8)
    counted = toes.toe & toes.counted[:, None]
    may_be = bounded.shear_range.max(axis=0) > limit
    found[counted & ~may_be] = 0
    station, face = np.nonzero(toes.toe & may_be)
    if station.size:
        of_extents = zip(loads, extents, strict=True)
        least = [least_range(weights_of(toes.stress, station, face, load)[1], extent) for load, extent in of_extents]
        found[station, face] = np.where(np.max(least, axis=0) > limit[station, face], 1, found[station, face])
    station, face = np.nonzero(counted & (found < 0))
    if station.size:
        of_events = [
            ranges(weights_of(toes.stress, station, face, load)[1], load.counted.q, limit[station, face])
            for load in loads
        ]
        found[station, face] = np.max(of_events, axis=0) > limit[station, face]
    return found
