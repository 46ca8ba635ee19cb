"""Worn treads, flanges and saturation: the laws, their limits, and what they add to linear contact."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from fatigue.errors import CaseError
from fatigue.vehicle.definition import Contact as ContactKeys
from fatigue.vehicle.definition import Suspension, Vehicle
from fatigue.vehicle.in_time.contact import (
    contact_of,
    equivalent_conicity,
    flange_force,
    remainder,
    saturation,
    worn_flag,
    worn_part,
)

SPEED = 350 / 3.6
HARD = contact_of(Vehicle(), SPEED)
SATURATED = contact_of(Vehicle(contact=ContactKeys(saturation_mu=0.35)), SPEED)


def test_constants_are_those_of_the_keys_and_of_the_setting():
    """Lengths are in metres; the worn conicity of a setting gives way to one of its own."""
    assert list(HARD) == [0.1, 1.2, 0.002, 10e6, 9e6, 0.7465, 0.46, 0.008, 5e6, np.inf, SPEED]
    assert contact_of(Vehicle(suspension=Suspension(setting="soft")), SPEED).worn_conicity == 0.9
    own = Vehicle(suspension=Suspension(setting="soft"), contact=ContactKeys(worn_conicity=0.5))
    assert contact_of(own, SPEED).worn_conicity == 0.5
    assert SATURATED.friction == pytest.approx(0.35 * 65e3)


def test_whole_numbers_are_taken_as_numbers():
    """A conicity of 1 is no other type of contact to compiled code."""
    assert all(isinstance(of, float) for of in contact_of(Vehicle(contact=ContactKeys(f11_N=10_000_000)), SPEED))


def test_what_is_no_contact_is_refused_all_at_once():
    """Each mistake names its key, its value and what to give."""
    keys = ContactKeys(
        state="used", worn_amplitude_mm=0.0, worn_ramp_m=-1.0, flange_N_m=float("nan"), saturation_mu=0.0
    )
    with pytest.raises(CaseError) as refused:
        contact_of(Vehicle(contact=keys), SPEED)
    assert str(refused.value).splitlines() == [
        "[contact] worn_amplitude_mm: 0.0 is out of range. Give a value above 0.",
        "[contact] worn_ramp_m: -1.0 is out of range. Give a value of 0 or above.",
        "[contact] flange_N_m: nan is out of range. Give a value of 0 or above.",
        "[contact] saturation_mu: 0.0 is out of range. Give a value above 0, or leave it out.",
        "[contact] state: 'used' is no state of the contact. Choose one of sound, worn.",
    ]


def test_sections_have_ramps_inside_their_ends():
    """1500-2100 m and 3000-3600 m: 24 % of 5 km, 0.8 % of it on ramps."""
    sections = ((1500.0, 2100.0), (3000.0, 3600.0))
    at = np.array([1499.0, 1500.0, 1510.0, 1520.0, 2080.0, 2095.0, 2100.0, 2500.0, 3300.0])
    np.testing.assert_allclose(worn_flag(at, sections, 20.0), [0, 0, 0.5, 1, 1, 0.25, 0, 0, 1])
    everywhere = np.arange(0.0, 5000.0, 0.5)
    assert np.mean(worn_flag(everywhere, sections, 20.0)) == pytest.approx(2 * 580 / 5000)
    assert not worn_flag(everywhere, (), 20.0).any()


def test_sections_that_overlap_short_ones_and_ends_without_ramps():
    """The largest flag counts; a section shorter than two ramps has a peak below 1; without ramps it is 0 or 1."""
    at = np.array([100.0, 115.0, 120.0, 130.0])
    np.testing.assert_allclose(worn_flag(at, ((90.0, 125.0), (115.0, 200.0)), 20.0), [0.5, 0.5, 0.25, 0.75])
    np.testing.assert_allclose(worn_flag(np.array([5.0]), ((0.0, 10.0),), 20.0), [0.25])
    np.testing.assert_allclose(worn_flag(at, ((115.0, 120.0),), 0.0), [0, 1, 1, 0])


def test_conicity_of_a_hollow_tread_by_quadrature():
    """The integral over a period, by another method, from almost at rest to far beyond the hollow."""
    for A in (1e-6, 5e-4, 2e-3, 8e-3, 0.05):
        whole, _ = quad(lambda p, A=A: np.tanh(A * np.sin(p) / 0.002) * np.sin(p), 0.0, np.pi / 2, epsabs=1e-13)
        expected = 0.1 + 1.1 * 0.002 / (np.pi * A) * 4 * whole
        assert equivalent_conicity(A, 0.1, 1.2, 0.002) == pytest.approx(expected, rel=1e-11)


def test_its_limits():
    """lambda0 at rest, less by (A/s0)^2/4 near it; far out 4 s0/(pi A) of the difference, that of a step."""
    at_rest, near, far = (float(equivalent_conicity(A, 0.1, 1.2, 0.002)) for A in (0.0, 2e-5, 2.0))
    assert at_rest == 1.2
    assert near == pytest.approx(1.2 - 1.1 * 0.01**2 / 4, abs=1e-8)
    assert far == pytest.approx(0.1 + 1.1 * 4 * 0.002 / (np.pi * 2.0), rel=1e-5)


@given(st.floats(0, 0.05), st.floats(0, 0.05), st.floats(0.2, 2.0))
def test_conicity_falls_with_amplitude(one, other, worn_conicity):
    """A tread that is steeper in the middle is the less conical, the further it swings."""
    small, large = sorted((one, other))
    found = equivalent_conicity([small, large], 0.1, worn_conicity, 0.002)
    assert 0.1 <= found[1] <= found[0] * (1 + 1e-12) <= worn_conicity * (1 + 2e-12)


@pytest.mark.parametrize(
    ("amplitude", "hollow", "said"),
    [
        (-1e-3, 0.002, "an amplitude of -0.001 m has no conicity"),
        (float("nan"), 0.002, "an amplitude of nan m has no conicity"),
        (1e-3, 0.0, "a tread that is hollow over 0.0 m has no conicity at rest"),
    ],
)
def test_no_conicity_where_there_is_none(amplitude, hollow, said):
    """A hollow without width would divide nothing by nothing at rest."""
    with pytest.raises(CaseError, match=said):
        equivalent_conicity(amplitude, 0.1, 1.2, hollow)


def test_the_difference_of_rolling_radii_has_the_slope_of_the_conicity():
    """lambda0 in the middle, lambda far out, only as far as the flag says."""
    step = 1e-9
    assert worn_part(step, 1.0, HARD) / step == pytest.approx(1.1, rel=1e-6)
    assert worn_part(step, 0.25, HARD) / step == pytest.approx(1.1 / 4, rel=1e-6)
    assert worn_part(0.02, 1.0, HARD) == pytest.approx(1.1 * 0.002, rel=1e-6)


def test_a_flange_pushes_back_beyond_its_clearance():
    """5 MN/m beyond 8 mm, nothing before."""
    assert [flange_force(d, HARD) for d in (0.0, 0.008, -0.008)] == [0.0, 0.0, 0.0]
    assert flange_force(0.009, HARD) == pytest.approx(-5e3)
    assert flange_force(-0.010, HARD) == pytest.approx(1e4)


def test_saturation_begins_at_one_and_ends_at_friction():
    """1 at rest; both branches meet at 1/3 with the same slope; far out the force is friction itself."""
    assert saturation(0.0, 1.0) == 1.0
    step = 1e-6
    below, at, above = (saturation(e, 1.0) for e in (3.0 - step, 3.0, 3.0 + step))
    assert at == pytest.approx(1 / 3)
    assert (at - below) == pytest.approx(above - at, rel=1e-4)
    assert 50.0 * saturation(50.0, 1.0) == pytest.approx(1.0)
    assert saturation(2e4, 2e4) == saturation(1.0, 1.0) == pytest.approx(1 - 1 / 3 + 1 / 27)


motion = (st.floats(-0.02, 0.02), st.floats(-0.02, 0.02), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0, 1))


@given(*motion)
def test_the_remainder_and_linear_contact_are_contact(d, psi, y_rate, psi_rate, worn):
    """Forces of the whole law, less those that the linear equations hold."""
    f11, f22, b, r0, V, mu_W = 10e6, 9e6, 0.7465, 0.46, SPEED, 0.35 * 65e3
    delta = 0.1 * d + worn * (1.2 - 0.1) * 0.002 * np.tanh(d / 0.002)
    flange = -5e6 * max(abs(d) - 0.008, 0.0) * np.sign(d)
    F_x, F_y = f11 * (b * psi_rate / V + delta / r0), f22 * (y_rate / V - psi)
    e = np.sqrt(F_x**2 + F_y**2) / mu_W
    factor = 1 - e / 3 + e**2 / 27 if e < 3 else 1 / e
    linear = -2 * F_y, -2 * b * f11 * (b * psi_rate / V + 0.1 * d / r0)
    for of, share in ((SATURATED, factor), (HARD, 1.0)):
        force, moment = remainder(d, psi, y_rate, psi_rate, worn, of)
        assert force == pytest.approx(flange - 2 * share * F_y - linear[0], abs=1e-6)
        assert moment == pytest.approx(-2 * b * share * F_x - linear[1], abs=1e-6)


@given(*motion)
def test_contact_is_odd(d, psi, y_rate, psi_rate, worn):
    """The other way round, the other force."""
    there = remainder(d, psi, y_rate, psi_rate, worn, SATURATED)
    back = remainder(-d, -psi, -y_rate, -psi_rate, worn, SATURATED)
    assert there == tuple(-force for force in back)


@given(st.floats(-0.0079, 0.0079), st.floats(-0.01, 0.01), st.floats(-0.5, 0.5))
def test_sound_contact_within_the_clearance_is_linear(d, psi, rate):
    """Nothing is left to add; with saturation the less, the more friction there is."""
    assert remainder(d, psi, rate, rate, 0.0, HARD) == (0.0, 0.0)
    much = SATURATED._replace(friction=1e15)
    np.testing.assert_allclose(remainder(d, psi, rate, rate, 0.0, much), 0.0, atol=1e-2)


def test_a_setting_nobody_knows_is_refused():
    """The worn conicity is that of the setting."""
    with pytest.raises(CaseError, match="'rigid' is no known setting"):
        contact_of(replace(Vehicle(), suspension=Suspension(setting="rigid")), SPEED)
