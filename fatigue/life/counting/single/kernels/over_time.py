"""A whole record, some samples of some points at a time: their stress, its count, and what is in doubt.

The loop is compiled where the record is in memory and ``kernels.simd`` multiplies, so that threads do not wait
for the interpreter between its steps. Else the interpreter goes through the same loop, with the product of BLAS or
reading from disk what each step needs.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.single.kernels.doubt import Exact, count_chunk_exactly
from fatigue.life.counting.single.kernels.loops import count_chunk
from fatigue.life.counting.single.kernels.power import PowerLaw
from fatigue.life.counting.single.kernels.product import multiply, rows_between, samples_of
from fatigue.life.counting.single.kernels.state import Room, Stage, State
from fatigue.life.records.spool import Samples

Numbers = NDArray[np.floating]


class Workspace(NamedTuple):
    """How a block is counted, and the work space.

    ``modal_stress`` laid out, of some points at a time membrane before bending; ``stress`` for so
    many points, ``space`` for the samples of a chunk, ``room`` for a surface; ``recurs`` and ``flat`` as in ``Stage``;
    ``sizes``: samples of a chunk, points at a time.
    """

    modal_stress: Numbers
    stress: Numbers
    space: Numbers
    room: Room
    recurs: bool
    flat: np.float32
    sizes: tuple[int, int]


def count_record(q: Samples, exact: Exact, law: PowerLaw, state: State, work: Workspace) -> None:
    """Count a record, some samples of some points at a time; ``count_in_memory`` is the same in compiled code.

    ``q`` is what stress is made of, ``exact`` settles what rounding may have decided: read where that is needed.
    """
    chunk, points = work.sizes
    n, t = len(state.sides), exact.q.shape[1]
    doubts = np.empty((2 * points, 2), np.int64)
    for begin in range(0, t, chunk):
        end = min(begin + chunk, t)
        samples = end - begin
        stage = Stage(begin == 0, end == t, work.recurs, work.flat)
        laid_out = samples_of(q, begin, end, work.space)
        for first in range(0, n, points):
            last = min(first + points, n)
            stress = work.stress[: 2 * (last - first)]
            waiting, residue = state.waiting[first:last], state.residue[first:last]
            some = State(state.sides[first:last], state.ends[first:last], waiting, residue)
            multiply(rows_between(work.modal_stress, 2 * first, 2 * last), laid_out, work.stress)
            found = count_chunk(stress, samples, stage, law, some, work.room, doubts)
            if found > 0:
                known = Exact(exact.membrane[first:last], exact.bending[first:last], exact.q[:, begin:end])
                count_chunk_exactly(stress, samples, stage, law, some, work.room, known, doubts[:found])


count_in_memory = compiled()(count_record)
