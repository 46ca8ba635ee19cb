"""Structural stress of some stations per unit modal coordinate, with what turns its ranges into damage."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.rule import CycleRule
from fatigue.weld.structural_stress import RawEnds


@dataclass(frozen=True, slots=True, eq=False)
class ModalStress:
    """Structural stress of a block of stations that share one S-N curve, per unit modal coordinate.

    Attributes
    ----------
    membrane, bending : (n, m) normal stress with treated ends, bending of the top face [MPa per unit modal coordinate]
    in_plane_shear, twist_shear : (n, m) shear stress likewise
    size : (n,) factor of the thickness on the range
    rule : how the damage of a cycle follows from its range
    raw_ends : e stations whose stress the end treatment changes, and their stress before it
    raw_end_matters : (e,) False where the damage of a raw end is proven to be too small to be worth counting
    """

    membrane: NDArray[np.float64]
    bending: NDArray[np.float64]
    in_plane_shear: NDArray[np.float64]
    twist_shear: NDArray[np.float64]
    size: NDArray[np.float64]
    rule: CycleRule
    raw_ends: RawEnds
    raw_end_matters: NDArray[np.bool_]

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
            raw_end_matters=self.raw_end_matters[np.isin(self.raw_ends.rows, rows)],
        )


def faces(mean: NDArray[np.float64], gradient: NDArray[np.float64]) -> NDArray[np.float64]:
    """Modal stress at both faces, (n, 2, m): the mean + the gradient part at the top, - at the bottom."""
    return np.stack([mean + gradient, mean - gradient], axis=1)
