"""Hunting and a mode of equipment: closed form, flags, coherence and phase against records whose answer is known."""

import numpy as np
import pytest
from scipy import signal

from fatigue.vibration.coincidence import (
    amplification,
    coherence,
    common_grid,
    flag,
    oscillator_phase,
)

RATE = 200.0
STEP = 1 / RATE


def hunting_noise(seconds, seed, rate=RATE):
    """Narrow-band noise round 8 Hz."""
    band = signal.butter(2, [7, 9], "bandpass", fs=rate, output="sos")
    return signal.sosfilt(band, np.random.default_rng(seed).standard_normal(round((seconds + 5) * rate)))[
        round(5 * rate) :
    ]


@pytest.mark.parametrize(("f_e", "x"), [(9.2, 10.05), (12.0, 2.39), (14.0, 1.75), (15.0, 1.60)])
def test_amplification_of_the_source(f_e, x):
    """9.2 Hz against modes of 5 % damping: 10, 2.4, 1.75 and 1.6."""
    assert amplification(9.2, f_e, 0.05) == pytest.approx(x, abs=0.005)


def test_amplification_in_the_limits():
    """Equipment follows slow vibration, rests in fast one, and has sqrt(1 + 4 z^2) / 2 z at resonance."""
    assert amplification(0.01, 9.2, 0.05) == pytest.approx(1.0, abs=1e-4)
    assert amplification(1000.0, 9.2, 0.01) < 0.001
    assert amplification(9.2, 9.2, 0.05) == pytest.approx(np.sqrt(1 + 0.1**2) / 0.1)
    assert amplification(9.2 * np.sqrt(2), 9.2, 0.3) == pytest.approx(1.0)


@pytest.mark.parametrize("ratio", [0.5, 0.9, 1.0, 1.3])
@pytest.mark.parametrize("damping", [0.02, 0.05, 0.2])
def test_amplification_and_phase_of_a_simulated_oscillator(ratio, damping):
    """The equation of motion, driven by a sine at its base, swings by as much and as far behind."""
    f_e, f = 9.2, 9.2 * ratio
    w = 2 * np.pi * f_e
    system = signal.lti([2 * damping * w, w**2], [1, 2 * damping * w, w**2])
    t = np.arange(0, 40, 1 / 1000)
    _, out, _ = signal.lsim(system, np.sin(2 * np.pi * f * t), t)
    late = t >= 20
    response = 2 * np.mean(out[late] * np.exp(-2j * np.pi * f * t[late])) * 1j
    assert abs(response) == pytest.approx(amplification(f, f_e, damping), rel=0.01)
    assert -np.degrees(np.angle(response)) == pytest.approx(oscillator_phase(f, f_e, damping), abs=1.0)


@pytest.mark.parametrize(
    ("f_hunt", "f_e", "damping", "colour"),
    [
        (9.2, 9.2, 0.05, "red"),
        (8.21, 9.2, 0.05, "red"),
        (10.19, 9.2, 0.05, "red"),
        (8.19, 9.2, 0.05, "amber"),
        (7.8, 9.2, 0.10, "red"),  # 2 z f_e = 1.84 Hz is more than 1 Hz
        (9.2, 14.0, 0.05, "amber"),
        (9.2, 16.5, 0.05, "green"),
        (14.0, 9.2, 0.05, "green"),
    ],
)
def test_flags(f_hunt, f_e, damping, colour):
    """Red is close, amber amplifies by more than 1.5, on either side."""
    assert flag(f_hunt, f_e, damping) == colour


@pytest.mark.parametrize("samples", [-12, -6, -3, 0, 3, 6, 12])
def test_phase_of_a_known_lag(samples):
    """A record that comes later is behind by 360 degrees times frequency times lag, one that comes earlier is ahead."""
    values = hunting_noise(62.0, 0)
    first, second = values[100:-100], values[100 - samples : values.size - 100 - samples]
    found = coherence(first, second, STEP, 8.0, [(0.0, 60.0)])
    assert found.phase_deg == pytest.approx(360 * 8.0 * samples * STEP, abs=1.5)
    assert found.value > 0.95


def test_phase_turned_over():
    """A sensor mounted the other way round reads 180 degrees."""
    values = hunting_noise(60.0, 0)
    assert coherence(values, -values, STEP, 8.0, [(0.0, 60.0)]).phase_deg == pytest.approx(180.0)


def test_an_oscillator_at_resonance_is_ninety_degrees_behind():
    """A converter of 8 Hz and 5 % on a frame that hunts at 8 Hz: coherent, and 84 degrees behind."""
    values = hunting_noise(120.0, 1)
    w = 2 * np.pi * 8.0
    t = np.arange(values.size) * STEP
    _, out, _ = signal.lsim(signal.lti([0.1 * w, w**2], [1, 0.1 * w, w**2]), values, t)
    found = coherence(values, out, STEP, 8.0, [(0.0, 120.0)])
    assert found.value > 0.7  # a resonance of 0.8 Hz in spectra that resolve 0.5 Hz: it is 1 in truth
    assert found.phase_deg == pytest.approx(oscillator_phase(8.0, 8.0, 0.05), abs=6)


def test_coherence_is_that_of_scipy():
    """One span, the frequency on a line of the spectrum: Welch's coherence, averaged over the lines of the band."""
    x = hunting_noise(40.0, 2)
    y = x + 0.3 * np.random.default_rng(3).standard_normal(x.size)
    f, wanted = signal.coherence(x, y, RATE, signal.windows.hann(400, sym=False), 400, 200, nfft=1600, detrend="linear")
    found = coherence(x, y, STEP, 8.0, [(0.0, 40.0)])
    assert found.value == pytest.approx(np.mean(wanted[np.abs(f - 8) <= 0.5 + 1e-9]), rel=1e-9)
    _, density = signal.csd(x, y, RATE, signal.windows.hann(400, sym=False), 400, 200, nfft=1600, detrend="linear")
    assert found.phase_deg == pytest.approx(-np.degrees(np.angle(density[64])), abs=1e-6)


@pytest.mark.parametrize("noise", [0.5, 1.0, 2.0])
def test_coherence_of_noise_added_is_known(noise):
    """With white noise of n times the density added to one of two records, the coherence is 1 / (1 + n^2)."""
    rng = np.random.default_rng(4)
    x = rng.standard_normal(200_000)
    found = coherence(x, x + noise * rng.standard_normal(x.size), STEP, 8.0, [(0.0, 1000.0)])
    assert found.value == pytest.approx(1 / (1 + noise**2), abs=0.03)


@pytest.mark.parametrize("seconds", [6.0, 9.0, 14.0])
def test_unrelated_records_stay_below_chance(seconds):
    """At one frequency some 5 % of unrelated records exceed the value told; their mean is one over the averages."""
    values, above = [], 0
    for seed in range(200):
        rng = np.random.default_rng(seed)
        x, y = rng.standard_normal((2, round(seconds * RATE)))
        found = coherence(x, y, STEP, 8.0, [(0.0, seconds)])
        values.append(found.value)
        above += found.value > found.significant
    assert np.mean(values) == pytest.approx(1 / found.averages, rel=0.2)
    assert above / 200 < 0.08


def test_only_the_spans_count():
    """Records that are one inside a stretch and unrelated outside: coherent there, and hardly so over the event."""
    rng = np.random.default_rng(5)
    x, y = rng.standard_normal((2, 24_000))
    y[4000:8000] = x[4000:8000]
    y[14_000:18_000] = x[14_000:18_000]
    inside = coherence(x, y, STEP, 8.0, [(20.0, 40.0), (70.0, 90.0)])
    assert inside.value == pytest.approx(1.0)
    assert inside.averages == pytest.approx(38 * 38 / (38 + 36 * 2 / 36))
    assert coherence(x, y, STEP, 8.0, [(0.0, 120.0)]).value < 0.4


def test_no_segment_bridges_two_stretches():
    """Six stretches of 1.9 s hold no segment of 2 s, and four of 2 s hold four."""
    x = hunting_noise(60.0, 6)
    assert coherence(x, x, STEP, 8.0, [(8.0 * k, 8.0 * k + 1.9) for k in range(6)]) is None
    assert coherence(x, x, STEP, 8.0, [(8.0 * k, 8.0 * k + 2.0) for k in range(3)]) is None
    assert coherence(x, x, STEP, 8.0, [(8.0 * k, 8.0 * k + 2.0) for k in range(4)]).averages == 4.0


@pytest.mark.parametrize("silent", [0.0, 9.81])
def test_silent_channel(silent):
    """A channel that does not move has no coherence and no phase, and warns of nothing."""
    x = hunting_noise(20.0, 7)
    for pair in ((x, np.full(x.size, silent)), (np.full(x.size, silent), x)):
        found = coherence(*pair, STEP, 8.0, [(0.0, 20.0)])
        assert np.isnan(found.value)
        assert np.isnan(found.phase_deg)


@pytest.mark.parametrize("rates", [(1000, 125), (125, 1000), (200, 200), (250, 200), (512, 300)])
def test_records_of_two_rates(rates):
    """Channels that are sampled differently, and start at different times, are compared sample for sample."""

    def lateral(t):
        return sum(np.sin(2 * np.pi * f * t + 7 * f**2) for f in np.arange(7.0, 9.0, 0.13))

    lag = 1 / 32  # a quarter of a period of 8 Hz
    t, u = 3.0 + np.arange(30 * rates[0]) / rates[0], 5.0013 + np.arange(30 * rates[1]) / rates[1]
    first, second, step, start = common_grid(
        (lateral(t), 1 / rates[0], 3.0), (lateral(u - lag), 1 / rates[1], 5.0013), 8.5
    )
    inner, times = slice(100, -100), start + np.arange(first.size) * step
    assert start == pytest.approx(5.0013)
    assert times[-1] <= 33.0
    assert first[inner] == pytest.approx(lateral(times)[inner], abs=0.02 * np.max(np.abs(first)))
    assert second[inner] == pytest.approx(lateral(times - lag)[inner], abs=0.02 * np.max(np.abs(first)))
    assert coherence(first, second, step, 8.0, [(0.0, 27.0)]).phase_deg == pytest.approx(90.0, abs=1.0)


def test_records_on_one_grid_are_left_alone():
    """Two columns of one file are compared as they are."""
    x, y = np.random.default_rng(8).standard_normal((2, 1000))
    first, second, step, start = common_grid((x, STEP, 1.0), (y, STEP, 1.0), 8.5)
    assert np.array_equal(first, x)
    assert np.array_equal(second, y)
    assert (step, start) == (STEP, 1.0)


def test_records_that_do_not_meet():
    """Records of different times have nothing in common."""
    first, second, _, _ = common_grid((np.ones(1000), STEP, 0.0), (np.ones(1000), STEP, 100.0), 8.5)
    assert first.size == second.size == 0
    assert coherence(first, second, STEP, 8.0, [(0.0, 10.0)]) is None
