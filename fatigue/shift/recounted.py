"""Damage of some points under the whole mission, counted again as the assessment counts it."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.life.records.history import stress_history, stress_record
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.side_by_side import in_order
from fatigue.why.across_events import loop_damages
from fatigue.why.attribute import count_credit
from fatigue.why.long_record import Row, is_long, long_damage
from fatigue.why.points import Points

Floats = NDArray[np.float64]

_SAMPLES_AT_ONCE = 4_000_000  # of membrane and bending stress: 32 MB


def event_damage(points: Points, load: EventLoad, threads: int | None) -> Floats:
    """Miner sum of one pass of an event at every point, (p,)."""
    q = load.counted.q
    if is_long(q):
        return np.array([_long_damage(points.of(slice(i, i + 1)), load) for i in range(len(points))])
    at_once = max(1, _SAMPLES_AT_ONCE // (2 * q.shape[1]))
    blocks = [points.of(slice(i, i + at_once)) for i in range(0, len(points), at_once)]
    return np.concatenate(in_order(_counted(load), blocks, threads))


def sequence_damage(points: Points, loads: Sequence[EventLoad], plan: Plan) -> Floats:
    """Damage per km that sequences of events add at every point, (p,) [1/km]."""
    if not plan.loops:
        return np.zeros(len(points))
    as_they_are = np.ones((1, points.membrane.shape[1]))
    one = (points.of(slice(i, i + 1)) for i in range(len(points)))
    return np.array([loop_damages(point, as_they_are, loads, plan)[0] for point in one])


def _counted(load: EventLoad) -> Callable[[Points], Floats]:
    """Miner sums of a block of points whose stresses are held in memory."""

    def damages(points: Points) -> Floats:
        modal_m, modal_b = load.stress_factor * points.membrane, load.stress_factor * points.bending
        membrane, bending = np.split(stress_history(np.concatenate([modal_m, modal_b]), load.counted.q), 2)
        offset = modal_m @ load.offset + points.side * (modal_b @ load.offset)
        of_points = zip(membrane, bending, points.side, points.size, points.rule, offset, strict=True)
        return np.array(
            [
                count_credit(m, b, side, size, rule, load.residue, constant, vertex=load.vertex).damage
                for m, b, side, size, rule, constant in of_points
            ]
        )

    return damages


def _long_damage(point: Points, load: EventLoad) -> float:
    """Miner sum of one point in one pass of a record that is on disk."""
    modal = load.stress_factor * np.concatenate([point.membrane, point.bending])
    stress, side = stress_record(modal, load.counted.q), float(point.side[0])
    offset = float((modal[0] + side * modal[1]) @ load.offset)
    row = Row(0, side, float(point.size[0]), point.rule[0], offset)
    return long_damage(stress, row, load.residue, vertex=load.vertex)
