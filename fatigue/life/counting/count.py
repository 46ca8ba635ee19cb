"""The one call that counts, as the stress is or under factors on it: which counter serves a rule and a record."""

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import HISTOGRAM_BINS, BlockCount, BlockStress
from fatigue.life.counting.chunks import count_chunks, count_chunks_and_residue, try_chunks
from fatigue.life.counting.factors import trials
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.residue import BlockResidue
from fatigue.life.counting.rows import count_rows, count_rows_and_residue, try_rows
from fatigue.life.counting.single.count import count_single, count_single_and_residue, is_single
from fatigue.life.rule import CycleRule

LONGEST_ROW = 250_000  # samples of a record of which 16 rows at a time are worth a matrix product


def count(stress: BlockStress, record: CountedRecord, rule: CycleRule) -> BlockCount:
    """Count top and bottom stress of a block, membrane + bending and membrane - bending, and sum the damage.

    No point depends on another. See ``fatigue.life.counting`` for the counters.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    if is_single(record, rule):
        return count_single(stress, record, rule)
    return count_chunks(stress, record, rule) if _is_long(record) else count_rows(stress, record, rule)


def count_and_residue(stress: BlockStress, record: CountedRecord, rule: CycleRule) -> tuple[BlockCount, BlockResidue]:
    """Count a block as ``count`` does, and keep the residue of every point; it has no constant of ``offset`` in it.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    if is_single(record, rule):
        return count_single_and_residue(stress, record, rule)
    counted = count_chunks_and_residue if _is_long(record) else count_rows_and_residue
    return counted(stress, record, rule)


def count_histograms(stress: BlockStress, record: CountedRecord, rule: CycleRule) -> NDArray[np.float64]:
    """Histograms (n, 2, 2, HISTOGRAM_BINS, 2) of the cycles of one pass at both surfaces: of S, then of dS.

    Each bin has sum n and sum n x**k, k the first slope; see ``block.HISTOGRAM_EDGES``. In double precision.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    return count_histograms_and_pieces(stress, record, rule, 0)[0]


def count_histograms_and_pieces(
    stress: BlockStress, record: CountedRecord, rule: CycleRule, pieces: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Histograms as of ``count_histograms``, and the damage (n, 2, ``pieces``) in equal pieces of the record.

    The piece of a sample i of N is ``floor(pieces i / N)``; half of the damage of a cycle goes to each of its instants.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    laid = np.zeros((len(stress), 2, pieces))
    counted = (count_chunks if _is_long(record) else count_rows)(stress, record, rule, pieces=laid)
    return counted.histogram.reshape(len(stress), 2, 2, HISTOGRAM_BINS, 2)[:, :, ::-1], laid


def count_top_and_pieces(
    stress: BlockStress, record: CountedRecord, rule: CycleRule, pieces: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Histograms (n, 2, HISTOGRAM_BINS, 2) and pieces (n, ``pieces``) of ``count_histograms_and_pieces``, of the top.

    The bottom of a point is the top of the same point with its bending stress reversed.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    if _is_long(record):
        histograms, laid = count_histograms_and_pieces(stress, record, rule, pieces)
        return histograms[:, 0], laid[:, 0]
    laid = np.zeros((len(stress), 2, pieces))
    counted = count_rows(stress, record, rule, pieces=laid, faces=(0,))
    return counted.histogram[:, 0].reshape(len(stress), 2, HISTOGRAM_BINS, 2)[:, ::-1], laid[:, 0]


def count_at_factors(
    stress: BlockStress,
    record: CountedRecord,
    rule: CycleRule,
    first: NDArray[np.float64],
    step: NDArray[np.float64],
    factors: int,
) -> NDArray[np.float64]:
    """Damage (n, 2, g) of one pass of a block with all stresses times ``first exp(i step)``, i < g ``factors``.

    ``first`` and ``step`` (n, 2) are of each surface; where ``first`` is 0 the damage is not wanted, and 0. In double
    precision; the mean-stress factor applies to a cycle as it does at each of the factors.

    Raises
    ------
    NumericalError : a stress is not finite
    """
    tried = trials(first, step, factors)
    (try_chunks if _is_long(record) else try_rows)(stress, record, rule, tried)
    return tried.damage


def _is_long(record: CountedRecord) -> bool:
    return int(record.q.shape[1]) > LONGEST_ROW
