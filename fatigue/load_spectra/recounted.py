"""The cycles of chosen points, counted once more as the assessment counts them, point after point under one event."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.long_rainflow import long_cycles
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.vertex import vertex_history
from fatigue.life.load_spectrum import LoadCycles
from fatigue.life.records.history import stress_chunks, stress_history
from fatigue.life.rule import bending_ratio, cycle_damage, equivalent_range
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.why.points import Points

Floats = NDArray[np.float64]

_SAMPLES_AT_ONCE = 4_000_000  # of membrane and bending stress: 32 MB


@dataclass(frozen=True, slots=True, eq=False)
class Counted:
    """Some cycles of one point under one event, in the order in which they close.

    ``damage`` and ``bending_ratio`` (c,) are of each cycle, its count not yet taken into account in the damage.
    """

    cycles: LoadCycles
    damage: Floats
    bending_ratio: Floats


def recounted(points: Points, load: EventLoad) -> Iterator[tuple[int, Counted]]:
    """Cycles of one pass of an event at each point, by the index of the point; of a long record in several pieces."""
    at_once = _SAMPLES_AT_ONCE // (2 * load.counted.q.shape[1])
    if at_once < 1:
        for index in range(len(points)):
            for counted in _long(points, index, load):
                yield index, counted
        return
    for first in range(0, len(points), at_once):
        some = points.of(slice(first, first + at_once))
        modal = load.stress_factor * np.concatenate([some.membrane, some.bending])
        membrane, bending = np.split(stress_history(modal, load.counted.q), 2)
        for i in range(len(some)):
            yield first + i, _counted(some, i, load, membrane[i], bending[i])


def _counted(points: Points, i: int, load: EventLoad, membrane: Floats, bending: Floats) -> Counted:
    """Cycles of a point with these stress histories (t,) [MPa]."""
    side = float(points.side[i])
    if load.vertex:
        membrane, bending, _ = vertex_history(membrane, bending, side, recurs=load.record.recurs)
    stress = membrane + side * bending
    cycles = rainflow(stress, load.residue)
    dm, db = (np.abs(s[cycles.end] - s[cycles.start]) for s in (membrane, bending))
    found = LoadCycles(stress[cycles.start], stress[cycles.end], cycles.range, cycles.count)
    return judged(points, i, found.raised(constant_of(points, i, load)), dm, db)


def _long(points: Points, i: int, load: EventLoad) -> Iterator[Counted]:
    """Cycles of a point in a record whose stress is not held in memory, some at a time."""
    modal = load.stress_factor * np.stack([points.membrane[i], points.bending[i]])

    def chunks() -> Iterator[tuple[Floats, Floats]]:
        return ((membrane, bending) for membrane, bending in stress_chunks(modal, load.counted.q))

    for piece in long_cycles(chunks, float(points.side[i]), load.residue, vertex=load.vertex):
        first, second = piece.stress.T
        dm, db = (np.abs(np.diff(part, axis=1)[:, 0]) for part in (piece.membrane, piece.bending))
        found = LoadCycles(first, second, np.abs(second - first), piece.weight)
        yield judged(points, i, found.raised(constant_of(points, i, load)), dm, db)


def judged(points: Points, i: int, cycles: LoadCycles, membrane_range: Floats, bending_range: Floats) -> Counted:
    """Cycles of a point with the damage of each, from their ranges of membrane and bending stress [MPa]."""
    rule, r, lowest = points.rule[i], bending_ratio(membrane_range, bending_range), cycles.lowest
    f_M = rule.mean_stress_factor(lowest, lowest + cycles.range)
    dS = equivalent_range(cycles.range, points.size[i], rule.ratio_factor(r), f_M)
    return Counted(cycles, cycle_damage(dS, rule.law), r)


def constant_of(points: Points, i: int, load: EventLoad) -> float:
    """Constant stress of a point under an event, carried beside its samples [MPa]."""
    modal = points.membrane[i] + points.side[i] * points.bending[i]
    return float(load.stress_factor * (modal @ load.offset))


def signal_cycles(load: EventLoad, coordinate: int) -> Iterator[LoadCycles]:
    """Cycles of one pass of a coordinate of the body by itself, in its own unit; of a long record in several pieces."""
    q, row = load.counted.q, slice(coordinate, coordinate + 1)
    if q.shape[1] <= _SAMPLES_AT_ONCE:
        signal = np.asarray(q[row, :], dtype=np.float64)[0]
        if load.vertex:
            signal = vertex_history(signal, np.zeros_like(signal), 1.0, recurs=load.record.recurs).membrane
        found = rainflow(signal, load.residue)
        yield LoadCycles(signal[found.start], signal[found.end], found.range, found.count)
        return
    only = np.zeros((1, q.shape[0]))
    only[0, coordinate] = 1.0

    def chunks() -> Iterator[tuple[Floats, Floats]]:
        return ((signal, np.zeros_like(signal)) for (signal,) in stress_chunks(only, q))

    for piece in long_cycles(chunks, 1.0, load.residue, vertex=load.vertex):
        first, second = piece.stress.T
        yield LoadCycles(first, second, np.abs(second - first), piece.weight)
