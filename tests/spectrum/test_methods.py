"""Damage from spectral moments: guards, closed forms, scale laws."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fatigue.spectrum.methods import (
    EXPONENTIAL,
    RAYLEIGH,
    damage_per_cycle,
    dirlik_damage_rate,
    dirlik_density,
    dirlik_over_narrow_band,
    narrow_band_damage_rate,
    spectral_shape,
    tovo_benasciutti_damage_rate,
)
from tests.naive_spectrum import (
    bent_law,
    damage_of_range,
    dirlik_by_quadrature,
    modal_spectrum,
    moments_of,
    narrow_spectrum,
    straight_law,
    two_band_spectrum,
)

METHODS = [dirlik_damage_rate, tovo_benasciutti_damage_rate, narrow_band_damage_rate]
ALL_METHODS = pytest.mark.parametrize("method", METHODS)


def moments_with(alpha1, alpha2, m0=100.0, crossings=8.0):
    """Make moments (4, n) with given bandwidth parameters."""
    m2 = m0 * crossings**2
    m4 = m2 * (crossings / alpha2) ** 2
    return np.array([m0 + 0 * alpha1, alpha1 * np.sqrt(m0 * m2), m2 + 0 * alpha1, m4])


bandwidths = st.tuples(st.floats(0.02, 0.999), st.floats(1e-3, 1)).map(
    lambda t: (np.array([t[0] + t[1] * (1 - t[0])]), np.array([t[0]]))
)


def test_rates_and_bandwidth():
    """nu0 = sqrt(m2/m0), nup = sqrt(m4/m2), alpha2 their ratio."""
    shape = spectral_shape(np.array([[4.0], [10.0], [36.0], [900.0]]))
    assert shape.zero_crossings[0] == pytest.approx(3.0)
    assert shape.peaks[0] == pytest.approx(5.0)
    assert shape.alpha2[0] == pytest.approx(0.6)
    assert shape.alpha1[0] == pytest.approx(10 / 12)


@ALL_METHODS
def test_amplitude_and_range_differ_by_two_to_the_k(method):
    """In the narrow band all methods give nu0 2^k E a^k / C: with ranges, a curve in ranges needs the 2^k."""
    narrow = moments_with(np.array([1.0]), np.array([1.0]), m0=50.0, crossings=5.0)
    rayleigh_mean = 100.0**1.8 * 1.6764907877644896  # E a^3.6 of Rayleigh amplitudes, m0 = 50: (2 m0)^1.8 Gamma(2.8)
    assert method(narrow, straight_law(3.6, 1e12))[0] == pytest.approx(5.0 * 2**3.6 * rayleigh_mean / 1e12, rel=1e-12)


@ALL_METHODS
def test_no_stress_no_damage(method):
    """A point that stays still has damage 0, on straight and bent laws, without a warning."""
    moments = np.array([[0.0, 0, 100, 100], [0, 0, 0, 500], [0, 0, 0, 2600], [0, 1, 0, 90000]])
    for law in (straight_law(3.6), bent_law([3, 5], [20.0]), bent_law([3], [], cutoff=5.0)):
        rate = method(moments, law)
        assert np.all(rate[:3] == 0)
        assert rate[3] > 0


@ALL_METHODS
def test_nan_is_not_hidden(method):
    """A NaN moment gives a NaN damage, never 0."""
    moments = moments_with(np.array([0.9, 0.9]), np.array([0.8, 0.8]))
    moments[:, 0] = np.nan
    rate = method(moments, straight_law(3.0))
    assert np.isnan(rate[0])
    assert rate[1] > 0


@ALL_METHODS
@pytest.mark.parametrize("gap", [0.0, 1e-16, 1e-13, 1e-11, 1e-9, 5e-8, 2e-7, 1e-6])
def test_the_narrow_band_limit_is_smooth(method, gap):
    """Towards alpha2 = 1 no method turns singular (Dirlik's Q is 0 / 0 there): all tend to the narrow band."""
    moments = moments_with(np.array([1 - gap / 4]), np.array([1 - gap]))
    narrow = narrow_band_damage_rate(moments, straight_law(3.6))
    assert method(moments, straight_law(3.6))[0] == pytest.approx(narrow[0], rel=1e-6 + 10 * gap)


@ALL_METHODS
def test_moments_that_rounding_made_inconsistent(method):
    """alpha1 a little above 1, alpha2 a little above alpha1: as on the border."""
    border = method(moments_with(np.array([1.0, 0.6]), np.array([1.0, 0.6])), straight_law(3.0))
    beyond = method(moments_with(np.array([1 + 1e-9, 0.6]), np.array([1 + 1e-9, 0.6 + 1e-9])), straight_law(3.0))
    np.testing.assert_allclose(beyond, border, rtol=1e-6)


def test_a_negative_dirlik_r_counts_with_its_magnitude():
    """R < 0 on a quarter of the triangle: the density is that of abs(R), real for any k."""
    moments = moments_with(np.array([0.99]), np.array([0.45]))
    density = dirlik_density(spectral_shape(moments))
    assert density.r[0] < 0
    for law in (straight_law(3.6), bent_law([3.0, 5.0], [30.0])):
        assert dirlik_damage_rate(moments, law)[0] == pytest.approx(dirlik_by_quadrature(moments, law), rel=1e-9)


def test_dirlik_weights_over_the_whole_triangle():
    """Weights are never negative and sum to 1, Q >= 0 and R < 1 for all 0 < alpha2 <= alpha1 <= 1."""
    a2, t = np.meshgrid(np.linspace(0.01, 0.9999, 300), np.linspace(0, 1, 301))
    a1 = a2 + t * (1 - a2)
    density = dirlik_density(spectral_shape(moments_with(a1.ravel(), a2.ravel())))
    assert all(np.min(weight) >= -1e-10 for weight in (density.d1, density.d2, density.d3, density.q))
    assert np.max(density.r) < 1
    np.testing.assert_allclose(density.d1 + density.d2 + density.d3, 1.0, rtol=1e-12)
    assert 0.2 < np.mean(density.r < 0) < 0.3


@pytest.mark.parametrize("k", [3.0, 3.6, 5.0])
def test_dirlik_over_narrow_band(k):
    """The ratio of the two damage rates on a straight law, up to a narrow band; none without stress."""
    moments = moments_with(np.array([0.8, 0.99, 0.3, 1.0]), np.array([0.55, 0.45, 0.01, 1.0]))
    expected = dirlik_damage_rate(moments, straight_law(k)) / narrow_band_damage_rate(moments, straight_law(k))
    np.testing.assert_allclose(dirlik_over_narrow_band(spectral_shape(moments), k), expected, rtol=1e-12)
    assert np.isnan(dirlik_over_narrow_band(spectral_shape(np.zeros((4, 1))), k)).all()


def test_tovo_benasciutti_closed_form():
    """On a straight law the two Rayleigh parts are NB [b + (1 - b) alpha2^(k - 1)]."""
    a1, a2, k = np.array([0.8]), np.array([0.55]), 3.6
    b = (a1 - a2) * (1.112 * (1 + a1 * a2 - a1 - a2) * np.exp(2.11 * a2) + a1 - a2) / (a2 - 1) ** 2
    moments = moments_with(a1, a2)
    expected = narrow_band_damage_rate(moments, straight_law(k)) * (b + (1 - b) * a2 ** (k - 1))
    np.testing.assert_allclose(tovo_benasciutti_damage_rate(moments, straight_law(k)), expected, rtol=1e-13)


@ALL_METHODS
@settings(deadline=None, max_examples=40)
@given(band=bandwidths, factor=st.floats(0.01, 100), k=st.floats(1, 12))
def test_scale_and_time_laws(method, band, factor, k):
    """Stress times c: damage times c^k. Frequency times c: damage times c."""
    moments = moments_with(*band)
    rate = method(moments, straight_law(k))
    np.testing.assert_allclose(method(factor**2 * moments, straight_law(k)), factor**k * rate, rtol=1e-7)
    faster = moments * factor ** np.array([[0.0], [1.0], [2.0], [4.0]])
    np.testing.assert_allclose(method(faster, straight_law(k)), factor * rate, rtol=1e-7)


@ALL_METHODS
@settings(deadline=None, max_examples=40)
@given(band=bandwidths, factor=st.floats(0.1, 10))
def test_a_bent_law_scales_with_its_knees(method, band, factor):
    """Stress, knees and cut-off times c, constant times c^k1: nothing changes."""
    moments = moments_with(*band)
    law = bent_law([3.0, 5.0, 9.0], [60.0, 30.0], 1e12, cutoff=10.0)
    scaled = bent_law([3.0, 5.0, 9.0], [60.0 * factor, 30.0 * factor], 1e12 * factor**3, cutoff=10.0 * factor)
    np.testing.assert_allclose(method(factor**2 * moments, scaled), method(moments, law), rtol=1e-7)


@ALL_METHODS
@settings(deadline=None, max_examples=40)
@given(band=bandwidths, m0=st.floats(1, 1e4), knee=st.floats(0.5, 500))
def test_a_knee_that_does_not_bend_changes_nothing(method, band, m0, knee):
    """Equal slopes on both sides of a knee are the straight law; a cut-off only takes away; a steeper foot too."""
    moments = moments_with(*band, m0=m0)
    straight = method(moments, straight_law(4.0))
    np.testing.assert_allclose(method(moments, bent_law([4.0, 4.0], [knee])), straight, rtol=1e-9)
    cut = method(moments, bent_law([4.0], [], cutoff=knee))
    bent = method(moments, bent_law([4.0, 6.0], [knee]))
    assert np.all(cut <= bent * (1 + 1e-9))
    assert np.all(bent <= straight * (1 + 1e-9))


@settings(deadline=None, max_examples=60)
@given(
    band=bandwidths,
    m0=st.floats(1, 1e4),
    slopes=st.lists(st.floats(1.5, 9), min_size=1, max_size=4),
    top=st.floats(5, 600),
    cutoff=st.floats(0, 1.2),
)
def test_any_piecewise_law_against_quadrature_of_the_density(band, m0, slopes, top, cutoff):
    """Dirlik's density integrated numerically over knees and cut-off, wherever they lie."""
    assume(band[0][0] - band[1][0] > 1e-3)  # the quadrature needs a q that is not 0
    moments = moments_with(*band, m0=m0)
    knees = [top * 0.6**i for i in range(len(slopes) - 1)]
    law = bent_law(slopes, knees, 1e9, cutoff=cutoff * top)
    slow = dirlik_by_quadrature(moments, law)
    negligible = 1e-12 * dirlik_damage_rate(moments, bent_law(slopes, knees, 1e9))[0]
    assert dirlik_damage_rate(moments, law)[0] == pytest.approx(slow, rel=1e-6, abs=negligible)


@pytest.mark.parametrize("weibull_shape", [EXPONENTIAL, RAYLEIGH])
def test_a_cutoff_far_in_the_tail_keeps_its_digits(weibull_shape):
    """A segment between a cut-off and a knee, both far above the stress: small, and right to many digits."""
    law = bent_law([3.0, 5.0], [25.0], cutoff=20.0)
    scale = np.array([1.0])
    x = np.linspace(20.0, 70.0, 2_000_001)
    density = weibull_shape * x ** (weibull_shape - 1) * np.exp(-(x**weibull_shape))
    damage = np.where(x >= 25.0, x**3, x**5 / 625.0)
    expected = np.trapezoid(density * damage, x)
    assert 0 < expected < 1e-4
    assert damage_per_cycle(scale, weibull_shape, law)[0] == pytest.approx(expected, rel=1e-7)


def test_a_cutoff_above_every_knee():
    """A cut-off inside an upper segment silences all segments below it."""
    law = bent_law([3.0, 5.0, 7.0], [40.0, 20.0], cutoff=60.0)
    scale = np.array([5.0, 30.0, 200.0])
    only_top = bent_law([3.0], [], cutoff=60.0)
    np.testing.assert_allclose(damage_per_cycle(scale, RAYLEIGH, law), damage_per_cycle(scale, RAYLEIGH, only_top))
    assert damage_of_range(59.9, law) == 0


def test_points_are_independent():
    """Many points at once give what each gives alone."""
    moments = np.hstack([moments_of(s()) for s in (narrow_spectrum, two_band_spectrum, modal_spectrum)])
    for method in METHODS:
        for law in (straight_law(3.6), bent_law([3.0, 5.0], [30.0], cutoff=2.0)):
            alone = [method(moments[:, [i]], law)[0] for i in range(3)]
            np.testing.assert_allclose(method(moments, law), alone, rtol=1e-14)


@pytest.mark.parametrize("order", [0, 2, 3], ids=["m0", "m2", "m4"])
@pytest.mark.parametrize("value", [0.0, -1e-30])
def test_one_moment_that_vanishes_is_a_point_that_stays_still(order, value):
    """Rounding may take away any one of m0, m2 and m4 alone: no rates, a narrow band, no damage, and no warning."""
    moments = np.array([[4.0, 4.0], [10.0, 10.0], [36.0, 36.0], [900.0, 900.0]])
    moments[order, 0] = value
    shape = spectral_shape(moments)
    assert (shape.zero_crossings[0], shape.peaks[0]) == (0.0, 0.0)
    assert (shape.alpha1[0], shape.alpha2[0]) == (1.0, 1.0)
    assert (shape.zero_crossings[1], shape.peaks[1]) == (3.0, 5.0)
    for method in METHODS:
        rate = method(moments, straight_law(3.6))
        assert rate[0] == 0.0
        assert rate[1] > 0.0
