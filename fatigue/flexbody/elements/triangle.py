"""Stiffness and mass of a flat three-node shell.

Mindlin bending with assumed transverse shear (MITC3, Lee & Bathe 2004), constant membrane strain, and the drilling
penalty of the quadrilateral. Its membrane is stiffer than that of the quadrilateral, as that of every triangle with
constant strain: meshes have few of them, away from welds. Degrees of freedom per node: ux, uy, uz, rx, ry, rz.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.elements.quad import curvature_matrix, drilling_matrix, plane_strain_matrix
from fatigue.flexbody.elements.section import Section

Floats = NDArray[np.float64]

GRADIENT = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])  # of N = 1 - r - s, r, s by r and s
MIDDLES = np.array([[0.5, 0.0], [0.0, 0.5], [0.5, 0.5]])  # r, s of edges; of weight 1/3, exact for degree 2


def triangle_stiffness(corners: Floats, section: Section) -> Floats:
    """Stiffness K_e (e, 18, 18) in global axes of the elements with these corners (e, 3, 3) [mm]."""
    axes = triangle_axes(corners)
    xy = np.einsum("eij,enj->eni", axes[:, :2], corners - corners.mean(axis=1, keepdims=True))
    J = GRADIENT @ xy
    dN = np.linalg.solve(J, np.broadcast_to(GRADIENT, (len(xy), 2, 3)))
    area = np.linalg.det(J)[:, None, None] / 2
    shears = [_transverse_shear(xy, J, r, s) for r, s in MIDDLES]
    drills = [drilling_matrix(dN, _shape(r, s)) for r, s in MIDDLES]
    membrane, bending, D = plane_strain_matrix(dN), curvature_matrix(dN), section.plane_stress
    K = np.zeros((len(xy), 18, 18))
    for dofs, matrix in (
        ([0, 1], section.t * (membrane.swapaxes(1, 2) @ D @ membrane)),
        ([2, 3, 4], section.bending * (bending.swapaxes(1, 2) @ D @ bending)),
        ([2, 3, 4], section.transverse_shear * _mean_square(shears)),
        ([0, 1, 5], section.drilling * _mean_square(drills)),
    ):
        at = (6 * np.arange(3)[:, None] + dofs).ravel()
        K[:, at[:, None], at] += area * matrix
    T = np.zeros_like(K)
    for block in range(0, 18, 3):
        T[:, block : block + 3, block : block + 3] = axes
    return np.asarray(T.swapaxes(1, 2) @ K @ T)


def triangle_mass(corners: Floats, section: Section) -> Floats:
    """Consistent mass m_e (e, 3, 3) [t] between the nodes of elements with these corners (e, 3, 3).

    It acts alike in all three displacements, and times t_b^2/12 on the rotations.
    """
    return np.asarray((section.area_mass * triangle_areas(corners))[:, None, None] * (np.eye(3) + 1) / 12)


def triangle_areas(corners: Floats) -> Floats:
    """Area (e,) of triangles with these corners (e, 3, 3)."""
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(np.linalg.norm(sides, axis=1) / 2)


def triangle_axes(corners: Floats) -> Floats:
    """Rows x, y, z of each element's axes (e, 3, 3): x along its first edge, z its normal."""
    x = corners[:, 1] - corners[:, 0]
    z = np.cross(x, corners[:, 2] - corners[:, 0])
    x = x / np.linalg.norm(x, axis=1, keepdims=True)
    z = z / np.linalg.norm(z, axis=1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _shape(r: float, s: float) -> Floats:
    return np.array([1 - r - s, r, s])


def _mean_square(strains: list[Floats]) -> Floats:
    """Mean of B' B over the middles of the edges."""
    return np.asarray(sum(B.swapaxes(1, 2) @ B for B in strains) / len(strains))


def _covariant_shear(xy: Floats, J: Floats, r: float, s: float, direction: int) -> Floats:
    """Shear strain along r or s (e, 9): duz/dr + dx/dr ry - dy/dr rx."""
    N = _shape(r, s)
    B = np.zeros((len(xy), 3, 3))
    B[:, :, 0] = GRADIENT[direction]
    B[:, :, 1] = -J[:, direction, 1:] * N
    B[:, :, 2] = J[:, direction, :1] * N
    return B.reshape(len(xy), 9)


def _transverse_shear(xy: Floats, J: Floats, r: float, s: float) -> Floats:
    """Transverse shear strains gxz, gyz (e, 2, 9): constant along each edge, Lee & Bathe 2004, Eq. 27."""
    along_r, along_s = _covariant_shear(xy, J, 0.5, 0.0, 0), _covariant_shear(xy, J, 0.0, 0.5, 1)
    c = along_s - along_r - _covariant_shear(xy, J, 0.5, 0.5, 1) + _covariant_shear(xy, J, 0.5, 0.5, 0)
    return np.asarray(np.linalg.solve(J, np.stack([along_r + c * s, along_s - c * r], axis=1)), dtype=np.float64)
