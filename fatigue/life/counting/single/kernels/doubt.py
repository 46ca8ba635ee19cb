"""A surface in one chunk of time, where single precision cannot tell which of two stresses is the larger one.

The larger one of two that are equal within rounding hardly matters for the range of a cycle, but its membrane stress is
the one that counts, and the membrane stress of the other one may be quite different. So both are worked out in double
precision, and the surface is counted again in this chunk with what they say. Samples of other chunks are not at hand:
if one of them is in doubt, or one of the few reversals that are left at the end of the record, the surface has to be
counted again from the beginning.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.single.kernels.loops import (
    add_cycles,
    append_last,
    begin_side,
    finish,
    hold_level,
    keep_residue,
    list_reversals,
    resume,
    suspend,
)
from fatigue.life.counting.single.kernels.power import PowerLaw
from fatigue.life.counting.single.kernels.state import Room, Stage, State

Floats = NDArray[np.float64]
Numbers = NDArray[np.floating]
Places = NDArray[np.int64]
Marks = NDArray[np.int32]


class Exact(NamedTuple):
    """What stress in double precision comes from: modal stress (n, m) of coordinates as given, and these (m, t)."""

    membrane: Floats
    bending: Floats
    q: Any  # an array in compiled code


@compiled()
def rise(exact: Exact, at: tuple[int, int], i: int, j: int) -> float:
    """``sum over k of (S_m,k + side S_b,k) (q_k,j - q_k,i)`` in double precision; samples i and j of a chunk from 1."""
    m_i = m_j = b_i = b_j = 0.0
    for k in range(len(exact.q)):
        m_i += exact.membrane[at[0], k] * exact.q[k, i - 1]
        b_i += exact.bending[at[0], k] * exact.q[k, i - 1]
        m_j += exact.membrane[at[0], k] * exact.q[k, j - 1]
        b_j += exact.bending[at[0], k] * exact.q[k, j - 1]
    side = 1.0 - 2.0 * at[1]
    return (m_j + side * b_j) - (m_i + side * b_i)


@compiled()
def write_steps(
    m: Numbers, b: Numbers, steps: int, at: tuple[int, int], flat: np.float32, exact: Exact, room: Room
) -> bool:
    """Write whether each step goes up (1), nowhere (0) or down (-1) into the work space; returns whether it is known.

    Samples 1 to t are in the chunk, sample 0 the one before it and t + 1 the one behind the record.
    """
    side, step, last = np.float32(1 - 2 * at[1]), room.marks[0], exact.q.shape[1]
    known = True
    for i in range(steps):
        s = m[i] + side * b[i]
        ds = (m[i + 1] + side * b[i + 1]) - s
        step[i] = np.int32(ds > 0) - np.int32(ds < 0)
        if abs(ds) <= flat + flat * abs(s) and m[i + 1] != m[i]:
            if i in (0, last):
                known = False
            else:
                exactly = rise(exact, at, i, i + 1)
                step[i] = np.int32(exactly > 0) - np.int32(exactly < 0)
    return known


@compiled()
def reaches(sample: Marks, i: int, sign: float, at: tuple[int, int], exact: Exact) -> int:
    """``sign (s_i - s_(i-2)) >= 0``: whether reversal i reaches the one before it on its side; -1 if not known.

    ``sign`` is 1 where both are peaks; ``sample`` says which sample of the chunk a reversal is, 0 if none.
    """
    if sample[i] == 0 or sample[i - 2] == 0:
        return -1
    return int(sign * rise(exact, at, sample[i - 2], sample[i]) >= 0.0)


@compiled()
def close_inner(
    room: Room, n: int, first_sign: float, at: tuple[int, int], flat: np.float32, exact: Exact
) -> tuple[int, int, bool]:
    """Close what ``kernels.loops.close_pass`` takes out in any number of passes, on a stack.

    ``first_sign`` is the sign of the first reversal; the second row of marks says which sample of the chunk a reversal
    is, 0 if none. Returns how many are left, how many cycles there are, and whether all of that is known.
    """
    z, zm, S, dm = room.numbers[0], room.numbers[1], room.numbers[2], room.numbers[3]
    sample = room.marks[1]
    top, cycles, known = -1, 0, True
    for k in range(n):
        top += 1
        z[top], zm[top], sample[top] = z[k], zm[k], sample[k]
        while top >= 3:
            a, b, c, d = top - 3, top - 2, top - 1, top
            last, last_but_one = int(z[d] >= z[b]), int(z[c] >= z[a])
            sign = first_sign * (1 - 2 * (d % 2))
            if abs(z[d] - z[b]) <= flat + flat * abs(z[b]) and zm[d] != zm[b]:
                last = reaches(sample, d, sign, at, exact)
            if abs(z[c] - z[a]) <= flat + flat * abs(z[a]) and zm[c] != zm[a]:
                last_but_one = reaches(sample, c, -sign, at, exact)
            known &= last >= 0 and last_but_one >= 0
            if last != 1 or last_but_one == 1:
                break
            S[cycles], dm[cycles] = z[b] + z[c], zm[b] + zm[c]
            cycles += 1
            z[b], zm[b], sample[b] = z[d], zm[d], sample[d]
            top = b
    return top + 1, cycles, known


@compiled()
def count_side_exactly(
    m: Numbers,
    b: Numbers,
    steps: int,
    at: tuple[int, int],
    stage: Stage,
    law: PowerLaw,
    state: State,
    room: Room,
    exact: Exact,
) -> None:
    """Count one surface as ``kernels.loops.count_side`` does, with double precision where it is needed."""
    known = state.sides[at]
    side = np.float32(1 - 2 * at[1])
    if not write_steps(m, b, steps, at, stage.flat, exact, room):
        known.doubtful = True
        return
    if known.up < 0:
        i = 0
        while i < steps and room.marks[0, i] == 0:
            i += 1
        if i == steps:  # level so far
            if stage.ends and state.residue.shape[3] > 0:
                keep_residue(at, 0, stage.recurs, state, room)
            return
        begin_side(room.marks[0, i] > 0, m[i], at, stage.recurs, state)
    waiting, sign = resume(state, at, room), 2.0 * known.up - 1.0
    hold_level(room, steps, known.up)
    n, known.up = list_reversals(m, b, side, steps, known.up, room, waiting)
    if stage.ends and state.residue.shape[3] > 0:
        keep_residue(at, n, stage.recurs, state, room)
    sample = room.marks[1]
    for k in range(n - 1, -1, -1):
        sample[k] = sample[k - waiting] if k >= waiting else 0
    if stage.ends:
        sample[n] = 0 if stage.recurs else steps
        n = append_last(m, b, steps, side, stage.recurs, known, room, n)
    n, cycles, settled = close_inner(room, n, sign * (1 - 2 * (waiting % 2)), at, stage.flat, exact)
    known.doubtful |= not settled
    if stage.ends:
        cycles = finish(known, n, cycles, stage, law, room)
    else:
        suspend(state, at, n, room)
    add_cycles(room, 2, cycles, 1.0, law, known)


@compiled()
def count_chunk_exactly(
    stress: Numbers,
    samples: int,
    stage: Stage,
    law: PowerLaw,
    state: State,
    room: Room,
    exact: Exact,
    doubts: Places,
) -> None:
    """Count the surfaces that ``kernels.loops.count_chunk`` has left out: rows and faces ``doubts`` (d, 2)."""
    points = stress.shape[0] // 2
    steps = samples + int(stage.ends and stage.recurs)
    for k in range(len(doubts)):
        at = (doubts[k, 0], doubts[k, 1])
        m, b = stress[at[0]], stress[points + at[0]]
        count_side_exactly(m, b, steps, at, stage, law, state, room, exact)
