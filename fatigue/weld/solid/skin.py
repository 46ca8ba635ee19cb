"""The skin of a solid mesh: its free faces as a mesh of surface elements, on which weld lines are found as on shells.

Two solids that share a face lie side by side; a face that only one solid has is free. The free faces, turned so that
their normals point out of the material, are a closed surface.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.mesh import NONE, ShellMesh
from fatigue.weld.solid.mesh import SolidMesh

FREE, BRANCHES = -1, -2
"""What lies beyond a face: nothing; several solids."""

SIDES = 6
"""Faces of a hexahedron; other solids have fewer."""


@dataclass(frozen=True, slots=True)
class _Form:
    """Local numbers of a solid: corners of every face, seen from outside; mid-side nodes by the two ends of an edge.

    ``opposite`` is, of every face, the one beyond and its corners, each behind one of the face; (-1, ()) without any.
    """

    faces: tuple[tuple[int, ...], ...]
    mids: dict[frozenset[int], int]
    opposite: tuple[tuple[int, tuple[int, ...]], ...]


def _mids(*edges: tuple[int, int]) -> dict[frozenset[int], int]:
    return {frozenset(edge): k for k, edge in enumerate(edges)}


_HEXA = _Form(
    ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    _mids(*((0, 1), (1, 2), (2, 3), (3, 0)), *((0, 4), (1, 5), (2, 6), (3, 7)), *((4, 5), (5, 6), (6, 7), (7, 4))),
    (
        *((1, (4, 7, 6, 5)), (0, (0, 1, 2, 3))),
        *((4, (3, 2, 6, 7)), (5, (0, 3, 7, 4)), (2, (1, 0, 4, 5)), (3, (2, 1, 5, 6))),
    ),
)
_NOTHING = (-1, ())
_PENTA = _Form(
    ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    _mids(*((0, 1), (1, 2), (2, 0)), *((0, 3), (1, 4), (2, 5)), *((3, 4), (4, 5), (5, 3))),
    ((1, (3, 5, 4)), (0, (0, 1, 2)), _NOTHING, _NOTHING, _NOTHING),
)
_TETRA = _Form(
    ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    _mids((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    (_NOTHING,) * 4,
)
FORMS = {8: _HEXA, 6: _PENTA, 4: _TETRA}
"""Local numbers of solids by their number of corners."""


@dataclass(frozen=True, slots=True, eq=False)
class Skin:
    """Free faces of a solid mesh, and what lies beyond every face; a *face* is 6 x solid + its number in the solid.

    Attributes
    ----------
    solids : the mesh
    mesh : the free faces as surface elements numbered from 1, normals out of the material; thickness NaN
    face : (f,) face of every surface element
    beyond : (6 e,) face of the neighbour that is the same face, ``FREE`` or ``BRANCHES``
    """

    solids: SolidMesh
    mesh: ShellMesh
    face: NDArray[np.int64]
    beyond: NDArray[np.int64]


def skin_of(solids: SolidMesh) -> Skin:
    """Skin of a solid mesh."""
    corner, mid, face = _all_faces(solids)
    key = np.sort(corner, axis=1)
    order = np.lexsort(key.T)
    starts = np.flatnonzero(np.append(True, (np.diff(key[order], axis=0) != 0).any(axis=1)))
    count = np.diff(np.append(starts, order.size))
    beyond = np.full(SIDES * solids.element.size, FREE, np.int64)
    first, second = order[starts[count == 2]], order[starts[count == 2] + 1]
    beyond[face[first]], beyond[face[second]] = face[second], face[first]
    several = np.repeat(count > 2, count)
    beyond[face[order[several]]] = BRANCHES
    free = np.sort(order[starts[count == 1]])
    corner, mid, face = corner[free], mid[free], face[free]
    corner, mid = _turned_out(solids, corner, mid, face // SIDES)
    mesh = ShellMesh(
        node=solids.node,
        xyz=solids.xyz,
        element=np.arange(1, free.size + 1),
        corner=corner,
        mid=mid,
        pid=solids.pid[face // SIDES],
        thickness=np.full(free.size, np.nan),
        offset=np.zeros(free.size),
    )
    return Skin(solids, mesh, face, beyond)


def _all_faces(solids: SolidMesh) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Corners (k, 4) and mid-side nodes (k, 4) of the faces of all solids, and their numbers (k,), ascending."""
    corners, mids, faces = [], [], []
    for size, form in FORMS.items():
        rows = np.flatnonzero(solids.corners == size)
        for number, local in enumerate(form.faces):
            padding = [NONE] * (4 - len(local))
            ends = zip(local, [*local[1:], local[0]], strict=True)
            at = [form.mids[frozenset(edge)] for edge in ends]
            own, own_mid = np.full((rows.size, 4), NONE), np.full((rows.size, 4), NONE)
            own[:, : 4 - len(padding)] = solids.corner[rows][:, list(local)]
            own_mid[:, : 4 - len(padding)] = solids.mid[rows][:, at]
            corners.append(own)
            mids.append(own_mid)
            faces.append(SIDES * rows + number)
    face = np.concatenate(faces)
    order = np.argsort(face)
    return np.concatenate(corners)[order], np.concatenate(mids)[order], face[order]


def _turned_out(
    solids: SolidMesh, corner: NDArray[np.int64], mid: NDArray[np.int64], solid: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Faces whose normals point away from the centres of their solids, whichever way these are numbered."""
    own = solids.corner[solid]
    centre = np.where((own != NONE)[:, :, None], solids.xyz[own], 0.0).sum(axis=1) / solids.corners[solid, None]
    a, b, c, d = (solids.xyz[corner[:, k]] for k in range(4))
    triangle = corner[:, 3] == NONE
    normal = np.where(triangle[:, None], np.cross(b - a, c - a), np.cross(c - a, d - b))
    middle = np.where(triangle[:, None], (a + b + c) / 3, (a + b + c + d) / 4)
    inside = np.einsum("ij,ij->i", normal, middle - centre) < 0
    corner, mid = corner.copy(), mid.copy()
    for size, which in ((3, inside & triangle), (4, inside & ~triangle)):
        back = [0, *range(size - 1, 0, -1)]
        corner[which, :size] = corner[which][:, back]
        mid[which, :size] = mid[which][:, list(range(size - 1, -1, -1))]
    return corner, mid
