"""A small finite element program of bricks of 8 nodes, with incompatible modes, and of 20: element nodal forces.

Units N, mm, MPa. Three degrees of freedom per node. Nodes of a brick: round its bottom, round its top, then the
mid-side nodes round the bottom, between bottom and top, and round the top.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

CORNER = np.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)])
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]
LOCAL = np.concatenate([CORNER, [(CORNER[a] + CORNER[b]) / 2 for a, b in EDGES]]).astype(float)


@dataclass
class SolidModel:
    """Nodes (n, 3) [mm] and bricks (e, 8) or (e, 20) as node indices."""

    xyz: np.ndarray
    bricks: np.ndarray
    E: float = 210000.0
    nu: float = 0.3
    stiffness: np.ndarray = field(init=False)  # (e, d, d) of each element

    def __post_init__(self):
        """Compute the element stiffness."""
        brick = brick_8 if self.bricks.shape[1] == 8 else brick_20
        self.stiffness = np.stack([brick(self.xyz[nodes], elasticity(self.E, self.nu)) for nodes in self.bricks])

    def dofs(self):
        """Degrees of freedom of each element, (e, d)."""
        return (3 * self.bricks[:, :, None] + np.arange(3)).reshape(len(self.bricks), -1)

    def solve(self, load, fixed):
        """Displacements, (n, 3), under nodal loads, (n, 3), with the dofs of ``fixed``, (n, 3) bool, held at zero."""
        dofs = self.dofs()
        row, column = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        size = 3 * len(self.xyz)
        K = csc_array((self.stiffness.ravel(), (row.ravel(), column.ravel())), shape=(size, size))
        free = ~fixed.ravel()
        u = np.zeros(size)
        u[free] = splu(K[free][:, free]).solve(np.asarray(load, dtype=float).ravel()[free])
        return u.reshape(-1, 3)

    def element_forces(self, u):
        """Return the forces on each element at its nodes, K_e u_e, (e, n, 3)."""
        return np.einsum("eij,ej->ei", self.stiffness, u.ravel()[self.dofs()]).reshape(len(self.bricks), -1, 3)


def elasticity(E, nu):
    """Isotropic elasticity, (6, 6), of strains xx, yy, zz, xy, yz, zx."""
    shear = E / 2 / (1 + nu)
    D = np.diag([2 * shear] * 3 + [shear] * 3)
    D[:3, :3] += E * nu / (1 + nu) / (1 - 2 * nu)
    return D


def derivatives(at, quadratic):
    """Derivatives of the shape functions of 8 or 20 nodes by the local coordinates at a point, (n, 3)."""
    step = 1e-20j  # complex step: exact to round-off
    points = np.array(at, dtype=complex) + step * np.eye(3)
    return np.stack([shape(point, quadratic).imag / 1e-20 for point in points], axis=1)


def shape(at, quadratic):
    """Shape functions of 8 or 20 nodes at a point, (n,)."""
    one = 1 + at * (LOCAL if quadratic else CORNER)
    if not quadratic:
        return one.prod(axis=1) / 8
    corner = one[:8].prod(axis=1) * (one[:8].sum(axis=1) - 5) / 8
    mid = np.where(LOCAL[8:] == 0, 1 - at**2, one[8:]).prod(axis=1) / 4
    return np.concatenate([corner, mid])


def strains(gradient):
    """Strain-displacement matrix, (6, 3 n), of gradients of shape functions, (n, 3)."""
    x, y, z = gradient.T
    o = np.zeros_like(x)
    rows = [(x, o, o), (o, y, o), (o, o, z), (y, x, o), (o, z, y), (z, o, x)]
    return np.stack([np.column_stack(row).ravel() for row in rows])


def gauss(count):
    """Points (g, 3) and weights (g,) of the cube."""
    point, weight = np.polynomial.legendre.leggauss(count)
    at = np.stack(np.meshgrid(point, point, point), axis=-1).reshape(-1, 3)
    return at, np.einsum("i,j,k->ijk", weight, weight, weight).ravel()


def brick_20(xyz, D):
    """Stiffness of a brick of 20 nodes, (60, 60), 27 Gauss points."""
    K = np.zeros((60, 60))
    for at, weight in zip(*gauss(3), strict=True):
        by_local = derivatives(at, True)
        jacobian = by_local.T @ xyz
        B = strains(by_local @ np.linalg.inv(jacobian).T)
        K += weight * np.linalg.det(jacobian) * B.T @ D @ B
    return K


def brick_8(xyz, D):
    """Stiffness of a brick of 8 nodes with incompatible modes, (24, 24), which bends as it should (Taylor, 1976)."""
    centre = derivatives(np.zeros(3), False).T @ xyz
    K = np.zeros((33, 33))
    for at, weight in zip(*gauss(2), strict=True):
        by_local = derivatives(at, False)
        jacobian = by_local.T @ xyz
        bubble = -2 * np.diag(at) @ np.linalg.inv(centre).T * np.linalg.det(centre) / np.linalg.det(jacobian)
        B = strains(np.concatenate([by_local @ np.linalg.inv(jacobian).T, bubble]))
        K += weight * np.linalg.det(jacobian) * B.T @ D @ B
    return K[:24, :24] - K[:24, 24:] @ np.linalg.solve(K[24:, 24:], K[24:, :24])


def block(x, y, z, quadratic=False):
    """Nodes and bricks of a box with the given stations along its axes."""
    n = [len(x), len(y), len(z)]
    number = np.arange(np.prod(n)).reshape(n)
    xyz = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3).astype(float)
    a = number[:-1, :-1, :-1].ravel()
    i, j, k = n[1] * n[2], n[2], 1
    bricks = a[:, None] + np.array([0, i, i + j, j, k, i + k, i + j + k, j + k])
    return with_mid_nodes(xyz, bricks) if quadratic else (xyz, bricks)


def with_mid_nodes(xyz, bricks):
    """Bricks of 20 nodes out of those of 8, mid-side nodes halfway."""
    pairs = np.sort(np.stack([bricks[:, edge] for edge in EDGES], axis=1), axis=2).reshape(-1, 2)
    ends, number = np.unique(pairs, axis=0, return_inverse=True)
    mid = len(xyz) + number.reshape(len(bricks), 12)
    return np.concatenate([xyz, xyz[ends].mean(axis=1)]), np.concatenate([bricks, mid], axis=1)


def joined(*meshes):
    """Meshes, pairs of nodes and bricks, as one; nodes at the same place become one node."""
    xyz = np.concatenate([mesh[0] for mesh in meshes])
    _, keep, number = np.unique(np.round(xyz, 6), axis=0, return_index=True, return_inverse=True)
    starts = np.cumsum([0, *(len(mesh[0]) for mesh in meshes)])
    bricks = [number.ravel()[mesh[1] + start] for mesh, start in zip(meshes, starts[:-1], strict=True)]
    return xyz[keep], np.concatenate(bricks)
