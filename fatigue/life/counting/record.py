"""One pass of an event as it is counted, and its copy in single precision."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import Residue
from fatigue.life.records.spool import Samples, Spool

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class SingleRecord:
    """Modal coordinates in single precision, and what takes them back; threads may read it at the same time.

    Attributes
    ----------
    q : without their mean and over ``scale``: in memory as ``single.kernels.product`` lays them out, or (m, t) on disk
    scale : (m,) powers of 2 near the standard deviations
    mean : (m,) time mean
    covariance : (m, m)
    """

    q: NDArray[np.float32] | Spool
    scale: Floats
    mean: Floats
    covariance: Floats


@dataclass(frozen=True, slots=True, eq=False)
class CountedRecord:
    """The modal coordinates of one pass, shared by all points; threads may read it at the same time.

    Attributes
    ----------
    q : (m, t) modal coordinates, in memory or on disk
    residue : whether the pass recurs, or what does not close is half cycles
    single : the same prepared for the counter in single precision; None: double precision counts
    vertex : whether reversals are read at their vertices, see ``fatigue.life.counting.vertex``
    """

    q: Samples
    residue: Residue
    single: SingleRecord | None = None
    vertex: bool = False

    @property
    def recurs(self) -> bool:
        """Whether the pass is a block that recurs for ever."""
        return self.residue == "repeat"
