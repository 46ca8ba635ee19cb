"""Lanczos iteration for the most flexible motions of a body, all of its vectors kept orthogonal.

The iteration goes on until enough motions have settled, and never begins anew: each step costs one solution with the
factors of K, which is what modes of a large body cost (Ericsson and Ruhe 1980; Grimes, Lewis and Simon 1994).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import eigh_tridiagonal

Floats = NDArray[np.float64]
Solve = Callable[[Floats], Floats]

LOOK = 4  # steps between looks at what has settled
EXHAUSTED = 1e-13  # of the largest flexibility: a step that adds less is rounding


def most_flexible(
    flexibility: Solve,
    M: sparse.csc_array,
    beside: tuple[Floats, Floats],
    start: Floats,
    enough: Callable[[Floats], bool],
    accuracy: float,
) -> tuple[Floats, Floats]:
    """Flexibilities 1/w^2 (k,), largest first, and shapes (n, k) with ``x' M x = 1``, as many as are ``enough``.

    Parameters
    ----------
    flexibility : displacement (n,) under loads (n,), symmetric
    beside : shapes (n, m), orthonormal in M, to which all motions are orthogonal, and M times them
    start : (n,) any motion; what it does to loads begins the iteration, so that rows without mass follow the others
    enough : whether the flexibilities that have settled, in order from the largest, are enough
    accuracy : of the flexibilities, relative; an empty space, or one that all steps have filled, ends the iteration
    """
    n, most = start.size, start.size - beside[0].shape[1]
    Q = np.zeros((n, 64), order="F")
    alpha: list[float] = []
    beta: list[float] = []
    w = _orthogonal(flexibility(M @ start), M, beside, Q[:, :0])
    size, largest = np.sqrt(w @ (M @ w)), 0.0
    if not size > 0.0:
        return np.zeros(0), np.zeros((n, 0))
    while True:
        step = len(alpha)
        if step == Q.shape[1]:
            Q = np.asfortranarray(np.hstack([Q, np.zeros_like(Q)]))
        Q[:, step] = w / size
        w = flexibility(M @ Q[:, step])
        w -= beside[0] @ (beside[1].T @ w)
        if step:
            w -= beta[-1] * Q[:, step - 1]
        alpha.append(float(Q[:, step] @ (M @ w)))
        w -= alpha[-1] * Q[:, step]  # what is large goes first, then what rounding has left along all others
        w = _orthogonal(w, M, beside, Q[:, : step + 1])
        size = float(np.sqrt(w @ (M @ w)))
        largest = max(largest, abs(alpha[-1]), size)
        ended = size <= EXHAUSTED * largest or step + 1 == most
        if ended or (step + 1) % LOOK == 0:
            flexible, S = eigh_tridiagonal(np.array(alpha), np.array(beta))
            order = np.argsort(-np.abs(flexible), kind="stable")
            flexible, S = flexible[order], S[:, order]
            left = 0.0 if ended else size * np.abs(S[-1])
            settled = int(np.argmin(np.append(left <= accuracy * np.abs(flexible), False)))
            if ended or enough(flexible[:settled]):
                return flexible[:settled], Q[:, : step + 1] @ S[:, :settled]
        beta.append(size)


def _orthogonal(w: Floats, M: sparse.csc_array, beside: tuple[Floats, Floats], Q: Floats) -> Floats:
    """Vector orthogonal in M to what lies beside the motions, and to the vectors Q so far."""
    w = w - beside[0] @ (beside[1].T @ w)
    return np.asarray(w - Q @ (Q.T @ (M @ w)))
