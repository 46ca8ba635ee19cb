"""A record as cosines: Parseval, densities between any two frequencies, filters that are exact at any sampling rate."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import signal

from fatigue.vibration.standards.mirrored import band_pass, filtered, lines, mean_square, spread


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 500))
def test_lines_sum_up_to_the_mean_square(seed, samples):
    """Parseval, at any length and any phase."""
    values = np.random.default_rng(seed).standard_normal(samples) + 3.0
    frequency, power = lines(values, 0.01)
    assert power.sum() == pytest.approx(np.mean(values**2), rel=1e-12)
    assert power[0] == pytest.approx(np.mean(values) ** 2, rel=1e-9, abs=1e-12)
    assert frequency[0] == 0.0
    assert frequency[-1] < 50.0


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1), st.lists(st.floats(0.1, 49.0), min_size=1, max_size=5))
def test_mean_squares_of_bands_sum_up_to_the_variance(seed, inner):
    """Bands that fill 0 to half the sampling rate share the variance, wherever they are cut."""
    values = np.random.default_rng(seed).standard_normal(300) - 2.0
    edges = np.array([0.0, *sorted(inner), 50.0])
    assert mean_square(values, 0.01, edges).sum() == pytest.approx(values.var(), rel=1e-12)


def test_no_density_is_told_above_half_the_sampling_rate():
    """Nothing is known there; the band up to half the sampling rate is whole."""
    values = np.random.default_rng(1).standard_normal(1000)
    assert np.isnan(mean_square(values, 0.01, np.array([1.0, 60.0]))[0])
    assert np.isfinite(mean_square(values, 0.01, np.array([1.0, 50.0]))[0])


def test_white_noise_is_flat():
    """Density of white noise is its variance over half the sampling rate, in narrow and in wide bands."""
    values = np.random.default_rng(5).standard_normal(200_000)
    edges = np.array([1.0, 2.0, 11.0, 40.0])
    assert mean_square(values, 0.01, edges) / np.diff(edges) == pytest.approx(np.full(3, 0.02), rel=0.05)


def test_a_drift_does_not_reach_a_band_above_it():
    """A ramp of 1 m/s2 leaves less than 2 mm/s2 above 0.5 Hz: its mirrored extension has no jump."""
    ramp = np.linspace(0.0, 1.0, 3000)
    assert np.sqrt(mean_square(ramp, 0.01, np.array([0.5, 40.0]))[0]) < 2e-3


def test_a_band_pass_is_that_of_scipy():
    """Gain of the band-pass beside the analogue Butterworth filter of scipy, of the same order on each side."""
    f = np.array([0.05, 0.4, 1.0, 5.0, 10.0, 30.0])
    b, a = signal.butter(4, [2 * np.pi * 0.4, 2 * np.pi * 10.0], "bandpass", analog=True)
    _, h = signal.freqs(b, a, 2 * np.pi * f)
    assert band_pass(0.4, 10.0)(f) == pytest.approx(np.abs(h), rel=1e-6)


def test_a_filter_scales_a_sine_by_its_gain_and_shifts_nothing():
    """Cosine of 2 Hz through a gain of 1 / f: half of it, in place."""
    x = np.cos(2 * np.pi * 2.0 * (np.arange(1000) + 0.5) / 100)
    assert filtered(x, 0.01, lambda f: 1 / np.maximum(f, 0.5)) == pytest.approx(0.5 * x, abs=1e-12)


@given(st.integers(1, 300), st.integers(1, 300), st.integers(1, 300))
def test_blocks_cover_a_record(samples, length, hop):
    """Blocks begin and end with the record and leave no sample out between them, if hops are no longer than a block."""
    first = spread(samples, length, hop)
    if samples < length:
        assert first.size == 0
        return
    assert (first[0], first[-1]) == (0, samples - length)
    assert ((np.diff(first) > 0) & (np.diff(first) <= hop)).all()
