"""Cycles across events: the passes of a loop are put one behind the other, counted, and set against the single events.

What the loop adds to the events counted by themselves are the cycles that close between their passes, less those that
do not occur because others do: the count of the whole chain less those of its passes, cycle by cycle.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.across_events.turns import Turns
from fatigue.verify.recount.anew.across_events.unknown_order import open_and_closed
from fatigue.verify.recount.anew.cycles import RecountCycles, count_cycles

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]

PASSES = 2  # of an event that repeats in each of its stints: those behind the first add the same each


@dataclass(frozen=True, slots=True, eq=False)
class Net:
    """Cycles that a loop of events adds, and with a count below 0 those it takes away.

    Attributes
    ----------
    start, end : (c,) turning points among those of all events of the loop
    count : (c,) without those that occur either way
    event : (r,) number of the event of each turning point
    membrane, bending : (r,) stresses [MPa]
    time : (r,) file time [s]
    closing : starts and ends of the cycles between passes, (2, l), also where an event by itself has the same
    """

    start: Counts
    end: Counts
    count: Floats
    event: Counts
    membrane: Floats
    bending: Floats
    time: Floats
    closing: Counts

    @property
    def stress(self) -> Floats:
        """Sum of membrane and bending, (r,) [MPa]."""
        return self.membrane + self.bending


def net_cycles(order: Sequence[int], turns: Mapping[int, Turns]) -> Net:
    """Cycles of a loop, in whose ``order`` events stand by number, beyond those of its events by themselves."""
    events = sorted(set(order))
    sizes = [len(turns[event].time) for event in events]
    first = dict(zip(events, np.cumsum([0, *sizes]).tolist(), strict=False))
    membrane, bending, time = (
        np.concatenate([getattr(turns[event], name) for event in events]) for name in ("membrane", "bending", "time")
    )
    stress = membrane + bending

    chain, passes = [], dict.fromkeys(events, 0)
    for event in order:
        of_stint = PASSES if turns[event].recurs else 1
        chain += of_stint * [first[event] + np.arange(len(turns[event].time))]
        passes[event] += of_stint
    path = np.concatenate(chain)
    found = count_cycles(stress[path], recurs=True)
    of_chain = RecountCycles(path[found.start], path[found.end], found.count)
    own = {event: _moved(turns[event].cycles, first[event]) for event in events}
    closed = {event: _moved(open_and_closed(turns[event])[1], first[event]) for event in events}
    entries = {event: order.count(event) for event in events}
    start, end, count = _added_up([(of_chain, 1), *((own[event], -passes[event]) for event in events)])
    closing = _added_up(
        [
            (of_chain, 1),
            *((own[event], entries[event] - passes[event]) for event in events),
            *((closed[event], -entries[event]) for event in events),
        ]
    )
    return Net(
        start,
        end,
        count,
        event=np.repeat(events, sizes).astype(np.int64),
        membrane=membrane,
        bending=bending,
        time=time,
        closing=np.stack(closing[:2])[:, closing[2] > 0.0],
    )


def _moved(cycles: RecountCycles, first: int) -> RecountCycles:
    return RecountCycles(cycles.start + first, cycles.end + first, cycles.count)


def _added_up(some: Sequence[tuple[RecountCycles, int]]) -> tuple[Counts, Counts, Floats]:
    """Cycles so many times each, those between the same two turning points as one; nothing of those that cancel."""
    start, end = (np.concatenate([getattr(cycles, name) for cycles, _ in some]) for name in ("start", "end"))
    count = np.concatenate([times * cycles.count for cycles, times in some])
    if not len(start):
        return start, end, count
    both = np.stack([np.minimum(start, end), np.maximum(start, end)])
    _, at, which = np.unique(both, axis=1, return_index=True, return_inverse=True)
    total = np.bincount(which.ravel(), count)
    left = total != 0.0
    return start[at][left], end[at][left], total[left]
