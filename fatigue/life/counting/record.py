"""One pass of an event as it is counted."""

from dataclasses import dataclass

from fatigue.life.counting.single.record import SingleRecord
from fatigue.life.records.history import Residue
from fatigue.life.records.spool import Samples


@dataclass(frozen=True, slots=True, eq=False)
class CountedRecord:
    """The modal coordinates of one pass, shared by all points; threads may read it at the same time.

    Attributes
    ----------
    q : (m, t) modal coordinates, in memory or on disk
    residue : whether the pass recurs, or what does not close is half cycles
    single : the same prepared for the counter in single precision; None: double precision counts
    """

    q: Samples
    residue: Residue
    single: SingleRecord | None = None

    @property
    def recurs(self) -> bool:
        """Whether the pass is a block that recurs for ever."""
        return self.residue == "repeat"
