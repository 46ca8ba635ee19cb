"""A small flat-shell finite element program over the elements of ``flexbody``: it delivers element nodal forces.

Units N, mm, MPa, t, s. Degrees of freedom per node: ux, uy, uz, rx, ry, rz in global axes.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import eigsh, splu

from fatigue.flexbody.elements.bilinear import GAUSS, jacobians, shape
from fatigue.flexbody.elements.quad import quad_stiffness
from fatigue.flexbody.elements.section import Section


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
    return np.asarray(pressure)[:, None] * (jacobians(corners) @ np.stack([shape(*at)[0] for at in GAUSS]))


def element_stiffness(corners, thickness, E, nu, bending_thickness=None):
    """Stiffness of each element, (e, 24, 24), in global axes, from its corners, (e, 4, 3)."""
    bending = thickness if bending_thickness is None else bending_thickness
    alike = [np.full(len(corners), value) for value in (E, nu, 0.0, 0.0)]
    return quad_stiffness(corners, Section(np.asarray(thickness), np.asarray(bending), *alike))
