"""Static condensation: exact under static loads on masters, and of rigid mass."""

import numpy as np
import pytest
from hypothesis import given, settings

from fatigue.errors import DataError
from fatigue.flexbody.condensation.guyan import guyan
from fatigue.flexbody.condensation.orthonormal import reduced
from fatigue.flexbody.factor import free_body
from fatigue.flexbody.mass import rigid_mass, rigid_motions
from tests.spring_body import NODES, SEEDS, masters_of, self_balanced, spring_body


@settings(max_examples=12)
@given(SEEDS, NODES)
def test_static_loads_on_masters_are_exact(seed, nodes):
    """The reduced body and the whole one move alike under forces on masters, but for a rigid motion."""
    S = spring_body(seed, nodes)
    masters = masters_of(S, 4)
    F = self_balanced(S, seed, masters)
    T = guyan(S, masters)
    K_r, _ = reduced(S, T)
    x = T @ np.linalg.lstsq(K_r, T.T @ F, rcond=None)[0]
    assert S.K @ x == pytest.approx(F, abs=1e-8 * abs(F).max())
    assert x @ F == pytest.approx(F @ free_body(S).elastic(F[:, None])[:, 0], rel=1e-8)


@settings(max_examples=12)
@given(SEEDS, NODES)
def test_rigid_motions_and_mass_are_kept(seed, nodes):
    """Masters that move rigidly take all slaves along, and the reduced mass is then that of the body."""
    S = spring_body(seed, nodes)
    masters = masters_of(S, 4)
    T = guyan(S, masters)
    R = rigid_motions(S.xyz, S.direction)
    assert T @ R[masters] == pytest.approx(R, abs=1e-9 * abs(R).max())
    M_r = reduced(S, T)[1]
    assert R[masters].T @ M_r @ R[masters] == pytest.approx(rigid_mass(S.M, R), rel=1e-9, abs=1e-8)


@settings(max_examples=12)
@given(SEEDS, NODES)
def test_stiffness_is_weakened_and_never_strengthened(seed, nodes):
    """K_mm less the reduced stiffness is positive semi-definite: free slaves only give way."""
    S = spring_body(seed, nodes)
    masters = masters_of(S, 3)
    K_mm = S.K[masters][:, masters].toarray()
    lost = np.linalg.eigvalsh(K_mm - reduced(S, guyan(S, masters))[0])
    assert lost.min() > -1e-9 * abs(K_mm).max()


def test_all_rows_as_masters_change_nothing():
    """Without slaves T is the identity."""
    S = spring_body(1, 6)
    assert guyan(S, np.ones(18, dtype=bool)).tolist() == np.eye(18).tolist()


def test_masters_that_do_not_hold_the_body_are_refused():
    """Two nodes of a body of pinned springs let it turn about the line between them."""
    S = spring_body(1, 6)
    with pytest.raises(DataError, match="moves freely"):
        guyan(S, masters_of(S, 2))
