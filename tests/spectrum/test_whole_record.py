"""Slow content and tones of a whole record."""

import numpy as np
import pytest

from fatigue.life.records.history import ModalHistory
from fatigue.spectrum import whole_record
from fatigue.spectrum.moments import quadratic_forms
from fatigue.spectrum.taper import hann
from fatigue.spectrum.whole_record import record_matrices
from tests.synthetic_records import RATE, curves, seconds, sine, stationary


def split(q, upper_hz=80.0):
    """Split the covariance of a record."""
    q = np.atleast_2d(q)
    return record_matrices(ModalHistory("event", np.arange(len(q)), q, 1 / RATE, 0.0), upper_hz)


def test_covariance_is_that_of_the_samples():
    """Mean removed, over the number of samples; gravity in single precision included."""
    q = (np.random.default_rng(0).normal(size=(3, 5000)) + 500).astype(np.float32)
    np.testing.assert_allclose(split(q).covariance, np.cov(q.astype(np.float64), bias=True), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(("duration", "slow_hz"), [(10, 1.0), (29, 10 / 29), (205, 0.3)])
def test_fewer_than_ten_cycles_are_slow(duration, slow_hz):
    """Slow is below ten cycles per record, and below 0.3 Hz in any record."""
    assert split(np.zeros(int(duration * RATE))).slow_hz == pytest.approx(slow_hz)


def test_slow_part_of_two_sines():
    """A slow and a fast sine are told apart, and their covariance with each other vanishes."""
    t = seconds(100 * 512)
    q = np.stack([3 * np.sin(2 * np.pi * 0.1 * t) + np.sin(2 * np.pi * 5 * t), np.sin(2 * np.pi * 0.1 * t)])
    found = split(q)
    np.testing.assert_allclose(found.slow, [[4.5, 1.5], [1.5, 0.5]], rtol=1e-6)
    np.testing.assert_allclose(found.covariance, [[5.0, 1.5], [1.5, 0.5]], rtol=1e-6)


def test_slow_share_of_quasi_static_curves():
    """Four curves of 120 MPa hold most of the variance, and all of it below 0.3 Hz."""
    found = split(curves(np.random.default_rng(1), 205 * 512))
    assert 0.8 < found.slow[0, 0] / found.covariance[0, 0] < 0.95


@pytest.mark.parametrize("frequency", [9.30, 9.3171, 40.0])
@pytest.mark.parametrize("duration", [29, 205])
def test_variance_of_a_tone(frequency, duration):
    """A tone of amplitude 1 in white noise: its half is found, wherever it lies between the bins."""
    samples = duration * 512
    noise = 0.2 * np.random.default_rng(2).normal(size=samples)
    found = split(np.sin(2 * np.pi * frequency * seconds(samples)) + noise)
    assert found.lines[0, 0] == pytest.approx(0.5, rel=0.03)


@pytest.mark.parametrize("samples", [20 * 512, 20 * 512 + 1])
@pytest.mark.parametrize("at_once", [1, 2_000_000])
def test_parts_are_those_of_the_tapered_record(samples, at_once, monkeypatch):
    """Slow part and tones against transforms of each record by itself, one under a taper, up to the last bin."""
    rng, t = np.random.default_rng(6), seconds(samples)
    tones = [np.sin(2 * np.pi * 9.3 * t), np.sin(np.pi * RATE * t + 1.0), np.zeros(samples)]
    q = np.stack(tones) + 0.05 * rng.normal(size=(3, samples)) + 7.0
    monkeypatch.setattr(whole_record, "NUMBERS_AT_ONCE", at_once)
    monkeypatch.setattr(whole_record, "CACHED_NUMBERS", at_once)
    found = split(q, RATE)
    centred, taper = q - q.mean(axis=1, keepdims=True), hann(samples)
    frequency = np.fft.rfftfreq(samples, 1 / RATE)
    plain = np.fft.rfft(centred)[:, (frequency > 0) & (frequency < found.slow_hz)]
    np.testing.assert_allclose(found.slow, 2 / samples**2 * (plain @ plain.conj().T).real, atol=1e-13)

    tapered = np.fft.rfft(centred * taper) * np.sqrt(2 / (samples * np.sum(taper**2)))
    near = np.abs(frequency - 9.3) < 0.2
    near |= frequency > RATE / 2 - 0.2
    part = (tapered[:, near] @ tapered[:, near].conj().T).real
    np.testing.assert_allclose(found.lines, part, atol=1e-3)
    assert found.lines[1, 1] > 0.3


def test_one_tone_through_many_modes():
    """Shapes see the tone as their modes carry it: in one it cancels."""
    samples = 100 * 512
    tone = np.sin(2 * np.pi * 9.3 * seconds(samples))
    noise = np.random.default_rng(3).normal(size=(2, samples))
    found = split(np.stack([tone, tone]) + 0.5 * noise)
    together, apart = quadratic_forms(np.array([[1.0, 1.0], [1.0, -1.0]]), found.lines[None])[0]
    assert together == pytest.approx(2.0, rel=0.05)
    assert apart < 0.02


def test_noise_and_modes_have_no_tones():
    """Ten records of three random modes: no more than a chance bin of the variance is called a tone."""
    q = np.stack([stationary(np.random.default_rng(seed), 100 * 512) for seed in range(10)])
    found = split(q)
    assert np.max(np.diag(found.lines) / np.diag(found.covariance)) < 0.15


def test_share_of_the_tone_in_modal_noise():
    """A tone with 90 % of the variance is found with 90 +- 10 %."""
    found = split(sine(0.9)(np.random.default_rng(4), 205 * 512))
    assert found.lines[0, 0] / found.covariance[0, 0] == pytest.approx(0.9, abs=0.1)


def test_a_band_too_narrow_to_look_for_tones():
    """Fewer bins than a block has: no tones, no failure."""
    found = split(np.random.default_rng(5).normal(size=10 * 512), upper_hz=2.0)
    assert np.all(found.lines == 0)
