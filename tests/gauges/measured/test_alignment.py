"""Lag, correlation and sign of a record that replays the simulation."""

import numpy as np
import pytest

from fatigue.gauges.measured.alignment import aligned
from fatigue.gauges.measured.band import band_limited

RATE = 200.0


@pytest.fixture(scope="module")
def signal():
    """20 s of noise up to 30 Hz."""
    return band_limited(np.random.default_rng(5).standard_normal(4000), RATE, 0.5, 30.0)


def delayed(x, seconds):
    """The same signal later by any time, around the record."""
    f = np.fft.rfftfreq(len(x), 1 / RATE)
    return np.fft.irfft(np.fft.rfft(x) * np.exp(-2j * np.pi * f * seconds), len(x))


@pytest.mark.parametrize("lag", [-0.1, -0.0371, 0.0, 0.0123, 0.15])
def test_the_lag_is_found_to_parts_of_a_sample(signal, lag):
    """Positive where the measured record is late; within a tenth of a sample."""
    found = aligned(1.3 * delayed(signal, lag), signal, RATE, 0.2)
    assert found.lag_s == pytest.approx(lag, abs=0.1 / RATE)
    assert found.shift == round(lag * RATE)
    assert found.correlation > 0.95
    assert not found.at_end


def test_the_sign_is_found(signal):
    """A flipped channel has the correlation of the sound one, below 0, at the same lag."""
    sound, flipped = (aligned(sign * delayed(signal, 0.04), signal, RATE, 0.2) for sign in (1, -1))
    assert flipped.correlation == pytest.approx(-sound.correlation)
    assert flipped.lag_s == pytest.approx(sound.lag_s)
    assert not sound.sign_is_open


def test_a_tone_leaves_its_sign_open_beyond_half_a_period():
    """Half a period later the other sign fits as well: within less than that it does not."""
    tone = np.sin(2 * np.pi * 5.0 * np.arange(4000) / RATE)
    assert aligned(-tone, tone, RATE, 0.15).sign_is_open
    assert not aligned(-tone, tone, RATE, 0.04).sign_is_open
    assert aligned(-tone, tone, RATE, 0.04).correlation == pytest.approx(-1.0, abs=1e-12)


def test_a_lag_beyond_the_search_is_told(signal):
    """The best within the search is at its end, or it is no correlation at all."""
    slow = band_limited(signal, RATE, 0.5, 3.0)
    found = aligned(delayed(slow, 0.05), slow, RATE, 0.03)
    assert found.at_end
    assert found.lag_s == pytest.approx(0.03)


def test_samples_that_are_cut_do_not_count(signal):
    """A gap, whatever stands in it, takes nothing from the correlation."""
    kept = np.ones(4000, dtype=bool)
    kept[1000:2200] = False
    measured = np.where(kept, delayed(signal, 0.01), 0.3)
    found = aligned(measured, signal, RATE, 0.2, kept)
    assert found.correlation > 0.98
    assert found.lag_s == pytest.approx(0.01, abs=1e-3)


def test_a_record_without_content_has_no_correlation(signal):
    """NaN, and no lag."""
    found = aligned(np.zeros(4000), signal, RATE, 0.2)
    assert np.isnan(found.correlation)
    assert found.lag_s == 0.0
