"""Many quadratic forms of the same points at once, from the products of all pairs of modes.

``s' M s = sum over i <= j of w_ij s_i s_j`` with ``w_ii = M_ii`` and ``w_ij = 2 M_ij`` beside the diagonal. A symmetric
matrix holds every number beside the diagonal twice, so this takes half the products of ``s' (M s)``. For all matrices
together it is one matrix product, of their weights with the products of the pairs.
"""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

T = TypeVar("T", np.float32, np.float64)

BLOCK_POINTS = 32  # their products of pairs, of a hundred modes in single precision, stay in the second-level cache


def pairs(modes: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """First and second mode of each pair, first <= second: the upper triangle, row by row."""
    first = np.repeat(np.arange(modes), np.arange(modes, 0, -1))
    return first, np.arange(len(first)) - first * (2 * modes - first - 1) // 2


def weights_of_pairs(modes: int) -> NDArray[np.float64]:
    """How often the number of each pair stands in a symmetric matrix: 1 on the diagonal, 2 beside it."""
    first, second = pairs(modes)
    return np.where(first == second, 1.0, 2.0)


def pair_forms(modal_stress: NDArray[np.floating], weights: NDArray[T]) -> NDArray[T]:
    """Quadratic forms, (p, n), given by their weights (p, pairs), of all rows of ``modal_stress`` (n, m).

    In the precision of the weights.
    """
    forms = np.empty((len(weights), len(modal_stress)), dtype=weights.dtype)
    for begin in range(0, len(modal_stress), BLOCK_POINTS):
        block = modal_stress[begin : begin + BLOCK_POINTS].T.astype(weights.dtype, order="C")
        products = np.empty((weights.shape[1], block.shape[1]), dtype=weights.dtype)
        _multiply_pairs(block, products)
        forms[:, begin : begin + BLOCK_POINTS] = weights @ products
    return forms


@compiled()
def _multiply_pairs(block: NDArray[np.floating], products: NDArray[np.floating]) -> None:
    """Write the products of all pairs of the modes of some points, (m, n), as (pairs, n), in the order of ``pairs``."""
    pair = 0
    for first in range(len(block)):
        for second in range(first, len(block)):
            for point in range(block.shape[1]):
                products[pair, point] = block[first, point] * block[second, point]
            pair += 1
