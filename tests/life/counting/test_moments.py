"""Mean and kurtosis of a signal."""

import math

import numpy as np
import pytest
from scipy.stats import kurtosis

from fatigue.life.counting.moments import DEPTH, LANES, mean_and_kurtosis


@pytest.mark.parametrize("samples", [1, 2, LANES, LANES * DEPTH - 1, LANES * DEPTH, LANES * DEPTH + 1, 1000])
def test_moments_are_those_of_scipy(samples):
    """Whole lanes and what is left of them, far from zero."""
    s = 1e3 + np.random.default_rng(samples).lognormal(size=samples)
    mean, found = mean_and_kurtosis(s)
    assert mean == pytest.approx(s.mean(), rel=1e-15)
    if samples > 1:
        assert found == pytest.approx(kurtosis(s, fisher=False), rel=1e-9)


def test_a_constant_signal_has_its_value_as_mean_and_no_kurtosis():
    """Exactly, also where the sum of so many samples is rounded; no samples have neither."""
    mean, found = mean_and_kurtosis(np.full(1001, 0.1))
    assert mean == 0.1
    assert math.isnan(found)
    assert all(math.isnan(value) for value in mean_and_kurtosis(np.empty(0)))
