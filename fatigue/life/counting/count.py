"""The one call that counts: which counter serves a rule and a record."""

from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.chunks import count_chunks
from fatigue.life.counting.record import CountedRecord
from fatigue.life.counting.rows import count_rows
from fatigue.life.counting.single.count import count_single, is_single
from fatigue.life.records.spool import Spool
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
    if isinstance(record.q, Spool) or record.q.shape[1] > LONGEST_ROW:
        return count_chunks(stress, record, rule)
    return count_rows(stress, record, rule)
