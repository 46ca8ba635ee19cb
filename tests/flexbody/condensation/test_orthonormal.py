"""Orthonormal shapes: unit modal mass, no rigid motion, what depends on others dropped and counted."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from fatigue.flexbody.condensation.free_interface import free_interface
from fatigue.flexbody.condensation.guyan import guyan
from fatigue.flexbody.condensation.orthonormal import orthonormal, reduced
from fatigue.flexbody.factor import free_body, unit_rigid_motions
from fatigue.flexbody.structure import Structure
from tests.spring_body import NODES, SEEDS, masters_of, spring_body


def is_orthonormal(S, basis):
    """Unit modal mass, diagonal stiffness, nothing rigid, in ascending order."""
    K_r, M_r = reduced(S, basis.shapes)
    w2 = (2 * np.pi * basis.frequency) ** 2
    assert M_r == pytest.approx(np.eye(len(w2)), abs=1e-8)
    assert K_r == pytest.approx(np.diag(w2), abs=1e-8 * w2.max())
    assert unit_rigid_motions(S).T @ (S.M @ basis.shapes) == pytest.approx(0.0, abs=1e-8)
    assert (np.diff(basis.frequency) >= 0.0).all()


@settings(max_examples=12)
@given(SEEDS, NODES, st.integers(1, 10))
def test_any_columns_become_orthonormal(seed, nodes, columns):
    """Columns that know nothing of rigid motions span as many elastic shapes as they are, up to those of the body."""
    S = spring_body(seed, nodes)
    T = np.random.default_rng(seed).standard_normal((3 * nodes, columns))
    found = orthonormal(S, T, 0.0)
    is_orthonormal(S, found.basis)
    assert len(found.basis.frequency) == min(columns, 3 * nodes - 6)
    assert found.dependent == 0
    assert not found.basis.normal.any()


@settings(max_examples=12)
@given(SEEDS, NODES, st.integers(0, 6), st.integers(0, 4))
def test_rigid_motions_are_dropped_however_many_there_are(seed, nodes, rigid, turned):
    """Some rigid motions among the columns, or hidden in combinations of them: it is never the first six that go."""
    S = spring_body(seed, nodes)
    rng = np.random.default_rng(seed)
    R = unit_rigid_motions(S)[:, :rigid]
    own = rng.standard_normal((3 * nodes, 5))
    T = np.hstack([R, own])
    if turned:
        T = T @ np.linalg.qr(rng.standard_normal((5 + rigid, 5 + rigid)))[0]
    found = orthonormal(S, T, np.inf)
    is_orthonormal(S, found.basis)
    assert (len(found.basis.frequency), found.dependent) == (5, 0)
    assert found.basis.frequency == pytest.approx(orthonormal(S, own, np.inf).basis.frequency, rel=1e-6)


@settings(max_examples=12)
@given(SEEDS, NODES, st.integers(1, 4))
def test_dependent_columns_are_dropped_and_counted(seed, nodes, copies):
    """The same load twice, or a sum of loads, adds nothing but a number."""
    body = free_body(spring_body(seed, nodes))
    S, rng = body.structure, np.random.default_rng(seed)
    F = rng.standard_normal((3 * nodes, 3))
    once = orthonormal(S, free_interface(body, F, count=2), np.inf)
    again = orthonormal(S, free_interface(body, np.hstack([F, F @ rng.standard_normal((3, copies))]), count=2), np.inf)
    assert (once.dependent, again.dependent) == (0, copies)
    assert again.basis.frequency == pytest.approx(once.basis.frequency, rel=1e-6)


@settings(max_examples=10)
@given(SEEDS, NODES, st.floats(-9.0, 9.0))
def test_scale_of_columns_says_nothing(seed, nodes, decades):
    """A column in other units spans the same."""
    S = spring_body(seed, nodes)
    T = guyan(S, masters_of(S, 4))
    scaled = T * 10.0 ** np.linspace(0.0, decades, T.shape[1])
    assert orthonormal(S, scaled, np.inf).basis.frequency == pytest.approx(
        orthonormal(S, T, np.inf).basis.frequency, rel=1e-6
    )


def test_zero_columns_and_repeated_shapes_are_dependent():
    """A column of nothing is dropped; so is one of two alike."""
    S = spring_body(1, 6)
    T = guyan(S, masters_of(S, 4))
    found = orthonormal(S, np.hstack([T, np.zeros((18, 2)), T[:, :1]]), np.inf)
    assert (len(found.basis.frequency), found.dependent) == (6, 3)


def test_a_combination_without_mass_has_no_frequency():
    """A node without mass, held by springs, moves alone with no inertia: dropped, counted, and no harm done."""
    S = spring_body(4, 7)
    mass = S.M.diagonal()
    mass[-3:] = 0.0
    light = Structure(S.K, sparse.csc_array(np.diag(mass)), S.node, S.direction, S.xyz)
    found = orthonormal(light, np.eye(21), np.inf)
    assert (len(found.basis.frequency), found.dependent) == (12, 3)
    expected = orthonormal(light, guyan(light, masters_of(light, 6)), np.inf).basis.frequency
    assert found.basis.frequency == pytest.approx(expected, rel=1e-7)


def test_only_rigid_motions_leave_no_shape():
    """A span of rigid motions has no elastic shape."""
    S = spring_body(1, 6)
    found = orthonormal(S, unit_rigid_motions(S), 1.0)
    assert found.basis.shapes.shape == (18, 0)
    assert found.dependent == 0


def test_the_same_twice_and_positive_first():
    """The same bytes in every run; the first of the large components of a shape is positive."""
    S = spring_body(1, 8)
    T = guyan(S, masters_of(S, 5))
    first, second = orthonormal(S, T, 10.0).basis, orthonormal(S, T.copy(), 10.0).basis
    assert first.shapes.tobytes() == second.shapes.tobytes()
    turned = orthonormal(S, -T, 10.0).basis
    assert turned.shapes == pytest.approx(first.shapes, abs=1e-9)
    assert first.normal.tolist() == (first.frequency <= 10.0).tolist()
