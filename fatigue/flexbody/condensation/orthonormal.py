"""From any columns that span a reduced body to shapes with unit modal mass: what a modal neutral file holds."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import eigh

from fatigue.errors import NumericalError, Problem
from fatigue.flexbody.condensation.rigid import rigid_modes
from fatigue.flexbody.structure import Basis, Structure

Floats = NDArray[np.float64]

MASSLESS = 1e-14  # of the largest mass under unit energy: a combination that moves nothing with mass
DEPENDENT = (
    1e-11  # of the largest, squares of independent parts of columns with unit norm: rounding of double precision
)
FREE = 0.1  # of the first elastic frequency: above that, K holds the body against a rigid motion
DISTINCT = 0.9  # of the largest displacement of a shape: the first row as large as that has the positive sign


@dataclass(frozen=True, slots=True, eq=False)
class Orthonormal:
    """A basis, and how many of the columns that it was made of depended on others."""

    basis: Basis
    dependent: int


def orthonormal(structure: Structure, T: Floats, normal_upto_hz: float) -> Orthonormal:
    """Elastic shapes of the body that the columns T (n, k) span, orthonormal by mass and orthogonal by stiffness.

    ``K_r N = M_r N diag(mu)`` with ``K_r = T' K T``, ``M_r = T' M T``; the shapes are ``T N``, their frequencies
    ``sqrt(mu)``. Shapes that are rigid motions are recognised by what mass they share with the exact ones and left
    out; the others are made orthogonal to these. The physical meaning of a constraint or attachment mode is lost: they
    come back as shapes of high frequency, that follow what enters at the interface without delay.

    Parameters
    ----------
    normal_upto_hz : shapes up to here count as modes of the body itself, ``normal``: the cut of the modes in T

    Raises
    ------
    NumericalError : K holds the body against a rigid motion

    Sources: Craig and Bampton 1968; theory of the flexible body in multibody codes (Craig-Bampton orthonormalised).
    """
    K, M = structure.K, structure.M
    X_r = rigid_modes(structure)
    K_r, M_r = T.T @ (K @ T), T.T @ (M @ T)
    W = _independent(K_r, M_r)
    of_span = W.T @ M_r @ W
    flexible, U = eigh(of_span)
    has_mass = flexible > MASSLESS * flexible[-1]
    N = (W @ U[:, has_mass] / np.sqrt(flexible[has_mass]))[:, ::-1]
    mu = np.einsum("ij,ij->j", N, K_r @ N)
    shapes = T @ N

    share = X_r.T @ (M @ shapes)  # of unit modal mass, what is rigid motion
    elastic = np.square(share).sum(axis=0) < 0.5
    shapes = shapes[:, elastic] - X_r @ share[:, elastic]
    if not shapes.shape[1]:
        return Orthonormal(Basis(shapes, np.zeros(0), np.zeros(0, dtype=bool)), T.shape[1] - N.shape[1])
    stiffness = np.diag(mu[elastic])
    mu, Q = eigh(stiffness, np.eye(len(stiffness)) - share[:, elastic].T @ share[:, elastic])
    shapes = shapes @ Q
    _refuse_held(X_r, K, mu[0])
    frequency = np.sqrt(mu) / (2.0 * np.pi)
    basis = Basis(shapes * signs(shapes), frequency, frequency <= normal_upto_hz)
    return Orthonormal(basis, T.shape[1] - N.shape[1])


def signs(shapes: Floats) -> Floats:
    """Sign (k,) of each shape (n, k) that makes the first of its large components positive, the same in every run."""
    large = np.abs(shapes) >= DISTINCT * np.abs(shapes).max(axis=0)
    first = shapes[np.argmax(large, axis=0), np.arange(shapes.shape[1])]
    return np.where(first < 0.0, -1.0, 1.0)


def _independent(K_r: Floats, M_r: Floats) -> Floats:
    """Combinations (k, j) of the columns, orthonormal by ``K + s M``, that depend on no others.

    A local column has next to no mass, a rigid one no stiffness; the sum of both sees all that a column does.
    """
    stiffness, mass = np.diag(K_r), np.diag(M_r)
    ratio = np.divide(stiffness, mass, out=np.full_like(mass, np.inf), where=mass > 0.0)
    s = float(np.median(ratio[np.isfinite(ratio)]))
    G = K_r + max(s, np.finfo(float).tiny) * M_r
    size = np.sqrt(np.diag(G))
    D = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0.0)
    value, vector = eigh(D[:, None] * G * D)
    apart = value > DEPENDENT * value[-1]
    return np.asarray(D[:, None] * vector[:, apart] / np.sqrt(value[apart]))


def _refuse_held(X_r: Floats, K: sparse.csc_array, first: float) -> None:
    """Refuse a stiffness that holds the body: a rigid motion with a frequency, measured by the first elastic one."""
    of_rigid = np.sqrt(np.abs(np.einsum("ij,ij->j", X_r, K @ X_r)).max(initial=0.0))
    if of_rigid > FREE * np.sqrt(first):
        raise NumericalError(
            Problem(
                "body_is_held",
                "finite element model",
                f"a rigid motion has a frequency of {of_rigid / (2 * np.pi):.4g} Hz, the first elastic shape "
                f"{np.sqrt(first) / (2 * np.pi):.4g} Hz: K holds the body",
                "take supports and springs to the ground out of the model; a body is reduced free",
            )
        )
