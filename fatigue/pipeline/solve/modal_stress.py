"""Structural stress of some stations per unit modal coordinate, with what turns its ranges into damage."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.rule import CycleRule


@dataclass(frozen=True, slots=True, eq=False)
class RawEnds:
    """Stations of a block whose stress the end treatment changes, and their stress without it.

    ``rows`` (e,) are ascending, ``membrane`` and ``bending`` (e, m) as in `Shapes`; ``matters`` (e,) is False where
    the damage without treatment is proven to be too small to be worth counting.
    """

    rows: NDArray[np.intp]
    membrane: NDArray[np.float64]
    bending: NDArray[np.float64]
    matters: NDArray[np.bool_]

    def at(self, rows: NDArray[np.intp]) -> Self:
        """Take those among some ascending rows of the block."""
        _, mine, theirs = np.intersect1d(self.rows, rows, assume_unique=True, return_indices=True)
        return type(self)(theirs, self.membrane[mine], self.bending[mine], self.matters[mine])


NO_ENDS = RawEnds(np.zeros(0, np.intp), np.zeros((0, 0)), np.zeros((0, 0)), np.zeros(0, np.bool_))


@dataclass(frozen=True, slots=True, eq=False)
class Shapes:
    """Structural stress shapes of a block of stations that share one S-N curve.

    ``membrane``, ``bending``, ``in_plane_shear``, ``twist_shear`` are (n, m) [MPa per unit modal coordinate], bending
    and twist those of the top face; ``size`` (n,) turns a structural stress range over ``I(r)^(1/m)`` into the
    equivalent range of the ``rule``. ``raw_ends`` are among them.
    """

    membrane: NDArray[np.float64]
    bending: NDArray[np.float64]
    in_plane_shear: NDArray[np.float64]
    twist_shear: NDArray[np.float64]
    size: NDArray[np.float64]
    rule: CycleRule
    raw_ends: RawEnds = NO_ENDS

    def __len__(self) -> int:
        """Count the stations."""
        return len(self.size)

    def at(self, rows: NDArray[np.intp]) -> Self:
        """Take some stations, ascending."""
        return replace(
            self,
            membrane=self.membrane[rows],
            bending=self.bending[rows],
            in_plane_shear=self.in_plane_shear[rows],
            twist_shear=self.twist_shear[rows],
            size=self.size[rows],
            raw_ends=self.raw_ends.at(rows),
        )


def faces(mean: NDArray[np.float64], gradient: NDArray[np.float64]) -> NDArray[np.float64]:
    """Shapes at both faces, (n, 2, m): top = mean + gradient part, bottom = mean - gradient part."""
    return np.stack([mean + gradient, mean - gradient], axis=1)
