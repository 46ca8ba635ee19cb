"""Dispersion test, kurtosis and crest: false alarms, power, and what must not matter."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import signal, stats

from fatigue.vibration.dispersion import dispersion, peakedness

RATE = 100


def oscillator(samples, f, damping, rng):
    """Stationary response of an oscillator to white noise."""
    w = 2 * np.pi * f / RATE
    radius = np.exp(-damping * w)
    poles = [1, -2 * radius * np.cos(w * np.sqrt(1 - damping**2)), radius**2]
    return signal.lfilter([1], poles, rng.standard_normal(samples + 6000))[6000:]


def bandpass(samples, rng):
    """Noise of the band of hunting."""
    sos = signal.butter(2, [4, 12], "bandpass", fs=RATE, output="sos")
    return signal.sosfilt(sos, rng.standard_normal(samples + 2000))[2000:]


STATIONARY = {
    "white": lambda samples, rng: rng.standard_normal(samples),
    "band": bandpass,
    "hunting 5 %": lambda samples, rng: oscillator(samples, 8.0, 0.05, rng),
    "body 1.5 %": lambda samples, rng: oscillator(samples, 8.0, 0.015, rng),
    "body 1 %": lambda samples, rng: oscillator(samples, 9.0, 0.01, rng),
    "sway 10 %": lambda samples, rng: oscillator(samples, 1.2, 0.1, rng),
    "mixed": lambda samples, rng: oscillator(samples, 8.0, 0.03, rng) / 10 + rng.standard_normal(samples),
}


def rejected(kind, seconds, seeds, level=0.05):
    """Share of stationary records that the test rejects, and the mean ratio."""
    found = [dispersion(STATIONARY[kind](seconds * RATE, np.random.default_rng(s)), 1 / RATE) for s in seeds]
    kept = [f for f in found if f is not None]
    assert len(kept) > 0.9 * len(found)
    return np.mean([f.p < level for f in kept]), np.mean([f.ratio for f in kept])


@pytest.mark.parametrize("kind", STATIONARY)
def test_false_alarms(kind):
    """Of stationary records some 5 in 100 are rejected at the level of 5 %, and the ratio is 1 in the mean."""
    share, ratio = rejected(kind, 60, range(150))
    assert 0.005 <= share <= 0.11  # 5 % of 150 records, give or take three standard deviations
    assert ratio == pytest.approx(1.0, abs=0.12)


@pytest.mark.slow
@pytest.mark.parametrize("seconds", [60, 300])
@pytest.mark.parametrize("kind", STATIONARY)
def test_false_alarms_over_many_records(kind, seconds):
    """Between 2 and 8 % over six hundred records, narrow-band and broadband, short and long."""
    share, ratio = rejected(kind, seconds, range(1000, 1600))
    assert 0.02 <= share <= 0.08
    assert ratio == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("kind", ["white", "band", "hunting 5 %"])
@pytest.mark.parametrize("seed", range(4))
def test_bursts_are_found(kind, seed):
    """A record that is three times as strong on a quarter of its length is rejected beyond doubt."""
    values = STATIONARY[kind](60 * RATE, np.random.default_rng(seed))
    values[1000:1700] *= 3
    values[3500:4300] *= 3
    found = dispersion(values, 1 / RATE)
    assert found.ratio > 4
    assert found.p < 1e-5


@pytest.mark.parametrize("seconds", [60, 120])
@pytest.mark.parametrize("share", [0.1, 0.25])
def test_a_burst_of_one_frequency_is_found(seconds, share):
    """A sine that comes and goes makes the record narrow, and does not pass for narrow-band noise."""
    values = 0.1 * np.random.default_rng(7).standard_normal(seconds * RATE)
    inside = slice(round(0.3 * values.size), round((0.3 + share) * values.size))
    values[inside] += np.sin(0.5 * np.arange(values.size))[inside]
    found = dispersion(values, 1 / RATE)
    assert found.ratio > 4
    assert found.p < 1e-3


def test_a_sine_scatters_less_than_noise():
    """The mean square of a sine hardly changes."""
    found = dispersion(np.sin(0.5 * np.arange(6000)), 1 / RATE)
    assert found.ratio < 0.01
    assert found.p > 0.999


def test_a_trend_is_found():
    """Noise that grows from one to three times its rms is not stationary, either."""
    values = np.random.default_rng(0).standard_normal(6000) * np.linspace(1, 3, 6000)
    assert dispersion(values, 1 / RATE).p < 1e-6


def test_white_noise_in_closed_form():
    """The expected variance of mean squares of white noise is 2 sigma^4 / samples, its bandwidth half the rate."""
    values = np.random.default_rng(1).standard_normal(200_000)
    found = dispersion(values, 1 / RATE)
    mean_square = np.mean(values.reshape(-1, 200) ** 2, axis=1)
    assert found.segments == 1000
    assert found.ratio == pytest.approx(np.var(mean_square, ddof=1) / (2 * np.var(values) ** 2 / 200), rel=0.1)


def test_bandwidth_of_an_oscillator():
    """The statistical bandwidth of a resonance is 2 pi zeta f; a segment lasts three over it."""
    values = oscillator(100_000, 8.0, 0.015, np.random.default_rng(2))
    found = dispersion(values, 1 / RATE)
    assert found.bandwidth_hz == pytest.approx(2 * np.pi * 0.015 * 8, rel=0.15)
    assert found.segment_s == pytest.approx(3 / found.bandwidth_hz, abs=0.02)


def test_expected_variance_of_long_segments():
    """For segments far longer than the correlation it is (1 / T) times the integral of the squared density."""
    values = bandpass(200_000, np.random.default_rng(3))
    found = dispersion(values, 1 / RATE)
    f, density = signal.welch(values, RATE, nperseg=1000)
    segments = values[: found.segments * 200].reshape(-1, 200)
    plain = np.var(np.mean(segments**2, axis=1), ddof=1) / (np.sum(density**2) * f[1] / 2.0)
    assert found.ratio == pytest.approx(plain, rel=0.12)
    assert found.p == pytest.approx(stats.chi2.sf((found.segments - 1) * plain, found.segments - 1), abs=0.3)


@settings(max_examples=25, deadline=None)
@given(st.floats(1e-9, 1e9), st.floats(-1e3, 1e3), st.floats(-1e-2, 1e-2))
def test_scale_constant_and_drift_do_not_matter(scale, constant, drift):
    """Units and offsets of a sensor change nothing."""
    values = bandpass(3000, np.random.default_rng(4))
    before = dispersion(values, 1 / RATE)
    after = dispersion(scale * (values + constant + drift * np.arange(3000)), 1 / RATE)
    assert after.ratio == pytest.approx(before.ratio, rel=1e-6)
    assert after.p == pytest.approx(before.p, rel=1e-5)


def test_what_cannot_be_tested():
    """Short records, narrow slow ones and silence have no test; none of them warns."""
    rng = np.random.default_rng(5)
    assert dispersion(rng.standard_normal(1599), 1 / RATE) is None
    assert dispersion(rng.standard_normal(1600), 1 / RATE).segments == 8
    assert dispersion(oscillator(6000, 0.2, 0.02, rng), 1 / RATE) is None
    for value in (0.0, 9.81):
        assert dispersion(np.full(6000, value), 1 / RATE) is None
        assert peakedness(np.full(6000, value)) is None


def test_kurtosis_and_crest_of_a_sine():
    """1.5 and the root of 2."""
    found = peakedness(5 + np.sin(2 * np.pi * 0.01 * np.arange(10_000)))
    assert found.kurtosis == pytest.approx(1.5)
    assert found.crest == pytest.approx(np.sqrt(2))


def test_kurtosis_is_that_of_scipy():
    """Pearson's, without a correction for few samples."""
    values = np.random.default_rng(6).laplace(size=5000)
    assert peakedness(values).kurtosis == pytest.approx(stats.kurtosis(values, fisher=False))


@pytest.mark.parametrize("kind", ["white", "band", "hunting 5 %"])
def test_expected_crest(kind):
    """Of Gaussian records the largest value comes close to the one expected."""
    found = [peakedness(STATIONARY[kind](6000, np.random.default_rng(s))) for s in range(60)]
    assert np.mean([f.crest / f.expected_crest for f in found]) == pytest.approx(1.0, abs=0.07)
    assert np.mean([f.crest > 1.3 * f.expected_crest for f in found]) < 0.05
