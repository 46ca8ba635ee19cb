"""A shell mesh as weld detection needs it: nodes, elements, edges, and the directions in their planes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line_geometry import unit

NONE = -1
"""Index of a corner or a mid-side node an element does not have."""

AT_ONCE = 16384  # elements whose sides are worked out together: what is needed on the way stays small


@dataclass(frozen=True, slots=True, eq=False)
class ShellMesh:
    """Three- and four-sided shells, linear or parabolic.

    Attributes
    ----------
    node : (n,) node ids, ascending
    xyz : (n, 3) coordinates [mm]
    element : (e,) element ids, ascending
    corner : (e, 4) indices into ``node`` round the element; the last is -1 on a triangle
    mid : (e, 4) indices of the mid-side nodes; side k lies between corners k and k + 1; -1 where there is none
    pid : (e,) property ids
    thickness : (e,) thickness [mm], NaN if unknown
    offset : (e,) distance from the nodes to the mid-surface along the element normal [mm]
    """

    node: NDArray[np.int64]
    xyz: NDArray[np.float64]
    element: NDArray[np.int64]
    corner: NDArray[np.int64]
    mid: NDArray[np.int64]
    pid: NDArray[np.int64]
    thickness: NDArray[np.float64]
    offset: NDArray[np.float64]

    def side_ends(self) -> NDArray[np.int64]:
        """Indices of the two end nodes of every side, (e, 4, 2); -1 for the fourth side of a triangle."""
        first = self.corner
        last = np.roll(first, -1, axis=1)
        triangle = first[:, 3] == NONE
        last[triangle, 2] = first[triangle, 0]
        last[triangle, 3] = NONE
        return np.stack([first, last], axis=2)


def centroids(mesh: ShellMesh) -> NDArray[np.float64]:
    """Mean of each element's corners, (e, 3) [mm]."""
    used, total = mesh.corner != NONE, np.zeros((len(mesh.corner), 3))
    for corner, has in zip(mesh.corner.T, used.T, strict=True):
        total += np.where(has[:, None], mesh.xyz[corner], 0.0)
    return np.asarray(total / used.sum(axis=1)[:, None])


def normals(mesh: ShellMesh) -> NDArray[np.float64]:
    """Unit normal of each element by the right-hand rule, (e, 3); zero for an element without area."""
    a, b, c, d = (mesh.xyz[mesh.corner[:, k]] for k in range(4))
    is_triangle = (mesh.corner[:, 3] == NONE)[:, None]
    vector = np.where(is_triangle, np.cross(b - a, c - a), np.cross(c - a, d - b))
    return unit(vector)


def inward(mesh: ShellMesh) -> NDArray[np.float64]:
    """Unit vector from each side into its element, normal to the side, (e, 4, 3); zero on no side."""
    ends, normal = mesh.side_ends(), normals(mesh)
    vector = np.empty((len(ends), 4, 3))
    for first in range(0, len(ends), AT_ONCE):
        some = slice(first, first + AT_ONCE)
        along = mesh.xyz[ends[some, :, 1]] - mesh.xyz[ends[some, :, 0]]
        vector[some] = unit(np.cross(normal[some, None, :], along))
    vector[ends[:, :, 1] == NONE] = 0.0
    return vector
