"""Endurance lines are read in the Haigh plane, by mean over amplitude."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.endurance.haigh import (
    allowed_amplitudes,
    endurance_line,
    kappa_of,
    mirrored,
    stress_ratio,
    utilisations,
)

R = np.array([-1.0, 0.0, 0.5])
STRESS_MAX = np.array([60.0, 92.3076923077, 126.315789474])  # amplitude 60 - 0.3 mean
LINE = endurance_line("invented", "perp", R, STRESS_MAX)
KNOWN = [
    (-1.0, 60.0, 60.0),
    (-0.7, 67.0391061453, 56.9832402235),
    (-0.3, 79.4701986755, 51.6556291391),
    (0.0, 92.3076923077, 46.1538461538),
    (0.2, 103.448275862, 41.3793103449),
    (0.5, 126.315789474, 31.5789473685),
]


def allowed(line, ratio):
    """Allowed amplitude at one stress ratio."""
    return float(allowed_amplitudes(line, kappa_of(np.array([ratio])))[0])


@pytest.mark.parametrize(("ratio", "stress_max", "amplitude"), KNOWN)
def test_a_line_is_straight_in_the_haigh_plane(ratio, stress_max, amplitude):
    """Upper stress and amplitude lie on the chord of mean and amplitude, not of R and upper stress."""
    found = allowed(LINE, ratio)
    assert found == pytest.approx(amplitude, rel=1e-9)
    assert 2.0 * found / (1.0 - ratio) == pytest.approx(stress_max, rel=1e-9)


def test_between_rows_the_upper_stress_is_not_linear():
    """Linear in R it would be 4 % too high at R = -0.7."""
    linear = float(np.interp(-0.7, R, STRESS_MAX))
    assert linear == pytest.approx(69.6923076923)
    assert linear / (2.0 * allowed(LINE, -0.7) / 1.7) == pytest.approx(1.04, abs=2e-3)


def test_two_rows_make_a_line():
    """Of a straight line any two rows say everything between them."""
    ends = endurance_line("ends", "perp", R[[0, 2]], STRESS_MAX[[0, 2]])
    assert 2.0 * allowed(ends, 0.0) == pytest.approx(92.3076923078, rel=1e-9)


@pytest.mark.parametrize("ratio", [-1e3, -5.0, -1.0000001])
def test_below_the_first_row_the_amplitude_stays(ratio):
    """More compression allows no larger amplitude."""
    assert allowed(LINE, ratio) == pytest.approx(60.0)


@pytest.mark.parametrize("ratio", [0.50001, 0.7, 0.999])
def test_above_the_last_row_nothing_is_allowed_or_forbidden(ratio):
    """Nothing is extrapolated to larger mean stress."""
    assert np.isnan(allowed(LINE, ratio))


def test_the_last_row_itself_is_in_the_table():
    """A cycle at the last R is found, whichever way its stress is rounded."""
    top = np.array([126.3, 0.3, 3e7, 1e-3])
    _, inside = utilisations(LINE, 0.5 * top * (1 + 1e-15), top)
    assert inside.all()


def test_utilisation_of_a_cycle():
    """-42 to 60 MPa is R = -0.7, amplitude 51 of 56.98."""
    u, inside = utilisations(LINE, np.array([-42.0]), np.array([60.0]))
    assert u[0] == pytest.approx(0.895, rel=1e-9)
    assert inside.all()


def test_compression_and_a_maximum_of_zero_make_no_case():
    """Cycles below zero, and to zero, have kappa at most -1: the amplitude of the first row."""
    low, high = np.array([-120.0, -60.0, -70.0]), np.array([0.0, -0.0, -10.0])
    u, inside = utilisations(LINE, low, high)
    np.testing.assert_allclose(u, [1.0, 0.5, 0.5])
    assert inside.all()
    np.testing.assert_array_equal(stress_ratio(low, high), [-np.inf, -np.inf, 7.0])


def test_what_does_not_alternate_uses_nothing():
    """Two equal stresses make no cycle, whatever their level."""
    same = np.array([-500.0, 0.0, 500.0])
    u, inside = utilisations(LINE, same, same)
    assert not u.any()
    assert inside.all()


def test_the_sign_of_shear_is_a_matter_of_the_frame():
    """Turned round, a cycle of shear is the same one; the larger magnitude is its maximum."""
    low, high = np.array([-60.0, -42.0]), np.array([42.0, 60.0])
    np.testing.assert_array_equal(mirrored(low, high), mirrored(-high, -low))
    np.testing.assert_array_equal(stress_ratio(*mirrored(low, high)), [-0.7, -0.7])


stresses = st.floats(-200.0, 200.0)


@settings(deadline=None)
@given(st.tuples(stresses, stresses, stresses, stresses))
def test_a_cycle_inside_another_is_not_more_severe(values):
    """So the two extreme stresses of a component are its worst pair, and a bound above the table is one."""
    a, b, c, d = sorted(values)
    (outer, inner), (knows_outer, knows_inner) = utilisations(LINE, np.array([a, b]), np.array([d, c]))
    assert inner <= outer * (1 + 1e-9) + 1e-12 or not knows_outer
    if not knows_inner and knows_outer:
        assert inner <= outer * (1 + 1e-9)


@settings(deadline=None)
@given(st.floats(-200.0, 200.0), st.floats(0.0, 150.0), st.floats(0.1, 10.0))
def test_utilisation_scales_with_the_stress(mean, amplitude, factor):
    """All stresses times f make the utilisation f times as large."""
    low, high = np.array([mean - amplitude]), np.array([mean + amplitude])
    one, _ = utilisations(LINE, low, high)
    scaled, _ = utilisations(LINE, factor * low, factor * high)
    np.testing.assert_allclose(scaled, factor * one, rtol=1e-9, atol=1e-12)
