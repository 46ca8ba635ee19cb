"""Numbers of a gauge: those of the oracle, and what they are under gains, distances and lengths of records."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.gauges.correlated.numbers import band_rms, compared, lost_share, ratio, side
from fatigue.gauges.correlated.prepared import without_trend
from fatigue.gauges.correlated.sides import Strain, counted, rms
from fatigue.gauges.measured.alignment import aligned
from fatigue.gauges.measured.band import band_limited
from fatigue.gauges.measured.rate import at_ratio, exact_ratio
from tests.gauges.measured.tones import tones

K, BAND = 3.6, (0.5, 60.0)


def whole(x):
    """A record that nothing is cut out of."""
    return Strain(x, ((0, len(x) - 1),))


@pytest.fixture(scope="module")
def sides():
    """Both sides of the oracle ``correlate``: gain 1.08, 12.3 ms late, a drift, an offset, 250 against 200 Hz."""
    t, late = np.arange(12000) / 200.0, np.arange(15000) / 250.0
    measured = 1.08 * tones(late - 0.0123) + 0.02 * late + 5.0
    rates = exact_ratio(250.0, 200.0, 15000)
    assert rates == Fraction(4, 5)
    x = at_ratio(measured, rates)[:12000]
    both = without_trend(whole(x)), tones(t)
    return [side([whole(band_limited(one, 200.0, *BAND))], "repeat", 1.0) for one in both]


def test_the_numbers_of_the_oracle(sides):
    """measured_oracles.json, correlate: rms, pseudo-damage, ratios to 1e-5; the closed form is 1.08^3.6."""
    found = compared(*sides, 200.0, BAND, K)
    assert list(found.range_ratios) == [1, 10, 100]
    assert found.rms_measured == pytest.approx(36.834578, rel=1e-6)
    assert found.rms_simulated == pytest.approx(34.0954542, rel=1e-6)
    assert found.rms_ratio == pytest.approx(1.08033692, rel=1e-6)
    assert found.damage_measured == pytest.approx(5828140280.0, rel=1e-6)
    assert found.damage_simulated == pytest.approx(4409695360.0, rel=1e-6)
    assert found.damage_ratio == pytest.approx(1.32166506, rel=1e-6)
    assert found.equivalent_range_ratio == pytest.approx(1.08054992, rel=1e-6)
    assert found.damage_ratio == pytest.approx(1.31924519, rel=2e-3)


def test_the_lag_of_the_oracle(sides):
    """correlate.lag_s to 2e-5 s, correlate.peak."""
    measured, simulated = (one.records[0].x for one in sides)
    found = aligned(measured, simulated, 200.0, 0.2)
    assert found.lag_s == pytest.approx(0.01229498, abs=1e-7)
    assert found.lag_s == pytest.approx(0.0123, abs=2e-5)
    assert found.correlation == pytest.approx(0.998038108, rel=1e-8)


def test_the_exceedance_of_the_oracle(sides):
    """correlate.exceedance_sim: cycles with a range of at least each threshold."""
    levels = np.array([20.0, 40.0, 60.0, 80.0, 100.0, 120.0, 140.0])
    assert sides[1].cycles.reached(levels).tolist() == [354.0, 174.0, 102.0, 102.0, 102.0, 78.0, 18.0]


def test_bands_that_hold_a_tone_have_its_gain_and_empty_ones_none(sides):
    """1.7, 6.3 and 11.9 Hz: bands 0.5-2, 5-8 and 8-12; the simulation has nothing in the others."""
    found = compared(*sides, 200.0, BAND, K).band_ratios
    assert list(found) == [(0.5, 2.0), (2.0, 5.0), (5.0, 8.0), (8.0, 12.0), (12.0, 20.0), (20.0, 60.0)]
    for band in ((0.5, 2.0), (5.0, 8.0), (8.0, 12.0)):
        assert found[band] == pytest.approx(1.08, rel=2e-3)
    for band in ((2.0, 5.0), (12.0, 20.0), (20.0, 60.0)):
        assert not found[band] < 1e6


@given(st.floats(0.2, 5.0), st.floats(0.5, 5.0), st.floats(1.0, 8.0))
def test_a_gain_is_its_power_in_damage_and_itself_in_every_range(gain, km, k):
    """Measured is gain x simulated over another distance of the same track."""
    x = np.random.default_rng(4).standard_normal(2000)
    simulated = side([whole(x)], "repeat", km)
    found = compared(side([whole(gain * x)], "repeat", km), simulated, 100.0, (0.0, 60.0), k)
    assert found.damage_ratio == pytest.approx(gain**k, rel=1e-9)
    assert found.equivalent_range_ratio == pytest.approx(gain, rel=1e-9)
    assert found.rms_ratio == pytest.approx(gain, rel=1e-9)
    for of_ranges in found.range_ratios.values():
        assert math.isnan(of_ranges) or of_ranges == pytest.approx(gain, rel=1e-9)


def test_twice_the_track_in_twice_the_distance_is_the_same():
    """Two passes of a block are two records, or one: per km it is one pass."""
    x = np.random.default_rng(4).standard_normal(2000)
    one, two = side([whole(x)], "repeat", 2.0), side([whole(x), whole(x)], "repeat", 4.0)
    found = compared(two, one, 100.0, (0.0, 60.0), K)
    assert found.damage_ratio == pytest.approx(1.0, rel=1e-12)
    assert list(found.range_ratios.values()) == pytest.approx([1.0] * 3, rel=1e-12)


def test_ranges_beyond_the_cycles_are_not_extrapolated():
    """One cycle a km is not known of ten km with less, and NaN is not 0."""
    x = np.tile([0.0, 1.0], 5)
    found = counted((whole(x),), "repeat", 100.0)
    assert np.isnan(found.range_exceeded(1.0))
    assert np.isnan(found.range_exceeded(1e-3))
    assert found.range_exceeded(0.05) == 1.0


def test_a_range_is_read_linearly_in_the_logarithm_of_its_cycles():
    """Ranges of 9, 6 and 3, reached by 1, 10 and 100 cycles: a range every decade, and between them on a line."""
    x = np.concatenate([np.tile([0.0, 3.0], 90), np.tile([0.0, 6.0], 9), [0.0, 9.0]])
    found = counted((whole(x),), "repeat", 1.0)
    assert [found.range_exceeded(n) for n in (1.0, 10.0, 100.0)] == [9.0, 6.0, 3.0]
    assert found.range_exceeded(10.5) == pytest.approx(6.0 - 3.0 * np.log(10.5 / 10.0) / np.log(11.0 / 10.0))


def test_a_cut_record_is_counted_as_single_passes():
    """Half cycles in every segment; a whole one with the residue of the event."""
    x = np.array([0.0, 2.0, 0.0, 3.0, 0.0, 2.0])
    assert counted((whole(x),), "repeat", 1.0).per_km.tolist() == [1.0, 1.0, 1.0]
    cut = counted((Strain(x, ((0, 2), (4, 5))),), "repeat", 1.0)
    assert cut.per_km.tolist() == [0.5, 0.5, 0.5]
    assert cut.range.tolist() == [2.0, 2.0, 2.0]
    assert cut.largest == (0, 0, 1)


def test_the_share_of_damage_outside_the_band(sides):
    """1 - D(B(sim)) / D(sim): tones below 10 Hz without that of 11.9 Hz."""
    x = tones(np.arange(12000) / 200.0)
    limited = side([whole(band_limited(x, 200.0, 0.0, 10.0))], "repeat", 1.0)
    slow = counted((whole(tones_below_10()),), "repeat", 1.0).pseudo_damage(K)
    everything = counted((whole(x),), "repeat", 1.0).pseudo_damage(K)
    assert lost_share(whole(x), limited, "repeat", K) == pytest.approx(1.0 - slow / everything, rel=1e-6)


def tones_below_10():
    """The oracle's tones of 1.7 and 6.3 Hz."""
    t = np.arange(12000) / 200.0
    return 40 * np.sin(2 * np.pi * 1.7 * t) + 25 * np.sin(2 * np.pi * 6.3 * t + 0.5)


def test_nothing_counted_has_no_numbers():
    """NaN, never a ratio of 0 that would look like a gauge at rest."""
    x = np.random.default_rng(4).standard_normal(200)
    found = compared(side([Strain(x, ())], "half", 0.0), side([whole(x)], "half", 1.0), 100.0, (0.0, 60.0), K)
    assert np.isnan(found.damage_ratio)
    assert np.isnan(found.rms_ratio)


def test_one_dead_record_of_two_takes_only_itself_away():
    """What the other one counted, over its own distance."""
    x = np.random.default_rng(4).standard_normal(200)
    both = side([Strain(x, ()), whole(x)], "half", 1.0)
    assert both.pseudo_damage(K) == side([whole(x)], "half", 1.0).pseudo_damage(K) > 0.0
    assert rms(both.records) == pytest.approx(x.std())


def test_a_ratio_over_nothing_is_infinite_and_of_nothing_none():
    """A gauge that the simulation leaves at rest is poor if it moves, and says nothing if it does not."""
    assert ratio(2.0, 4.0) == 0.5
    assert ratio(1.0, 0.0) == math.inf
    assert ratio(0.0, 1.0) == 0.0
    assert math.isnan(ratio(0.0, 0.0))
    assert math.isnan(ratio(math.nan, 1.0))


def test_a_band_with_less_than_a_ten_thousandth_of_the_whole_is_empty():
    """Leakage of a resampling filter is no content."""
    t = np.arange(2000) / 100.0
    for share, expected in ((0.9e-4, 0.0), (1.1e-4, 1.1e-4)):
        x = np.sin(2 * np.pi * 3.0 * t) + share * np.sin(2 * np.pi * 15.0 * t)
        found = band_rms([whole(x)], 100.0, (0.0, 10.0, 20.0))
        assert found[0] == pytest.approx(math.sqrt(0.5))
        assert found[1] == pytest.approx(expected * math.sqrt(0.5), rel=1e-6)


def test_a_trend_is_that_of_the_samples_that_are_counted():
    """A gap filled with anything does not bend the line."""
    x = 3.0 + 0.5 * np.arange(100)
    x[40:60] = 500.0
    left = without_trend(Strain(x, ((0, 39), (60, 99))))
    np.testing.assert_allclose(left[:40], 0.0, atol=1e-9)
    np.testing.assert_allclose(left[60:], 0.0, atol=1e-9)
