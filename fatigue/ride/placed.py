"""Where on the track the damage of an event is made: between given instants, at some points.

A cycle has two instants. Half of its damage belongs to either, as in ``fatigue.why``, so that the parts of an event add
up to its damage whatever the instants are.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from fatigue.life.attribution import cycle_credit
from fatigue.life.counting.long_rainflow import long_cycles
from fatigue.life.records.history import stress_chunks
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.why.points import Points

Floats = NDArray[np.float64]
Spans = list[tuple[float, float]]  # start and end of stretches [s]


def placed_damage(points: Points, load: EventLoad, edges_s: Floats) -> Floats:
    """Damage of one pass of an event before, between and behind some instants, at p points: (p, edges + 1).

    The cycles are those of the assessment, piece by piece, so that a record on disk stays there. An instant that is an
    edge belongs to what comes behind it.

    Parameters
    ----------
    points : the points
    load : the event
    edges_s : (e,) ascending instants in file time of the event [s]
    """
    damage = np.zeros((len(points), len(edges_s) + 1))
    for i in range(len(points)):
        modal = load.stress_factor * np.stack([points.membrane[i], points.bending[i]])
        side = float(points.side[i])
        offset = float((modal[0] + side * modal[1]) @ load.offset)
        of_point = (side, float(points.size[i]), points.rule[i], offset)

        def chunks(modal: Floats = modal) -> Iterator[tuple[Floats, Floats]]:
            return ((membrane, bending) for membrane, bending in stress_chunks(modal, load.counted.q))

        for piece in long_cycles(chunks, side, load.residue, vertex=load.vertex):
            of = cycle_credit(piece.membrane.T, piece.bending.T, piece.weight, *of_point)
            instant = load.counted.start + load.counted.step * piece.at.ravel()
            part = np.searchsorted(edges_s, instant, side="right")
            damage[i] += np.bincount(part, np.repeat(0.5 * of.damage, 2), len(edges_s) + 1)
    return damage


def edges_of(spans: list[Spans]) -> Floats:
    """Ascending instants at which any of the stretches of several channels begins or ends [s]."""
    return np.unique(np.array([instant for of_channel in spans for span in of_channel for instant in span]))


def inside(spans: Spans, edges_s: Floats) -> NDArray[np.bool_]:
    """Which parts before, between and behind the edges lie in the stretches of one channel, (edges + 1,)."""
    begin = np.concatenate([[-np.inf], edges_s])
    lies = [(begin >= start) & (begin < end) for start, end in spans]
    return np.any(lies, axis=0) if lies else np.zeros(begin.size, dtype=np.bool_)
