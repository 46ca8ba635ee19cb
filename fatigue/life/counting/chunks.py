"""Counting records of any length in double precision: chunk by chunk, the counter carrying its state, for any law.

The stress of some thousand samples is recovered, its reversals are appended to those that wait, cycles that close are
summed up at once, and what is left waits for the next chunk: values of membrane and bending stress, as many as it
takes. The loops of ``reversals`` and ``tally`` find cycles and sum them up.

A single pass is counted just as in whole rows: the stack of open reversals is all that the counter knows. Of a block
that recurs, whole rows begin at its largest sample, which here is known at the end only. Until then a range is closed
when it is smaller than the one before it and not larger than the one after it: what lies before cannot change that, so
it is a cycle wherever counting begins. The rest is turned so that it begins at its largest reversal, and closes
entirely. Every cycle is the same as in whole rows. Only where the largest or smallest stress of a block that recurs
occurs several times, exactly equal, other instants of it may be paired: same ranges, but perhaps other bending ratios.

Reversals that are read at their vertices are moved there when they are found. For that a chunk brings the sample before
its first column, and a block that recurs what follows its first sample. Where the residue of the pass is wanted, open
ranges of a single pass wait to its end as well, and what waits behind the last chunk is the residue.
"""

from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.factors import Trials, add_trials
from fatigue.life.counting.moments import add_moments, mean_and_kurtosis_of
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.residue import BlockResidue, residue_places
from fatigue.life.counting.reversals import Buffers, buffers_for, close_cycles, close_open
from fatigue.life.counting.tally import (
    Counted,
    SurfaceCycles,
    block_count,
    nothing_counted,
    plain,
    refuse_not_finite,
    tally,
)
from fatigue.life.counting.vertex import at_shift, shift_of
from fatigue.life.rule import CycleRule

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Three: TypeAlias = tuple[float, float, float]  # a sample between its neighbours

POINTS = 128  # counted at a time
CHUNK = 8192  # samples recovered at a time
WAITING = 64  # reversals of a point there is room for at first
CYCLES = 65_536  # summed up at a time, and those of one surface in a chunk


class _State(NamedTuple):
    """What is known of each point and surface (n, 2) between two chunks; pairs (..., 2) are membrane and bending.

    ``first`` (n, 2) is the first sample. ``first_step`` and ``step`` are the directions of the first step and of the
    last one, 0 before there is any; ``plateau`` (n, 2, 2) is the sample before the first step. The first ``waiting`` of
    the reversals ``m``, ``b`` (n, 2, r) have not closed a cycle. ``earlier`` (n, 2) is the sample before the last one;
    ``alone`` (n, 2) says whether the first plateau is the first sample alone, ``after`` (n, 2, 2) what follows it then.
    ``moments`` (n, 2, 5) are number, mean, and sums of the 2nd, 3rd and 4th power of the deviations from it, of the
    samples so far. ``at`` and ``plateau_at`` are the samples of what waits, and of the first plateau.
    """

    first: Floats
    first_step: NDArray[np.int64]
    step: NDArray[np.int64]
    plateau: Floats
    waiting: NDArray[np.int64]
    m: Floats
    b: Floats
    at: Indices
    moments: Floats
    earlier: Floats
    alone: NDArray[np.int64]
    after: Floats
    plateau_at: Indices


class _Room(NamedTuple):
    """Work space of one row: stress of a chunk, and membrane, bending and structural stress of its reversals.

    ``at`` are the samples of the reversals, ``kept`` (2, r) are membrane and bending stress of the residue, in the end.
    """

    stress: Floats
    m: Floats
    b: Floats
    s: Floats
    at: Indices
    kept: Floats
    buffers: Buffers


class _Stage(NamedTuple):
    """Samples of a chunk, whether the record ends with it and whether it recurs, and the steps between its columns.

    ``first`` is the sample of its first column, the one before the chunk; ``record`` is how many the record has.
    ``keeps``: whether the residue is wanted; ``vertex``: reversals are read at their vertices.
    """

    first: int
    record: int
    samples: int
    ends: bool
    recurs: bool
    steps: int
    keeps: bool
    vertex: bool


def count_chunks(
    stress: BlockStress, record: CountedRecord, rule: CycleRule, chunk: int = CHUNK, *, pieces: Floats | None = None
) -> BlockCount:
    """Count a block as ``count`` does, ``chunk`` samples at a time.

    With ``pieces`` (n, 2, p), to which the damage in p equal pieces of the record is added, there are bins of all
    ranges: see ``nothing_counted``.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    counted = nothing_counted(len(stress), rule.law, pieces)
    _count_points(stress, record, rule, counted, chunk)
    return block_count(counted, rule, stress.level)


def count_chunks_and_residue(
    stress: BlockStress, record: CountedRecord, rule: CycleRule, chunk: int = CHUNK
) -> tuple[BlockCount, BlockResidue]:
    """Count a block as ``count_chunks`` does, and keep the residue of every point."""
    counted = nothing_counted(len(stress), rule.law)
    residues = _count_points(stress, record, rule, counted, chunk, keeps=True)
    return block_count(counted, rule, stress.level), BlockResidue.joined(residues)


def try_chunks(stress: BlockStress, record: CountedRecord, rule: CycleRule, tried: Trials, chunk: int = CHUNK) -> None:
    """Add the damage of one pass of a block under factors on its stress to the trials."""
    _count_points(stress, record, rule, tried, chunk)


def _count_points(
    stress: BlockStress,
    record: CountedRecord,
    rule: CycleRule,
    counted: Counted | Trials,
    chunk: int,
    *,
    keeps: bool = False,
) -> list[BlockResidue]:
    """Count a block some points at a time; returns their residues where they are to be kept."""
    residues = []
    for first in range(0, len(stress), POINTS):
        some = slice(first, first + POINTS)
        state = _count(stress.at(some), record, rule, counted.at(some), chunk, keeps=keeps)
        if keeps:
            residues.append(BlockResidue.of_padded(state.m, state.b, state.waiting))
    return residues


def _count(
    some: BlockStress, record: CountedRecord, rule: CycleRule, counted: Counted | Trials, chunk: int, *, keeps: bool
) -> _State:
    """Count some points, chunk by chunk; returns the state behind the last one."""
    modal_stress = np.concatenate([plain(some.membrane), plain(some.bending)])
    points, t = len(some), record.q.shape[1]
    edges = np.linspace(0, t, -(-t // chunk) + 1).astype(int).tolist()
    width = max((end - first for first, end in pairwise(edges)), default=0)
    stress = np.zeros((2 * points, width + 2))  # between the last sample before and, at the end, the first of all
    state = _fresh_state(points)
    room, listed, found = _room_for(width + 1, WAITING), _list_of(CYCLES + 2 * width), np.zeros(1, np.intp)
    for first, end in pairwise(edges):
        samples, ends = end - first, end == t
        recovered = stress[:, 1 : samples + 1]
        np.matmul(modal_stress, record.q[:, first:end].astype(np.float64, copy=False), out=recovered)
        refuse_not_finite(recovered[:points], recovered[points:])
        if first == 0:
            stress[:, 0] = stress[:, 1]
            state.first[:] = stress[:, 1].reshape(2, points).T
        if ends and record.recurs:
            stress[:, samples + 1] = state.first.T.ravel()
        steps = samples + int(ends and record.recurs)
        stage = _Stage(first - 1, t, samples, ends, record.recurs, steps, keeps, record.vertex)
        at = count_chunk(stress, stage, 0, state, room, listed, found)
        while at < 2 * points:  # more cycles are found, or more reversals wait, than there is room for
            _sum_up(listed, found, some, rule, counted, t)
            left, room_before = int(state.waiting.ravel()[at]), room
            if left > state.m.shape[2]:
                state = _grown(state, 2 * left)
                room, listed = _room_for(width + 1, 2 * left), _list_of(CYCLES + 2 * width + 4 * left)
                for rows, kept in ((state.m, room_before.m), (state.b, room_before.b), (state.at, room_before.at)):
                    rows.reshape(2 * points, -1)[at, :left] = kept[:left]
                at += 1
            at = count_chunk(stress, stage, at, state, room, listed, found)
        _sum_up(listed, found, some, rule, counted, t)
        state.earlier[:] = stress[:, samples - 1].reshape(2, points).T
        stress[:, 0] = stress[:, samples]
    if isinstance(counted, Counted):
        counted.totals["mean"], counted.totals["kurtosis"] = mean_and_kurtosis_of(state.moments, t)
    return state


def _list_of(cycles: int) -> SurfaceCycles:
    """Room for so many cycles."""
    membrane, bending = np.empty((2, cycles)), np.empty((2, cycles))
    return SurfaceCycles(np.empty(cycles, np.intp), membrane, bending, np.empty(cycles), np.empty((2, cycles), np.intp))


def _sum_up(
    listed: SurfaceCycles,
    found: Indices,
    some: BlockStress,
    rule: CycleRule,
    counted: Counted | Trials,
    samples: int,
) -> None:
    """Sum up the cycles found so far, and forget them."""
    cycles = SurfaceCycles._make(values[..., : found[0]] for values in listed)
    found[0] = 0
    if isinstance(counted, Counted):
        tally(cycles, some, rule, counted, samples)
    else:
        add_trials(cycles, some, rule, counted)


def _fresh_state(points: int) -> _State:
    """Nothing counted yet."""
    one, pair, rows = (points, 2), (points, 2, 2), (points, 2, WAITING)
    first_step, step, waiting, alone = (np.zeros(one, np.int64) for _ in range(4))
    first, earlier, plateau, after = np.zeros(one), np.zeros(one), np.zeros(pair), np.zeros(pair)
    begin = first, first_step, step, plateau, waiting
    m, b, at = np.zeros(rows), np.zeros(rows), np.zeros(rows, np.intp)
    return _State(*begin, m, b, at, np.zeros((*one, 5)), earlier, alone, after, np.zeros(one, np.intp))


def _grown(state: _State, room: int) -> _State:
    """Make room for more reversals that wait."""
    more = ((0, 0), (0, 0), (0, room - state.m.shape[2]))
    return state._replace(m=np.pad(state.m, more), b=np.pad(state.b, more), at=np.pad(state.at, more))


def _room_for(steps: int, waiting: int) -> _Room:
    """Work space for the reversals of so many steps behind those that wait: once, and once more to turn them."""
    reversals = steps + waiting + 2
    m, b, s = (np.empty(2 * reversals + 1) for _ in range(3))
    at = np.empty(2 * reversals + 1, np.intp)
    return _Room(np.empty(steps + 1), m, b, s, at, np.empty((2, reversals + 2)), buffers_for(reversals))


@compiled()
def append(m: float, b: float, at: int, side: float, n: int, room: _Room) -> int:
    """Append a reversal at a sample and return how many there are."""
    room.m[n], room.b[n], room.s[n], room.at[n] = m, b, m + side * b, at
    return n + 1


@compiled()
def append_vertex(m: Three, b: Three, at: int, side: float, n: int, room: _Room) -> int:
    """Append a reversal between its neighbours, read at its vertex, and return how many there are."""
    s = (m[0] + side * b[0], m[1] + side * b[1], m[2] + side * b[2])
    p = shift_of(s[0], s[1], s[2])
    if p == 0.0:
        return append(m[1], b[1], at, side, n, room)
    return append(at_shift(m[0], m[1], m[2], p), at_shift(b[0], b[1], b[2], p), at, side, n, room)


@compiled()
def append_reversals(
    m: Floats, b: Floats, earlier: Floats, stage: _Stage, side: float, step: int, n: int, room: _Room
) -> tuple[int, int]:
    """Append the reversals among the first columns of a row, the last samples of their plateaus.

    ``earlier`` (2,) is the sample before the first column, ``step`` the direction before. Returns how many reversals
    there are, and the direction behind them.
    """
    s, signs, at, steps = room.stress, room.buffers.step, room.buffers.reversal, stage.steps
    for i in range(steps):
        signs[i] = int(s[i + 1] > s[i]) - int(s[i + 1] < s[i])
    reversals = 0
    for i in range(steps):
        at[reversals] = i
        reversals += int(signs[i] * step < 0)  # adding 0 or 1 is cheaper than a branch nobody can predict
        step = signs[i] if signs[i] != 0 else step
    for k in range(reversals):
        i = at[k]
        if stage.vertex:
            m_before, b_before = (m[i - 1], b[i - 1]) if i > 0 else (earlier[0], earlier[1])
            both = (m_before, m[i], m[i + 1]), (b_before, b[i], b[i + 1])
            n = append_vertex(both[0], both[1], stage.first + i, side, n, room)
        else:
            n = append(m[i], b[i], stage.first + i, side, n, room)
    return n, step


@compiled()
def turn_to_largest(n: int, room: _Room) -> None:
    """Begin the cyclic list of reversals at its first largest one, and end it there too."""
    first = 0
    for i in range(1, n):
        first = i if room.s[i] > room.s[first] else first
    for values in (room.m, room.b, room.s):
        for i in range(n + 1):
            values[n + i] = values[(first + i) % n]
        for i in range(n + 1):
            values[i] = values[n + i]
    for i in range(n + 1):
        room.at[n + i] = room.at[(first + i) % n]
    for i in range(n + 1):
        room.at[i] = room.at[n + i]


@compiled()
def close_all(n: int, recurs: bool, room: _Room) -> int:
    """Close all cycles of the reversals at the end of the record and return how many there are."""
    if recurs and n > 0:
        turn_to_largest(n, room)
        n += 1
    for k in range(n):
        room.buffers.reversal[k] = k
    of = room.buffers
    return close_cycles(room.s, n, recurs, of.reversal, of.start, of.end, of.weight)


@compiled()
def gather_reversals(m: Floats, b: Floats, at: tuple[int, int], stage: _Stage, state: _State, room: _Room) -> int:
    """Put the reversals of a chunk behind those that wait and return how many there are, 0 before the first step."""
    row, side, s = at[0], 1.0 - 2.0 * at[1], room.stress
    n = 0
    for i in range(state.waiting[at]):
        n = append(state.m[at][i], state.b[at][i], state.at[at][i], side, n, room)
    step = state.step[at]
    if step == 0:
        i = 0
        while step == 0 and i < stage.steps:
            step = int(s[i + 1] > s[i]) - int(s[i + 1] < s[i])
            i += 1
        if step == 0:
            return 0
        state.first_step[at] = step
        state.plateau[at][0], state.plateau[at][1] = m[i - 1], b[i - 1]
        state.plateau_at[at] = stage.first + i - 1
        state.after[at][0], state.after[at][1] = m[i], b[i]
        before = state.moments[at][0] - stage.samples  # of this chunk; its column 1 is the next sample
        state.alone[at] = int(before + i == 2)
        if not stage.recurs:  # a single pass turns at its first sample
            n = append(state.first[row, 0], state.first[row, 1], 0, side, n, room)
    n, step = append_reversals(m, b, state.earlier[row], stage, side, step, n, room)
    state.step[at] = step
    if stage.ends and not stage.recurs:
        n = append(m[stage.samples], b[stage.samples], stage.record - 1, side, n, room)
    elif stage.ends and step != state.first_step[at]:  # a block that recurs turns where its first plateau ends
        first, after = state.plateau[at], state.after[at]
        if stage.vertex and state.alone[at]:
            last = stage.samples
            n = append_vertex((m[last], first[0], after[0]), (b[last], first[1], after[1]), 0, side, n, room)
        else:
            n = append(first[0], first[1], state.plateau_at[at], side, n, room)
    return n


@compiled()
def keep_residue(m: Floats, b: Floats, at: tuple[int, int], n: int, stage: _Stage, state: _State, room: _Room) -> int:
    """Copy the residue of a record that ends, n reversals wait, to ``room.kept`` and return how many it has.

    A block that recurs turns at its first and its last sample as well, where another pass comes before or behind it. At
    its first plateau, the last of its reversals, only its own next pass turns.
    """
    side, s, place = 1.0 - 2.0 * at[1], room.s[n:], room.buffers.start
    if stage.recurs:
        n -= int(n > 0 and state.step[at] != state.first_step[at])
    kept_m, kept_b = room.kept
    kept_m[0], kept_b[0] = state.first[at[0], 0], state.first[at[0], 1]
    for i in range(n):
        kept_m[1 + i], kept_b[1 + i] = room.m[i], room.b[i]
    kept_m[1 + n], kept_b[1 + n] = m[stage.samples], b[stage.samples]
    for i in range(n + 2):
        s[i] = kept_m[i] + side * kept_b[i]
    length = residue_places(s, n + 2, place)
    for k in range(length):
        kept_m[k], kept_b[k] = kept_m[place[k]], kept_b[place[k]]
    return length


@compiled()
def put_cycles(number: int, cycles: int, room: _Room, listed: SurfaceCycles, found: Indices) -> None:
    """Put the cycles of a surface behind those found so far."""
    start, end, weight = room.buffers.start, room.buffers.end, room.buffers.weight
    for c in range(cycles):
        k, i, j = found[0] + c, start[c], end[c]
        listed.surface[k], listed.weight[k] = number, weight[c]
        listed.membrane[0, k], listed.membrane[1, k] = room.m[i], room.m[j]
        listed.bending[0, k], listed.bending[1, k] = room.b[i], room.b[j]
        listed.at[0, k], listed.at[1, k] = room.at[i], room.at[j]
    found[0] += cycles


@compiled()
def count_chunk(
    stress: Floats, stage: _Stage, first: int, state: _State, room: _Room, listed: SurfaceCycles, found: Indices
) -> int:
    """Count the steps between the first columns of a block, its membrane rows above its bending rows.

    Begins with one surface of one point, ``first = 2 * row + surface``. Cycles are listed behind the ``found`` (1,) of
    them. Stops before a surface for whose cycles there may be no room, or behind one for whose waiting reversals there
    is none, with these at the front of ``room``. Returns where it stopped.
    """
    points = stress.shape[0] // 2
    for number in range(first, 2 * points):
        if found[0] + state.waiting[number // 2, number % 2] + stage.steps + 4 > listed.weight.size:
            return number
        row, surface = number // 2, number % 2
        m, b, side = stress[row], stress[points + row], 1.0 - 2.0 * surface
        for i in range(stage.steps + 1):
            room.stress[i] = m[i] + side * b[i]
        add_moments(room.stress[1 : stage.samples + 1], state.moments[row, surface])

        n = gather_reversals(m, b, (row, surface), stage, state, room)
        if stage.ends:
            left = keep_residue(m, b, (row, surface), n, stage, state, room) if stage.keeps else 0
            cycles = close_all(n, stage.recurs, room)
        else:
            waits = stage.recurs or stage.keeps
            cycles, left = close_open(room.s, state.waiting[row, surface], n, waits, room.buffers)
        put_cycles(number, cycles, room, listed, found)

        state.waiting[row, surface] = left
        for k in range(left):
            if stage.ends:
                room.m[k], room.b[k] = room.kept[0, k], room.kept[1, k]
            else:
                kept = room.buffers.reversal[k]
                room.m[k], room.b[k], room.at[k] = room.m[kept], room.b[kept], room.at[kept]
        if left > state.m.shape[2]:
            return number
        for k in range(left):
            state.m[row, surface, k], state.b[row, surface, k] = room.m[k], room.b[k]
            state.at[row, surface, k] = room.at[k]
    return int(2 * points)
