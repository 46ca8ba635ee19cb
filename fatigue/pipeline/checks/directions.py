"""The direction in which the stress at a point does most damage, out of many.

The stress in a direction is a sum of a few stresses of the point, linear in all of them: sigma_perp cos psi + tau_perp
sin psi in a throat, three components in a plate. Damage is counted for every direction over the whole mission, and only
then compared: the worst direction of each event would be another one, and their sum belongs to no crack.

Each record is turned into the few stresses of the point first, which are then summed up in every direction. So a
direction costs the search for cycles, and not the superposition of all modes once more.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.life.records.history import stress_chunks, stress_history
from fatigue.life.records.spool import Spool
from fatigue.life.rule import CycleRule
from fatigue.pipeline.checks.signals import Signals, counted_damage, without_spectrum
from fatigue.pipeline.mission.event_load import EventLoad

Floats = NDArray[np.float64]

EQUAL = 1.0 - 1e-9  # damages that only rounding tells apart: the first of them is taken
LONGEST = 4_000_000  # samples of a record of which the stresses of one point are held in memory: 64 MB of two


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
    for point, of_point in enumerate(parts):
        size_of_point = float(size[point])
        value = direction_damage(of_point, sums, size_of_point, rule, loads, plan, names)
        if not value.any():
            value = direction_ranges(of_point, sums, loads, plan)
        found[point] = int((value >= EQUAL * value.max()).argmax())
    return found


def direction_damage(
    parts: Floats, sums: Floats, size: float, rule: CycleRule, loads: Sequence[EventLoad], plan: Plan, names: str
) -> Floats:
    """Damage per km (d,) of the stress of one point in every direction, its stresses ``parts`` (p, c)."""
    short = all(load.counted.q.shape[1] <= LONGEST and not isinstance(load.counted.q, Spool) for load in loads)
    of_point = [_of_point(load, parts) if short else without_spectrum(load) for load in loads]
    stress = sums if short else sums @ parts
    if rule.uses_bending_ratio:  # a pair of directions is no membrane and bending
        signals = Signals(stress, np.zeros_like(stress), np.full(len(stress), size), rule)
        return counted_damage(signals, of_point, plan, names)[:, 0]
    one, other = stress[0::2], np.zeros_like(stress[0::2])
    other[: len(stress) // 2] = stress[1::2]
    signals = Signals.of_pairs(one, other, np.full(len(one), size), rule)
    return counted_damage(signals, of_point, plan, names).reshape(-1)[: len(stress)]


def direction_ranges(parts: Floats, sums: Floats, loads: Sequence[EventLoad], plan: Plan) -> Floats:
    """Largest range (d,) of the stress of one point in every direction [MPa], of the events that occur."""
    largest = np.zeros(len(sums))
    for load, one_pass in zip(loads, plan.passes, strict=True):
        if one_pass.passes_per_km > 0.0:
            chunks = [(c.min(axis=1), c.max(axis=1)) for c in stress_chunks(sums @ parts, load.counted.q)]
            low, high = (np.array(ends) for ends in zip(*chunks, strict=True))
            largest = np.maximum(largest, load.stress_factor * (high.max(axis=0) - low.min(axis=0)))
    return largest


def _of_point(load: EventLoad, parts: Floats) -> EventLoad:
    """An event with the stresses of one point (p, c) as its coordinates."""
    record = replace(load.counted, mode=np.arange(len(parts)), q=stress_history(parts, load.counted.q))
    return replace(
        without_spectrum(load),
        counted=record,
        single=None,
        mean=parts @ load.mean,
        offset=parts @ load.offset,
        covariance=parts @ load.covariance @ parts.T,
    )
