"""Percentiles over units: linear, as numpy and DuckDB have them, and infinite where lives are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fatigue.decide.fleet.percentiles import percentiles

KM = np.array([[5.0, 1.0, 2.0], [6.0, 0.5, 4.0], [4.0, 2.0, 3.0], [7.0, 0.0, 5.0], [5.5, 1.5, 1.0]]) * 1e6
D = np.array([2e-8, 9e-8, 3e-8])


def test_lives_of_five_units():
    """Oracle [B4 units]."""
    damage = KM @ D
    np.testing.assert_allclose(damage, [0.25, 0.285, 0.35, 0.29, 0.275], rtol=1e-12)
    told = [3.0935960591133007, 3.5087719298245617, 3.8545454545454545]
    np.testing.assert_allclose(percentiles(1.0 / damage, [10.0, 50.0, 90.0]), told, rtol=1e-12)


@given(
    arrays(np.float64, st.tuples(st.integers(1, 3), st.integers(1, 9)), elements=st.floats(0.0, 1e9)),
    st.lists(st.floats(0.0, 100.0), min_size=1, max_size=5),
)
def test_they_are_those_of_numpy(values, percent):
    """Over the last axis, for any number of units."""
    want = np.moveaxis(np.quantile(values, np.array(percent) / 100.0, axis=-1), 0, -1)
    np.testing.assert_allclose(percentiles(values, percent), want, rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize(
    ("percent", "want"), [(0.0, 1.0), (25.0, 2.0), (26.0, np.inf), (75.0, np.inf), (100.0, np.inf)]
)
def test_lives_without_end(percent, want):
    """Between a life and an infinite one it is infinite; between two infinite ones as well."""
    values = np.array([np.inf, 2.0, np.inf, 1.0, np.inf])
    assert percentiles(values, [percent])[0] == want
