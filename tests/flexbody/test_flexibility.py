"""The flexibility index against static solutions of a free beam, and the directions that interface modes span."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.flexbody.flexibility import flexibility_index, flexibility_of_modes, spanned
from tests.free_beam import BENDING_STIFFNESS, LENGTH, MASS_PER_MM, free_beam

BEAM = free_beam()
LOADED = st.lists(st.integers(0, 21), min_size=1, max_size=4, unique=True)


def ratio(basis, loaded, scale=1.0):
    """Flexibility index of loaded degrees of freedom over the static solution; every mode multiplied by a scale."""
    scale = scale * np.ones(len(basis.frequency))
    index = flexibility_index(basis.shape[loaded] * scale, scale**2, basis.frequency)
    return index / np.diag(BEAM.static(loaded)[loaded])


def test_mass_on_a_spring_has_the_flexibility_of_the_spring():
    """One mode: 1 / k, whatever the mass."""
    stiffness, mass = 250.0, 0.7
    hz = np.array([np.sqrt(stiffness / mass) / (2 * np.pi)])
    assert flexibility_index(np.ones((1, 1)), np.array([mass]), hz)[0] == pytest.approx(1 / stiffness, rel=1e-14)


def test_static_solution_of_the_beam_against_its_closed_form():
    """Under a force at its end a free beam of mass m turns so that v is L^3 / (105 E I) at the end, less rigid motion.

    A load P at the end is balanced by q(x) = P (4 L - 6 x) / L^2: E I v'''' = -q.
    """
    fine = free_beam(40)
    assert fine.static([0])[0, 0] == pytest.approx(LENGTH**3 / (105 * BENDING_STIFFNESS), rel=1e-6)
    assert fine.w[0] == pytest.approx(22.3733 / LENGTH**2 * np.sqrt(BENDING_STIFFNESS / MASS_PER_MM), rel=1e-5)


@given(LOADED, st.integers(1, 6))
@settings(deadline=None, max_examples=30)
def test_residual_modes_make_the_index_that_of_the_body(loaded, kept):
    """With a residual attachment mode for each loaded direction the ratio is 1, however few modes are kept."""
    np.testing.assert_allclose(ratio(BEAM.with_residual(kept, loaded), loaded), 1.0, rtol=1e-9)


@given(LOADED)
@settings(deadline=None, max_examples=30)
def test_normal_modes_alone_are_too_stiff(loaded):
    """Without residual modes the ratio grows with the number of modes, never beyond 1, and ends there."""
    of_counts = np.array([ratio(BEAM.normal(count), loaded) for count in range(1, 21)])
    assert (np.diff(of_counts, axis=0) >= -1e-12).all()
    assert (of_counts[:6].min(axis=0) < 0.999).all()
    assert of_counts.max() <= 1 + 1e-9
    np.testing.assert_allclose(of_counts[-1], 1.0, rtol=1e-9)


@given(st.integers(1, 5), st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=20)
def test_the_normalisation_of_a_mode_says_nothing(kept, seed):
    """A mode of another size with its modal mass gives the same index."""
    loaded, basis = [0, 9], BEAM.with_residual(kept, [0, 9])
    scale = np.exp(np.random.default_rng(seed).normal(0.0, 3.0, len(basis.frequency)))
    np.testing.assert_allclose(ratio(basis, loaded, scale), ratio(basis, loaded), rtol=1e-12)


def test_what_modes_add_sums_up():
    """The index is the sum of what the modes add, none of them below 0."""
    basis = BEAM.normal(5)
    of_modes = flexibility_of_modes(basis.shape, np.ones(5), basis.frequency)
    assert (of_modes >= 0).all()
    np.testing.assert_allclose(of_modes.sum(axis=1), flexibility_index(basis.shape, np.ones(5), basis.frequency))


def test_independent_directions():
    """Three directions of two modes: one combination is lost; a direction that nothing moves is told apart."""
    shape = np.array([[1.0, 0.0], [0.0, 2e-3], [1.0, 2e-3], [0.0, 0.0]])
    found = spanned(shape, np.array([1.0, 1.0, 1.0, 1.0]))
    assert (found.rank, found.not_moved.tolist()) == (2, [False, False, False, True])
    assert found.lost.shape == (1, 4)
    unit = shape[:3] / np.linalg.norm(shape[:3], axis=1, keepdims=True)
    np.testing.assert_allclose(found.lost[0, :3] @ unit, 0.0, atol=1e-12)
    assert spanned(np.zeros((2, 3)), np.ones(2)).rank == 0


@given(st.integers(1, 6), st.integers(1, 8), st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=40)
def test_rank_is_the_smaller_of_modes_and_directions(directions, modes, seed):
    """Shapes drawn at random span as many directions as there are, or as there are modes; the rest is lost."""
    shape = np.random.default_rng(seed).standard_normal((directions, modes))
    found = spanned(shape, np.linalg.norm(shape, axis=1))
    assert found.rank == min(directions, modes)
    assert len(found.lost) == directions - found.rank
    unit = shape / np.linalg.norm(shape, axis=1, keepdims=True)
    np.testing.assert_allclose(found.lost @ unit, 0.0, atol=1e-8)
