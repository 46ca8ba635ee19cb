"""The cycles of a loop of events at chosen points: those that close across events, and those they replace."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.residue import residue_indices
from fatigue.life.load_spectrum import LoadCycles
from fatigue.life.mission import Loop
from fatigue.life.records.history import Residue, stress_chunks
from fatigue.load_spectra.recounted import Counted, judged
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.why.points import Points

Floats = NDArray[np.float64]

Residues = list[list[Floats]]  # of every event and point: membrane and bending stress at the reversals, (2, r) [MPa]


def residues_of(points: Points, loads: Sequence[EventLoad], loops: Sequence[Loop]) -> Residues:
    """What one pass of every event that is in a loop leaves open at each point, constants included; else nothing."""
    joined = {event for loop in loops for event in loop.order}
    return [_residues(points, load) if event in joined else [] for event, load in enumerate(loads)]


def _residues(points: Points, load: EventLoad) -> list[Floats]:
    """Residues of one pass of an event, chunk by chunk of its record."""
    n = len(points)
    modal = load.stress_factor * np.concatenate([points.membrane, points.bending])
    found = [np.empty((2, 0)) for _ in range(n)]
    for stress in stress_chunks(modal, load.counted.q):
        for i in range(n):
            longer = np.concatenate([found[i], stress[[i, n + i]]], axis=1)
            found[i] = longer[:, residue_indices(longer[0] + points.side[i] * longer[1])]
    constant = (modal @ load.offset).reshape(2, n)
    return [own + constant[:, i : i + 1] for i, own in enumerate(found)]


def loop_cycles(
    points: Points, i: int, loop: Loop, loads: Sequence[EventLoad], residues: Residues
) -> Iterator[Counted]:
    """Cycles of one run of a loop at one point, those replaced with a count below 0.

    Added to the cycles of all passes they are those of the concatenated record, see ``fatigue.life.sequence``.
    """
    stints = [residues[event][i] for event in loop.order]
    yield _cycles(points, i, np.concatenate(stints, axis=1), "repeat", 1.0)
    for event, own in zip(loop.order, stints, strict=True):
        yield _cycles(points, i, own, loads[event].residue, -1.0)


def _cycles(points: Points, i: int, chain: Floats, residue: Residue, sign: float) -> Counted:
    """Cycles of a chain of reversals (2, r)."""
    stress = chain[0] + points.side[i] * chain[1]
    found = rainflow(stress, residue)
    dm, db = np.abs(chain[:, found.end] - chain[:, found.start])
    cycles = LoadCycles(stress[found.start], stress[found.end], found.range, sign * found.count)
    return judged(points, i, cycles, dm, db)
