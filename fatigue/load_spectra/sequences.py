"""The cycles of a loop of events at chosen points: those that close across events, and those they replace."""

from collections.abc import Sequence

import numpy as np

from fatigue.life.load_spectrum import LoadCycles
from fatigue.life.mission import Loop
from fatigue.load_spectra.recounted import Counted, judged
from fatigue.pipeline.count.joined import chains
from fatigue.pipeline.count.joined.chains import Chain
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.why.points import Points

Residues = dict[int, list[Chain]]  # of every event in a loop, by its number, at every point


def residues_of(points: Points, loads: Sequence[EventLoad], loops: Sequence[Loop]) -> Residues:
    """What one pass of every event that is in a loop leaves open at each point, constants included."""
    return chains.chains_of_loops(points.membrane, points.bending, points.side, loads, loops)


def loop_cycles(points: Points, i: int, loop: Loop, loads: Sequence[EventLoad], residues: Residues) -> Counted:
    """Cycles of one run of a loop at one point, those replaced with a count below 0.

    Added to the cycles of all passes they are those of the concatenated record, see ``fatigue.life.sequence``.
    """
    side = float(points.side[i])
    found = chains.loop_cycles({event: of[i] for event, of in residues.items()}, loop.order, side, loads)
    first, second = (chain.membrane + side * chain.bending for chain in (found.start, found.end))
    cycles = LoadCycles(first, second, np.abs(second - first), found.count)
    dm, db = (np.abs(getattr(found.end, name) - getattr(found.start, name)) for name in ("membrane", "bending"))
    return judged(points, i, cycles, dm, db)
