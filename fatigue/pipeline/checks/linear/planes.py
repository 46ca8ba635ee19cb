"""The critical plane across a plate at stress points: that with the largest damage of the whole mission.

The weighted sum over events comes first, the maximum over planes behind it: each event may have another worst plane,
and the sum of these belongs to no crack.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.life.records.history import stress_chunks
from fatigue.life.rule import CycleRule
from fatigue.pipeline.checks.linear.directions import EQUAL
from fatigue.pipeline.checks.linear.signals import Signals, counted_damage
from fatigue.pipeline.mission.event_load import EventLoad

Floats = NDArray[np.float64]


def face_pairs(stress: Floats, size: Floats, rule: CycleRule) -> Signals:
    """Stress (n, 2, c) at the two faces of a plate, to be counted: half their difference is the bending stress."""
    return Signals.of_pairs(stress[:, 0], stress[:, 1], size, rule)


def critical_planes(
    stress: Floats, size: Floats, rule: CycleRule, loads: Sequence[EventLoad], plan: Plan, names: str
) -> NDArray[np.intp]:
    """Number of the critical one of d planes at two faces of n points, (n, 2), given stress (n, d, 2, c) on them.

    Of planes with the same damage it is the first one; where none does any damage, as below a cut-off, the one with the
    largest range. ``size`` (n,) and ``rule`` as of ``Signals``; ``names`` says in messages whose stresses they are.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    n, planes = stress.shape[:2]
    signals = face_pairs(stress.reshape(n * planes, *stress.shape[2:]), np.repeat(size, planes), rule)
    value = counted_damage(signals, loads, plan, names).reshape(n, planes, 2)
    undamaged = ~value.any(axis=1)
    value.swapaxes(1, 2)[undamaged] = _ranges(stress.swapaxes(1, 2)[undamaged], loads, plan)
    return np.asarray((value >= EQUAL * value.max(axis=1, keepdims=True)).argmax(axis=1))


def _ranges(stress: Floats, loads: Sequence[EventLoad], plan: Plan) -> Floats:
    """Largest range (n, d) of stress (n, d, c) in the events that occur [MPa]."""
    n, planes, coordinates = stress.shape
    largest = np.zeros(n * planes)
    for load, one_pass in zip(loads, plan.passes, strict=True):
        if n and one_pass.passes_per_km > 0.0:
            low, high = np.full(n * planes, np.inf), np.full(n * planes, -np.inf)
            for chunk in stress_chunks(stress.reshape(-1, coordinates), load.counted.q):
                low, high = np.minimum(low, chunk.min(axis=1)), np.maximum(high, chunk.max(axis=1))
            largest = np.maximum(largest, load.stress_factor * (high - low))
    return largest.reshape(n, planes)
