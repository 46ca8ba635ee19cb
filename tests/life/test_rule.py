"""The master equation: constants, units, thickness rules, mean stress, what it refuses, and its slopes."""

import numpy as np
import pytest

from fatigue.errors import CaseError
from fatigue.life.curves import DamageLaw, catalogue, damage_law, user_curve
from fatigue.life.rule import (
    M_SS,
    CycleRule,
    bending_ratio,
    cycle_damage,
    equivalent_range,
    local_slope,
    log_ratio_factor_slope,
    mean_stress_factor,
    ratio_factor,
    size_exponent,
    size_factor,
)

STEEL = catalogue()["master-steel"]
ALUMINIUM = catalogue()["master-aluminium"]
PLAIN = user_curve("plain", (3.0, 5.0), (1e7,), 40.0, "structural", "a test")


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
    assert equivalent_range(dm + db, size, ratio_factor(r), 1.0) == pytest.approx(expected, rel=5e-7)


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


def test_local_slope_changes_at_the_knees():
    """At a knee the segment of the larger ranges holds, as in the damage itself."""
    law = DamageLaw(np.array([3.0, 5.0]), np.array([20.0, 25.0]), np.array([40.0]), 0.0)
    assert local_slope(np.array([80.0, 40.0, 39.9]), law).tolist() == [3.0, 3.0, 5.0]
    x = np.array([80.0, 20.0])
    numeric = (np.log(cycle_damage(x * 1.0001, law)) - np.log(cycle_damage(x, law))) / np.log(1.0001)
    assert local_slope(x, law) == pytest.approx(numeric, rel=1e-9)


def test_slope_of_the_bending_ratio_factor():
    """Slope d ln I^(1/m) / dr against differences of the factor itself."""
    r, step = np.linspace(0.01, 0.99, 9), 1e-6
    numeric = (np.log(ratio_factor(r + step)) - np.log(ratio_factor(r - step))) / (2 * step)
    assert log_ratio_factor_slope(r) == pytest.approx(numeric, rel=1e-8)


@pytest.mark.parametrize(
    ("curve", "rule", "thickness", "expected"),
    [
        (ALUMINIUM, "actual", 8.0, (M_SS - 2) / (2 * M_SS)),
        (ALUMINIUM, "asme", 20.0, (M_SS - 2) / (2 * M_SS)),
        (ALUMINIUM, "asme", 8.0, 0.0),
        (ALUMINIUM, "asme", 200.0, 0.0),
        (PLAIN, "actual", 8.0, 0.0),
        (user_curve("t", (3.0,), (), 40.0, "structural", "a test", None, 25.0, 0.2), "actual", 30.0, 0.2),
        (user_curve("t", (3.0,), (), 40.0, "structural", "a test", None, 25.0, 0.2), "actual", 20.0, 0.0),
    ],
)
def test_size_exponent_is_that_of_the_size_factor(curve, rule, thickness, expected):
    """The exponent of the thickness rule, inside and outside its limits, against the factor itself."""
    t, step = np.array([thickness]), 1e-6
    numeric = np.log(size_factor(t * (1 + step), curve, rule) / size_factor(t, curve, rule))[0] / step
    assert size_exponent(thickness, curve, rule) == pytest.approx(expected)
    assert numeric == pytest.approx(expected, abs=1e-6)


def test_a_rule_with_mean_stress_needs_a_yield_stress():
    """Refused where the rule is made."""
    with pytest.raises(CaseError, match="f_M needs the yield stress"):
        CycleRule(damage_law(STEEL, None, "none", 1e7), uses_bending_ratio=True, mean_stress=True)


def test_what_a_rule_does_not_use_is_one():
    """No bending ratio for curves in plain structural stress, no f_M where it is only shown beside the damage."""
    rule = CycleRule(damage_law(PLAIN, None, "none", 1e7), uses_bending_ratio=False, yield_MPa=100.0)
    r = np.array([0.0, 0.7])
    assert rule.ratio_factor(r).tolist() == [1.0, 1.0]
    assert rule.mean_stress_factor(np.array([90.0]), np.array([120.0])).tolist() == [1.0]
    assert rule.yield_of_damage is None
