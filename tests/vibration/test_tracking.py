"""Dominant frequency over time and hot stretches: chirps, bursts, noise, and what must not matter."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import signal

from fatigue.vibration.tracking import (
    ABOVE_NYQUIST,
    FEWEST_HOT,
    SHORT,
    Track,
    cannot_be_tracked,
    hot_slices,
    stretches,
    track,
)

BAND = (4.0, 12.0)
RATES = (200.0, 213.7, 250.0, 500.0, 1000.0, 4096.0)


def noise(rate, seconds, seed):
    """Noise below 40 Hz, of the same rms in the band whatever the rate."""
    samples = round(seconds * rate)
    white = np.random.default_rng(seed).standard_normal(samples) * np.sqrt(rate / 200)
    return signal.sosfilt(signal.butter(2, 40, fs=rate, output="sos"), white)


def hunting(ratio, rate=200.0, seconds=60.0, between=(20.3, 31.7), seed=0):
    """Draw noise of median rms 1 in the band, and a burst of 7.8 Hz of ``ratio`` times that."""
    background = noise(rate, seconds, seed)
    background /= track(background, 1 / rate, BAND).median_rms
    t = np.arange(background.size) / rate
    inside = (t >= between[0]) & (t < between[1])
    return background + ratio * np.sqrt(2) * np.sin(2 * np.pi * 7.8 * t) * inside


def found(values, rate=200.0, factor=3.0, share=0.5):
    """Look for stretches with the rules by default."""
    of = track(values, 1 / rate, BAND)
    return stretches(values, 1 / rate, BAND, of, hot_slices(of, factor, share, of.median_rms))


@pytest.mark.parametrize("rate", RATES)
def test_chirp_is_tracked(rate):
    """A frequency that goes from 5 to 11 Hz in a minute is found within 0.002 Hz, at any sampling rate."""
    t = np.arange(round(60 * rate)) / rate
    of = track(signal.chirp(t, 5, 60, 11), 1 / rate, BAND)
    assert np.max(np.abs(of.frequency - (5 + of.time / 10))) < 0.002
    assert np.all(of.share > 0.9)


def test_densities_are_those_of_scipy():
    """Ridge, power and share are those of the slices of ``scipy.signal.ShortTimeFFT``."""
    rate, values = 200.0, noise(200.0, 30.0, 3)
    of = track(values, 1 / rate, BAND)
    window = signal.windows.hann(400, sym=False)
    spectra = signal.ShortTimeFFT(window, 50, rate, fft_mode="onesided2X", mfft=1600, scale_to="psd")
    first, end = spectra.lower_border_end[1], spectra.upper_border_begin(values.size)[1]
    density = spectra.spectrogram(values, detr="linear", p0=first, p1=end)
    inside = (spectra.f >= 4) & (spectra.f <= 12)
    assert of.time == pytest.approx(spectra.t(values.size, first, end))
    assert of.frequency == pytest.approx(spectra.f[inside][density[inside].argmax(axis=0)], abs=spectra.delta_f / 2)
    half_bins = (density[inside][0] + density[inside][-1]) / 2
    assert of.rms**2 == pytest.approx((density[inside].sum(axis=0) - half_bins) * spectra.delta_f)
    constant = spectra.spectrogram(values, detr="constant", p0=first, p1=end)
    assert of.rms**2 == pytest.approx(constant[inside].sum(axis=0) * spectra.delta_f, rel=0.1)


def test_rms_of_a_sine():
    """The rms of a slice is that of the sine in it, its frequency that of the sine, and the peak its amplitude."""
    t = np.arange(6000) / 200
    values = 2.5 * np.sin(2 * np.pi * 8.37 * t)
    of = track(values, 0.005, BAND)
    assert of.rms == pytest.approx(2.5 / np.sqrt(2), rel=1e-3)
    assert of.frequency == pytest.approx(8.37, abs=0.002)
    (whole,) = found(values)
    assert (whole.start_s, whole.end_s) == (0.0, 30.0)
    assert whole.peak == pytest.approx(2.5, rel=0.02)


@pytest.mark.parametrize("ratio", [4, 5, 10, 30, 100])
@pytest.mark.parametrize("seed", range(3))
def test_burst_is_found_where_it_is(ratio, seed):
    """A burst of hunting on noise is one hot stretch, its ends within half a second, whatever its strength."""
    parts = found(hunting(ratio, seed=seed))
    assert [p.hot for p in parts] == [False, True, False]
    assert abs(parts[1].start_s - 20.3) < 0.5
    assert abs(parts[1].end_s - 31.7) < 0.5
    assert parts[1].frequency == pytest.approx(7.8, abs=0.03)
    assert parts[1].rms == pytest.approx(np.hypot(ratio, 1), rel=0.1)
    assert (
        ratio * np.sqrt(2) < parts[1].peak < (1.07 * ratio + 4.5) * np.sqrt(2)
    )  # a sine switched on swings beyond itself


@pytest.mark.parametrize("rate", RATES)
def test_sampling_rate_does_not_matter(rate):
    """The same burst is found at the same time, with the same frequency, at any sampling rate."""
    parts = found(hunting(8, rate=rate, seed=1), rate)
    assert [p.hot for p in parts] == [False, True, False]
    assert parts[1].start_s == pytest.approx(20.3, abs=0.5)
    assert parts[1].end_s == pytest.approx(31.7, abs=0.5)
    assert parts[1].frequency == pytest.approx(7.8, abs=0.02)
    assert parts[1].rms == pytest.approx(8, rel=0.05)


def test_two_bursts_at_the_ends():
    """Bursts at the start and at the end of a record reach to its first and last sample."""
    both = hunting(10, between=(0.0, 8.0)) + hunting(10, between=(52.0, 60.0))
    parts = found(both)
    assert [p.hot for p in parts] == [True, False, True]
    assert parts[0].start_s == 0.0
    assert parts[-1].end_s == 60.0
    assert parts[0].end_s == pytest.approx(8.0, abs=0.5)
    assert parts[2].start_s == pytest.approx(52.0, abs=0.5)


@settings(max_examples=10, deadline=None)
@given(st.floats(min_value=1e-9, max_value=1e9), st.floats(min_value=-1e3, max_value=1e3), st.floats(-50.0, 50.0))
def test_scale_constant_and_drift_do_not_matter(scale, constant, drift):
    """A unit, a sensor that is off, and one that drifts change neither frequency nor stretches."""
    values = hunting(6, seconds=30.0, between=(10.0, 18.0))
    moved = scale * (values + constant + drift * np.arange(values.size) / 200)
    before, after = track(values, 0.005, BAND), track(moved, 0.005, BAND)
    assert after.frequency == pytest.approx(before.frequency, abs=1e-6)
    assert after.rms == pytest.approx(scale * before.rms, rel=1e-6)
    assert [(p.start_s, p.end_s, p.hot) for p in found(moved)] == [(p.start_s, p.end_s, p.hot) for p in found(values)]


def test_sign_does_not_matter():
    """A sensor mounted the other way round says the same."""
    values = hunting(6)
    assert found(-values) == found(values)


def test_later_is_later():
    """A record that starts 3 s later has its stretch 3 s earlier."""
    values = hunting(6)
    before, after = found(values), found(values[600:])
    assert after[1].start_s == pytest.approx(before[1].start_s - 3)
    assert after[1].end_s == pytest.approx(before[1].end_s - 3)
    assert after[1].frequency == pytest.approx(before[1].frequency, abs=1e-9)


def hot_share_of_noise(seeds):
    """Share of hot slices over minutes of stationary noise, broad and narrow."""
    narrow = signal.butter(2, [7, 9], "bandpass", fs=200, output="sos")
    hot = []
    for seed in seeds:
        values = noise(200.0, 60.0, seed)
        for record in (values, signal.sosfilt(narrow, values)):
            of = track(record, 0.005, BAND)
            hot.append(np.mean(hot_slices(of, 3.0, 0.5, of.median_rms)))
    return np.mean(hot)


def test_noise_is_not_hot():
    """Stationary noise has less than half a percent of hot slices."""
    assert hot_share_of_noise(range(8)) < 0.005


@pytest.mark.slow
def test_noise_is_not_hot_over_many_records():
    """Nor has it in three hundred minutes."""
    assert hot_share_of_noise(range(100, 250)) < 0.005


def test_strong_noise_without_a_ridge_is_not_hot():
    """A stretch of ten times the noise is loud, but not hunting: its power lies at no one frequency."""
    values = noise(200.0, 60.0, 2)
    values[4000:6400] *= 10
    assert not any(p.hot for p in found(values))
    assert any(p.hot for p in found(values, share=0.02))


def test_fewer_than_four_slices_are_not_hot():
    """Three slices in a row are not enough, four are."""
    time = np.arange(1, 21) / 4 + 0.75
    rms = np.ones(20)
    rms[3:6] = 9.0
    rms[10 : 10 + FEWEST_HOT] = 9.0
    of = Track(time, np.full(20, 8.0), np.full(20, 0.9), rms, 7.0)
    assert np.flatnonzero(hot_slices(of, 3.0, 0.5, of.median_rms)).tolist() == [10, 11, 12, 13]
    assert not hot_slices(of, 3.0, 0.95, of.median_rms).any()
    assert not hot_slices(of, 3.0, 0.5, 3.0).any()


def test_reference_tells_hunting_from_end_to_end():
    """A record that hunts throughout has no hot slice beside its own median, and only hot ones beside another."""
    values = hunting(8, between=(0.0, 60.0))
    of = track(values, 0.005, BAND)
    assert not hot_slices(of, 3.0, 0.5, of.median_rms).any()
    assert hot_slices(of, 3.0, 0.5, 1.0).all()


def test_stretches_tile_the_record():
    """Each stretch starts where the one before ends, the first at 0, the last at the end."""
    parts = found(hunting(5, seconds=47.3))
    assert parts[0].start_s == 0.0
    assert parts[-1].end_s == pytest.approx(47.3)
    assert all(a.end_s == b.start_s and a.hot != b.hot for a, b in pairwise(parts))


@pytest.mark.parametrize("value", [0.0, 9.81, -1e6, 1e-30])
def test_silence(value):
    """A channel that does not move has no frequency, no share and no stretch, and warns of nothing."""
    values = np.full(6000, value)
    of = track(values, 0.005, BAND)
    assert np.all(of.rms == 0)
    assert np.all(np.isnan(of.frequency))
    (whole,) = found(values)
    assert not whole.hot
    assert (whole.rms, whole.peak) == (0.0, 0.0)
    assert np.isnan(whole.frequency)


def test_partly_silent():
    """A channel that is silent for more than half of the record is hot where it moves: its median is 0."""
    t = np.arange(12000) / 200
    values = np.where((t > 30) & (t < 40), np.sin(2 * np.pi * 8 * t), 0.0)
    parts = found(values)
    assert [p.hot for p in parts] == [False, True, False]
    assert parts[0].rms < 0.1
    assert parts[1].frequency == pytest.approx(8, abs=0.05)


def test_ridge_at_the_edge_stays_in_the_band():
    """Power outside the band does not pull the ridge beyond its edge."""
    t = np.arange(6000) / 200
    of = track(np.sin(2 * np.pi * 13 * t), 0.005, BAND)
    assert np.all(of.frequency <= 12.0)
    assert np.all(of.share <= 1.0)


def test_what_cannot_be_tracked():
    """Records shorter than a hot stretch and a slice beside it, and a band above half the rate, are refused."""
    assert cannot_be_tracked(950, 0.005, BAND) is None
    assert cannot_be_tracked(949, 0.005, BAND) == SHORT
    assert cannot_be_tracked(24 * 10, 1 / 24, BAND) is None
    assert cannot_be_tracked(23 * 10, 1 / 23, BAND) == ABOVE_NYQUIST
    with pytest.raises(ValueError, match="short"):
        track(np.ones(100), 0.005, BAND)


@pytest.mark.parametrize("rate", [24.0, 24.1, 30.0])
def test_band_up_to_half_the_sampling_rate(rate):
    """A record that is just fast enough is tracked, and its peak found."""
    t = np.arange(round(30 * rate)) / rate
    (whole,) = found(np.sin(2 * np.pi * 7.8 * t), rate)
    assert whole.frequency == pytest.approx(7.8, abs=0.01)
    assert whole.peak == pytest.approx(1.0, abs=0.1)


def test_shortest_record():
    """4.75 s have twelve slices of 2 s."""
    assert track(noise(200.0, 4.75, 0), 0.005, BAND).time.size == 12
