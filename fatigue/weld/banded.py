"""Symmetric banded systems that do not touch one another, with many right sides each.

A positive definite A is factorised as ``A = L D L'`` without pivots; on a tridiagonal A this does the operations of
LAPACK's ptsv. The right sides of a row lie side by side, so every step runs along memory, and one system is solved
while it is in the cache.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


@compiled()
def solve_banded(
    band: Floats, place: Indices, begin: Indices, right_sides: NDArray[np.floating], solution: Floats
) -> None:
    """Solve the systems of the rows between ``begin`` (k + 1,) and write their solution (n, c).

    ``band`` (n, w + 1) holds ``A[i, i - d]`` at (i, d), zero across the begin of a system, and is used up. Row i of A
    belongs to the row ``place[i]`` of the right sides (n, c) and of the solution.
    """
    for system in range(len(begin) - 1):
        first, end = begin[system], begin[system + 1]
        _factorise(band[first:end])
        _substitute(band[first:end], place[first:end], right_sides, solution)


@compiled()
def _factorise(band: Floats) -> None:
    """Replace A by D, its column 0, and the rows of L beside it."""
    width = band.shape[1] - 1
    for i in range(len(band)):
        reach = min(i, width)
        for d in range(reach, 0, -1):  # until the row is done it holds L D
            for e in range(d + 1, reach + 1):
                band[i, d] -= band[i, e] * band[i - d, e - d]
        for d in range(reach, 0, -1):
            product = band[i, d]
            band[i, d] = product / band[i - d, 0]
            band[i, 0] -= product * band[i, d]


@compiled()
def _substitute(band: Floats, place: Indices, right_sides: NDArray[np.floating], solution: Floats) -> None:
    """Solve ``L y = b``, then ``D L' x = y``, all right sides of a row at a time."""
    n, width, columns = len(band), band.shape[1] - 1, right_sides.shape[1]
    for i in range(n):
        row, b = solution[place[i]], right_sides[place[i]]
        for c in range(columns):
            row[c] = b[c]
        for d in range(min(i, width), 0, -1):
            factor, above = band[i, d], solution[place[i - d]]
            for c in range(columns):
                row[c] -= factor * above[c]
    for i in range(n - 1, -1, -1):
        row, divisor = solution[place[i]], band[i, 0]
        for c in range(columns):
            row[c] /= divisor
        for d in range(1, min(n - 1 - i, width) + 1):
            factor, below = band[i + d, d], solution[place[i + d]]
            for c in range(columns):
                row[c] -= factor * below[c]
