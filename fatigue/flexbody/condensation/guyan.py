"""Static condensation: slaves follow the masters as if nothing had mass."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import SuperLU

from fatigue.flexbody.condensation.factored import factored, solved
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]


def guyan(structure: Structure, masters: NDArray[np.bool_]) -> Floats:
    """Constraint modes T (n, m), ``x = T x_m`` with ``T = [I; -K_ss^-1 K_sm]``; columns in the order of the rows.

    Each column moves one of the ``masters`` (n,) by 1 and holds the others. Exact for static loads on masters; rigid
    motions and the rigid mass of the body are kept. ``T' K T = K_mm - K_ms K_ss^-1 K_sm`` is what masters feel of the
    whole body, less than K_mm by a positive semi-definite part: a "weakened" stiffness is no more than that.

    Raises
    ------
    NumericalError : the masters do not hold the body

    Source: Guyan, AIAA Journal 3 (1965) 380.
    """
    K, slaves = structure.K, ~masters
    return followed(factored(K[slaves][:, slaves]), K, masters)


def followed(of_slaves: SuperLU, D: sparse.csc_array, masters: NDArray[np.bool_]) -> Floats:
    """T (n, m) of slaves that no force is left on, ``D_sm x_m + D_ss x_s = 0``, from the factors of D_ss."""
    T = np.zeros((len(masters), int(masters.sum())))
    T[masters] = np.eye(T.shape[1])
    T[~masters] = -solved(of_slaves, D[~masters][:, masters].toarray())
    return T
