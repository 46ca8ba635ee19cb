"""From any columns that span a reduced body to shapes with unit modal mass: what a modal neutral file holds."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from fatigue.flexbody.factor import unit_rigid_motions
from fatigue.flexbody.modes import signed
from fatigue.flexbody.structure import Basis, Structure

Floats = NDArray[np.float64]

DEPENDENT = 1e-11  # square of the part of a column that is its own, of unit columns: a thousand times rounding
MASSLESS = 1e-14  # of the largest mass per energy: a combination that moves nothing that has mass


@dataclass(frozen=True, slots=True, eq=False)
class Orthonormal:
    """A basis, and how many of the columns that it was made of depend on others and were dropped."""

    basis: Basis
    dependent: int


def reduced(structure: Structure, T: Floats) -> tuple[Floats, Floats]:
    """Stiffness ``T' K T`` and mass ``T' M T`` (k, k) of the coordinates of T (n, k)."""
    return np.asarray(T.T @ (structure.K @ T)), np.asarray(T.T @ (structure.M @ T))


def orthonormal(structure: Structure, T: Floats, normal_upto_hz: float) -> Orthonormal:
    """Elastic shapes that columns T (n, k) span together with the rigid motions, orthonormal by mass.

    The eigenproblem of the reduced pair, ``T' K T N = T' M T N diag(mu)``, on the part of the span that is orthogonal
    to exact rigid motions by mass. Where T contains these, as all recipes but Kuhar's, that drops the first six
    eigenvalues; it is the span that decides, never their number. The physical meaning of a constraint or attachment
    mode is lost: such columns come back as shapes of high frequency, which follow what enters at the interface.

    Parameters
    ----------
    normal_upto_hz : shapes up to here count as modes of the body itself, ``normal``: the cut of the modes in T

    Sources: Craig and Bampton 1968; theory of flexible bodies in multibody codes (orthonormalised Craig-Bampton).
    """
    X_r = unit_rigid_motions(structure)
    K_r, M_r = reduced(structure, T)
    of_rigid = X_r.T @ (structure.M @ T)  # what of each column is rigid motion

    # A local column has next to no mass, a rigid one no stiffness: K + s M sees what either of them is.
    G = K_r + _between(K_r, M_r) * M_r
    size = np.sqrt(np.diag(G))
    D = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0.0)
    span = D[:, None] * _independent(D[:, None] * G * D)
    rank = span.shape[1]
    elastic = span.T @ (G - _between(K_r, M_r) * of_rigid.T @ of_rigid) @ span
    span = span @ _independent(elastic)

    share = of_rigid @ span
    flexible, N = eigh(span.T @ M_r @ span - share.T @ share)
    has_mass = flexible > MASSLESS * flexible.max(initial=0.0)
    N = (span @ (N[:, has_mass] / np.sqrt(flexible[has_mass])))[:, ::-1]
    shapes = T @ N - X_r @ (of_rigid @ N)
    frequency = np.sqrt(np.einsum("ij,ij->j", N, K_r @ N)) / (2.0 * np.pi)
    dependent = T.shape[1] - rank + int(np.count_nonzero(~has_mass))
    return Orthonormal(Basis(signed(shapes), frequency, frequency <= normal_upto_hz), dependent)


def _between(K_r: Floats, M_r: Floats) -> float:
    """Weight s [1/s^2] that makes mass and stiffness of the columns comparable: their median ratio."""
    stiffness, mass = np.diag(K_r), np.diag(M_r)
    s = float(np.median(stiffness[mass > 0.0] / mass[mass > 0.0])) if (mass > 0.0).any() else 1.0
    return s if s > 0.0 else 1.0


def _independent(G: Floats) -> Floats:
    """Combinations (k, j), orthonormal by G (k, k), of columns that depend on no others."""
    value, vector = eigh(G)
    apart = value > DEPENDENT * value.max(initial=0.0)
    return np.asarray(vector[:, apart] / np.sqrt(value[apart]))
