"""Mission arithmetic: passes per km, lives, load factors, equivalent range."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.counting.block import HISTOGRAM_EDGES
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.mission import Pass, life_km, load_factor, mission_sum, range_at_2e6, straight_load_factor
from fatigue.life.rule import cycle_damage


def test_shares_and_numbers_add_up_per_km():
    """Share / length passes per km for a section, number / 1000 for an event counted by number."""
    passes = [Pass("a", 9, 5.0, 0.7, None), Pass("b", 9, 2.0, 0.3, None), Pass("c", 2, None, None, 1.5)]
    per_pass = np.array([[1.0], [1.0], [1.0]])
    assert mission_sum(per_pass, passes)[0] == pytest.approx(0.7 / 5 + 0.3 / 2 + 1.5 / 1000)


def test_life_is_infinite_only_without_damage():
    """No damage is an infinite life, not an error and not a gap."""
    assert life_km(np.array([1e-7, 0.0]), 0.5).tolist() == pytest.approx([5e6, np.inf])


def test_straight_load_factor_meets_the_target():
    """Twice the stress on slope k is 2^k the damage, so utilisation 2^-k leaves a factor of 2."""
    assert straight_load_factor(np.array([2.0**-3.6, 1.0, 0.0]), 3.6).tolist() == pytest.approx([2.0, 1.0, np.inf])


def spectrum(ranges, counts, law):
    """Bin a list of ranges as the counter stores them."""
    bins = np.searchsorted(HISTOGRAM_EDGES, ranges, side="right") - 1
    n = np.zeros((1, HISTOGRAM_EDGES.size - 1))
    p = np.zeros_like(n)
    np.add.at(n[0], bins, counts)
    np.add.at(p[0], bins, counts * ranges ** law.slopes[0])
    return n, p


@settings(deadline=None, max_examples=40)
@given(seed=st.integers(0, 10_000), extension=st.sampled_from(["haibach", "cutoff"]), level=st.floats(0.2, 5.0))
def test_load_factor_from_the_spectrum(seed, extension, level):
    """Scaling every range by the factor meets the target within the width of one bin, on curves with a knee."""
    rng = np.random.default_rng(seed)
    law = damage_law(catalogue()["master-aluminium"], None, extension, 1e7)
    ranges = level * 20.0 * rng.weibull(1.2, 500) + 0.01
    counts = rng.uniform(0.5, 50.0, 500)
    n, p = spectrum(ranges, counts, law)
    factor = load_factor(n, p, law, target_km=1e4, damage_limit=1.0)[0]
    used = [(counts @ cycle_damage(ranges * factor * f, law)) * 1e4 for f in (10 ** (-1 / 64), 10 ** (1 / 64))]
    assert used[0] <= 1.0 <= used[1]


def test_load_factor_without_cycles_is_infinite():
    """Nothing to scale."""
    law = damage_law(catalogue()["master-aluminium"], None, "haibach", 1e7)
    empty = np.zeros((2, HISTOGRAM_EDGES.size - 1))
    assert np.isinf(load_factor(empty, empty, law, 1e6, 1.0)).all()


def test_load_factor_on_the_first_slope_is_the_straight_one():
    """Far above the knee the histogram gives the exact factor."""
    law = damage_law(catalogue()["master-aluminium"], None, "haibach", 1e7)
    ranges, counts = np.array([500.0, 300.0]), np.array([1.0, 2.0])
    n, p = spectrum(ranges, counts, law)
    utilisation = counts @ cycle_damage(ranges, law) * 10.0
    expected = straight_load_factor(np.array([utilisation]), law.slopes[0])
    assert load_factor(n, p, law, 10.0, 1.0) == pytest.approx(expected, rel=1e-9)


def test_equivalent_range_of_constant_amplitude():
    """2e6 cycles of one range over the target are that range."""
    assert range_at_2e6(np.array([2.0 * 40.0**3.6]), 3.6, 1e6)[0] == pytest.approx(40.0)
