"""The direction in which the stress at a point does most damage, out of many.

The stress in a direction is a sum of a few stresses of the point, linear in all of them: sigma_perp cos psi + tau_perp
sin psi in a throat, three components in a plate. Damage is counted for every direction over the whole mission, and only
then compared: the worst direction of each event would be another one, and their sum belongs to no crack.

A record in memory is turned into the few stresses of each point first, which are then summed up in every direction. So
a direction costs the search for cycles, and not the superposition of all modes once more.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.life.records.history import stress_chunks, stress_history
from fatigue.life.records.spool import Spool
from fatigue.life.rule import CycleRule
from fatigue.pipeline.checks.linear.signals import Signals, counted_damage
from fatigue.pipeline.mission.event_load import EventLoad, without_spectrum

Floats = NDArray[np.float64]

EQUAL = 1.0 - 1e-9  # damages that only rounding tells apart: the first of them is taken
AT_ONCE = 4_000_000  # stress samples recovered before directions are counted: 32 MB; those of one point at least


def half_circle(step_deg: float) -> Floats:
    """Directions [deg] from 0 to below 180, which is the first one again.

    >>> half_circle(45.0)
    array([  0.,  45.,  90., 135.])
    """
    return np.arange(0.0, 180.0, step_deg)


def worst_directions(
    parts: Floats, sums: Floats, size: Floats, rule: CycleRule, loads: Sequence[EventLoad], plan: Plan, names: str
) -> NDArray[np.intp]:
    """Which direction of each point does most damage over the mission, (n,); the first of equal ones.

    Where none does any damage, as below a cut-off, it is the one with the largest range.

    Parameters
    ----------
    parts : (n, p, c) the stresses of n points per unit coordinate [MPa]
    sums : (d, p) how much of each is in the stress of a direction
    size, rule : as of ``Signals``; names : whose stresses they are, in messages

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    found = np.zeros(len(parts), dtype=np.intp)
    samples = max(load.counted.q.shape[1] for load in loads)
    on_disk = any(isinstance(load.counted.q, Spool) for load in loads)
    at_once = 1 if on_disk else max(1, AT_ONCE // (samples * len(loads) * parts.shape[1]))
    for first in range(0, len(parts), at_once):
        some = parts[first : first + at_once]
        records = [[] if on_disk else list(_of_points(load, some)) for load in loads]
        for number, of_point in enumerate(some):
            coordinates, stress = loads, sums @ of_point
            if not on_disk:
                coordinates, stress = [record[number] for record in records], sums
            point = first + number
            value = direction_damage(stress, float(size[point]), rule, coordinates, plan, names)
            if not value.any():
                value = direction_ranges(stress, coordinates, plan)
            found[point] = int((value >= EQUAL * value.max()).argmax())
    return found


def direction_damage(
    stress: Floats, size: float, rule: CycleRule, loads: Sequence[EventLoad], plan: Plan, names: str
) -> Floats:
    """Damage per km (d,) of the stress in every direction, (d, c) per unit coordinate."""
    d = len(stress)
    if rule.depends_on_bending:  # a pair of directions is no membrane and bending
        signals = Signals(stress, np.zeros_like(stress), np.full(d, size), rule)
        return counted_damage(signals, loads, plan, names)[:, 0]
    one, other = stress[0::2], np.zeros_like(stress[0::2])
    other[: d // 2] = stress[1::2]
    signals = Signals.of_pairs(one, other, np.full(len(one), size), rule)
    return counted_damage(signals, loads, plan, names).reshape(-1)[:d]


def direction_ranges(stress: Floats, loads: Sequence[EventLoad], plan: Plan) -> Floats:
    """Largest range (d,) of the stress in every direction [MPa], of the events that occur."""
    largest = np.zeros(len(stress))
    for load, one_pass in zip(loads, plan.passes, strict=True):
        if one_pass.passes_per_km > 0.0:
            chunks = [(c.min(axis=1), c.max(axis=1)) for c in stress_chunks(stress, load.counted.q)]
            low, high = (np.array(ends) for ends in zip(*chunks, strict=True))
            largest = np.maximum(largest, load.stress_factor * (high.max(axis=0) - low.min(axis=0)))
    return largest


def _of_points(load: EventLoad, parts: Floats) -> Iterator[EventLoad]:
    """An event for each of some points, with the stresses of the point, ``parts`` (k, p, c), as its coordinates."""
    k, p, c = parts.shape
    stress = stress_history(parts.reshape(k * p, c), load.counted.q).reshape(k, p, -1)
    for of_point, q in zip(parts, stress, strict=True):
        yield replace(
            without_spectrum(load),
            counted=replace(load.counted, mode=np.arange(p), q=q),
            single=None,
            mean=of_point @ load.mean,
            offset=of_point @ load.offset,
            covariance=of_point @ load.covariance @ of_point.T,
        )
