"""Stiffness and mass of a flat three-node shell.

Bending and transverse shear of the discrete Kirchhoff-Mindlin triangle (DKMT, Katili 1993): the shear of each edge is
constant and in equilibrium with its bending, so that a thin plate has none and does not lock. Constant membrane strain,
and the drilling penalty of the quadrilateral. The membrane is stiffer than that of the quadrilateral, as that of every
triangle with constant strain: meshes have few of them, away from welds. Degrees of freedom per node: ux, uy, uz, rx,
ry, rz.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.elements.quad import curvature_matrix, drilling_matrix, plane_strain_matrix
from fatigue.flexbody.elements.section import Section

Floats = NDArray[np.float64]

GRADIENT = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])  # of N = 1 - r - s, r, s by r and s
EDGES = ((0, 1), (1, 2), (2, 0))
MIDDLES = np.array([[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])  # r, s of the edges; of weight 1/3, exact for degree 2


def triangle_stiffness(corners: Floats, section: Section) -> Floats:
    """Stiffness K_e (e, 18, 18) in global axes of the elements with these corners (e, 3, 3) [mm]."""
    axes = triangle_axes(corners)
    xy = np.einsum("eij,enj->eni", axes[:, :2], corners - corners.mean(axis=1, keepdims=True))
    J = GRADIENT @ xy
    dN = np.asarray(np.linalg.solve(J, np.broadcast_to(GRADIENT, (len(xy), 2, 3))), dtype=np.float64)
    area = np.linalg.det(J)[:, None, None] / 2
    edge_shear, phi = _edge_shear(xy), _shear_of_edges(xy, section)
    membrane, D = plane_strain_matrix(dN), section.plane_stress
    bending = [curvature_matrix(dN) + _curvature_of_edges(xy, dN, _shape(r, s), edge_shear, phi) for r, s in MIDDLES]
    carried = (phi / (1 + phi))[:, :, None] * edge_shear
    shears = [_transverse_shear(J, r, s, carried) for r, s in MIDDLES]
    drills = [drilling_matrix(dN, _shape(r, s)) for r, s in MIDDLES]
    K = np.zeros((len(xy), 18, 18))
    for dofs, matrix in (
        ([0, 1], section.t * (membrane.swapaxes(1, 2) @ D @ membrane)),
        ([2, 3, 4], section.bending * _mean(bending, D)),
        ([2, 3, 4], section.transverse_shear * _mean(shears, np.eye(2))),
        ([0, 1, 5], section.drilling * _mean(drills, np.eye(1))),
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


def _mean(strains: list[Floats], D: Floats) -> Floats:
    """Mean of B' D B over the middles of the edges."""
    return np.asarray(sum(B.swapaxes(1, 2) @ D @ B for B in strains) / len(strains))


def _edge_shear(xy: Floats) -> Floats:
    """Shear along each edge with linear rotations (e, 3, 9), times its length: uz_j - uz_i + mean of dx ry - dy rx."""
    B = np.zeros((len(xy), 3, 3, 3))
    for edge, (i, j) in enumerate(EDGES):
        d = xy[:, j] - xy[:, i]
        B[:, edge, i, 0], B[:, edge, j, 0] = -1.0, 1.0
        for corner in (i, j):
            B[:, edge, corner, 1], B[:, edge, corner, 2] = -d[:, 1] / 2, d[:, 0] / 2
    return B.reshape(len(xy), 3, 9)


def _shear_of_edges(xy: Floats, section: Section) -> Floats:
    """Flexibility in shear over that in bending of each edge (e, 3), 12 D_b/(D_s L^2): 0 of a thin plate."""
    squared = np.stack([np.sum((xy[:, j] - xy[:, i]) ** 2, axis=1) for i, j in EDGES], axis=1)
    D_b = section.plane_stress[:, 0, 0] * section.bending[:, 0, 0]
    return np.asarray(12 * (D_b / section.transverse_shear[:, 0, 0])[:, None] / squared)


def _curvature_of_edges(xy: Floats, dN: Floats, N: Floats, edge_shear: Floats, phi: Floats) -> Floats:
    """Curvatures (e, 3, 9) of rotations that bulge along the edges by ``-3/(2 (1 + phi) L)`` of their shear."""
    total = np.zeros((len(xy), 3, 9))
    for edge, (i, j) in enumerate(EDGES):
        d = xy[:, j] - xy[:, i]
        P = 4 * (N[i] * dN[:, :, j] + N[j] * dN[:, :, i])  # gradient of the bulge 4 N_i N_j
        bulge = np.stack([P[:, 0] * d[:, 0], P[:, 1] * d[:, 1], P[:, 1] * d[:, 0] + P[:, 0] * d[:, 1]], axis=1)
        size = -1.5 / ((1 + phi[:, edge]) * np.sum(d**2, axis=1))
        total += (size[:, None] * bulge)[:, :, None] * edge_shear[:, edge, None, :]
    return total


def _transverse_shear(J: Floats, r: float, s: float, of_edges: Floats) -> Floats:
    """Transverse shear strains gxz, gyz (e, 2, 9) with those ``of_edges`` (e, 3, 9), constant along each."""
    along_r, along_s = of_edges[:, 0], -of_edges[:, 2]
    c = along_s - along_r - of_edges[:, 1]
    return np.asarray(np.linalg.solve(J, np.stack([along_r + c * s, along_s - c * r], axis=1)), dtype=np.float64)
