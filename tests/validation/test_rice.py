"""Closed forms of random vibration: Rice's rates, moments of an oscillator, of a flat band, of a sine."""

import numpy as np
import pytest
from scipy.integrate import simpson

from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.methods import narrow_band_damage_rate, spectral_shape
from fatigue.spectrum.moments import moment_matrices, point_moments, segment_spectra
from fatigue.spectrum.trust import tone_damage_factor
from tests.naive_spectrum import moments_of, straight_law


def test_moments_of_an_oscillator_under_white_noise():
    """m0 = pi f0 G / 4 zeta, m1 = m0 f0 (1 - 2/pi asin zeta) / sqrt(1 - zeta^2), m2 = m0 f0^2 (Lutes and Sarkani)."""
    f0, zeta, g = 9.3, 0.02, 0.4

    def density(f):
        r = f / f0
        return g / ((1 - r**2) ** 2 + (2 * zeta * r) ** 2)

    f = np.concatenate([np.linspace(0, 8, 20001)[:-1], np.linspace(8, 11, 60001)[:-1], np.geomspace(11, 2e5, 200001)])
    m0 = np.pi * f0 * g / 4 / zeta
    m1 = m0 * f0 * (1 - 2 / np.pi * np.arcsin(zeta)) / np.sqrt(1 - zeta**2)
    computed = moments_of((f, density(f)), (0, 1, 2))[:, 0]
    np.testing.assert_allclose(computed, (m0, m1, m0 * f0**2), rtol=2e-5)


def test_narrow_band_bound_of_the_wafo_example():
    """WAFO (Lund University), spec2dplus: an oscillator of damping 0.1, sum of a^k per second for k = 3, 4, 5.

    Its grid of 257 frequencies begins with a density of 0 at 0 rad/s, and Simpson's rule runs over it.
    """
    omega = 4 / 257 * np.arange(258)
    density = 1 / np.pi / ((1 - omega**2) ** 2 + (0.2 * omega) ** 2)
    density[0] = 0
    moments = np.array([[simpson((omega / 2 / np.pi) ** p * density, x=omega)] for p in (0, 1, 2, 4)])
    for k, expected in ((3.0, 2.32262632), (4.0, 7.80833829), (5.0, 28.99281031)):
        assert narrow_band_damage_rate(moments, straight_law(k, 2.0**k))[0] == pytest.approx(expected, rel=1e-5)


def test_rates_of_a_gaussian_record_are_those_counted():
    """Rice 1945: upward crossings and maxima of a long record agree with sqrt(m2/m0) and sqrt(m4/m2)."""
    rng = np.random.default_rng(7)
    step, samples = 1 / 400, 400 * 600
    f = np.fft.rfftfreq(samples, step)
    lines = np.where((f > 3) & (f < 20), rng.normal(size=f.size) + 1j * rng.normal(size=f.size), 0)
    x = np.fft.irfft(lines * samples)[None]
    record = ModalHistory("event", np.array([1]), x, step, 0.0)
    moments = point_moments(np.ones((1, 1)), moment_matrices(segment_spectra(record, 4.0, 60.0)))
    shape = spectral_shape(moments)
    duration = samples * step
    crossings = np.sum((x[0, :-1] < 0) & (x[0, 1:] >= 0)) / duration
    peaks = np.sum((x[0, 1:-1] > x[0, :-2]) & (x[0, 1:-1] > x[0, 2:])) / duration
    assert shape.zero_crossings[0] == pytest.approx(crossings, rel=0.02)
    assert shape.peaks[0] == pytest.approx(peaks, rel=0.02)


def test_a_sine_has_half_its_amplitude_squared():
    """One line: m0 = a^2 / 2, all rates its frequency, whatever its place between the bins."""
    step, frequency, amplitude = 1 / 256, 9.37, 40.0
    t = np.arange(256 * 30) * step
    record = ModalHistory("event", np.array([1]), np.sin(2 * np.pi * frequency * t)[None], step, 0.0)
    matrices = moment_matrices(segment_spectra(record, 4.0, 60.0))
    moments = point_moments(np.array([[amplitude]]), matrices)
    assert moments[0, 0] == pytest.approx(amplitude**2 / 2, rel=1e-3)
    shape = spectral_shape(moments)
    assert shape.zero_crossings[0] == pytest.approx(frequency, rel=1e-3)
    assert shape.peaks[0] == pytest.approx(frequency, rel=3e-3)


@pytest.mark.parametrize(("share", "factor"), [(0.5, 0.905), (0.9, 0.677), (0.99, 0.605)])
def test_tone_in_narrow_band_noise(share, factor):
    """Rice's distribution of the amplitude, k = 3.6: closed form, and the envelope of such a record."""
    assert tone_damage_factor(np.array([share]), 3.6)[0] == pytest.approx(factor, abs=6e-4)
    rng = np.random.default_rng(11)
    noise = rng.normal(size=(2, 400_000)) * np.sqrt(1 - share)
    envelope = np.hypot(noise[0] + np.sqrt(2 * share), noise[1])
    gaussian = np.hypot(*rng.normal(size=(2, 400_000)))
    assert np.mean(envelope**3.6) / np.mean(gaussian**3.6) == pytest.approx(factor, rel=0.02)
