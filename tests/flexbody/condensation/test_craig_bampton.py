"""Craig-Bampton: static loads exact with any cut, the whole body with all modes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.flexbody.condensation.craig_bampton import craig_bampton
from fatigue.flexbody.condensation.guyan import guyan
from fatigue.flexbody.condensation.orthonormal import orthonormal, reduced
from fatigue.flexbody.factor import free_body
from tests.spring_body import NODES, SEEDS, elastic_modes, masters_of, self_balanced, spring_body


@settings(max_examples=12)
@given(SEEDS, NODES)
def test_with_all_modes_it_is_the_body(seed, nodes):
    """All fixed-interface modes give all modes of the body, frequencies and shapes."""
    S = spring_body(seed, nodes)
    T = craig_bampton(S, masters_of(S, 4), count=3 * (nodes - 4))
    basis = orthonormal(S, T, np.inf).basis
    hz, exact = elastic_modes(S)
    assert basis.frequency == pytest.approx(hz, rel=1e-7)
    alike = np.abs(np.einsum("ij,ij->j", basis.shapes, S.M @ exact))
    apart = np.r_[True, np.diff(hz) > 1e-3 * hz[1:]] & np.r_[np.diff(hz) > 1e-3 * hz[1:], True]
    assert alike[apart] == pytest.approx(1.0, abs=1e-6)


@settings(max_examples=12)
@given(SEEDS, NODES, st.integers(0, 5))
def test_frequencies_come_from_above(seed, nodes, count):
    """By Rayleigh and Ritz no frequency is below that of the body, and none rises when a mode is added."""
    S = spring_body(seed, nodes)
    masters = masters_of(S, 4)
    less, more = (orthonormal(S, craig_bampton(S, masters, count=n), np.inf).basis for n in (count, count + 1))
    exact = elastic_modes(S)[0]
    assert (less.frequency >= exact[: len(less.frequency)] * (1 - 1e-9)).all()
    assert (more.frequency[: len(less.frequency)] <= less.frequency * (1 + 1e-9)).all()
    assert len(more.frequency) == len(less.frequency) + 1


@settings(max_examples=12)
@given(SEEDS, NODES, st.integers(0, 3))
def test_static_loads_on_masters_are_exact_with_any_cut(seed, nodes, count):
    """The shapes alone give the static answer under forces on masters."""
    S = spring_body(seed, nodes)
    masters = masters_of(S, 4)
    F = self_balanced(S, seed, masters)
    basis = orthonormal(S, craig_bampton(S, masters, count=count), np.inf).basis
    x = basis.shapes @ ((basis.shapes.T @ F) / (2 * np.pi * basis.frequency) ** 2)
    assert x == pytest.approx(free_body(S).elastic(F[:, None])[:, 0], abs=1e-8 * abs(x).max())


def test_columns_are_constraint_modes_and_modes_below_the_cut():
    """Constraint modes come first; the stiffness of both kinds is not coupled."""
    S = spring_body(2, 9)
    masters = masters_of(S, 4)
    every = craig_bampton(S, masters, count=15)
    hz = np.sqrt(np.diag(reduced(S, every)[0])[12:]) / (2 * np.pi)
    T = craig_bampton(S, masters, upto_hz=(hz[6] + hz[7]) / 2)
    assert T.shape == (27, 12 + 7)
    assert T[:, :12].tolist() == guyan(S, masters).tolist()
    K_r = reduced(S, T)[0]
    assert K_r[:12, 12:] == pytest.approx(0.0, abs=1e-9 * abs(K_r).max())
    assert K_r[12:, 12:] == pytest.approx(np.diag((2 * np.pi * hz[:7]) ** 2), abs=1e-7 * abs(K_r[12:, 12:]).max())


def test_a_cut_below_all_modes_is_guyan():
    """No fixed-interface mode is left below 15 Hz of the frame with 18 nodes: that is a case, no mistake."""
    S = spring_body(2, 9)
    masters = masters_of(S, 4)
    assert craig_bampton(S, masters, upto_hz=1e-3).tolist() == guyan(S, masters).tolist()
