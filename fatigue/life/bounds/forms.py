"""Two quadratic forms of many stresses from one matrix product.

Two symmetric matrices that have no negative eigenvalues have common directions (Golub and Van Loan, Matrix
Computations, 8.7): A = T diag(a) T' and B = T diag(b) T'. So with p = T'w of a stress per unit modal coordinate w,

    w'A w = sum over k of a_k p_k^2,    w'B w = sum over k of b_k p_k^2,

never negative, and the top and the bottom stress need no product of their own: theirs are the sum and the difference
of p of membrane and bending.

Rounding. With s_i^2 = A_ii / c_A + B_ii / c_B, where c_A and c_B make both of a size, the rows of T over s have length
1, and a <= c_A. A sum of m products is off by some m eps of the sum of their magnitudes, so a form of either face by no
more than ``c (4 (m + 4) eps + e) (sum s_i (|S_m| + |S_b|)_i)^2``, e what the directions miss of the matrix.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

Floats = NDArray[np.float64]

AT_ONCE = 64  # stations whose products stay in the first-level cache


@dataclass(frozen=True, slots=True, eq=False)
class FormPair:
    """Two matrices (m, m) by their common directions; see ``form_pair``.

    Attributes
    ----------
    directions : (m, r) T
    weights : (r, 2) a and b
    size : (m,) s
    rounding : (2,) largest error of each form, over ``(size @ (|S_m| + |S_b|))**2``
    """

    directions: Floats
    weights: Floats
    size: Floats
    rounding: Floats


def form_pair(A: Floats, B: Floats) -> FormPair:
    """Find the common directions of two symmetric matrices (m, m) without negative eigenvalues."""
    eps = np.finfo(np.float64).eps
    of_A, of_B = np.diagonal(A), np.diagonal(B)
    both = (of_A > 0.0) & (of_B > 0.0)
    c = np.array([1.0, np.mean(of_B[both] / of_A[both]) if both.any() else 1.0])
    size = np.sqrt(of_A / c[0] + of_B / c[1])
    unit = np.where(size > 0.0, size, 1.0)
    scaled = np.stack([A / c[0], B / c[1]]) / np.outer(unit, unit)

    values, vectors = np.linalg.eigh(scaled.sum(axis=0))
    kept = values > eps * max(1.0, values[-1])
    root = vectors[:, kept] * np.sqrt(values[kept])
    inverse = vectors[:, kept] / np.sqrt(values[kept])
    share, rotation = np.linalg.eigh(inverse.T @ scaled[0] @ inverse)
    share = np.clip(share, 0.0, 1.0)
    shares = np.stack([share, 1.0 - share])
    directions = root @ rotation
    missed = np.abs((directions * shares[:, None]) @ directions.T - scaled).max(axis=(1, 2))
    return FormPair(
        directions=unit[:, None] * directions,
        weights=(c[:, None] * shares).T,
        size=size,
        rounding=c * (4.0 * (len(A) + 4) * eps + missed),
    )


def face_forms(S_m: Floats, S_b: Floats, pair: FormPair) -> Floats:
    """Evaluate both forms of top stress S_m + S_b and bottom stress S_m - S_b, modal stress (n, m): (2, n, 2)."""
    return part_forms(S_m, S_b, pair)[..., 2:]


def part_forms(S_m: Floats, S_b: Floats, pair: FormPair) -> Floats:
    """Evaluate both forms of membrane, bending, top and bottom stress, modal stress (n, m): (2, n, 4)."""
    forms = np.zeros((2, len(S_m), 4))
    if pair.directions.size:
        S_m, S_b, T, weights = (np.ascontiguousarray(a) for a in (S_m, S_b, pair.directions, pair.weights.T))
        _sum_squares(S_m, S_b, T, weights, AT_ONCE, forms)
    return forms


@compiled("reassoc", "contract")
def _sum_squares(S_m: Floats, S_b: Floats, T: Floats, weights: Floats, at_once: int, forms: Floats) -> None:
    """``forms = sum over k of weights_k p_k^2`` with p = T'w of both weights (2, r) and of membrane, bending and faces.

    Some stations at a time; BLAS multiplies.
    """
    room = np.empty((2, at_once, T.shape[1]))
    for first in range(0, len(S_m), at_once):
        n = min(at_once, len(S_m) - first)
        p_m, p_b = room[0, :n], room[1, :n]
        np.dot(S_m[first : first + n], T, p_m)
        np.dot(S_b[first : first + n], T, p_b)
        for i in range(n):
            for form in range(2):
                m = b = top = bottom = 0.0
                for k in range(T.shape[1]):
                    weight, x, y = weights[form, k], p_m[i, k], p_b[i, k]
                    m += weight * (x * x)
                    b += weight * (y * y)
                    top += weight * ((x + y) * (x + y))
                    bottom += weight * ((x - y) * (x - y))
                parts = forms[form, first + i]
                parts[0], parts[1], parts[2], parts[3] = m, b, top, bottom
