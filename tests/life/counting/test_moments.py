"""Mean and kurtosis of a signal."""

import numpy as np
import pytest
from scipy.stats import kurtosis

from fatigue.life.counting.moments import mean_and_kurtosis


@pytest.mark.parametrize("samples", [1, 2, 8, 63, 64, 65, 1000])
def test_moments_are_those_of_scipy(samples):
    """Of each signal, far from zero."""
    s = 1e3 + np.random.default_rng(samples).lognormal(size=(3, samples))
    mean, found = mean_and_kurtosis(s)
    np.testing.assert_allclose(mean, s.mean(axis=1), rtol=1e-15)
    if samples > 1:
        np.testing.assert_allclose(found, kurtosis(s, axis=1, fisher=False), rtol=1e-9)


def test_a_constant_signal_has_its_value_as_mean_and_no_kurtosis():
    """Exactly, also where the sum of so many samples is rounded; no samples have neither."""
    mean, found = mean_and_kurtosis(np.full((1, 1001), 0.1))
    assert mean[0] == 0.1
    assert np.isnan(found[0])
    assert np.isnan(mean_and_kurtosis(np.empty((1, 0)))).all()
