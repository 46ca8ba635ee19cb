"""Two stresses of a point counted as a path in their plane, over the mission.

A path has half cycles whatever the direction, where a single direction sees its projection alone. Their ranges scale
with the load, so the load factor follows from them without counting again.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.mission import Plan, stress_utilisation
from fatigue.life.path.count import COUNT, count_path
from fatigue.life.records.history import stress_history
from fatigue.life.rule import CycleRule, cycle_damage
from fatigue.pipeline.count.overflow import no_overflow
from fatigue.pipeline.mission.event_load import EventLoad

Floats = NDArray[np.float64]

HALVINGS = 60  # of the distance between two factors in the logarithm
LARGEST = 1e250  # factor beyond which nothing damages


def counted_paths(
    parts: Floats, size: Floats, rule: CycleRule, loads: Sequence[EventLoad], plan: Plan, names: str
) -> dict[str, NDArray[Any]]:
    """Columns of ``check_rows`` for the paths of n points, ``parts`` (n, 2, c) per unit coordinate [MPa].

    Events must not join: a cycle across events has no path. ``size`` and ``rule`` are as of ``Signals``.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    n, limit = len(parts), plan.damage_limit
    damage, largest, factor = np.zeros((n, len(loads))), np.zeros(n), np.zeros(n)
    for point, of_point in enumerate(parts):
        ranges, counts = [], []
        for number, (load, one_pass) in enumerate(zip(loads, plan.passes, strict=True)):
            with no_overflow(load.counted.event, names):
                one, other = load.stress_factor * stress_history(of_point, load.counted.q)
                found = count_path(one, other, 1.0, load.residue).range
                damage[point, number] = (
                    one_pass.passes_per_km * COUNT * cycle_damage(size[point] * found, rule.law).sum()
                )
            if one_pass.passes_per_km > 0.0:
                largest[point] = max(largest[point], found.max(initial=0.0))
                ranges.append(size[point] * found)
                counts.append(np.full(len(found), COUNT * one_pass.passes_per_km * plan.target_km))
        factor[point] = largest_factor(np.concatenate(ranges), np.concatenate(counts), rule.law, limit)
    per_km = damage.sum(axis=1)
    governing = np.where(per_km > 0.0, damage.argmax(axis=1), len(loads))
    return {
        "range_max_MPa": largest,
        "damage_per_km": per_km,
        "damage_sum": per_km * plan.target_km,
        "damage_limit": np.full(n, limit),
        "utilisation_stress": stress_utilisation(factor),
        "fulfilled": (per_km * plan.target_km / limit <= 1.0).astype(np.int64),
        "governing_event": np.array([*(one.event for one in plan.passes), ""])[governing],
    }


def largest_factor(x: Floats, n: Floats, law: DamageLaw, limit: float) -> float:
    """Largest factor on all equivalent ranges x (h,), each n times, up to which the Miner sum keeps its limit.

    At a cut-off, where damage jumps, it is the supremum; +inf where nothing damages at any load.

    >>> straight = DamageLaw(np.array([3.0]), np.array([np.log(8e6)]), np.zeros(0), 0.0)
    >>> round(largest_factor(np.array([2.0]), np.array([1e6]), straight, 1.0), 9)
    1.0
    """

    def miner(log_factor: float) -> float:
        with np.errstate(over="ignore"):
            return float((n * cycle_damage(np.exp(log_factor) * x, law)).sum())

    if not (x > 0.0).any():
        return np.inf
    low, high = -1.0, 1.0
    while miner(low) > limit:
        low, high = 2.0 * low, low
    while miner(high) <= limit:
        if high > np.log(LARGEST):
            return np.inf
        low, high = high, 2.0 * high
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if miner(middle) > limit else (middle, high)
    return float(np.exp(low))
