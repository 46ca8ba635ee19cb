"""Completeness: flexibility that grows with the basis and is never too large, masses that sum up to the body."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.flexbody.condensation.completeness import effective_masses, flexibility_ratio
from fatigue.flexbody.condensation.craig_bampton import craig_bampton
from fatigue.flexbody.condensation.orthonormal import orthonormal
from fatigue.flexbody.factor import free_body
from fatigue.flexbody.modes import free_modes, held_modes
from tests.spring_body import NODES, SEEDS, masters_of, spring_body


@settings(max_examples=12)
@given(SEEDS, NODES, st.integers(0, 4))
def test_flexibility_grows_with_the_basis(seed, nodes, count):
    """Each fixed-interface mode adds flexibility; and none makes it more flexible than the body."""
    body = free_body(spring_body(seed, nodes))
    S, masters = body.structure, masters_of(body.structure, 4)
    F = np.eye(3 * nodes)
    less, more = (
        flexibility_ratio(body, orthonormal(S, craig_bampton(S, masters, count=n), np.inf).basis, F)
        for n in (count, count + 1)
    )
    assert (more >= less - 1e-8).all()
    assert (more <= 1.0 + 1e-8).all()


@settings(max_examples=12)
@given(SEEDS, NODES)
def test_all_modes_are_complete(seed, nodes):
    """All modes of the free body have its flexibility, at every degree of freedom."""
    body = free_body(spring_body(seed, nodes))
    every = free_modes(body, count=3 * nodes - 6)
    assert flexibility_ratio(body, every, np.eye(3 * nodes)) == pytest.approx(np.ones(3 * nodes), rel=1e-7)


@settings(max_examples=12)
@given(SEEDS, NODES)
def test_effective_masses_sum_up(seed, nodes):
    """All fixed-interface modes and the mass on the interface are the body; a band carries a share of it."""
    S = spring_body(seed, nodes)
    masters = masters_of(S, 4)
    fixed = held_modes(S, masters, count=3 * (nodes - 4))
    found = effective_masses(S, masters, fixed, S.xyz.mean(axis=0))
    assert found.effective.sum(axis=0) + found.boundary == pytest.approx(found.total, rel=1e-8)
    assert found.total[:3] == pytest.approx(S.M.diagonal().sum() / 3.0)
    below = found.share(fixed.frequency[2])
    assert below == pytest.approx(found.effective[:3].sum(axis=0) / found.total)
    assert (below <= 1.0).all()
