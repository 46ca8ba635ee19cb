"""Quadratic forms from products of pairs of modes."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.spectrum.pairs import pair_forms, pairs, weights_of_pairs


@settings(deadline=None, max_examples=20)
@given(modes=st.integers(1, 40))
def test_pairs_are_the_upper_triangle_row_by_row(modes):
    """As numpy orders it; beside the diagonal each number stands twice in a symmetric matrix."""
    first, second = pairs(modes)
    np.testing.assert_array_equal(np.stack([first, second]), np.stack(np.triu_indices(modes)))
    assert weights_of_pairs(modes).sum() == modes**2


@settings(deadline=None, max_examples=20)
@given(points=st.integers(0, 300), modes=st.integers(1, 9))
def test_forms_are_those_of_the_matrices(points, modes):
    """Indefinite symmetric matrices, any number of points, whatever the block."""
    rng = np.random.default_rng(points)
    half = rng.normal(size=(5, modes, modes))
    matrices = half + half.transpose(0, 2, 1)
    modal_stress = rng.normal(size=(points, modes))
    first, second = pairs(modes)
    weights = (weights_of_pairs(modes) * matrices[:, first, second]).astype(np.float32)
    found = pair_forms(modal_stress, weights)
    assert found.dtype == np.float32
    slow = np.einsum("ni,pij,nj->pn", modal_stress, matrices, modal_stress)
    size = np.einsum("ni,pij,nj->pn", np.abs(modal_stress), np.abs(matrices), np.abs(modal_stress))
    assert np.all(np.abs(found - slow) <= 1e-5 * size)
