"""Stiffness of a flat four-node shell.

Mindlin bending with assumed transverse shear (MITC4, Bathe & Dvorkin 1985), membrane with incompatible modes (QM6,
Taylor, Beresford & Wilson 1976), and a small penalty that ties the drilling rotation to the membrane's own rotation, so
that rigid rotations stay free of force. A double skin bends, and gives way to transverse shear, with a thickness of its
own. Degrees of freedom per node: ux, uy, uz, rx, ry, rz.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.elements.bilinear import GAUSS, gradient, in_plane, quad_axes, shape
from fatigue.flexbody.elements.section import Section
from fatigue.flexbody.elements.warp import freed_from_warp

Floats = NDArray[np.float64]
Strain = Callable[[Floats, float, float], tuple[Floats, Floats]]


def quad_stiffness(corners: Floats, section: Section) -> Floats:
    """Stiffness K_e (e, 24, 24) in global axes of the elements with these corners (e, 4, 3) [mm].

    It is the sum of membrane, bending (t_b^3/12), transverse shear (5/6 G t_b) and drilling penalty. The corners of a
    warped element are projected on a plane, and rigid rotations freed of force after it.
    """
    axes = quad_axes(corners)
    xy = in_plane(corners, axes)
    one = np.ones((1, 1, 1))
    K = np.zeros((len(xy), 24, 24))
    for dofs, matrix in (
        ([0, 1], section.t * _membrane(xy, section.plane_stress)),
        ([2, 3, 4], section.bending * _integral(curvature, xy, section.plane_stress)),
        ([2, 3, 4], section.transverse_shear * _integral(_transverse_shear, xy, one * np.eye(2))),
        ([0, 1, 5], section.drilling * _integral(_drilling, xy, one)),
    ):
        at = (6 * np.arange(4)[:, None] + dofs).ravel()
        K[:, at[:, None], at] += matrix
    T = np.zeros_like(K)
    for block in range(0, 24, 3):
        T[:, block : block + 3, block : block + 3] = axes
    return freed_from_warp(T.swapaxes(1, 2) @ K @ T, corners, axes)


def plane_strain_matrix(gradient: Floats) -> Floats:
    """Strains exx, eyy, gxy (e, 3, 2 k) from the u and v of k functions with the gradient (e, 2, k)."""
    B = np.zeros((len(gradient), 3, gradient.shape[2], 2))
    B[:, 0, :, 0] = B[:, 2, :, 1] = gradient[:, 0]
    B[:, 1, :, 1] = B[:, 2, :, 0] = gradient[:, 1]
    return B.reshape(len(B), 3, -1)


def curvature(xy: Floats, xi: float, eta: float) -> tuple[Floats, Floats]:
    """Curvatures of u = z ry, v = -z rx (e, 3, 12), from uz, rx, ry; and the Jacobian matrix (e, 2, 2)."""
    dN, J = gradient(xy, xi, eta)
    return curvature_matrix(dN), J


def curvature_matrix(gradient: Floats) -> Floats:
    """Curvatures (e, 3, 3 k) of u = z ry, v = -z rx from the uz, rx, ry of k functions with the gradient (e, 2, k)."""
    B = np.zeros((len(gradient), 3, gradient.shape[2], 3))
    B[:, 0, :, 2] = B[:, 2, :, 1] = gradient[:, 0]
    B[:, 1, :, 1] = B[:, 2, :, 2] = gradient[:, 1]
    B[:, 1:, :, 1] *= -1
    return B.reshape(len(B), 3, -1)


def drilling_matrix(gradient: Floats, N: Floats) -> Floats:
    """Drilling rotation less the membrane's own, rz - (dv/dx - du/dy)/2 (e, 1, 3 k), from ux, uy, rz."""
    B = np.stack([gradient[:, 1] / 2, -gradient[:, 0] / 2, np.broadcast_to(N, gradient[:, 0].shape)], axis=-1)
    return B.reshape(len(B), 1, -1)


def _integral(strain: Strain, xy: Floats, D: Floats) -> Floats:
    """Integral of B' D B over each element."""
    total = np.zeros(1)
    for xi, eta in GAUSS:
        B, J = strain(xy, xi, eta)
        total = total + B.swapaxes(1, 2) @ D @ B * np.linalg.det(J)[:, None, None]
    return total


def _membrane(xy: Floats, D: Floats) -> Floats:
    """Plane stiffness per thickness (e, 8, 8) of the bilinear quad with four condensed incompatible modes."""
    J0 = gradient(xy, 0.0, 0.0)[1]
    j0 = np.linalg.det(J0)
    K, L, Q = np.zeros(1), np.zeros(1), np.zeros(1)
    for xi, eta in GAUSS:
        dN, J = gradient(xy, xi, eta)
        j = np.linalg.det(J)
        # 1 - xi^2 and 1 - eta^2, mapped by the Jacobian of the centre and scaled by j0 / j: the patch test holds
        bubbles = np.broadcast_to(np.diag([-2 * xi, -2 * eta]), (len(xy), 2, 2))
        dP = np.linalg.solve(J0, bubbles) * (j0 / j)[:, None, None]
        B, C = plane_strain_matrix(dN), plane_strain_matrix(dP)
        weight = j[:, None, None]
        K = K + B.swapaxes(1, 2) @ D @ B * weight
        L = L + C.swapaxes(1, 2) @ D @ B * weight
        Q = Q + C.swapaxes(1, 2) @ D @ C * weight
    return np.asarray(K - L.swapaxes(1, 2) @ np.linalg.solve(Q, L))


def _covariant_shear(xy: Floats, xi: float, eta: float, direction: int) -> Floats:
    """Shear strain along the natural coordinate ``direction`` (e, 12): duz/dxi + dx/dxi ry - dy/dxi rx."""
    N, dN = shape(xi, eta)
    dx = dN[direction] @ xy
    B = np.zeros((len(xy), 4, 3))
    B[:, :, 0] = dN[direction]
    B[:, :, 1] = -dx[:, 1:] * N
    B[:, :, 2] = dx[:, :1] * N
    return B.reshape(len(xy), 12)


def _transverse_shear(xy: Floats, xi: float, eta: float) -> tuple[Floats, Floats]:
    """Transverse shear strains gxz, gyz (e, 2, 12), interpolated between the middles of opposite edges."""
    J = gradient(xy, xi, eta)[1]
    along_xi = [(1 + sign * eta) / 2 * _covariant_shear(xy, 0.0, sign, 0) for sign in (-1, 1)]
    along_eta = [(1 + sign * xi) / 2 * _covariant_shear(xy, sign, 0.0, 1) for sign in (-1, 1)]
    along = np.stack([along_xi[0] + along_xi[1], along_eta[0] + along_eta[1]], axis=1)
    return np.asarray(np.linalg.solve(J, along), dtype=np.float64), J


def _drilling(xy: Floats, xi: float, eta: float) -> tuple[Floats, Floats]:
    """Drilling rotation less the membrane's own (e, 1, 12), and the Jacobian matrix."""
    dN, J = gradient(xy, xi, eta)
    return drilling_matrix(dN, shape(xi, eta)[0]), J
