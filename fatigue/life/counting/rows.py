"""Counting whole rows in double precision, for any law: the plain reading of the standard that all else is tested by.

The reversals of each row are found and paired, and membrane and bending stress at the two instants of every cycle give
its damage, with the exact ranges. Short records take a sixth less time here than in ``chunks``, long ones a tenth more.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.factors import Trials, no_trials, tally_trials
from fatigue.life.counting.moments import mean_and_kurtosis
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.residue import BlockResidue, residue_of_rows
from fatigue.life.counting.reversals import Buffers, buffers_for, find_cycles
from fatigue.life.counting.tally import (
    CompiledRule,
    Surface,
    block_count,
    compiled_rule,
    lay_halves,
    no_pieces,
    nothing_counted,
    own_of,
    plain,
    refuse_not_finite,
    tally,
)
from fatigue.life.counting.vertex import move, shifts
from fatigue.life.records.history import Residue, stress_history
from fatigue.life.rule import CycleRule

Floats = NDArray[np.float64]

SAMPLES_AT_ONCE = 4_000_000  # stress samples of one component recovered before they are counted: 32 MB


class _Histories(NamedTuple):
    """Stresses of a block and, per point and surface, what is counted: see ``nothing_counted``; or damage of trials.

    ``pieces`` (n, s, p): damage in each of p equal pieces of the record, p 0 where it is not wanted.
    """

    membrane: Floats
    bending: Floats
    size: Floats
    same_ratio: Floats
    shear_factor: Floats
    offset: Floats
    totals: NDArray[np.void]
    histogram: Floats
    trials: Trials
    pieces: Floats


def count_rows(
    stress: BlockStress, record: CountedRecord, rule: CycleRule, *, pieces: Floats | None = None
) -> BlockCount:
    """Count a block as ``count`` does: the histories of a few points at a time.

    With ``pieces`` (n, s, p), to which the damage in p equal pieces of the record is added, there are bins of all
    ranges: see ``nothing_counted``. With one of the s surfaces, the count is of the top only.
    """
    counts, begin, how = [], 0, (record.recurs, record.vertex)
    for some, both in _histories(stress, record):
        of_some = None if pieces is None else pieces[begin : begin + len(some)]
        counts.append(_count_some(some, both, how, rule, of_some))
        begin += len(some)
    return _joined(counts)


def count_rows_and_residue(
    stress: BlockStress, record: CountedRecord, rule: CycleRule
) -> tuple[BlockCount, BlockResidue]:
    """Count a block as ``count_rows`` does, and keep the residue of every point."""
    counts, residues = [], []
    for some, both in _histories(stress, record):
        counts.append(_count_some(some, both, (record.recurs, False), rule))
        residues.append(residue_of_rows(*both))
    return _joined(counts), BlockResidue.joined(residues)


def try_rows(stress: BlockStress, record: CountedRecord, rule: CycleRule, tried: Trials) -> None:
    """Add the damage of one pass of a block under factors on its stress to the trials."""
    begin = 0
    for some, (membrane, bending) in _histories(stress, record):
        at = slice(begin, begin + len(some))
        begin += len(some)
        refuse_not_finite(membrane, bending)
        totals, histogram = nothing_counted(len(membrane), rule.law)
        of_points = plain(membrane), plain(bending), plain(some.size), plain(some.same_ratio), *own_of(some)
        trials = Trials(*(part[at] for part in tried))
        block = _Histories(*of_points, totals, histogram, trials, no_pieces(len(membrane)))
        _count(block, record.recurs, record.vertex, compiled_rule(rule), buffers_for(membrane.shape[1]))


def _histories(stress: BlockStress, record: CountedRecord) -> Iterator[tuple[BlockStress, tuple[Floats, Floats]]]:
    """A few points at a time, with their membrane and bending stress over time."""
    rows = _rows_at_once(record)
    for first in range(0, len(stress), rows):
        some = stress.at(slice(first, first + rows))
        yield some, (stress_history(some.membrane, record.q), stress_history(some.bending, record.q))


def _joined(counts: Sequence[BlockCount]) -> BlockCount:
    """The points of several counts, one count after the other."""
    return BlockCount(*(np.concatenate([getattr(count, f.name) for count in counts]) for f in fields(BlockCount)))


def _rows_at_once(record: CountedRecord) -> int:
    """How many points at a time: of the record only, so that the bytes do not depend on the machine."""
    return max(1, SAMPLES_AT_ONCE // int(record.q.shape[1]))


def count_histories(
    membrane: Floats, bending: Floats, size: Floats, same_ratio: Floats, residue: Residue, rule: CycleRule
) -> BlockCount:
    """Count membrane + bending and membrane - bending of histories (n, t) [MPa]; the rest is as in ``BlockStress``.

    Raises
    ------
    NumericalError : a sample is not finite
    """
    return _count_some(
        BlockStress(membrane, bending, size, same_ratio), (membrane, bending), (residue == "repeat", False), rule
    )


def _count_some(
    some: BlockStress,
    histories: tuple[Floats, Floats],
    how: tuple[bool, bool],
    rule: CycleRule,
    pieces: Floats | None = None,
) -> BlockCount:
    """Count some points, of which membrane and bending stress over time are given.

    ``how``: whether the record recurs, and whether reversals are read at their vertices. ``pieces``: as
    of ``count_rows``.
    """
    membrane, bending = histories
    refuse_not_finite(membrane, bending)
    laid = no_pieces(len(membrane)) if pieces is None else pieces
    surfaces = laid.shape[1]
    totals, histogram = nothing_counted(len(membrane), rule.law, surfaces=surfaces, ranges=pieces is not None)
    of_points = plain(membrane), plain(bending), plain(some.size), plain(some.same_ratio), *own_of(some)
    block = _Histories(*of_points, totals, histogram, no_trials(len(membrane)), laid)
    _count(block, *how, compiled_rule(rule), buffers_for(membrane.shape[1]))
    return block_count(totals, histogram, rule, some.level[:, :surfaces])


@compiled()
def _count(block: _Histories, recurs: bool, vertex: bool, rule: CompiledRule, buffers: Buffers) -> None:
    """Count the surfaces of every row of the block."""
    s = np.empty(block.membrane.shape[1])
    room = np.empty((3, s.size if vertex else 0))  # membrane, bending and shifts of a history of vertices
    for row in range(block.membrane.shape[0]):
        for surface in range(block.totals.shape[1]):
            side = 1.0 - 2.0 * surface
            for i in range(s.size):
                s[i] = block.membrane[row, i] + side * block.bending[row, i]
            total, histogram = block.totals[row, surface], block.histogram[row, surface]
            tries = block.trials.damage.shape[2] > 0
            if not tries:
                total["mean"], total["kurtosis"] = mean_and_kurtosis(s)
            membrane, bending = block.membrane[row], block.bending[row]
            if vertex:
                shifts(s, recurs, room[2])
                move(membrane, room[2], room[0])
                move(bending, room[2], room[1])
                membrane, bending = room[0], room[1]
                for i in range(s.size):
                    s[i] = membrane[i] + side * bending[i]
            at = row, surface
            own = block.size[row], block.same_ratio[at], block.shear_factor[at], block.offset[at]
            point = Surface(membrane, bending, side, own[0], own[1], own[2], own[3])
            cycles = find_cycles(s, recurs, buffers)
            if tries:
                first, step = block.trials.first[row, surface], block.trials.step[row, surface]
                tally_trials(point, first, step, block.trials.damage[row, surface], rule, buffers, cycles)
                continue
            total["r_largest"] = math.nan
            tally(point, total, histogram, rule, buffers, cycles)
            if block.pieces.shape[2] > 0:
                lay_halves(buffers.start, buffers.end, buffers.damage, cycles, s.size, block.pieces[row, surface])
