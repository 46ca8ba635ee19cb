"""Residues of few points with the instants of their reversals, chunk by chunk of a record of any length."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.residue import residue_indices
from fatigue.life.mission import Loop
from fatigue.life.records.history import Residue, stress_chunks
from fatigue.pipeline.mission.event_load import EventLoad

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """Reversals in the order of time, arrays (r,): membrane and bending stress [MPa], number of event and sample."""

    membrane: Floats
    bending: Floats
    event: NDArray[np.intp]
    sample: NDArray[np.intp]

    def at(self, places: NDArray[np.intp]) -> Self:
        """Take some reversals."""
        return type(self)(*(getattr(self, field.name)[places] for field in fields(self)))

    @classmethod
    def joined(cls, chains: Sequence[Self]) -> Self:
        """One chain behind the other."""
        return cls(*(np.concatenate([getattr(chain, field.name) for chain in chains]) for field in fields(cls)))


@dataclass(frozen=True, slots=True, eq=False)
class ChainCycles:
    """Cycles of a chain: its reversals at which each begins and ends, and the ``count`` (c,) of each."""

    start: Chain
    end: Chain
    count: Floats


def residue_chains(membrane: Floats, bending: Floats, side: Floats, load: EventLoad, event: int) -> list[Chain]:
    """Residues of one pass of an event at n points, with its stress factor and its constants.

    ``membrane``, ``bending`` (n, c) per unit coordinate, ``side`` (n,) 1 for the top face and -1 for the bottom face.
    """
    n = len(side)
    modal = load.stress_factor * np.concatenate([membrane, bending])
    nothing = Chain(np.empty(0), np.empty(0), np.empty(0, np.intp), np.empty(0, np.intp))
    chains, begin = [nothing] * n, 0
    for stress in stress_chunks(modal, load.counted.q):
        samples = begin + np.arange(stress.shape[1])
        of_event = np.full(len(samples), event)
        for i in range(n):
            longer = Chain.joined([chains[i], Chain(stress[i], stress[n + i], of_event, samples)])
            chains[i] = longer.at(residue_indices(longer.membrane + side[i] * longer.bending))
        begin += len(samples)
    constant = modal @ load.offset
    return [
        Chain(chain.membrane + constant[i], chain.bending + constant[n + i], chain.event, chain.sample)
        for i, chain in enumerate(chains)
    ]


def chains_of_loops(
    membrane: Floats, bending: Floats, side: Floats, loads: Sequence[EventLoad], loops: Sequence[Loop]
) -> dict[int, list[Chain]]:
    """Residues at n points of every event that is in a loop, by its number; arguments as of ``residue_chains``."""
    events = sorted({event for loop in loops for event in loop.order})
    return {event: residue_chains(membrane, bending, side, loads[event], event) for event in events}


def loop_cycles(
    residues: dict[int, Chain], order: Sequence[int], side: float, loads: Sequence[EventLoad]
) -> ChainCycles:
    """Cycles that close in one run of a loop at one point, and, with negative counts, those of its events."""
    parts = [_cycles(Chain.joined([residues[event] for event in order]), side, "repeat", 1.0)]
    parts += [_cycles(residues[event], side, loads[event].residue, -1.0) for event in order]
    return ChainCycles(
        Chain.joined([part.start for part in parts]),
        Chain.joined([part.end for part in parts]),
        np.concatenate([part.count for part in parts]),
    )


def _cycles(chain: Chain, side: float, residue: Residue, sign: float) -> ChainCycles:
    found = rainflow(chain.membrane + side * chain.bending, residue)
    return ChainCycles(chain.at(found.start), chain.at(found.end), sign * found.count)
