"""Limits of the rule of a cycle, on either side of each, in the formulas and in the counter that compiles them."""

import math

import numpy as np
import pytest

from fatigue.life.counting.block import BINS_PER_DECADE
from fatigue.life.counting.rows import count_histories
from fatigue.life.curves import DamageLaw, catalogue, user_curve
from fatigue.life.rule import (
    SIZE_EXPONENT,
    CycleRule,
    cycle_damage,
    has_mean_stress,
    local_slope,
    mean_stress_factor,
    ratio_factor,
    segment,
    size_exponent,
    size_factor,
)

MASTER = catalogue()["master-steel"]
PLAIN = user_curve("plain", (3.0,), (), 90.0, "structural", "a test", thickness_reference=25.0, thickness_exponent=0.3)
YIELD = 250.0


@pytest.mark.parametrize(
    ("curve", "rule", "thickness", "expected"),
    [
        (MASTER, "actual", 0.5, SIZE_EXPONENT),
        (MASTER, "actual", 500.0, SIZE_EXPONENT),
        (MASTER, "asme", 15.99, 0.0),
        (MASTER, "asme", 16.0, SIZE_EXPONENT),
        (MASTER, "asme", 149.9, SIZE_EXPONENT),
        (MASTER, "asme", 150.0, 0.0),
        (PLAIN, "actual", 24.9, 0.0),
        (PLAIN, "actual", 25.0, 0.3),
        (PLAIN, "asme", 300.0, 0.3),
    ],
)
def test_exponent_of_the_thickness(curve, rule, thickness, expected):
    """What a plate slightly thicker does, as the size factor has it: the slope to its right."""
    assert size_exponent(thickness, curve, rule) == expected
    step = 1.0 + 1e-7
    here, thicker = size_factor(np.array([thickness, thickness * step]), curve, rule)
    assert math.log(thicker / here) / math.log(step) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(
    ("minimum", "maximum", "applies"),
    [
        (100.0, 150.0, True),
        (100.0, 149.9, False),  # their mean below half the yield stress
        (0.0, 260.0, False),
        (1e-6, 260.0, True),
        (100.0, 600.0, True),
        (100.0, 600.1, False),  # a range above twice the yield stress
        (200.0, 200.0, False),
        (-1.0, 300.0, False),
    ],
)
def test_where_the_mean_stress_factor_applies(minimum, maximum, applies):
    """R above 0, a mean of half the yield stress and more, a range of twice the yield stress at most."""
    low, high = np.array([minimum]), np.array([maximum])
    assert has_mean_stress(low, high, YIELD)[0] == applies
    expected = (1.0 - minimum / maximum) ** (1.0 / 3.6) if applies else 1.0
    assert mean_stress_factor(low, high, YIELD)[0] == pytest.approx(expected, rel=1e-14)
    if maximum > minimum:  # ... and in the counter
        law = DamageLaw(np.array([3.0]), np.array([0.0]), np.array([]), 0.0)
        stress = np.array([[minimum, maximum]])
        one = np.ones(1), np.zeros((1, 2))
        count = count_histories(stress, 0.0 * stress, *one, "repeat", CycleRule(law, False, YIELD, True))
        assert count.damage[0, 0] == pytest.approx(((maximum - minimum) / expected) ** 3, rel=1e-12)
        beside = count_histories(stress, 0.0 * stress, *one, "repeat", CycleRule(law, False, YIELD))
        assert beside.damage[0, 0] == pytest.approx((maximum - minimum) ** 3, rel=1e-12)
        assert beside.damage_mean_stress[0, 0] == pytest.approx(count.damage[0, 0], rel=1e-12)


def test_a_knee_belongs_to_the_segment_above_it():
    """Three segments with jumps at the knees, so that each side is told apart; the cut-off itself still damages."""
    law = DamageLaw(np.array([3.0, 5.0, 9.0]), np.array([0.0, 1.0, 2.0]), np.array([60.0, 30.0]), 10.0)
    x = np.array([61.0, 60.0, 59.9, 30.0, 29.9, 10.0, 9.99, 0.0])
    at = np.array([0, 0, 1, 1, 2, 2, 2, 2])
    assert segment(x, law.knees).tolist() == at.tolist()
    assert local_slope(x, law).tolist() == law.slopes[at].tolist()
    expected = np.where(x >= 10.0, x ** law.slopes[at] / np.exp(law.log_constants[at]), 0.0)
    np.testing.assert_allclose(cycle_damage(x, law), expected, rtol=1e-13)
    stress = np.stack([np.zeros(8), x], axis=1)
    count = count_histories(stress, 0.0 * stress, np.ones(8), np.zeros((8, 2)), "repeat", CycleRule(law, False))
    np.testing.assert_allclose(count.damage[:, 0], expected, rtol=1e-12)
    np.testing.assert_allclose(count.damage[:, 1], expected, rtol=1e-12)


@pytest.mark.parametrize("uses_ratio", [True, False])
def test_the_histogram_holds_every_cycle_in_its_bin(uses_ratio):
    """64 bins per decade from 1e-3: number of cycles and sum n dS^k, for a law with a knee; S and same ratio beside."""
    law = DamageLaw(np.array([3.0, 5.0]), np.array([0.0, -5.0]), np.array([50.0]), 0.0)
    membrane = np.array([[0.0, 70.0, 20.0, 45.0, 0.0, 5.0]])
    bending = 0.25 * membrane
    size, same = np.array([1.3]), np.array([[0.4, 0.7]])
    count = count_histories(membrane, bending, size, same, "repeat", CycleRule(law, uses_ratio))
    for surface, side in ((0, 1.25), (1, 0.75)):
        S = side * np.array([70.0, 25.0, 5.0])  # 0-70, 20-45, 0-5
        r = 0.2
        dS = S * 1.3 / (ratio_factor(r) if uses_ratio else 1.0)
        bins = ((np.log10(dS) + 3.0) * BINS_PER_DECADE).astype(int)
        histogram = count.histogram[0, surface]
        assert np.flatnonzero(histogram[:, 0]).tolist() == sorted(bins)
        assert histogram[bins, 0].tolist() == [1.0, 1.0, 1.0]
        np.testing.assert_allclose(histogram[bins, 1], dS**3, rtol=1e-12)
        assert count.cycles[0, surface] == 3.0
        assert count.power_sum[0, surface] == pytest.approx(np.sum(S**3), rel=1e-12)
        assert count.max_range[0, surface] == pytest.approx(S[0], rel=1e-14)
        assert count.max_equivalent_range[0, surface] == pytest.approx(dS[0], rel=1e-14)
        at_same_ratio = S * 1.3 / (ratio_factor(same[0, surface]) if uses_ratio else 1.0)
        expected = np.sum(cycle_damage(at_same_ratio, law))
        assert count.damage_same_ratio[0, surface] == pytest.approx(expected, rel=1e-12)
        assert count.r_largest[0, surface] == 0.0
