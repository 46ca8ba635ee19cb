"""Dynamic condensation: exact at its frequency, Guyan's at 0, refused where it has no answer."""

import numpy as np
import pytest
from hypothesis import assume, given, settings

from fatigue.errors import NumericalError
from fatigue.flexbody.condensation.guyan import guyan
from fatigue.flexbody.condensation.kuhar import kuhar
from fatigue.flexbody.condensation.orthonormal import orthonormal, reduced
from fatigue.flexbody.factor import unit_rigid_motions
from fatigue.flexbody.modes import held_modes
from tests.spring_body import NODES, SEEDS, elastic_modes, masters_of, spring_body


def away_from(hz, frequencies):
    """Tell whether a frequency is some per cent away from others."""
    return abs(hz / frequencies - 1.0).min() > 0.02


@settings(max_examples=12)
@given(SEEDS, NODES)
def test_exact_at_its_frequency(seed, nodes):
    """The reduced body answers a harmonic force on masters at p as the whole one does; so does the basis made of it."""
    S = spring_body(seed, nodes)
    masters = masters_of(S, 4)
    hz = elastic_modes(S)[0][1] * 1.1
    assume(away_from(hz, held_modes(S, masters, count=3 * (nodes - 4)).frequency))
    assume(away_from(hz, elastic_modes(S)[0]))
    p2 = (2 * np.pi * hz) ** 2
    F = np.where(masters, np.random.default_rng(seed).standard_normal(3 * nodes), 0.0)
    x = np.linalg.solve((S.K - p2 * S.M).toarray(), F)
    T = kuhar(S, masters, hz)
    K_r, M_r = reduced(S, T)
    assert T @ np.linalg.solve(K_r - p2 * M_r, T.T @ F) == pytest.approx(x, rel=1e-6, abs=1e-7 * abs(x).max())
    basis, R = orthonormal(S, T, np.inf).basis, unit_rigid_motions(S)
    q = (basis.shapes.T @ F) / ((2 * np.pi * basis.frequency) ** 2 - p2)
    assert basis.shapes @ q - R @ (R.T @ F) / p2 == pytest.approx(x, rel=1e-5, abs=1e-6 * abs(x).max())


@settings(max_examples=12)
@given(SEEDS, NODES)
def test_a_mode_at_its_frequency_is_kept(seed, nodes):
    """Condensed at a natural frequency, the body has that mode exactly."""
    S = spring_body(seed, nodes)
    masters = masters_of(S, 4)
    hz = elastic_modes(S)[0]
    assume(away_from(hz[0], held_modes(S, masters, count=3 * (nodes - 4)).frequency))
    found = orthonormal(S, kuhar(S, masters, hz[0]), np.inf).basis.frequency
    assert abs(found / hz[0] - 1.0).min() < 1e-7


def test_at_rest_it_is_that_of_guyan():
    """At 0 Hz the dynamic stiffness is the static one."""
    S = spring_body(3, 7)
    masters = masters_of(S, 3)
    assert kuhar(S, masters, 0.0) == pytest.approx(guyan(S, masters), abs=1e-12)


@pytest.mark.parametrize("off", [0.0, 1e-9, -3e-8, 5e-7])
@pytest.mark.parametrize("which", [0, 3, -1])
def test_refused_at_a_fixed_interface_mode(which, off):
    """At, or within a millionth of, a mode of the body with held masters nothing can be said."""
    S = spring_body(5, 7)
    masters = masters_of(S, 4)
    hz = held_modes(S, masters, count=9).frequency[which]
    with pytest.raises(NumericalError, match=r"with its interface held, the body has a mode at .* Hz"):
        kuhar(S, masters, hz * (1.0 + off))


def test_near_a_fixed_interface_mode_is_fine():
    """A part in ten thousand away it is exact still."""
    S = spring_body(5, 7)
    masters = masters_of(S, 4)
    hz = held_modes(S, masters, count=1).frequency[0] * 1.0001
    T = kuhar(S, masters, hz)
    D = (S.K - (2 * np.pi * hz) ** 2 * S.M).toarray()
    assert (D @ T)[~masters] == pytest.approx(0.0, abs=1e-10 * abs(D).max() * abs(T).max())


def test_masters_may_be_all_rows():
    """Without slaves there is nothing to condense."""
    assert kuhar(spring_body(1, 6), np.ones(18, dtype=bool), 10.0).tolist() == np.eye(18).tolist()
