"""Extremes of the ratio of two laws: no cycle is beyond them, and some cycle is near each."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.bounds.law_ratio import ratio_extremes
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import cycle_damage
from tests.life.bounds.test_histogram import laws

ALUMINIUM = catalogue()["master-aluminium"]


@settings(max_examples=300, deadline=None)
@given(laws(), laws(), st.floats(0.2, 5.0), st.floats(1.0, 400.0))
def test_no_cycle_is_beyond_the_extremes(old, new, factor, largest):
    """Of ranges up to the largest, on both sides of every knee, none has another ratio; the closest are near."""
    ends = np.array([*old.knees, old.cutoff, *new.knees / factor, new.cutoff / factor])
    x = np.concatenate([np.geomspace(1e-9 * largest, largest, 4000), ends * (1 + 1e-9), ends * (1 - 1e-9), ends])
    x = np.sort(x[(x > 0.0) & (x <= largest)])
    a, b = cycle_damage(x, old), cycle_damage(factor * x, new)
    least, most = (float(part[0]) for part in ratio_extremes(old, new, np.array([factor]), np.array([largest])))
    assert (b <= most * a * (1 + 1e-9)).all() if np.isfinite(most) else True
    assert (b >= least * a * (1 - 1e-9)).all()
    damages = a > 0.0
    if damages.any() and np.isfinite(most):
        np.testing.assert_allclose((b[damages] / a[damages]).max(), most, rtol=1e-2, atol=1e-300)


def test_same_law_is_one_and_a_straight_law_scales():
    """Without change both are 1; a factor on a straight law is its power; survival is the ratio of its constants."""
    law, mean = (damage_law(ALUMINIUM, level, "none", 1e7) for level in ("mean-2sigma", "mean"))
    ones, many = np.ones(3), np.array([1.0, 30.0, 1e4])
    np.testing.assert_array_equal(ratio_extremes(law, law, ones, many), np.ones((2, 3)))
    np.testing.assert_allclose(ratio_extremes(law, law, 1.1 * ones, many), 1.1 ** law.slopes[0], rtol=1e-12)
    np.testing.assert_allclose(ratio_extremes(mean, law, ones, many), 4.41175761744262, rtol=1e-12)


def test_what_a_law_leaves_out_has_no_bound():
    """From a law with a cut-off to one without there is none above; a point without ranges is not changed."""
    straight, cutoff = (damage_law(ALUMINIUM, "mean", extension, 1e7) for extension in ("none", "cutoff"))
    ones, largest = np.ones(2), np.array([0.0, 500.0])
    assert ratio_extremes(cutoff, straight, ones, largest).most.tolist() == [1.0, np.inf]
    assert ratio_extremes(straight, cutoff, ones, largest).least.tolist() == [1.0, 0.0]
    below = np.array([0.5 * cutoff.cutoff])
    assert ratio_extremes(straight, cutoff, np.ones(1), below).most.tolist() == [0.0]
