"""Corners of independent loads: their extremes and the largest distance of two, against going through all of them."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fatigue.life.endurance.haigh import stress_ratio
from fatigue.life.endurance.zonotope import corner_signs, corners, diameter, extremes

KNOWN = [  # static, loads, range, largest, least, R, plane range, signs at one of its ends
    ([30, 5], [[12, 4], [8, -6]], 40, 50, 10, 0.2, 40.1995024845, [1, 1]),
    ([30, 5], [[12, 4], [8, -6], [-5, 9]], 50, 55, 5, 0.0909090909091, 54.626001135, [1, 1, -1]),
    ([-20, 0], [[10, 2], [-7, 8], [3, -9], [6, 6]], 52, 6, -46, -7.66666666667, 55.0272659688, [1, -1, 1, 1]),
    (
        [7.2, 1.03923048454],
        [[33.0, 13.509996299], [2.4, 20.7846096908]],
        70.8,
        42.6,
        -28.2,
        -0.661971830986,
        98.575453334,
        [1, 1],
    ),
]


@pytest.mark.parametrize(("static", "loads", "reach", "largest", "least", "R", "plane", "signs"), KNOWN)
def test_known_combinations(static, loads, reach, largest, least, R, plane, signs):
    """Range, extremes, R and plane range of the worked combinations."""
    s_0, v = np.array([static], dtype=float), np.array([loads], dtype=float)
    low, high, _ = extremes(s_0[:, 0], v[:, :, 0])
    np.testing.assert_allclose([low[0], high[0], high[0] - low[0]], [least, largest, reach], rtol=1e-10)
    np.testing.assert_allclose(stress_ratio(low, high), R, rtol=1e-10)
    length, at = diameter(v)
    np.testing.assert_allclose(length, plane, rtol=1e-10)
    assert at[0].tolist() in (signs, [-s for s in signs])


def by_all_corners(v):
    """Largest distance of two of all corners, every pair compared."""
    some = corners(np.zeros((1, v.shape[-1])), v[None])[0]
    return max(float(np.linalg.norm(a - b)) for a, b in itertools.product(some, some))


whole = st.integers(-9, 9).map(float)  # ties, parallel loads and loads of nothing


@given(st.integers(1, 6).flatmap(lambda k: arrays(float, (k, 2), elements=st.one_of(whole, st.floats(-50, 50)))))
def test_the_diameter_is_that_of_all_corners(v):
    """The turn of the directions meets the farthest corners, and its signs make that distance."""
    length, signs = diameter(v[None])
    assert length[0] == pytest.approx(by_all_corners(v), rel=1e-9, abs=1e-9)
    assert 2.0 * np.linalg.norm(signs[0] @ v) == pytest.approx(length[0], rel=1e-9, abs=1e-9)


@given(st.integers(1, 6).flatmap(lambda k: arrays(float, (k,), elements=st.floats(-50, 50))), st.floats(-50, 50))
def test_extremes_are_those_of_all_corners(v, static):
    """The largest stress is at a corner, and so is the least one, with the opposite signs."""
    low, high, signs = extremes(np.array([static]), v[None])
    some = static + corner_signs(len(v)) @ v
    assert low[0] == pytest.approx(some.min(), abs=1e-9)
    assert high[0] == pytest.approx(some.max(), abs=1e-9)
    assert static + signs[0] @ v == pytest.approx(high[0], abs=1e-9)


def test_many_loads_need_no_corners():
    """Forty loads have 2^40 corners; a regular star has the diameter of its polygon."""
    angle = np.pi * np.arange(40) / 40
    v = np.column_stack([np.cos(angle), np.sin(angle)])
    length, signs = diameter(v[None])
    assert length[0] == pytest.approx(2.0 / np.sin(np.pi / 80), rel=1e-9)
    assert np.linalg.norm(signs[0] @ v) == pytest.approx(length[0] / 2.0, rel=1e-12)


def test_points_do_not_touch_each_other():
    """Each point has the diameter that it has alone."""
    v = np.random.default_rng(3).normal(size=(20, 5, 2))
    together, _ = diameter(v)
    np.testing.assert_array_equal(together, np.concatenate([diameter(one[None])[0] for one in v]))
