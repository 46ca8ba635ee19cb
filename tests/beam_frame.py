"""A small space frame of beams with consistent mass, for what fixed-interface modes carry: N, mm, t, s."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg import eigh

E, G, RHO = 210000.0, 81000.0, 7.85e-9
AREA, I_Y, I_Z, J = 2000.0, 1.2e6, 2.9e6, 0.8e6


@dataclass
class Frame:
    """Matrices of all degrees of freedom (6 n,), node by node x, y, z, rx, ry, rz; ``held`` are those of the feet."""

    xyz: np.ndarray
    K: np.ndarray
    M: np.ndarray
    held: np.ndarray

    @property
    def place(self):
        """Place of each degree of freedom (6 n, 3)."""
        return np.repeat(self.xyz, 6, axis=0)

    @property
    def direction(self):
        """Direction of each degree of freedom (6 n,)."""
        return np.tile(np.arange(6), len(self.xyz))

    @property
    def mass(self):
        """Mass matrix as the formulas take it."""
        return sparse.csc_array(self.M)

    def fixed_modes(self):
        """Frequencies [Hz] and mass-normalised shapes (6 n, m) of all modes with the feet held."""
        free = ~self.held
        w2, vectors = eigh(self.K[free][:, free], self.M[free][:, free])
        shapes = np.zeros((len(self.held), free.sum()))
        shapes[free] = vectors
        return np.sqrt(w2) / (2 * np.pi), shapes

    def free_modes(self):
        """Frequencies [Hz] and shapes of all elastic modes with nothing held."""
        w2, vectors = eigh(self.K, self.M)
        return np.sqrt(w2[6:]) / (2 * np.pi), vectors[:, 6:]


def frame(foot_mass=0.0):
    """A portal out of plane: two feet, a beam, an arm to the side, all of two elements; masses [t] on the feet."""
    xyz = np.array(
        [
            [0.0, 0.0, 0.0],
            [0.0, 100.0, 800.0],
            [0.0, 200.0, 1600.0],
            [1000.0, 200.0, 1700.0],
            [2000.0, 300.0, 1500.0],
            [2100.0, 150.0, 700.0],
            [2000.0, 0.0, 0.0],
            [1100.0, 900.0, 1750.0],
        ]
    )
    beams = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (3, 7)]
    size = 6 * len(xyz)
    K, M = np.zeros((size, size)), np.zeros((size, size))
    for a, b in beams:
        k, m = _beam(xyz[a], xyz[b])
        at = np.r_[6 * a : 6 * a + 6, 6 * b : 6 * b + 6]
        K[np.ix_(at, at)] += k
        M[np.ix_(at, at)] += m
    held = np.zeros(size, dtype=bool)
    for foot in (0, 6):
        at = np.arange(6 * foot, 6 * foot + 6)
        held[at] = True
        M[at[:3], at[:3]] += foot_mass
    return Frame(xyz, K, M, held)


def lumped(model):
    """The same frame with its mass lumped at the nodes, translations and rotations alike."""
    M = np.zeros_like(model.M)
    total = model.M.sum() / 3.0  # about the size of it, shared out evenly: any positive diagonal will do
    for direction in range(6):
        at = np.arange(direction, len(M), 6)
        M[at, at] = (total if direction < 3 else 1e4 * total) * (1.0 + 0.1 * np.arange(len(at)))
    return Frame(model.xyz, model.K, M, model.held)


def _beam(start, end):
    """Stiffness and consistent mass (12, 12) of an Euler beam in global axes."""
    L = np.linalg.norm(end - start)
    x = (end - start) / L
    y = np.cross([0.0, 0.0, 1.0], x) if abs(x[2]) < 0.9 else np.cross([0.0, 1.0, 0.0], x)
    y /= np.linalg.norm(y)
    T = np.kron(np.eye(4), np.stack([x, y, np.cross(x, y)]))
    k, m = np.zeros((12, 12)), np.zeros((12, 12))
    for at, stiff, mass in (([0, 6], E * AREA, RHO * AREA), ([3, 9], G * J, RHO * (I_Y + I_Z))):
        k[np.ix_(at, at)] += stiff / L * np.array([[1, -1], [-1, 1]])
        m[np.ix_(at, at)] += mass * L / 6 * np.array([[2, 1], [1, 2]])
    for at, inertia, sign in (([1, 5, 7, 11], I_Z, 1.0), ([2, 4, 8, 10], I_Y, -1.0)):
        s = sign * L
        bending = [[12, 6 * s, -12, 6 * s], [6 * s, 4 * L**2, -6 * s, 2 * L**2]]
        bending += [[-12, -6 * s, 12, -6 * s], [6 * s, 2 * L**2, -6 * s, 4 * L**2]]
        moved = [[156, 22 * s, 54, -13 * s], [22 * s, 4 * L**2, 13 * s, -3 * L**2]]
        moved += [[54, 13 * s, 156, -22 * s], [-13 * s, -3 * L**2, -22 * s, 4 * L**2]]
        k[np.ix_(at, at)] += E * inertia / L**3 * np.array(bending)
        m[np.ix_(at, at)] += RHO * AREA * L / 420 * np.array(moved)
    return T.T @ k @ T, T.T @ m @ T
