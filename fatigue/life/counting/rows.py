"""Counting whole rows in double precision, for any law: the plain reading of the standard that all else is tested by.

The reversals of each row are found and paired, and membrane and bending stress at the two instants of every cycle give
its damage, with the exact ranges. Only how cycles are found is compiled, so that the first of them are there soon.
"""

from collections.abc import Iterator, Sequence
from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.factors import Trials, add_trials
from fatigue.life.counting.moments import mean_and_kurtosis
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.residue import BlockResidue, residue_of_rows
from fatigue.life.counting.reversals import cycles_of
from fatigue.life.counting.tally import (
    SurfaceCycles,
    block_count,
    nothing_counted,
    plain,
    refuse_not_finite,
    tally,
)
from fatigue.life.counting.vertex import vertex_history
from fatigue.life.records.history import Residue, stress_history
from fatigue.life.rule import CycleRule

Floats = NDArray[np.float64]

SAMPLES_AT_ONCE = 4_000_000  # stress samples of one component recovered before they are counted: 32 MB
CACHED = 131_072  # samples of one component counted at a time: they stay in the second-level cache


def count_rows(
    stress: BlockStress,
    record: CountedRecord,
    rule: CycleRule,
    *,
    pieces: Floats | None = None,
    faces: Sequence[int] = (0, 1),
) -> BlockCount:
    """Count a block as ``count`` does: the histories of a few points at a time.

    With ``pieces`` (n, 2, p), to which the damage in p equal pieces of the record is added, there are bins of all
    ranges: see ``nothing_counted``. Only ``faces`` are counted, 0 top and 1 bottom; nothing is on others.
    """
    counts, begin, how = [], 0, (record.recurs, record.vertex)
    for some, both in _histories(stress, record):
        of_some = None if pieces is None else pieces[begin : begin + len(some)]
        counts.append(_count_some(some, both, how, rule, of_some, faces))
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
        trials = tried.at(at)
        for rows in _cached(membrane):
            for face in range(2):
                found, _ = _cycles(membrane[rows], bending[rows], face, record.recurs, record.vertex)
                add_trials(found, some.at(rows), rule, trials.at(rows))


def _histories(stress: BlockStress, record: CountedRecord) -> Iterator[tuple[BlockStress, tuple[Floats, Floats]]]:
    """A few points at a time, with their membrane and bending stress over time."""
    rows = _rows_at_once(record)
    for first in range(0, len(stress), rows):
        some = stress.at(slice(first, first + rows))
        both = stress_history(np.concatenate([some.membrane, some.bending]), record.q)  # a record on disk is read once
        yield some, (both[: len(some)], both[len(some) :])


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
    faces: Sequence[int] = (0, 1),
) -> BlockCount:
    """Count some points, of which membrane and bending stress over time are given.

    ``how``: whether the record recurs, and whether reversals are read at their vertices. ``pieces`` and
    ``faces``: as of ``count_rows``.
    """
    membrane, bending = (plain(part) for part in histories)
    refuse_not_finite(membrane, bending)
    counted = nothing_counted(len(membrane), rule.law, pieces)
    for rows in _cached(membrane):
        of_rows, sums = some.at(rows), counted.at(rows)
        for face in faces:
            found, s = _cycles(membrane[rows], bending[rows], face, *how)
            if pieces is None:
                sums.totals["mean"][:, face], sums.totals["kurtosis"][:, face] = mean_and_kurtosis(s)
            tally(found, of_rows, rule, sums, membrane.shape[1])
    return block_count(counted, rule, some.level)


def _cached(membrane: Floats) -> Iterator[slice]:
    """Few rows at a time."""
    rows = max(1, CACHED // max(1, membrane.shape[1]))
    for first in range(0, len(membrane), rows):
        yield slice(first, first + rows)


def _cycles(membrane: Floats, bending: Floats, face: int, recurs: bool, vertex: bool) -> tuple[SurfaceCycles, Floats]:
    """Cycles of one face, 0 top or 1 bottom, of some histories (n, t), and the stress there as it was sampled."""
    side = 1.0 - 2.0 * face
    s = sampled = plain(membrane + side * bending)
    if vertex:
        moved = [vertex_history(*of_point, side, recurs=recurs) for of_point in zip(membrane, bending, strict=True)]
        membrane, bending = np.stack([m for m, _, _ in moved]), np.stack([b for _, b, _ in moved])
        s = membrane + side * bending
    found = cycles_of(s, recurs=recurs)
    row = np.repeat(np.arange(len(s)), found.number)
    at = np.stack([found.start, found.end])
    return SurfaceCycles(2 * row + face, membrane[row, at], bending[row, at], found.weight, at), sampled
