"""The bilinear quadrilateral in its own plane: axes, shape functions, their gradients, points of integration.

Corners 1 to 4 run around the element; natural coordinates xi and eta go from -1 to 1. Corners that do not lie in one
plane are projected on the plane parallel to both diagonals, which passes them at equal distances.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
GAUSS = CORNERS / np.sqrt(3)  # 2 x 2 points of weight 1, exact for polynomials of degree 3 in xi and in eta


def quad_axes(corners: Floats) -> Floats:
    """Rows x, y, z of each element's axes (e, 3, 3) from its corners (e, 4, 3): z normal to both diagonals."""
    x = corners[:, 1] + corners[:, 2] - corners[:, 0] - corners[:, 3]
    z = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    x -= np.sum(x * z, axis=1, keepdims=True) * z
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=1)


def in_plane(corners: Floats, axes: Floats) -> Floats:
    """Corners (e, 4, 2) in the axes of each element, from its centre."""
    return np.asarray(np.einsum("eij,enj->eni", axes[:, :2], corners - corners.mean(axis=1, keepdims=True)))


def shape(xi: float, eta: float) -> tuple[Floats, Floats]:
    """Shape functions N (4,) and their derivatives by xi and eta (2, 4)."""
    cx, cy = CORNERS.T
    return (1 + xi * cx) * (1 + eta * cy) / 4, np.stack([cx * (1 + eta * cy), cy * (1 + xi * cx)]) / 4


def gradient(xy: Floats, xi: float, eta: float) -> tuple[Floats, Floats]:
    """Derivatives of the shape functions by x and y (e, 2, 4), and the Jacobian matrix (e, 2, 2)."""
    _, dN = shape(xi, eta)
    J = dN @ xy
    return np.asarray(np.linalg.solve(J, np.broadcast_to(dN, (len(xy), 2, 4))), dtype=np.float64), J


def jacobians(corners: Floats) -> Floats:
    """Determinant of the Jacobian matrix (e, 4) at the points of integration: above 0 for a convex element.

    Their sum is the area of the element, projected on its plane.
    """
    xy = in_plane(corners, quad_axes(corners))
    return np.stack([np.linalg.det(shape(*at)[1] @ xy) for at in GAUSS], axis=1)
