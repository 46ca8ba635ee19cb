"""Stress on planes: linear in the state of stress, unlike the largest principal stress and that of von Mises."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.weld.beside.planes import PARENT_DEG, TOE_DEG, normal_stress, shear_stress

STRESS = st.floats(-200.0, 200.0)
STATES = st.lists(st.tuples(STRESS, STRESS, STRESS), min_size=2, max_size=8)
ROTATING = [(50.0 * np.cos(t), -50.0 * np.cos(t), 50.0 * np.sin(t)) for t in 2.0 * np.pi * np.arange(360) / 360.0]


def ranges(history, planes, of=normal_stress):
    """Range on each plane of a history of states (n, 3)."""
    on_planes = of(np.array(history, dtype=float).T, np.array(planes, dtype=float))
    return np.ptp(on_planes, axis=-1)


def tensor_on(states, phi_deg):
    """Normal and shear stress by turning the matrix of the state."""
    phi = np.deg2rad(phi_deg)
    n, s = np.array([np.cos(phi), np.sin(phi)]), np.array([-np.sin(phi), np.cos(phi)])
    matrices = [np.array([[sx, txy], [txy, sy]]) for sx, sy, txy in states]
    return np.array([n @ m @ n for m in matrices]), np.array([n @ m @ s for m in matrices])


@pytest.mark.parametrize(
    ("history", "planes", "best", "largest", "at_0"),
    [
        ([(0, 0, 0), (100, 20, 30)], TOE_DEG, 20, 109.925406015, 100.0),
        ([(0, 0, 0), (20, 100, 30)], TOE_DEG, 60, 105.980762114, 20.0),
        ([(0, 0, 30), (0, 0, -30)], PARENT_DEG, 45, 60.0, 0.0),
        ([(60, 0, 0), (-60, 0, 0)], TOE_DEG, 0, 120.0, 120.0),
    ],
)
def test_ranges_on_planes(history, planes, best, largest, at_0):
    """Principal stress within the planes, beyond them, pure shear, and a stress that changes its sign."""
    found = ranges(history, planes)
    assert planes[int((found > found.max() * (1.0 - 1e-12)).argmax())] == best
    assert found.max() == pytest.approx(largest, rel=1e-9)
    assert found[planes.index(0)] == pytest.approx(at_0, abs=1e-9)


def test_every_plane_sees_a_principal_stress_that_turns():
    """Its range is 2 A on every plane, where the largest principal stress and von Mises see nothing."""
    assert ranges(ROTATING, PARENT_DEG) == pytest.approx(np.full(36, 100.0), rel=1e-3)
    sx, sy, txy = np.array(ROTATING).T
    assert np.ptp((sx + sy) / 2 + np.hypot((sx - sy) / 2, txy)) == pytest.approx(0.0, abs=1e-9)
    assert np.ptp(np.sqrt(sx**2 - sx * sy + sy**2 + 3 * txy**2)) == pytest.approx(0.0, abs=1e-9)


@given(STATES, st.sampled_from(PARENT_DEG))
def test_planes_turn_the_tensor(states, phi):
    """Normal and shear stress are those of the turned matrix of the state."""
    normal, shear = tensor_on(states, phi)
    columns = np.array(states).T
    assert np.allclose(normal_stress(columns, np.array([phi]))[0], normal, atol=1e-9)
    assert np.allclose(shear_stress(columns, np.array([phi]))[0], shear, atol=1e-9)


@given(STATES, st.sampled_from(PARENT_DEG))
def test_a_normal_turned_over_turns_the_sign_of_the_angle(states, phi):
    """With the normal on the other side txy changes its sign, and the plane phi becomes -phi with the same stress."""
    over = np.array(states) * (1.0, 1.0, -1.0)
    one, other = np.array([float(phi)]), np.array([-float(phi)])
    assert np.allclose(normal_stress(np.array(states).T, one), normal_stress(over.T, other), atol=1e-9)
    assert np.allclose(shear_stress(np.array(states).T, one), -shear_stress(over.T, other), atol=1e-9)


@given(STRESS, STRESS, STRESS)
def test_the_grid_of_planes_is_fine_enough(sx, sy, txy):
    """The largest range of a proportional load is at most 0.2 % of the circle of stress below the principal one."""
    principal = (sx + sy) / 2 + np.array([1.0, -1.0]) * np.hypot((sx - sy) / 2, txy)
    found = ranges([(0, 0, 0), (sx, sy, txy)], PARENT_DEG).max()
    largest = np.abs(principal).max()
    assert largest - 0.002 * np.ptp(principal) - 1e-9 <= found <= largest + 1e-9


def test_stress_along_the_weld_enters_with_three_quarters():
    """The planes at a toe end at 60 deg: sin^2 of it is 3/4."""
    assert ranges([(0, 0, 0), (0, 100, 0)], TOE_DEG).max() == pytest.approx(75.0)


def test_planes():
    """Planes at a toe are 25 within 60 deg, the nearest first; in parent metal 36 all around."""
    assert sorted(TOE_DEG) == list(range(-60, 61, 5))
    assert TOE_DEG[:3] == (0, 5, -5)
    assert list(PARENT_DEG) == list(range(0, 180, 5))
