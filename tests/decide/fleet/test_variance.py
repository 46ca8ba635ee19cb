"""Variance shares in closed form against the oracles, and against the variance of everything that can happen."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.decide.fleet.distances import covariance
from fatigue.decide.fleet.variance import variance_of_damage

D = np.array([2e-8, 9e-8, 3e-8])
KM, SD = np.array([6e6, 1e6, 3e6]), np.array([1e6, 4e5, 1e6])


def test_independent_distances():
    """Oracle [B4 sobol_independent]: first order is total."""
    found = variance_of_damage(D, KM, np.diag(SD**2))
    shares = found.distance / found.total
    np.testing.assert_allclose(shares, [0.15408320493066258, 0.49922958397534667, 0.34668721109399075], rtol=1e-12)
    assert np.sqrt(found.total) == pytest.approx(0.050950956811427986, rel=1e-12)
    assert not found.damage.any()
    assert not found.both.any()


def test_correlated_distances():
    """Oracle [B4 correlated_rho_13_-0.6]: covariance shares."""
    rho = np.eye(3)
    rho[0, 2] = rho[2, 0] = -0.6
    found = variance_of_damage(D, KM, covariance(SD, rho))
    assert np.sqrt(found.total) == pytest.approx(0.04331281565541543, rel=1e-12)
    shares = found.distance / found.total
    np.testing.assert_allclose(shares, [0.0213219616204691, 0.6908315565031984, 0.28784648187633255], rtol=1e-12)


def test_products():
    """Oracle [B4 products]: distance, damage, and their interaction."""
    found = variance_of_damage(D, KM, np.diag(SD**2), (np.array([0.1, 0.3, 0.2]) * D) ** 2)
    assert found.total == pytest.approx(0.003949639999999999, rel=1e-12)
    parts = {
        "distance": [0.10127505291621518, 0.3281311714485371, 0.22786886906148413],
        "damage": [0.03645901904983746, 0.18457378393980212, 0.08203279286213427],
        "both": [0.0010127505291621518, 0.02953180543036834, 0.009114754762459366],
    }
    for name, want in parts.items():
        np.testing.assert_allclose(getattr(found, name) / found.total, want, rtol=1e-12)


@given(st.integers(0, 2**32 - 1), st.booleans())
def test_the_parts_are_the_variance(seed, shared):
    """Correlated distances and uncertain damage, two conditions with one damage: all outcomes weighed by hand."""
    rng = np.random.default_rng(seed)
    damage, sd = rng.uniform(-0.2, 1.0, 3), rng.uniform(0.0, 0.5, 3)
    same = np.array([0, 1, 0]) if shared else np.arange(3)
    if shared:
        damage[2], sd[2] = damage[0], sd[0]
    distances, weight = rng.uniform(0.0, 3.0, (4, 3)), rng.dirichlet(np.ones(4))
    mean = weight @ distances
    cov = (distances - mean).T @ (weight[:, None] * (distances - mean))
    found = variance_of_damage(damage, mean, cov, sd**2, same)
    outcomes = []
    for (row, w), *signs in product(zip(distances, weight, strict=True), *[(-1.0, 1.0)] * 3):
        error = np.array(signs)[same]  # conditions of one group err together
        outcomes.append((w / 8.0, float((damage + sd * error) @ row)))
    p, value = np.array(outcomes).T
    want = p @ value**2 - (p @ value) ** 2
    assert found.total == pytest.approx(want, rel=1e-9, abs=1e-12)
