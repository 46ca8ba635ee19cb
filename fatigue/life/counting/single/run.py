"""A whole record, some samples of some points at a time: their stress, its count, and what is in doubt.

The loop is compiled where the record is in memory and its product that of `single.simd`, so that threads do not wait
for the interpreter between its steps. Else the interpreter goes through the same loop, with the product of BLAS or
reading from disk what each step needs.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.single.doubt import Exact, count_chunk_exactly
from fatigue.life.counting.single.loops import count_chunk
from fatigue.life.counting.single.power import PowerLaw
from fatigue.life.counting.single.product import multiply, samples_of, shapes_between
from fatigue.life.counting.single.state import Room, Stage, State
from fatigue.life.records.spool import Samples

Numbers = NDArray[np.floating]


class Run(NamedTuple):
    """How a block is counted, and the work space.

    ``shapes`` laid out, of each piece of points those of the membrane before those of bending; ``stress`` for the block
    of a piece, ``space`` for the samples of a chunk, ``room`` for a surface; ``recurs`` and ``flat`` as in `Stage`;
    ``sizes``: samples of a chunk, points of a piece.
    """

    shapes: Numbers
    stress: Numbers
    space: Numbers
    room: Room
    recurs: bool
    flat: np.float32
    sizes: tuple[int, int]


def count_record(q: Samples, exact: Exact, rules: PowerLaw, state: State, run: Run) -> None:
    """Count a record, some samples of some points at a time; `count_in_memory` is the same in compiled code.

    ``q`` is what stress is made of, ``exact`` settles what rounding may have decided: read where that is needed.
    """
    chunk, points = run.sizes
    n, t = len(state.sides), exact.q.shape[1]
    doubts = np.empty((2 * points, 2), np.int64)
    for begin in range(0, t, chunk):
        end = min(begin + chunk, t)
        samples = end - begin
        stage = Stage(begin == 0, end == t, run.recurs, run.flat)
        laid_out = samples_of(q, begin, end, run.space)
        for first in range(0, n, points):
            last = min(first + points, n)
            stress = run.stress[: 2 * (last - first)]
            piece = State(state.sides[first:last], state.ends[first:last], state.waiting[first:last])
            multiply(shapes_between(run.shapes, 2 * first, 2 * last), laid_out, run.stress)
            found = count_chunk(stress, samples, stage, rules, piece, run.room, doubts)
            if found > 0:
                known = Exact(exact.membrane[first:last], exact.bending[first:last], exact.q[:, begin:end])
                count_chunk_exactly(stress, samples, stage, rules, piece, run.room, known, doubts[:found])


count_in_memory = compiled()(count_record)
