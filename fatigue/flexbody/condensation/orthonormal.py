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
ROUNDING = 1e-12  # of the ratio of stiffness and mass of single rows: ten thousand units of it
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
    rigid = X_r.T @ (structure.M @ T)  # what of each column is rigid motion
    X = T - X_r @ rigid
    K_e, M_e = reduced(structure, X)
    M_r = M_e + rigid.T @ rigid

    # A local column has next to no mass, a rigid one no stiffness: K + s M sees what either of them is.
    s = _between(structure, K_e, M_r)
    size = np.sqrt(np.diag(K_e + s * M_r))
    D = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0.0)[:, None]
    rank = _independent(D * (K_e + s * M_r) * D.T).shape[1]
    span = D * _independent(D * (K_e + s * M_e) * D.T)

    flexible, N = eigh(span.T @ M_e @ span)
    has_mass = flexible > MASSLESS * flexible.max(initial=0.0)
    N = (span @ (N[:, has_mass] / np.sqrt(flexible[has_mass])))[:, ::-1]
    frequency = np.sqrt(np.einsum("ij,ij->j", N, K_e @ N)) / (2.0 * np.pi)
    dependent = T.shape[1] - rank + int(np.count_nonzero(~has_mass))
    return Orthonormal(Basis(signed(X @ N), frequency, frequency <= normal_upto_hz), dependent)


def _between(structure: Structure, K_r: Floats, M_r: Floats) -> float:
    """Weight s [1/s^2] that makes mass and stiffness of the columns comparable: their median ratio.

    Where most of them are rigid motions that is rounding, and the rounding of the matrices is taken instead.
    """
    stiffness, mass = np.diag(K_r), np.diag(M_r)
    of_columns = float(np.median(stiffness[mass > 0.0] / mass[mass > 0.0])) if (mass > 0.0).any() else 0.0
    of_rows = float(structure.K.diagonal().sum() / structure.M.diagonal().sum())
    return max(of_columns, ROUNDING * of_rows)


def _independent(G: Floats) -> Floats:
    """Combinations (k, j), orthonormal by G (k, k) of unit columns, that depend on no others."""
    value, vector = eigh(G)
    apart = value > DEPENDENT
    return np.asarray(vector[:, apart] / np.sqrt(value[apart]))
