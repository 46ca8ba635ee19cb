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

from fatigue.life.rainflow import compiled

Floats = NDArray[np.float64]

AT_ONCE = 64  # stations whose products stay in the first-level cache


@dataclass(frozen=True, slots=True, eq=False)
class FormPair:
    """Two matrices (m, m) by their common directions; see `form_pair`.

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
    """Evaluate both forms of top stress S_m + S_b and bottom stress S_m - S_b, shapes (n, m): (2, n, 2)."""
    forms = np.empty((2, len(S_m), 2))
    weights = np.ascontiguousarray(pair.weights.T)
    for first in range(0, len(S_m), AT_ONCE):
        some = slice(first, first + AT_ONCE)
        _sum_squares(S_m[some] @ pair.directions, S_b[some] @ pair.directions, weights, forms[:, some])
    return forms


@compiled("reassoc", "contract")
def _sum_squares(p_m: Floats, p_b: Floats, weights: Floats, forms: Floats) -> None:
    """Sum the squares of p of both faces with both weights (2, r) into ``forms`` (2, n, 2)."""
    for i in range(len(p_m)):
        top_a = bottom_a = top_b = bottom_b = 0.0
        for k in range(p_m.shape[1]):
            a, b = weights[0, k], weights[1, k]
            top, bottom = p_m[i, k] + p_b[i, k], p_m[i, k] - p_b[i, k]
            top_a += a * (top * top)
            bottom_a += a * (bottom * bottom)
            top_b += b * (top * top)
            bottom_b += b * (bottom * bottom)
        forms[0, i, 0], forms[0, i, 1], forms[1, i, 0], forms[1, i, 1] = top_a, bottom_a, top_b, bottom_b
