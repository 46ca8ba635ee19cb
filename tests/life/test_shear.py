"""What shear adds to the equivalent range: the clause, its threshold, nothing where nothing varies."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.shear import shear_factor


def test_shear_below_a_third_costs_up_to_fifteen_percent():
    """In phase and at the clause's threshold of a third, shear adds 15.5 % to the range."""
    sigma, tau = 1.0, 1.0 / 3.0
    factor = shear_factor(np.array([sigma**2]), np.array([tau**2]), np.array([sigma * tau]))
    assert factor == pytest.approx(1.1547, rel=1e-4)


@settings(deadline=None, max_examples=80)
@given(tau=st.floats(0.01, 3.0), delta=st.floats(0.0, 3.14))
def test_shear_factor_is_the_clause_for_harmonic_paths(tau, delta):
    """The covariance form equals ASME's F(delta) for every amplitude ratio and phase."""
    a, b = 1.0, 3.0 * tau**2
    inner = 1.0 - 12.0 * tau**2 * np.sin(delta) ** 2 / (a + b) ** 2
    F = np.sqrt(0.5) * np.sqrt(1.0 + np.sqrt(max(inner, 0.0)))
    by_clause = np.sqrt(a + b) / F
    by_covariance = shear_factor(np.array([0.5]), np.array([tau**2 / 2]), np.array([tau * np.cos(delta) / 2]))
    assert by_covariance[0] == pytest.approx(by_clause, rel=1e-6)


def test_shear_without_normal_stress_has_no_factor():
    """Where the normal stress does not vary there is nothing to multiply."""
    assert np.isnan(shear_factor(np.zeros(1), np.ones(1), np.zeros(1))[0])
