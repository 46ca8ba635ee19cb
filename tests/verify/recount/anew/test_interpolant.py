"""What a load is between its samples, against closed forms, scipy and published numbers."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import resample

from fatigue.verify.recount.anew.interpolant import Grid, mirrored, periodic, straight


def test_a_band_limited_record_is_met_between_its_samples():
    """0.7 + sin(2 pi 3 i / 32) + 0.4 cos(2 pi 7 i / 32), at quarters of a step."""
    i = np.arange(32)
    x = 0.7 + np.sin(2 * np.pi * 3 * i / 32) + 0.4 * np.cos(2 * np.pi * 7 * i / 32)
    at = np.array([1, 2, 3, 5, 50, 127])
    value = [1.22334810052857, 1.299488858599557, 1.3331961911075707, 1.3128667650648735]
    value += [1.5427144082165296, 0.9298871516178443]
    np.testing.assert_allclose(periodic(x, Grid(0.0, 0.25, 128))[at], value, rtol=1e-12)


def test_mirrored_samples():
    """The numbers of the specification: two samples are half a cosine between them."""
    two = [0.0, 0.14644660940672627, 0.5, 0.8535533905932737, 1.0]
    np.testing.assert_allclose(mirrored(np.array([0.0, 1.0]), Grid(0.0, 0.25, 5)), two, atol=1e-14)
    four = [0.0, 0.48365396477444733, 1.0, 0.6666666666666666, 0.5, 1.349679368558886, 2.0]
    np.testing.assert_allclose(mirrored(np.array([0.0, 1.0, 0.5, 2.0]), Grid(0.0, 0.5, 7)), four, atol=1e-14)


@pytest.mark.parametrize("n", [2, 3, 64, 65, 1300])
def test_the_sum_of_cosines_is_the_interpolation_by_transform(n):
    """Of samples that repeat, scipy.signal.resample on a finer grid; and the samples themselves."""
    x = np.random.default_rng(n).standard_normal(n)
    np.testing.assert_allclose(periodic(x, Grid(0.0, 0.25, 4 * n)), resample(x, 4 * n), atol=1e-11)
    np.testing.assert_allclose(mirrored(x, Grid(0.0, 1.0, n)), x, atol=1e-11)


@given(st.integers(2, 40), st.floats(-3, 3), st.floats(0.01, 3), st.integers(1, 50))
def test_any_grid_is_a_sum_term_by_term(n, first, step, count):
    """Places in rows or one by one, the interpolants are the same; mirror images have the same values."""
    x = np.random.default_rng(n).standard_normal(n)
    for interpolant in (periodic, mirrored):
        one_by_one = [interpolant(x, Grid(first + step * i, 1.0, 1))[0] for i in range(count)]
        np.testing.assert_allclose(interpolant(x, Grid(first, step, count)), one_by_one, atol=1e-9)
    np.testing.assert_allclose(
        mirrored(x, Grid(first, step, count)), mirrored(x, Grid(-first, -step, count)), atol=1e-9
    )


def test_straight_lines_invent_no_extremes():
    """Between samples a straight line, beyond the ends the ends."""
    found = straight(np.array([0.0, 1.0, -1.0]), Grid(-0.5, 0.5, 7))
    np.testing.assert_allclose(found, [0.0, 0.0, 0.5, 1.0, 0.0, -1.0, -1.0])
