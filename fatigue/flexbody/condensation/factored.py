"""A symmetric matrix factored once and solved for many columns, and the number of eigenvalues below a bound."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from fatigue.errors import NumericalError, Problem

Floats = NDArray[np.float64]

AT_ONCE = 32  # columns of a right-hand side: more at once are no faster, and take memory


def factored(K: sparse.csc_array, pivot_threshold: float = 0.0) -> SuperLU:
    """Factors of a symmetric matrix (n, n) in an order of little fill.

    Pivots stay on the diagonal with a threshold of 0, which a positive definite matrix allows; one that is indefinite
    takes a pivot elsewhere where that on the diagonal is smaller than this share of the largest of its column.

    Raises
    ------
    NumericalError : the matrix is singular
    """
    try:
        return splu(
            sparse.csc_array(K),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=pivot_threshold,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise NumericalError(
            Problem(
                "singular",
                "finite element model",
                f"a system of {K.shape[0]} degrees of freedom is singular ({error})",
                "look for parts that hang together by nothing, and for degrees of freedom without stiffness",
            )
        ) from error


def solved(factors: SuperLU, F: Floats) -> Floats:
    """Solution for right-hand sides (n,) or (n, c), some columns at a time."""
    if F.ndim == 1:
        return np.asarray(factors.solve(F))
    X = np.empty(F.shape)
    for first in range(0, F.shape[1], AT_ONCE):
        some = slice(first, first + AT_ONCE)
        X[:, some] = factors.solve(np.ascontiguousarray(F[:, some]))
    return X


def number_below(K: sparse.csc_array, M: sparse.csc_array, hz: float) -> int | None:
    """Number of eigenvalues of ``K x = w^2 M x`` below a frequency [Hz]; None where the factors cannot tell.

    ``K - w^2 M = L D L'`` has as many negative pivots as there are eigenvalues below w^2 (Sylvester's law of inertia),
    as long as no row is exchanged without its column.
    """
    factors = factored(K - (2.0 * np.pi * hz) ** 2 * M)
    if not np.array_equal(factors.perm_r, factors.perm_c):
        return None
    return int(np.count_nonzero(factors.U.diagonal() < 0.0))
