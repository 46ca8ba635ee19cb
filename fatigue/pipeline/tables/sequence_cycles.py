"""Cycles across events of the points that govern: those that close in a loop, and those of its events they replace."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.residue import residue_indices
from fatigue.life.mission import Loop, Plan
from fatigue.life.records.history import Residue, stress_chunks
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.tables.cycle_rows import CycleParts, KeptPoint, cycle_rows
from fatigue.results import coded

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """Reversals in the order of time, arrays (r,): membrane and bending stress [MPa], event, and file time [s]."""

    membrane: Floats
    bending: Floats
    event: NDArray[np.intp]
    time: NDArray[np.floating]

    def at(self, places: NDArray[np.intp]) -> Self:
        """Take some reversals."""
        return type(self)(*(getattr(self, field.name)[places] for field in fields(self)))

    @classmethod
    def joined(cls, chains: Sequence[Self]) -> Self:
        """One chain behind the other."""
        return cls(*(np.concatenate([getattr(chain, field.name) for chain in chains]) for field in fields(cls)))


def sequence_rows(points: Sequence[KeptPoint], loads: Sequence[EventLoad], plan: Plan) -> Iterator[dict[str, Any]]:
    """Rows of ``cycles.parquet`` for the loops of a mission, of one point after the other.

    The cycles that close have the count of a cycle, those they replace its negative, so that all rows of a loop add up
    to its row in ``damage.parquet``.
    """
    joined = sorted({event for loop in plan.loops for event in loop.order})
    of_events = {event: residue_chains(points, loads[event], event) for event in joined}
    for loop in plan.loops:
        for i, point in enumerate(points):
            yield _loop_rows(point, {event: chains[i] for event, chains in of_events.items()}, loads, plan, loop)


def residue_chains(points: Sequence[KeptPoint], load: EventLoad, event: int) -> list[Chain]:
    """Residues of one pass of an event at some points, chunk by chunk of its record."""
    f, n = load.stress_factor, len(points)
    modal = f * np.stack([*(p.membrane for p in points), *(p.bending for p in points)])
    nothing = Chain(np.empty(0), np.empty(0), np.empty(0, np.intp), np.empty(0))
    chains, begin = [nothing] * n, 0
    for stress in stress_chunks(modal, load.counted.q):
        samples = begin + np.arange(stress.shape[1])
        time = load.counted.start + load.counted.step * samples
        of_event = np.full(len(samples), event)
        for i, point in enumerate(points):
            longer = Chain.joined([chains[i], Chain(stress[i], stress[n + i], of_event, time)])
            chains[i] = longer.at(residue_indices(longer.membrane + _side(point) * longer.bending))
        begin += len(samples)
    constants = modal @ load.offset
    return [
        Chain(chain.membrane + constants[i], chain.bending + constants[n + i], chain.event, chain.time)
        for i, chain in enumerate(chains)
    ]


def _side(point: KeptPoint) -> float:
    return 1.0 if point.face == 0 else -1.0


def _loop_rows(
    point: KeptPoint, residues: dict[int, Chain], loads: Sequence[EventLoad], plan: Plan, loop: Loop
) -> dict[str, Any]:
    """Rows of one loop at one point."""
    whole = Chain.joined([residues[event] for event in loop.order])
    parts = [_cycles(point, whole, "repeat", 1.0)]
    parts += [_cycles(point, residues[event], loads[event].residue, -1.0) for event in loop.order]
    start, end = (Chain.joined([pair[k] for pair, _ in parts]) for k in range(2))
    side = _side(point)
    s_i, s_j = start.membrane + side * start.bending, end.membrane + side * end.bending
    cycles = CycleParts(
        range=np.abs(s_j - s_i),
        mean=0.5 * (s_i + s_j),
        count=np.concatenate([count for _, count in parts]),
        membrane=np.abs(end.membrane - start.membrane),
        bending=np.abs(end.bending - start.bending),
        minimum=np.minimum(s_i, s_j),
        start_s=start.time,
        end_s=end.time,
    )
    names = [one.event for one in plan.passes]
    of_events = {"start_event": coded(start.event, names), "end_event": coded(end.event, names)}
    return cycle_rows(point, loop.name, cycles) | of_events


def _cycles(point: KeptPoint, chain: Chain, residue: Residue, sign: float) -> tuple[tuple[Chain, Chain], Floats]:
    """Reversals at which the cycles of a chain begin and end, and how often each counts."""
    found = rainflow(chain.membrane + _side(point) * chain.bending, residue)
    return (chain.at(found.start), chain.at(found.end)), sign * found.count
