"""The axes in which NASTRAN solvers state the stresses of shells, and the way from there into the frame of a point.

CQUAD4 and CQUADR: x bisects the angle of the diagonals, from corner 1 to 3 and from 4 to 2, wherever in the element
(MSC and NX element libraries; OptiStruct 2021, element results representation: "the bi-sector system for CQUAD4
elements ... and the G1-G2 system for CTRIA3 elements" in OUTPUT2 files). CTRIA3, CTRIAR and CTRIA6: x runs from corner
1 to 2. CQUAD8: x and y lie at equal angles from the lines of constant eta and xi at the point itself.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line_geometry import unit
from fatigue.weld.mesh import NONE, ShellMesh, normals

Floats = NDArray[np.float64]
BEFORE, AFTER = (3, 0, 1, 2), (1, 2, 3, 0)


def element_axes(mesh: ShellMesh) -> Floats:
    """Axes of all elements, one in each row, (e, 3, 3): x as their solver has it, z their normal."""
    a, b, c, d = (mesh.xyz[mesh.corner[:, k]] for k in range(4))
    z = normals(mesh)
    is_triangle = (mesh.corner[:, 3] == NONE)[:, None]
    is_parabolic = (mesh.mid != NONE).any(axis=1)[:, None]
    bisector = unit(c - a) + unit(b - d)
    centre = unit(b + c - a - d) + np.cross(unit(c + d - a - b), z)
    return _axes(np.where(is_triangle, b - a, np.where(is_parabolic, centre, bisector)), z)


def corner_axes(mesh: ShellMesh, element: int, corner: int) -> Floats:
    """Axes (3, 3) at one corner of a parabolic quadrangle, from its tangents there."""
    xi, eta = corner_tangents(mesh, element, corner)
    z = unit(np.cross(xi, eta))
    return np.asarray(_axes((xi + np.cross(eta, z))[None], z[None])[0])


def corner_tangents(mesh: ShellMesh, element: int, corner: int) -> tuple[Floats, Floats]:
    """Unit tangents (3,) at a corner, along its sides, in the senses in which xi and eta grow."""
    xyz, nodes, mids = mesh.xyz, mesh.corner[element], mesh.mid[element]

    def away(other: int, side: int) -> Floats:
        """Tangent at the corner along a side that leads to another corner."""
        chord = xyz[nodes[other]] - xyz[nodes[corner]]
        if mids[side] != NONE:
            chord = 4.0 * (xyz[mids[side]] - xyz[nodes[corner]]) - chord
        return unit(chord)

    on, back = away(AFTER[corner], corner), away(BEFORE[corner], BEFORE[corner])
    along = {0: (on, back), 1: (-back, on), 2: (-on, -back), 3: (back, -on)}
    return along[corner]


def _axes(x: Floats, z: Floats) -> Floats:
    """Right-handed axes (e, 3, 3) of normals and of directions that are turned into their planes."""
    x = unit(x - np.sum(x * z, axis=1)[:, None] * z)
    return np.stack([x, np.cross(z, x), z], axis=1)


def into_frame(axes: Floats, x: Floats, normal: Floats) -> Floats:
    """Matrix (3, 3) that turns sx, sy, txy of ``axes`` into those of the frame of x and normal.

    The frame is laid into the plane of the element, whose normal may point to the other side.

    >>> turned = into_frame(np.eye(3), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, -1.0]))
    >>> (turned @ np.array([1.0, 2.0, 3.0])).tolist()
    [2.0, 1.0, 3.0]
    """
    z = axes[2] if axes[2] @ normal >= 0 else -axes[2]
    first = unit(x - (x @ z) * z)
    c, s = axes[:2] @ first
    d, e = axes[:2] @ np.cross(z, first)
    return np.array([[c * c, s * s, 2 * c * s], [d * d, e * e, 2 * d * e], [c * d, s * e, c * e + s * d]])
