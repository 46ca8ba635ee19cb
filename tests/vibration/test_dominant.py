"""Dominant frequencies and shares of known records."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.vibration.dominant import dominant_hz, share_between, spectrum
from tests.vibration.oscillator import band_limited_noise, response

STEP = 0.004


@given(st.floats(2.0, 90.0), st.integers(2000, 8000), st.floats(0.0, 6.28))
def test_the_frequency_of_a_sine(hz, samples, phase):
    """Of any frequency and length, beside a weaker one: to an eighth of the distance between two lines."""
    t = STEP * np.arange(samples)
    x = 3.0 * np.sin(2.0 * np.pi * hz * t + phase) + np.sin(2.0 * np.pi * 0.4 * hz * t) + 50.0
    assert float(dominant_hz(spectrum(x, STEP))) == pytest.approx(hz, abs=0.125 / (STEP * samples))


def test_lines_add_up_to_the_variance():
    """Of even and odd numbers of samples, for noise whose ends are like the rest."""
    for samples in (5000, 5001):
        x = band_limited_noise(samples, STEP, 40.0)
        assert spectrum(x, STEP).variance.sum() == pytest.approx(x.var(), rel=0.05)


def test_a_resonance_dominates_what_broad_noise_excites():
    """A mode of 8 Hz with 1.5 % under noise up to 40 Hz swings at 8 Hz; the noise itself has little there."""
    f = band_limited_noise(16 * 7000, STEP / 16, 40.0)
    q = response(f, STEP / 16, 8.0, 0.015)[::16]
    low, high = 8.0 * (1.0 - 0.03), 8.0 * (1.0 + 0.03)
    assert float(dominant_hz(spectrum(q, STEP))) == pytest.approx(8.0, abs=0.1)
    assert share_between(spectrum(q, STEP), low, high) > 0.5  # 2 / pi arctan 2 = 0.70 of a long record
    assert share_between(spectrum(f[::16], STEP), low, high) == pytest.approx(0.48 / 40.0, rel=0.5)


def test_many_records_at_once():
    """Row by row the same as alone; a record at rest has neither frequency nor share."""
    t = STEP * np.arange(3000)
    x = np.stack([np.sin(2.0 * np.pi * f * t) for f in (3.0, 11.0)] + [np.full(len(t), 7.0)])
    of = spectrum(x, STEP)
    assert dominant_hz(of)[:2] == pytest.approx([3.0, 11.0], abs=1e-3)
    shares = share_between(of, np.array([2.0, 2.0, 2.0]), np.array([4.0, 4.0, 4.0]))
    assert shares[:2] == pytest.approx([1.0, 0.0], abs=2e-3)
    assert np.isnan([dominant_hz(of)[2], shares[2]]).all()


def test_a_short_record_has_a_wide_band():
    """Of eight lines three make the band; the frequency is that of the sine to the distance of the lines."""
    t = 0.05 * np.arange(16)
    assert float(dominant_hz(spectrum(np.sin(2.0 * np.pi * 5.0 * t), 0.05))) == pytest.approx(5.0, abs=0.7)
