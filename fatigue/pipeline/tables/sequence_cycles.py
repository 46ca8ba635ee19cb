"""Cycles across events of the points that govern: those that close in a loop, and those of its events they replace."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Loop, Plan
from fatigue.pipeline.count.joined.chains import Chain, chains_of_loops, loop_cycles
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.tables.cycle_rows import CycleParts, KeptPoint, cycle_rows
from fatigue.results import coded


def sequence_rows(points: Sequence[KeptPoint], loads: Sequence[EventLoad], plan: Plan) -> Iterator[dict[str, Any]]:
    """Rows of ``cycles.parquet`` for the loops of a mission, of one point after the other.

    The cycles that close have the count of a cycle, those they replace its negative, so that all rows of a loop add up
    to its row in ``damage.parquet``.
    """
    side = np.array([point.side for point in points])
    membrane, bending = (np.stack([getattr(p, name) for p in points]) for name in ("membrane", "bending"))
    chains = chains_of_loops(membrane, bending, side, loads, plan.loops)
    for loop in plan.loops:
        for i, point in enumerate(points):
            residues = {event: of_points[i] for event, of_points in chains.items()}
            yield _loop_rows(point, residues, loads, plan, loop)


def _loop_rows(
    point: KeptPoint, residues: dict[int, Chain], loads: Sequence[EventLoad], plan: Plan, loop: Loop
) -> dict[str, Any]:
    """Rows of one loop at one point."""
    side = point.side
    found = loop_cycles(residues, loop.order, side, loads)
    start, end = found.start, found.end
    s_i, s_j = start.membrane + side * start.bending, end.membrane + side * end.bending
    cycles = CycleParts(
        range=np.abs(s_j - s_i),
        mean=0.5 * (s_i + s_j),
        count=found.count,
        membrane=np.abs(end.membrane - start.membrane),
        bending=np.abs(end.bending - start.bending),
        minimum=np.minimum(s_i, s_j),
        start_s=_times(start, loads),
        end_s=_times(end, loads),
    )
    names = [one.event for one in plan.passes]
    of_events = {"start_event": coded(start.event, names), "end_event": coded(end.event, names)}
    return cycle_rows([point], loop.name, [cycles]) | of_events


def _times(chain: Chain, loads: Sequence[EventLoad]) -> NDArray[np.float64]:
    """File times of reversals [s]."""
    start, step = (np.array([getattr(load.counted, name) for load in loads]) for name in ("start", "step"))
    return np.asarray(start[chain.event] + step[chain.event] * chain.sample)
