"""Elongation rows against finite displacements; energy and dissipation of what they add."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from fatigue.vehicle.equations.coordinates import BOGIES, CAR, WHEELSETS, Coordinates
from fatigue.vehicle.equations.springs import Spring, damping, elongation, from_rail, stacked, stiffness

AT = Coordinates(0)
places = st.tuples(*[st.floats(-10.0, 10.0)] * 3).map(np.array)
small = st.tuples(*[st.floats(-1e-4, 1e-4)] * 5).map(np.array)


def moved(place, cg, q):
    """Displacement of a place on a rigid body with the motion q: y, z, and a finite rotation about its cg."""
    arm = place - cg
    return np.array([0.0, q[0], q[1]]) + Rotation.from_rotvec(q[2:]).apply(arm) - arm


@given(places, places, places, places, small, small, st.sampled_from([0, 1, 2]))
@settings(deadline=None, max_examples=60)
def test_a_row_gives_the_elongation_between_two_moved_bodies(a, b, cg_a, cg_b, q_a, q_b, direction):
    """To first order: what is left is of second order in the rotations."""
    row = elongation(direction, AT.carried(CAR, cg_a, a), AT.carried(BOGIES[0], cg_b, b))
    q = np.zeros(AT.size)
    q[AT.of(CAR)], q[AT.of(BOGIES[0])] = q_a, q_b
    finite = (moved(a, cg_a, q_a) - moved(b, cg_b, q_b))[direction]
    second_order = (np.abs(q_a[2:]).sum() ** 2 + np.abs(q_b[2:]).sum() ** 2) * 40.0
    assert row @ q == pytest.approx(finite, abs=second_order + 1e-15)


def test_a_wheelset_moves_sideways_and_turns_alone():
    """No roll, no rise: a point 1 m to the left of its centre moves back along x by the yaw."""
    motion = AT.carried(WHEELSETS[1], np.array([7.5, 0.0, 0.46]), np.array([7.5, 1.0, 0.46]))
    y, yaw = AT.column(WHEELSETS[1], "y"), AT.column(WHEELSETS[1], "rz")
    assert motion[:, y].tolist() == [0.0, 1.0, 0.0]
    assert motion[:, yaw].tolist() == [-1.0, 0.0, 0.0]
    assert np.count_nonzero(motion) == 2


rows = st.lists(st.lists(st.floats(-5.0, 5.0), min_size=4, max_size=4), min_size=1, max_size=5)


@given(rows, st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4), st.integers(0, 10_000))
@settings(deadline=None, max_examples=50)
def test_energy_is_the_sum_of_the_elements(rows, q, seed):
    """``q K q / 2 = sum of k e^2/2`` and the same of what is dissipated; K and C are symmetric."""
    rng, q = np.random.default_rng(seed), np.array(q)
    springs = [Spring(str(k), np.array(row), *rng.uniform(1.0, 1e3, 2)) for k, row in enumerate(rows)]
    e = stacked(springs) @ q
    k, c = (np.array([getattr(spring, key) for spring in springs]) for key in ("stiffness", "damping"))
    K, C = stiffness(springs), damping(springs)
    assert q @ K @ q == pytest.approx(k @ e**2, abs=1e-6)
    assert q @ C @ q == pytest.approx(c @ e**2, abs=1e-6)
    np.testing.assert_allclose(K, K.T, atol=1e-12)
    np.testing.assert_allclose(C, C.T, atol=1e-12)


def test_what_the_rail_pushes_with():
    """A spring that stands on the rail feels ``k w + c w'`` along its row; one that does not, nothing."""
    standing = Spring("z", np.array([1.0, 2.0]), 10.0, 3.0, np.array([0.0, 1.0, -0.5]))
    hanging = Spring("y", np.array([1.0, 0.0]), 7.0, 1.0)
    of_value, of_rate = from_rail([standing, hanging], 3)
    assert of_value.tolist() == [[0.0, 10.0, -5.0], [0.0, 20.0, -10.0]]
    assert of_rate.tolist() == [[0.0, 3.0, -1.5], [0.0, 6.0, -3.0]]
