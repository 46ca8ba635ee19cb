"""Warped quadrilaterals: rigid rotations freed of force.

The stiffness of a flat element, put at corners that lie beside its plane, resists rigid rotations, and its forces have
a moment that nothing balances. The projector of Rankin and Nour-Omid (1988) takes the mean rigid rotation out of the
displacements, and with it the unbalanced moment out of the forces. A flat element stays as it is.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FLAT = 1e-12  # of the diagonal: less is rounding of the corners


def warp(corners: Floats, axes: Floats) -> Floats:
    """Distance of the corners from the plane of each element (e,) [mm]: all four have it, by turns above and below."""
    return np.asarray(np.abs(np.einsum("ej,ej->e", axes[:, 2], corners[:, 0] - corners.mean(axis=1))))


def freed_from_warp(K: Floats, corners: Floats, axes: Floats) -> Floats:
    """Stiffness P' K P (e, 24, 24), in global axes: P = 1 - R G takes the rotation G u of the corners out of u.

    R (24, 3) is the rigid rotation about the centre, G its least squares fit to the displacements of the corners.
    """
    diagonal = np.linalg.norm(corners[:, 2] - corners[:, 0], axis=1)
    warped = np.flatnonzero(warp(corners, axes) > FLAT * diagonal)
    if not warped.size:
        return K
    r = corners[warped] - corners[warped].mean(axis=1, keepdims=True)
    R = np.zeros((warped.size, 4, 6, 3))
    R[:, :, [1, 2, 0], [0, 1, 2]] = -r[:, :, [2, 0, 1]]
    R[:, :, [2, 0, 1], [0, 1, 2]] = r[:, :, [1, 2, 0]]
    moved = R.reshape(warped.size, 24, 3).copy()
    R[:, :, [3, 4, 5], [0, 1, 2]] = 1.0
    turned = R.reshape(warped.size, 24, 3)
    G = np.linalg.solve(moved.swapaxes(1, 2) @ moved, moved.swapaxes(1, 2))
    P = np.eye(24) - turned @ G
    freed = K.copy()
    freed[warped] = P.swapaxes(1, 2) @ K[warped] @ P
    return freed
