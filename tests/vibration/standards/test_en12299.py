"""EN 12299: responses beside a digital filter and remembered tables, rms of blocks, percentiles of sections."""

import numpy as np
import pytest
from scipy import signal

from fatigue.vibration.standards.en12299 import BAND_HZ, Q1, block_rms, mean_comfort, response, section_percentiles


def analogue(weighting):
    """Numerator and denominator of a weighting as products of polynomials in s, written down once more."""
    w1, w2 = 2 * np.pi * 0.4, 2 * np.pi * 100.0
    w4 = 2 * np.pi * {"Wb": 16.0, "Wd": 2.0}[weighting]
    above = [[1, 0, 0], [w2**2], [w4, w4**2]]
    below = [[1, w1 / 0.707, w1**2], [1, w2 / 0.707, w2**2], [1, w4 / 0.63, w4**2]]
    if weighting == "Wb":
        w5, w6 = 2 * np.pi * 2.5, 2 * np.pi * 4.0
        above += [[0.4], [1 / w5**2, 1 / (0.8 * w5), 1]]
        below += [[1 / w6**2, 1 / (0.8 * w6), 1]]
    b, a = np.array([1.0]), np.array([1.0])
    for factor in above:
        b = np.polymul(b, factor)
    for factor in below:
        a = np.polymul(a, factor)
    return b, a


def digital_filter(weighting, rate):
    """Second-order sections of the bilinear transform at a sampling rate [Hz], without warping it first."""
    return signal.zpk2sos(*signal.bilinear_zpk(*signal.tf2zpk(*analogue(weighting)), rate))


@pytest.mark.parametrize("weighting", ["Wb", "Wd"])
def test_the_response_is_that_of_its_poles_and_zeros(weighting):
    """Response beside one from polynomials, and beside a digital filter at 4 kHz in the band of comfort."""
    f = np.geomspace(0.1, 100.0, 60)
    b, a = analogue(weighting)
    _, h = signal.freqs(b, a, 2 * np.pi * f)
    assert response(f, weighting) == pytest.approx(h, rel=1e-9)
    _, digital = signal.sosfreqz(digital_filter(weighting, 4000.0), f[f < 40], fs=4000.0)
    assert np.abs(response(f[f < 40], weighting)) == pytest.approx(np.abs(digital), rel=2e-3)
    assert (BAND_HZ, Q1) == ((0.4, 100.0), 0.707)


def test_responses_are_near_those_of_tables():
    """ISO 2631-1, Wd at 1, 2, 4, 8 Hz as remembered: 1.011, 0.890, 0.512, 0.253; Wb near 1 about 10 Hz, 0.4 at 1 Hz."""
    wd = np.abs(response(np.array([1.0, 2.0, 4.0, 8.0]), "Wd"))
    assert wd == pytest.approx([1.011, 0.890, 0.512, 0.253], rel=5e-3)
    assert np.abs(response(np.array([1.0, 8.0, 12.5]), "Wb")) == pytest.approx([0.39, 1.0, 1.0], rel=0.06)


@pytest.mark.parametrize(("weighting", "frequency"), [("Wb", 1.3), ("Wb", 9.2), ("Wd", 1.3), ("Wd", 9.2)])
def test_a_sine_reads_its_response(weighting, frequency):
    """Rms of each block is amplitude / sqrt(2) times the response, whatever the sampling rate and the mean."""
    for rate in (100.0, 250.0, 1000.0):
        t = np.arange(round(30 * rate)) / rate
        rms = block_rms(9.81 + 0.4 * np.sin(2 * np.pi * frequency * t), 1 / rate, weighting)
        expected = 0.4 / np.sqrt(2) * abs(response(np.array([frequency]), weighting)[0])
        assert rms[1:-1] == pytest.approx(np.full(4, expected), rel=1e-3)
        assert rms == pytest.approx(np.full(6, expected), rel=0.04)  # the ends, where the sine breaks off


def test_noise_reads_the_same_by_a_filter_in_time():
    """Blocks of noise beside a digital filter of the whole response at 1 kHz, once its start has died away."""
    values = np.random.default_rng(2).standard_normal(60_000)
    weighed = signal.sosfilt(digital_filter("Wb", 1000.0), values)
    in_time = np.sqrt((weighed.reshape(-1, 5000) ** 2).mean(axis=1))
    assert block_rms(values, 1e-3, "Wb")[1:] == pytest.approx(in_time[1:], rel=0.02)


def test_percentiles_are_of_sections_of_five_minutes():
    """Sixty blocks a section; a short record is one section; sections overlap where the record is no multiple."""
    assert section_percentiles(np.arange(1.0, 61.0)) == pytest.approx([np.percentile(np.arange(1.0, 61.0), 95)])
    assert section_percentiles(np.array([2.0, 2.0])) == pytest.approx([2.0])
    assert section_percentiles(np.arange(90.0)) == pytest.approx([56.05, 86.05])
    assert section_percentiles(np.array([])).size == 0
    assert mean_comfort(np.zeros(2), np.zeros(2), np.array([0.1, 0.2])) == pytest.approx([0.6, 1.2])


def test_records_that_say_little():
    """Shorter than a block: nothing; zeros: zero; a constant: nothing but rounding."""
    assert block_rms(np.ones(499), 0.01, "Wb").size == 0
    assert block_rms(np.zeros(1000), 0.01, "Wd").tolist() == [0.0, 0.0]
    assert block_rms(np.full(1000, 9.81), 0.01, "Wd") == pytest.approx([0.0, 0.0], abs=1e-12)
