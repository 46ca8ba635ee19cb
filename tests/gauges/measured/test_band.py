"""The band filter: it removes the mean and every line outside, the same on both sides, and nothing else."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.gauges.measured.band import band_edges, band_limited, bin_from

SIGNALS = st.tuples(st.integers(2, 300), st.integers(0, 10_000)).map(
    lambda drawn: 5.0 + np.random.default_rng(drawn[1]).standard_normal(drawn[0])
)
ENDS = st.tuples(st.floats(0.0, 40.0), st.floats(0.1, 60.0)).filter(lambda ends: ends[0] < ends[1])


@given(SIGNALS, ENDS)
def test_it_is_a_projection(x, ends):
    """Applied twice it is applied once; what is left and what is taken are orthogonal; the mean is gone."""
    once = band_limited(x, 100.0, *ends)
    np.testing.assert_allclose(band_limited(once, 100.0, *ends), once, atol=1e-12)
    assert once.mean() == pytest.approx(0.0, abs=1e-12)
    assert once @ (x - x.mean() - once) == pytest.approx(0.0, abs=1e-9)


@given(SIGNALS, ENDS, st.floats(-3.0, 3.0), st.floats(-100.0, 100.0))
def test_it_is_linear_and_blind_to_the_mean(x, ends, gain, offset):
    """A gain goes through, an offset does not."""
    np.testing.assert_allclose(
        band_limited(gain * x + offset, 100.0, *ends), gain * band_limited(x, 100.0, *ends), atol=1e-10
    )


@given(SIGNALS, st.lists(st.floats(0.1, 49.0), max_size=5))
def test_bands_that_share_edges_add_up(x, inner):
    """No line falls between two bands, and none into both."""
    edges = [0.0, *sorted(inner), 51.0]
    parts = [band_limited(x, 100.0, low, high) for low, high in pairwise(edges)]
    np.testing.assert_allclose(sum(parts), x - x.mean(), atol=1e-11)


@given(st.integers(0, 200))
def test_it_commutes_with_a_shift_around_the_record(shift):
    """The filter has no phase: it delays neither side."""
    x = np.random.default_rng(1).standard_normal(200)
    np.testing.assert_allclose(
        band_limited(np.roll(x, shift), 100.0, 3.0, 20.0), np.roll(band_limited(x, 100.0, 3.0, 20.0), shift), atol=1e-12
    )


def test_a_line_on_an_edge_belongs_to_the_band_above_it():
    """What has f < lo or f >= hi is out, also where rounding puts it beside the edge (12000 samples at 200 Hz)."""
    t = np.arange(12000) / 200.0
    tone = np.sin(2 * np.pi * 60.0 * t)
    assert np.abs(band_limited(tone, 200.0, 0.0, 60.0)).max() < 1e-9
    assert band_limited(tone, 200.0, 60.0, 90.0).std() == pytest.approx(np.sqrt(0.5))
    assert bin_from(60.0, 200.0, 12000) == 3600


def test_several_signals_are_filtered_each_by_itself():
    """Signals (n, t) along time."""
    x = np.random.default_rng(2).standard_normal((3, 128))
    for row, filtered in zip(x, band_limited(x, 50.0, 1.0, 10.0), strict=True):
        np.testing.assert_allclose(filtered, band_limited(row, 50.0, 1.0, 10.0), atol=1e-14)


def test_edges_of_the_bands_that_are_compared():
    """0, 2, 5, 8, 12, 20 Hz and the ends, whichever lie inside."""
    assert band_edges(0.0, 60.0) == (0.0, 2.0, 5.0, 8.0, 12.0, 20.0, 60.0)
    assert band_edges(2.0, 12.0) == (2.0, 5.0, 8.0, 12.0)
    assert band_edges(0.0, 1.0) == (0.0, 1.0)
