"""Equivalent range and damage of a cycle: constants, units, thickness rules, mean stress, shear."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.curves import catalogue, damage_law, user_curve
from fatigue.life.damage import (
    bending_ratio,
    cycle_damage,
    mean_stress_factor,
    ratio_factor,
    shear_factor,
    size_factor,
)

STEEL = catalogue()["master-steel"]
ALUMINIUM = catalogue()["master-aluminium"]


@pytest.mark.parametrize(
    ("curve", "thickness", "dm", "db", "rule", "expected"),
    [
        (STEEL, 20.0, 60.0, 40.0, "asme", 157.57788),
        (STEEL, 10.0, 80.0, 0.0, "asme", 121.28206),
        (STEEL, 10.0, 80.0, 0.0, "actual", 109.25380),
        (ALUMINIUM, 3.0, 20.0, 10.0, "asme", 45.12506),
        (ALUMINIUM, 3.0, 20.0, 10.0, "actual", 31.10732),
        (STEEL, 10.0, 60.0, 40.0, "actual", 135.0827),
    ],
)
def test_equivalent_range_golden_values(curve, thickness, dm, db, rule, expected):
    """The equivalent structural stress range of hand-worked cases, thickness in mm, range and not amplitude."""
    r = bending_ratio(np.array([dm]), np.array([db]))
    size = size_factor(np.array([thickness]), curve, rule)
    assert (dm + db) * size / ratio_factor(r) == pytest.approx(expected, rel=5e-7)


@pytest.mark.parametrize(("r", "expected"), [(0.0, 1.2214499), (0.4, 1.234874), (0.5, 1.2421248), (1.0, 1.3307839)])
def test_ratio_factor_values(r, expected):
    """I(r)^(1/m) of the load-controlled edge crack at known ratios."""
    assert ratio_factor(np.array(r)) == pytest.approx(expected, rel=1e-6)


def test_bending_ratio_of_nothing_is_zero():
    """A cycle without range has no bending share."""
    assert bending_ratio(np.zeros(1), np.zeros(1))[0] == 0.0


def test_bending_ratio_ignores_signs():
    """The ratio is built from absolute ranges."""
    assert bending_ratio(np.array([-20.0]), np.array([10.0]))[0] == pytest.approx(1 / 3)


@pytest.mark.parametrize(
    ("thickness", "stress"), [(2.0, 1.587), (3.0, 1.451), (4.0, 1.361), (6.0, 1.244), (8.0, 1.167), (10.0, 1.110)]
)
def test_asme_floor_against_actual_thickness(thickness, stress):
    """The 16 mm floor is worth a factor of 1.1 to 1.6 in stress on thin plate."""
    t = np.array([thickness])
    assert size_factor(t, ALUMINIUM, "asme") / size_factor(t, ALUMINIUM, "actual") == pytest.approx(stress, rel=5e-4)


def test_asme_ceiling_is_150_mm():
    """Beyond 150 mm the clause keeps 150."""
    assert size_factor(np.array([300.0]), STEEL, "asme") == size_factor(np.array([150.0]), STEEL, "actual")


def test_fat_class_thickness_correction_only_above_reference():
    """(t/25)^0.3 above 25 mm, nothing below."""
    size = size_factor(np.array([10.0, 25.0, 50.0]), catalogue()["iiw-steel-90"], "actual")
    assert size == pytest.approx([1.0, 1.0, 2.0**0.3])


def test_curve_without_thickness_rule_has_size_one():
    """A user curve without a reference thickness takes the range as it is."""
    curve = user_curve("own", (3.0,), (), 80.0, "structural", "test")
    assert size_factor(np.array([3.0, 80.0]), curve, "asme").tolist() == [1.0, 1.0]


def test_fat_check_against_master_curve_size():
    """At 2e6 cycles and 4 mm the aluminium curve sits between IIW classes 36 and 40: constants, units, exponent."""
    law = damage_law(ALUMINIUM, "mean-2sigma", "none", 1e7)
    size = size_factor(np.array([4.0]), ALUMINIUM, "actual")[0] / ratio_factor(np.array(0.0))
    grid = np.geomspace(10.0, 100.0, 20001)
    at_2e6 = grid[np.searchsorted(cycle_damage(grid * size, law), 1 / 2e6)]
    assert at_2e6 == pytest.approx(37.3, abs=0.1)


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (60.0, 100.0, (1 - 0.6) ** (1 / 3.6)),  # mean 80 = half of yield, R = 0.6
        (59.0, 100.0, 1.0),  # mean below half of yield
        (-10.0, 400.0, 1.0),  # R < 0
        (1.0, 330.0, 1.0),  # range above twice yield
        (200.0, 200.0, 1.0),  # no range at all
        (-100.0, -60.0, 1.0),  # all in compression
    ],
)
def test_mean_stress_factor_conditions(low, high, expected):
    """The three conditions of the clause, each on its own; yield 160 MPa."""
    assert mean_stress_factor(np.array([low]), np.array([high]), 160.0)[0] == pytest.approx(expected)


def test_no_range_no_damage():
    """A cycle of zero range does nothing, not NaN."""
    assert cycle_damage(np.array([0.0]), damage_law(STEEL, None, "none", 1e7))[0] == 0.0


def test_shear_below_a_third_costs_up_to_fifteen_percent():
    """In phase and at the clause's threshold of a third, shear adds 15.5 % to the range."""
    sigma, tau = 1.0, 1.0 / 3.0
    factor = shear_factor(np.array([sigma**2]), np.array([tau**2]), np.array([sigma * tau]))
    assert factor == pytest.approx(1.1547, rel=1e-4)


@settings(deadline=None, max_examples=80)
@given(tau=st.floats(0.01, 3.0), delta=st.floats(0.0, 3.14))
def test_shear_factor_is_the_clause_for_harmonic_paths(tau, delta):
    """The covariance form equals ASME's F(delta) for every amplitude ratio and phase."""
    a, b = 1.0, 3.0 * tau**2
    inner = 1.0 - 12.0 * tau**2 * np.sin(delta) ** 2 / (a + b) ** 2
    F = np.sqrt(0.5) * np.sqrt(1.0 + np.sqrt(max(inner, 0.0)))
    by_clause = np.sqrt(a + b) / F
    by_covariance = shear_factor(np.array([0.5]), np.array([tau**2 / 2]), np.array([tau * np.cos(delta) / 2]))
    assert by_covariance[0] == pytest.approx(by_clause, rel=1e-6)


def test_shear_without_normal_stress_has_no_factor():
    """Where the normal stress does not vary there is nothing to multiply."""
    assert np.isnan(shear_factor(np.zeros(1), np.ones(1), np.zeros(1))[0])
