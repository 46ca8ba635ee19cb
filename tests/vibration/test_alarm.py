"""The bogie alarm: cycles counted on a signal that needs no filter, and the filter apart."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.vibration.alarm import cannot_be_filtered, count_alarms, filtered

BAND = (0.5, 10.0)


def cycles_of(cycles, amplitude=8.1, rate=1000.0, f=8.0):
    """Draw a sine of so many cycles between calm stretches that swing at a tenth of it."""
    calm = 0.1 * amplitude * np.sin(2 * np.pi * f * np.arange(round(4 * rate / f)) / rate)
    strong = amplitude * np.sin(2 * np.pi * f * np.arange(round(cycles * rate / f)) / rate)
    turned = calm if round(2 * cycles) % 2 == 0 else -calm
    return np.concatenate([calm, strong, turned])


@pytest.mark.parametrize(("cycles", "alarms"), [(5, 0), (5.5, 0), (6, 1), (6.5, 1), (12, 1), (40, 1)])
def test_six_cycles_set_it_off(cycles, alarms):
    """Six cycles of 8.1 m/s2 are an alarm, five and a half are none, forty are one."""
    count = count_alarms(cycles_of(cycles), 0.001, 8.0, 6)
    assert count.times.size == alarms
    assert count.longest_run == cycles
    assert count.peak == pytest.approx(8.1, rel=1e-3)


def test_time_of_the_alarm():
    """It goes off in the twelfth half cycle, when that reaches the threshold."""
    count = count_alarms(cycles_of(9), 0.001, 8.0, 6)
    rises = np.arcsin(8 / 8.1) / (2 * np.pi)  # of a cycle
    assert count.times == pytest.approx([(4 + 5.5 + rises) / 8], abs=0.002)


@pytest.mark.parametrize("cycles", [1, 4, 6, 10])
def test_cycles_of_the_rule(cycles):
    """So many cycles as the rule asks for, and no half a cycle less."""
    assert count_alarms(cycles_of(cycles), 0.001, 8.0, cycles).times.size == 1
    assert count_alarms(cycles_of(cycles - 0.5), 0.001, 8.0, cycles).times.size == 0


def test_threshold_is_reached_not_passed():
    """A peak that equals the threshold counts."""
    square = np.tile(np.repeat([8.0, -8.0], 20), 6)
    assert count_alarms(square, 0.001, 8.0, 6).times.size == 1
    assert count_alarms(square, 0.001, np.nextafter(8.0, 9.0), 6).times.size == 0


def test_one_low_half_cycle_starts_the_count_anew():
    """Two runs with one half cycle below between them are two alarms, or none where each is too short."""
    peaks = np.array([8.1] * 13 + [7.9] + [8.1] * 12)
    signs = np.where(np.arange(peaks.size) % 2, -1, 1)
    values = (peaks * signs)[:, np.newaxis] * np.sin(np.pi * np.arange(50) / 50)
    assert count_alarms(values.ravel(), 0.001, 8.0, 6).times.size == 2
    assert count_alarms(values.ravel()[100:-50], 0.001, 8.0, 6).times.size == 0
    assert count_alarms(values.ravel()[100:-50], 0.001, 8.0, 6).longest_run == 5.5


def test_one_sided_half_cycles_do_not_count():
    """An offset that lifts the lower half cycles over the threshold's negative leaves runs of one half cycle."""
    count = count_alarms(cycles_of(20) + 1.0, 0.001, 8.0, 6)
    assert count.times.size == 0
    assert count.longest_run == 0.5


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 10_000), st.floats(1e-3, 1e3))
def test_sign_and_unit_do_not_matter(seed, scale):
    """A sensor turned round, or another unit of values and threshold, gives the same alarms."""
    values = np.random.default_rng(seed).standard_normal(400).cumsum()
    values -= values.mean()
    count = count_alarms(values, 0.01, 1.0, 1)
    turned = count_alarms(-values, 0.01, 1.0, 1)
    scaled = count_alarms(scale * values, 0.01, scale * (1.0 - 1e-12), 1)
    assert turned.longest_run == count.longest_run == scaled.longest_run
    assert turned.times.tolist() == count.times.tolist()
    assert scaled.peak == pytest.approx(scale * count.peak)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.1, 3.0), st.integers(1, 4))
def test_against_a_plain_loop(seed, threshold, cycles):
    """Alarms, longest run and peak are those of a loop over samples."""
    values = np.random.default_rng(seed).standard_normal(300)
    values = np.convolve(values, np.ones(4) / 2, "same")
    runs, run, peaks, peak = [], 0, [], 0.0
    for before, value in zip([values[0], *values[:-1]], values, strict=True):
        if (before > 0) != (value > 0):
            peaks.append(peak)
            peak = 0.0
        peak = max(peak, abs(value))
    for reached in [*peaks, peak]:
        if reached >= threshold:
            run += 1
        else:
            runs.append(run)
            run = 0
    runs.append(run)
    count = count_alarms(values, 0.01, threshold, cycles)
    assert count.times.size == sum(r >= 2 * cycles for r in runs)
    assert count.longest_run == max(runs) / 2
    assert count.peak == np.max(np.abs(values))


def test_silence():
    """A channel that does not move has no alarm and no peak."""
    count = count_alarms(np.zeros(1000), 0.01, 8.0, 6)
    assert (count.times.size, count.peak, count.longest_run) == (0, 0.0, 0.0)
    values, step = filtered(np.full(1000, 9.81), 0.01, BAND, "offline")
    assert count_alarms(values, step, 8.0, 6).peak < 1e-9
    values, step = filtered(np.full(1000, 9.81), 0.01, BAND, "on_board")
    assert count_alarms(values, step, 8.0, 6).peak < 1e-9
    assert count_alarms(np.empty(0), 0.01, 8.0, 6).times.size == 0


@pytest.mark.parametrize("how", ["offline", "on_board"])
def test_filter_keeps_hunting_and_drops_the_rest(how):
    """5 Hz pass as they are, an offset and 60 Hz do not."""
    t = np.arange(40_000) / 1000
    values, _ = filtered(3 * np.sin(2 * np.pi * 5 * t) + 9.81 + 4 * np.sin(2 * np.pi * 60 * t), 0.001, BAND, how)
    assert np.max(np.abs(values[10_000:-10_000])) == pytest.approx(3.0, rel=0.02)


def test_on_board_is_behind_and_offline_is_not():
    """The unit on board sees a burst later; forward and backward it stays where it is."""
    t = np.arange(20_000) / 1000
    burst = np.sin(2 * np.pi * 6 * t) * np.exp(-(((t - 10) / 0.5) ** 2))

    def middle(how):
        values, step = filtered(burst, 0.001, BAND, how)
        return np.sum(np.arange(values.size) * step * values**2) / np.sum(values**2)

    assert middle("offline") == pytest.approx(10.0, abs=1e-3)
    assert middle("on_board") > 10.03


@pytest.mark.parametrize("rate", [21.0, 50.0, 100.0, 200.0, 1000.0])
def test_peaks_between_samples_are_found(rate):
    """A sine is read within 2 % of its amplitude at any sampling rate that carries the band."""
    t = np.arange(round(60 * rate)) / rate
    values, step = filtered(8.1 * np.sin(2 * np.pi * 5.03 * t), 1 / rate, BAND, "offline")
    count = count_alarms(values, step, 7.9, 6)
    assert count.times.size == 1
    assert count.peak == pytest.approx(8.1, rel=0.03)
    assert step <= 1 / 199.9


def test_what_cannot_be_filtered():
    """A band above half the sampling rate, and records in which the filter cannot settle, are refused."""
    assert cannot_be_filtered(4000, 0.001, BAND) is None
    assert cannot_be_filtered(3999, 0.001, BAND) == "short"
    assert cannot_be_filtered(4000, 1 / 20, BAND) == "above_nyquist"
    assert cannot_be_filtered(4000, 1 / 20.1, BAND) is None
    with pytest.raises(ValueError, match="above_nyquist"):
        filtered(np.zeros(4000), 0.1, BAND, "offline")
