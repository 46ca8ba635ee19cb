"""A free beam of finite elements and bases of its modes: flexibility at loaded points is known exactly.

Two degrees of freedom a node, deflection and rotation; N, mm, t, s. The recipes are those of Craig and Chang (1977):
normal modes of the free body, with or without residual attachment modes, orthonormal in the end as a solver writes
them.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

Floats = NDArray[np.float64]

LENGTH, BENDING_STIFFNESS, MASS_PER_MM = 24_000.0, 3e14, 1.2e-3  # mm, N mm2, t/mm: about a car body


@dataclass(frozen=True)
class Basis:
    """Elastic modes (n, m) with unit modal mass, frequencies [Hz], and how many of them are normal modes as given."""

    shape: Floats
    frequency: Floats
    normal: int


@dataclass(frozen=True)
class FreeBeam:
    """Stiffness and mass (n, n) of a beam in space without supports, and its elastic modes."""

    K: Floats
    M: Floats
    rigid: Floats
    modes: Floats
    w: Floats

    def static(self, loaded: list[int]) -> Floats:
        """Inertia-relief displacement (n, d) under a unit load of each degree of freedom, without rigid motion."""
        n = len(self.K)
        P = np.eye(n) - self.M @ self.rigid @ self.rigid.T
        balanced = P[:, loaded]
        free = np.arange(2, n)  # the first node is held: a support that is statically determinate
        x = np.zeros((n, len(loaded)))
        x[free] = np.linalg.solve(self.K[np.ix_(free, free)], balanced[free])
        return P.T @ x

    def normal(self, count: int) -> Basis:
        """The first normal modes."""
        return Basis(self.modes[:, :count], self.w[:count] / (2 * np.pi), count)

    def with_residual(self, count: int, loaded: list[int]) -> Basis:
        """The first normal modes with a residual attachment mode for each loaded degree of freedom."""
        kept = self.modes[:, :count]
        residual = self.static(loaded) - (kept / self.w[:count] ** 2) @ kept[loaded].T
        residual = residual / np.sqrt(np.einsum("ij,ij->j", residual, self.M @ residual))
        X = np.hstack([kept, residual])
        mu, N = eigh(X.T @ self.K @ X, X.T @ self.M @ X)
        return Basis(X @ N, np.sqrt(mu) / (2 * np.pi), count)


def free_beam(elements: int = 10) -> FreeBeam:
    """A uniform beam."""
    n, length = 2 * (elements + 1), LENGTH / elements
    K, M = np.zeros((n, n)), np.zeros((n, n))
    a = length
    k = BENDING_STIFFNESS / a**3 * np.array(
        [[12, 6 * a, -12, 6 * a], [6 * a, 4 * a**2, -6 * a, 2 * a**2], [-12, -6 * a, 12, -6 * a],
         [6 * a, 2 * a**2, -6 * a, 4 * a**2]]
    )  # fmt: skip
    m = MASS_PER_MM * a / 420 * np.array(
        [[156, 22 * a, 54, -13 * a], [22 * a, 4 * a**2, 13 * a, -3 * a**2], [54, 13 * a, 156, -22 * a],
         [-13 * a, -3 * a**2, -22 * a, 4 * a**2]]
    )  # fmt: skip
    for i in range(elements):
        at = slice(2 * i, 2 * i + 4)
        K[at, at] += k
        M[at, at] += m
    x = length * np.arange(elements + 1) - LENGTH / 2
    R = np.zeros((n, 2))
    R[0::2, 0], R[0::2, 1], R[1::2, 1] = 1.0, x, 1.0
    rigid = R / np.sqrt(np.einsum("ij,ij->j", R, M @ R))  # of a symmetric beam these two are orthogonal
    mu, modes = eigh(K, M)
    return FreeBeam(K, M, rigid, modes[:, 2:], np.sqrt(mu[2:]))
