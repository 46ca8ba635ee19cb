"""What lies above the band: its moments by Welch, and its damage against rainflow of whole and filtered records."""

from math import sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import welch

from fatigue.life.counting.rainflow import rainflow
from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.methods import tovo_benasciutti_damage_rate
from fatigue.spectrum.moments import moment_matrices, point_moments, segment_spectra, spectra_above
from fatigue.spectrum.outside import NEGLIGIBLE, missed_damage, peak_rate, share_above
from fatigue.spectrum.trust import missed_limit
from tests.naive_spectrum import straight_law

RATE = 1000.0
SAMPLES = 2**17


def moments(q, step, upper_hz, segment_s=1.0):
    """Moments of a record in its band and above it, (4,) each."""
    history = ModalHistory("e", np.array([1]), q[None], step, 0.0)
    spectra = segment_spectra(history, segment_s, upper_hz)
    above = spectra_above(spectra)
    one = np.ones((1, 1))
    band = point_moments(one, moment_matrices(spectra))[:, 0]
    return band, np.zeros(4) if above is None else point_moments(one, moment_matrices(above))[:, 0]


def band_noise(seed, low, high):
    """Gaussian noise of variance 1 between two frequencies."""
    f = np.fft.rfftfreq(SAMPLES, 1 / RATE)
    rng = np.random.default_rng(seed)
    lines = (rng.normal(size=f.size) + 1j * rng.normal(size=f.size)) * ((f > low) & (f < high))
    x = np.fft.irfft(lines, SAMPLES)
    return x / x.std()


@settings(max_examples=30, deadline=None)
@given(length=st.integers(4, 40), upper=st.floats(0.01, 3.0), seed=st.integers(0, 99))
def test_band_and_above_make_the_whole(length, upper, seed):
    """The two add up to the trapezoid over all lines of Welch's density, whatever the band and the segment."""
    step = 0.25
    q = np.random.default_rng(seed).standard_normal(3 * length + 1)
    band, above = moments(q, step, upper, length * step)
    f, density = welch(q, 1 / step, "hann", length, length // 2, detrend="constant")
    whole = [np.trapezoid(f**p * density, f) for p in (0, 1, 2, 4)]
    np.testing.assert_allclose(band + above, whole, rtol=1e-11)
    kept = f <= upper * (1 + 1e-9)
    np.testing.assert_allclose(band[0], np.trapezoid(density[kept], f[kept]), rtol=1e-11, atol=1e-13)


def test_two_tones():
    """Amplitudes 3 and 1: a tenth of the variance lies above; nu_p^2 = sum a^2 f^4 / sum a^2 f^2."""
    t = np.arange(40_000) / RATE
    band, above = moments(3 * np.sin(2 * np.pi * 10 * t) + np.sin(2 * np.pi * 80 * t), 1 / RATE, 40.0, 4.0)
    assert share_above(band, above) == pytest.approx(0.1, rel=1e-6)
    rate = sqrt((9 * 10**4 + 80**4) / (9 * 10**2 + 80**2))
    assert peak_rate(band, above) == pytest.approx(rate, rel=1e-3)
    assert peak_rate(band, 0 * above) == pytest.approx(10.0, rel=1e-2)


def test_white_noise_peaks_at_0_77_of_half_the_rate():
    """sqrt(3/5) of half the sampling rate, 2.6 samples per peak: no record asks for more than 16 times the samples."""
    band, above = moments(np.random.default_rng(0).standard_normal(SAMPLES), 1 / RATE, 100.0)
    assert peak_rate(band, above) == pytest.approx(sqrt(0.6) * RATE / 2, rel=0.01)
    assert share_above(band, above) == pytest.approx(0.8, rel=0.01)


def test_noise_too_small_to_matter_has_no_peaks():
    """White noise of 0.5 % of the rms makes most of the peaks and 1 % of the damage: the rate is that of the band."""
    t = np.arange(SAMPLES) / RATE
    slow = sqrt(2) * np.sin(2 * np.pi * t)
    noise = np.random.default_rng(1).standard_normal(SAMPLES)
    assert peak_rate(*moments(slow + 0.005 * noise, 1 / RATE, 40.0, 4.0)) < 20.0
    assert share_above(*moments(slow + 0.005 * noise, 1 / RATE, 40.0, 4.0)) < NEGLIGIBLE
    assert peak_rate(*moments(slow + 0.02 * noise, 1 / RATE, 40.0, 4.0)) > 300.0


@pytest.mark.parametrize("k", [3.0, 3.6, 5.0])
@pytest.mark.parametrize("low_hz", [(1.0, 20.0), (8.0, 12.0)])
@pytest.mark.parametrize(("high_hz", "share"), [((78.0, 82.0), 0.03), ((60.0, 200.0), 0.01), ((60.0, 200.0), 0.1)])
def test_damage_missed_is_the_damage_that_a_filter_takes_out(k, low_hz, high_hz, share):
    """Rainflow of the whole record over rainflow of its band, against Tovo-Benasciutti of both: within 0.8 to 1.25."""
    slow, fast = band_noise(2, *low_hz), sqrt(share / (1 - share)) * band_noise(3, *high_hz)
    counted = [float(np.sum(c.count * c.range**k)) for c in (rainflow(x, "repeat") for x in (slow + fast, slow))]
    band, above = moments(slow + fast, 1 / RATE, 40.0)
    law = straight_law(k)
    tb = [tovo_benasciutti_damage_rate(m[:, None], law)[0] for m in (band + above, band)]
    assert 0.8 < (tb[0] / tb[1]) / (counted[0] / counted[1]) < 1.25


def test_limit_is_worth_its_words():
    """From the limit on a tenth of the damage at least is missing, by count; without content above nothing is."""
    slow = band_noise(4, 8.0, 12.0)
    for share in (1e-3, 3e-3, 1e-2, 3e-2, 0.1):
        x = slow + sqrt(share / (1 - share)) * band_noise(5, 78.0, 82.0)
        band, above = moments(x, 1 / RATE, 40.0)
        tb, whole = (tovo_benasciutti_damage_rate(m[:, None], straight_law(3.6)) for m in (band, band + above))
        counted = [float(np.sum(c.count * c.range**3.6)) for c in (rainflow(y, "repeat") for y in (x, slow))]
        outside = missed_damage(tb, whole)[0] > missed_limit(3.6)
        assert not outside or counted[0] > 1.1 * counted[1]
        assert outside or counted[0] < 1.5 * counted[1]
    assert missed_damage(tb, tb)[0] == 0.0
