"""A small flat-shell finite element program: the oracle that delivers element nodal forces.

Four-node flat shells: Mindlin bending with assumed transverse shear (MITC4, Bathe & Dvorkin 1985), membrane with
incompatible modes (QM6, Taylor, Beresford & Wilson 1976), and a small penalty that ties the drilling rotation to the
membrane's own rotation, so that rigid rotations stay free of force. Units N, mm, MPa, t, s. Degrees of freedom per
node: ux, uy, uz, rx, ry, rz in global axes.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import eigsh, splu

DRILLING = 1e-3  # penalty stiffness per area, in units of G t
CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
GAUSS = CORNERS / np.sqrt(3)


@dataclass
class ShellModel:
    """Nodes (n, 3) [mm], quads (e, 4) as node indices in a sense of rotation about their normal, thickness (e,).

    A double skin bends, and gives way to transverse shear, with a ``bending_thickness`` (e,) of its own.
    """

    xyz: np.ndarray
    quads: np.ndarray
    thickness: np.ndarray
    E: float = 210000.0
    nu: float = 0.3
    rho: float = 7.85e-9
    bending_thickness: np.ndarray | None = None
    stiffness: np.ndarray = field(init=False)  # (e, 24, 24) of each element

    def __post_init__(self):
        """Compute the element stiffness."""
        self.thickness = np.broadcast_to(np.asarray(self.thickness, dtype=float), len(self.quads))
        corners, bending = self.xyz[self.quads], self.bending_thickness
        self.stiffness = element_stiffness(corners, self.thickness, self.E, self.nu, bending)

    def dofs(self):
        """Degrees of freedom of each element, (e, 24)."""
        return (6 * self.quads[:, :, None] + np.arange(6)).reshape(-1, 24)

    def assembled(self):
        """Stiffness of the whole model."""
        dofs = self.dofs()
        row, column = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        size = 6 * len(self.xyz)
        return csc_array((self.stiffness.ravel(), (row.ravel(), column.ravel())), shape=(size, size))

    def solve(self, load, fixed):
        """Displacements, (n, 6), under nodal loads, (n, 6), with the dofs of ``fixed``, (n, 6) bool, held at zero."""
        K, free = self.assembled(), ~fixed.ravel()
        u = np.zeros(free.size)
        u[free] = splu(K[free][:, free]).solve(np.asarray(load, dtype=float).ravel()[free])
        return u.reshape(-1, 6)

    def mass(self):
        """Lumped mass of each dof, (6 n,), with a token rotary inertia."""
        mass = np.zeros(len(self.xyz))
        np.add.at(mass, self.quads, (self.rho * self.thickness * areas(self.xyz[self.quads]) / 4)[:, None])
        return (mass[:, None] * np.array([1, 1, 1, *3 * [self.thickness.mean() ** 2 / 12]])).ravel()

    def modes(self, count, fixed):
        """Lowest natural frequencies, (count,) [Hz], and mass-normalised modes, (count, n, 6)."""
        free = ~fixed.ravel()
        mass = self.mass()[free]
        eigenvalue, vectors = eigsh(self.assembled()[free][:, free], count, M=diags_array(mass).tocsc(), sigma=0)
        u = np.zeros((count, free.size))
        u[:, free] = vectors.T
        return np.sqrt(eigenvalue) / (2 * np.pi), u.reshape(count, -1, 6)

    def element_forces(self, u):
        """Return the forces and moments on each element at its nodes, K_e u_e, (e, 4, 6)."""
        return np.einsum("eij,ej->ei", self.stiffness, u.ravel()[self.dofs()]).reshape(-1, 4, 6)

    def side_forces(self, u, elements, nodes):
        """Sum of the forces on the ``elements`` at each of the ``nodes``, (n, 6)."""
        total = np.zeros((len(self.xyz), 6))
        np.add.at(total, self.quads[elements], self.element_forces(u)[elements])
        return total[nodes]


def grid(x, y, z=0.0):
    """Nodes and quads of a flat rectangular mesh with the given stations along x and y."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    X, Y = np.meshgrid(x, y, indexing="ij")
    xyz = np.stack([X, Y, np.full_like(X, z)], axis=-1).reshape(-1, 3)
    number = np.arange(X.size).reshape(X.shape)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1)
    return xyz, quads.reshape(-1, 4)


def joined(*meshes):
    """Meshes, pairs of nodes and quads, as one; nodes at the same place become one node."""
    xyz = np.concatenate([mesh[0] for mesh in meshes])
    _, keep, number = np.unique(np.round(xyz, 6), axis=0, return_index=True, return_inverse=True)
    starts = np.cumsum([0, *(len(mesh[0]) for mesh in meshes)])
    quads = [number.ravel()[mesh[1] + start] for mesh, start in zip(meshes, starts[:-1], strict=True)]
    return xyz[keep], np.concatenate(quads)


def areas(corners):
    """Area of each quad, (e,), from its corners, (e, 4, 3)."""
    return np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1) / 2


def surface_load(corners, pressure):
    """Consistent nodal forces of each element, (e, 4), under its pressure, (e,) [MPa]: the integral of p N dA."""
    axes = _element_axes(corners)
    xy = np.einsum("eij,enj->eni", axes[:, :2], corners - corners.mean(axis=1, keepdims=True))
    of_corners = [_shape(*at)[0] * np.linalg.det(_gradient(xy, *at)[1])[:, None] for at in GAUSS]
    return np.asarray(pressure)[:, None] * sum(of_corners)


def element_stiffness(corners, thickness, E, nu, bending_thickness=None):
    """Stiffness of each element, (e, 24, 24), in global axes, from its corners, (e, 4, 3)."""
    axes = _element_axes(corners)
    xy = np.einsum("eij,enj->eni", axes[:, :2], corners - corners.mean(axis=1, keepdims=True))
    t, G = thickness[:, None, None], E / (2 * (1 + nu))
    t_b = t if bending_thickness is None else bending_thickness[:, None, None]
    plane_stress = E / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    K = np.zeros((len(xy), 24, 24))
    for dofs, matrix in (
        ([0, 1], t * _membrane(xy, plane_stress)),
        ([2, 3, 4], t_b**3 / 12 * _integrate(_curvature, xy, plane_stress)),
        ([2, 3, 4], 5 / 6 * G * t_b * _integrate(_transverse_shear, xy, np.eye(2))),
        ([0, 1, 5], DRILLING * G * t * _integrate(_drilling, xy, np.eye(1))),
    ):
        at = (6 * np.arange(4)[:, None] + dofs).ravel()
        K[:, at[:, None], at] += matrix
    T = np.zeros_like(K)
    for block in range(0, 24, 3):
        T[:, block : block + 3, block : block + 3] = axes
    return T.swapaxes(1, 2) @ K @ T


def _element_axes(corners):
    """Rows x, y, z of each element's axes, (e, 3, 3): z normal to both diagonals."""
    x = corners[:, 1] + corners[:, 2] - corners[:, 0] - corners[:, 3]
    z = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    x -= np.sum(x * z, axis=1, keepdims=True) * z
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _shape(xi, eta):
    """Bilinear shape functions, (4,), and their derivatives by xi and eta, (2, 4)."""
    cx, cy = CORNERS.T
    return (1 + xi * cx) * (1 + eta * cy) / 4, np.stack([cx * (1 + eta * cy), cy * (1 + xi * cx)]) / 4


def _gradient(xy, xi, eta):
    """Shape function derivatives by x and y, (e, 2, 4), and the Jacobian matrix, (e, 2, 2)."""
    _, dN = _shape(xi, eta)
    J = dN @ xy
    return np.linalg.solve(J, np.broadcast_to(dN, (len(xy), 2, 4))), J


def _integrate(strain, xy, D):
    """Integral of B^T D B over each element by 2 x 2 Gauss points."""
    total = 0.0
    for xi, eta in GAUSS:
        B, J = strain(xy, xi, eta)
        total = total + B.swapaxes(1, 2) @ D @ B * np.linalg.det(J)[:, None, None]
    return total


def _membrane(xy, D):
    """Plane stiffness per thickness, (e, 8, 8), of the bilinear quad with four condensed incompatible modes."""
    J0 = _gradient(xy, 0.0, 0.0)[1]
    j0 = np.linalg.det(J0)
    K, L, Q = 0.0, 0.0, 0.0
    for xi, eta in GAUSS:
        dN, J = _gradient(xy, xi, eta)
        j = np.linalg.det(J)
        # 1 - xi^2 and 1 - eta^2, mapped by the Jacobian of the centre and scaled by j0 / j: the patch test holds
        bubbles = np.broadcast_to(np.diag([-2 * xi, -2 * eta]), (len(xy), 2, 2))
        dP = np.linalg.solve(J0, bubbles) * (j0 / j)[:, None, None]
        B, C = _plane_strain_matrix(dN), _plane_strain_matrix(dP)
        weight = j[:, None, None]
        K = K + B.swapaxes(1, 2) @ D @ B * weight
        L = L + C.swapaxes(1, 2) @ D @ B * weight
        Q = Q + C.swapaxes(1, 2) @ D @ C * weight
    return K - L.swapaxes(1, 2) @ np.linalg.solve(Q, L)


def _plane_strain_matrix(gradient):
    """Strains exx, eyy, gxy, (e, 3, 2 k), from the u and v of k functions with the gradient (e, 2, k)."""
    B = np.zeros((len(gradient), 3, gradient.shape[2], 2))
    B[:, 0, :, 0] = B[:, 2, :, 1] = gradient[:, 0]
    B[:, 1, :, 1] = B[:, 2, :, 0] = gradient[:, 1]
    return B.reshape(len(B), 3, -1)


def _curvature(xy, xi, eta):
    """Curvatures of u = z ry, v = -z rx, (e, 3, 12), from uz, rx, ry."""
    dN, J = _gradient(xy, xi, eta)
    B = np.zeros((len(xy), 3, 4, 3))
    B[:, 0, :, 2] = B[:, 2, :, 1] = dN[:, 0]
    B[:, 1, :, 1] = B[:, 2, :, 2] = dN[:, 1]
    B[:, 1:, :, 1] *= -1
    return B.reshape(len(xy), 3, 12), J


def _covariant_shear(xy, xi, eta, direction):
    """Shear strain along the natural coordinate ``direction``, (e, 12): duz/dxi + dx/dxi ry - dy/dxi rx."""
    N, dN = _shape(xi, eta)
    dx = dN[direction] @ xy
    B = np.zeros((len(xy), 4, 3))
    B[:, :, 0] = dN[direction]
    B[:, :, 1] = -dx[:, 1:] * N
    B[:, :, 2] = dx[:, :1] * N
    return B.reshape(len(xy), 12)


def _transverse_shear(xy, xi, eta):
    """Transverse shear strains gxz, gyz, (e, 2, 12), interpolated between the middles of opposite edges."""
    J = _gradient(xy, xi, eta)[1]
    along_xi = [(1 + sign * eta) / 2 * _covariant_shear(xy, 0.0, sign, 0) for sign in (-1, 1)]
    along_eta = [(1 + sign * xi) / 2 * _covariant_shear(xy, sign, 0.0, 1) for sign in (-1, 1)]
    return np.linalg.solve(J, np.stack([sum(along_xi), sum(along_eta)], axis=1)), J


def _drilling(xy, xi, eta):
    """Drilling rotation less the membrane's own, rz - (dv/dx - du/dy) / 2, (e, 1, 12), from ux, uy, rz."""
    N, _ = _shape(xi, eta)
    dN, J = _gradient(xy, xi, eta)
    B = np.stack([dN[:, 1] / 2, -dN[:, 0] / 2, np.broadcast_to(N, (len(xy), 4))], axis=-1)
    return B.reshape(len(xy), 1, 12), J
