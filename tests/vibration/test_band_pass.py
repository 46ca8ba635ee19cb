"""A record in a band: what passes, what does not, and no swing at the ends."""

import numpy as np
import pytest
from scipy import signal

from fatigue.vibration.band_pass import band_passed, taper_s


@pytest.mark.parametrize("band", [(4.0, 12.0), (0.5, 10.0)])
@pytest.mark.parametrize("phase", range(6))
def test_no_swing_at_the_ends(band, phase):
    """A sine that breaks off anywhere keeps its amplitude up to the ends, within 3 %."""
    t = np.arange(6000) / 200
    for f in (5.0, 7.8, 8.37):
        inside = band_passed(np.sin(2 * np.pi * f * t + phase), 0.005, band)
        assert np.max(np.abs(inside)) < 1.03 * np.max(np.abs(inside[1000:-1000]))


@pytest.mark.parametrize(("f", "gain"), [(2.0, 0.0), (4.0, 0.5), (7.0, 1.0), (12.0, 0.5), (24.0, 0.0)])
def test_gain(f, gain):
    """The edges pass half the amplitude, an octave beyond nothing to speak of; there is no delay."""
    t = np.arange(20_000) / 200
    sine = np.sin(2 * np.pi * f * t)
    inside = band_passed(sine, 0.005, (4.0, 12.0))[2000:-2000]
    assert inside == pytest.approx(gain * sine[2000:-2000], abs=0.01)


def test_gain_is_that_of_the_filter_twice():
    """The response to an impulse is the squared magnitude of the Butterworth filter."""
    impulse = np.zeros(8000)
    impulse[4000] = 1.0
    f = np.fft.rfftfreq(8000, 0.005)
    sos = signal.butter(4, (4.0, 12.0), "bandpass", fs=200, output="sos")
    wanted = np.abs(signal.sosfreqz(sos, 2 * np.pi * f / 200)[1]) ** 2
    assert np.abs(np.fft.rfft(band_passed(impulse, 0.005, (4.0, 12.0)))) == pytest.approx(wanted, abs=1e-3)


def test_a_constant_passes_nothing():
    """A sensor that is off says nothing."""
    assert band_passed(np.full(4000, 9.81), 0.005, (0.5, 10.0)) == pytest.approx(0.0, abs=1e-12)


def test_slow_sway_hardly_passes():
    """A sway of 20 s leaves a seventh of itself at the ends of the band of an alarm, and nothing elsewhere."""
    t = np.arange(6000) / 200
    inside = np.abs(band_passed(3 * np.cos(2 * np.pi * 0.05 * t), 0.005, (0.5, 10.0)))
    assert np.max(inside) < 0.45
    assert np.max(inside[1000:-1000]) < 0.01


def test_fading():
    """Half a second, or half a period of the lower edge where that is longer."""
    assert taper_s((4.0, 12.0)) == 0.5
    assert taper_s((0.5, 10.0)) == 1.0
