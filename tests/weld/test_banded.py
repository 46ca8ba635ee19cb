"""Banded systems with many right sides: against a dense solver and the one of LAPACK."""

from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import solveh_banded

from fatigue.weld.banded import solve_banded

SIZES = st.lists(st.integers(1, 12), min_size=1, max_size=4)


def systems(sizes, width, columns, seed):
    """Positive definite systems, scaled over many decades: dense matrices, their bands, and their right sides."""
    rng = np.random.default_rng(seed)
    n = sum(sizes)
    dense, band, begin = np.zeros((n, n)), np.zeros((n, width + 1)), np.cumsum([0, *sizes])
    for a, b in pairwise(begin):
        A = np.triu(np.tril(rng.uniform(-1.0, 1.0, (b - a, b - a)), width), -width)
        A = A + A.T
        scale = 10.0 ** rng.uniform(-3.0, 3.0, b - a)
        dense[a:b, a:b] = (A + np.diag(1.0 + np.abs(A).sum(axis=1))) * np.outer(scale, scale)
    for d in range(width + 1):
        band[d:, d] = np.diagonal(dense, -d)
    return dense, band, begin, rng.normal(size=(n, columns))


@given(SIZES, st.integers(0, 4), st.integers(0, 5), st.integers(0, 10**6))
@settings(deadline=None, max_examples=60)
def test_every_system_is_solved(sizes, width, columns, seed):
    """Backward stable: what is left of the right sides is rounding of the terms, in every row of every system."""
    dense, band, begin, right_sides = systems(sizes, width, columns, seed)
    place = np.arange(len(dense))
    solution = np.empty(right_sides.shape)
    solve_banded(band, place, begin, right_sides, solution)
    left = np.abs(dense @ solution - right_sides)
    assert (left <= 50 * np.finfo(float).eps * (np.abs(dense) @ np.abs(solution) + np.abs(right_sides))).all()


@given(st.integers(2, 40), st.integers(1, 4), st.integers(0, 10**6))
@settings(deadline=None, max_examples=40)
def test_solution_of_lapack(n, width, seed):
    """To rounding that of scipy."""
    dense, band, begin, right_sides = systems([n], min(width, n - 1), 3, seed)
    solution = np.empty(right_sides.shape)
    lower = np.zeros(band.shape[::-1])
    for d in range(len(lower)):
        lower[d, : n - d] = np.diagonal(dense, -d)
    expected = solveh_banded(lower, right_sides, lower=True)
    solve_banded(band, np.arange(n), begin, right_sides, solution)
    scale = np.sqrt(np.diagonal(dense))[:, None]
    np.testing.assert_allclose(
        scale * solution, scale * expected, rtol=1e-13, atol=1e-13 * np.abs(scale * expected).max()
    )


@given(SIZES, st.integers(0, 4), st.integers(0, 10**6))
@settings(deadline=None, max_examples=30)
def test_neighbours_wider_bands_and_the_order_of_rows_leave_no_trace(sizes, width, seed):
    """A system has the same solution, to the last bit, alone, in a wider band, and with its rows at other places."""
    _, band, begin, right_sides = systems(sizes, width, 2, seed)
    together = np.empty(right_sides.shape)
    solve_banded(band.copy(), np.arange(len(band)), begin, right_sides, together)
    place = np.random.default_rng(seed).permutation(len(band))
    moved, right_sides_moved = np.empty(right_sides.shape), np.empty(right_sides.shape)
    right_sides_moved[place] = right_sides
    wider = np.pad(band, ((0, 0), (0, 2)))
    solve_banded(wider, place, begin, right_sides_moved, moved)
    np.testing.assert_array_equal(moved[place], together)
    for a, b in pairwise(begin):
        alone = np.empty((b - a, 2))
        solve_banded(band[a:b].copy(), np.arange(b - a), np.array([0, b - a]), right_sides[a:b].copy(), alone)
        np.testing.assert_array_equal(alone, together[a:b])
