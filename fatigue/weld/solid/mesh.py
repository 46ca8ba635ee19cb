"""A solid mesh as weld detection needs it: hexahedra and pentahedra whose nodes stand in columns through a plate."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class SolidMesh:
    """Hexahedra, pentahedra and tetrahedra, linear or parabolic.

    Attributes
    ----------
    node : (n,) node ids, ascending
    xyz : (n, 3) coordinates [mm]
    element : (e,) element ids, ascending
    corner : (e, 8) indices into ``node``: of a hexahedron round its bottom, 4, and its top, 4; of a pentahedron round
        its bottom, 3, and its top, 3, then -1; of a tetrahedron 4, then -1
    mid : (e, 12) indices of the mid-side nodes, -1 where there is none: of a hexahedron round the bottom, 4, of the
        edges between bottom and top, 4, and round the top, 4; of a pentahedron 3, 3 and 3 alike, then -1; of a
        tetrahedron 6, then -1
    pid : (e,) property ids
    """

    node: NDArray[np.int64]
    xyz: NDArray[np.float64]
    element: NDArray[np.int64]
    corner: NDArray[np.int64]
    mid: NDArray[np.int64]
    pid: NDArray[np.int64]

    @property
    def corners(self) -> NDArray[np.int64]:
        """Number of corners of each element, (e,): 8, 6 or 4."""
        return np.asarray((self.corner >= 0).sum(axis=1))
