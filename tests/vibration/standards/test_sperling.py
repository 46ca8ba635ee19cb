"""Sperling's index: sines in closed form, both forms beside each other, and what each depends on."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.vibration.standards.sperling import (
    comfort_weight,
    line_weight,
    ride_quality_weight,
    wz_filter,
    wz_lines,
)

BAND = (0.5, 40.0)


def sine(frequency, amplitude=0.5, duration=60.0, rate=400.0, phase=0.3):
    """Sine [m/s2] and its step [s]."""
    return amplitude * np.sin(2 * np.pi * frequency * np.arange(round(duration * rate)) / rate + phase), 1 / rate


def closed_forms(frequency, direction, amplitude=0.5):
    """Index of a sine in both forms, from the two formulas."""
    f = np.array([frequency])
    filter_form = (100 * amplitude * comfort_weight(f, direction)[0]) ** (2 / 6.67)
    return filter_form, 3.57 * (amplitude**3 * line_weight(f, direction)[0] / frequency) ** 0.1


def test_the_sine_of_the_source():
    """A sine of 0.5 m/s2 at 5.4 Hz, vertical: 3.036 in the filter form and 3.068 in the line form."""
    assert closed_forms(5.4, "z") == pytest.approx((3.036, 3.068), abs=5e-4)
    values, step = sine(5.4)
    assert wz_filter(values, step, "z", BAND) == pytest.approx(3.036, abs=1e-3)
    assert wz_lines(values, step, "z", BAND, 5.0) == pytest.approx(np.full(23, 3.068), abs=1e-3)


@pytest.mark.parametrize("direction", ["y", "z"])
@pytest.mark.parametrize("frequency", [1.0, 2.0, 5.4, 8.0, 20.0, 30.0, 36.0, 40.0])
def test_a_sine_reads_its_closed_form(direction, frequency):
    """Both forms, at the edge of the band as inside it."""
    values, step = sine(frequency)
    filter_form, line_form = closed_forms(frequency, direction)
    assert wz_filter(values, step, direction, BAND) == pytest.approx(filter_form, rel=6e-3)
    assert wz_lines(values, step, direction, BAND, 5.0).mean() == pytest.approx(line_form, rel=2e-3)


def test_the_two_forms_part_above_10_hz():
    """Within 1.2 % (lateral 3.3 %) from 2 to 9.9 Hz; the line form is higher by 5.6, 16, 20, 23 % from 20 to 40 Hz."""
    ratio = {
        (d, f): closed_forms(f, d)[1] / closed_forms(f, d)[0] - 1
        for d in "yz"
        for f in (2.0, 4.0, 5.4, 7.0, 9.0, 9.9, 20.0, 30.0, 36.0, 40.0)
    }
    assert max(abs(r) for (d, f), r in ratio.items() if d == "z" and f < 10) < 0.012
    assert max(abs(r) for (d, f), r in ratio.items() if d == "y" and f < 10) < 0.0335
    assert [ratio["z", f] for f in (20.0, 30.0, 36.0, 40.0)] == pytest.approx([0.056, 0.16, 0.20, 0.23], abs=6e-3)


def test_the_filter_form_is_a_power_of_the_weighed_rms():
    """``Wz = 4.42 a_w^0.3`` with a_w in m/s2, of noise as of a sine."""
    values = 0.1 * np.random.default_rng(3).standard_normal(20_000)
    f = np.fft.rfftfreq(values.size, 0.005)
    weighed = np.fft.irfft(np.fft.rfft(values) * comfort_weight(f, "z") * ((f >= 0.5) & (f <= 40.0)), values.size)
    assert wz_filter(values, 0.005, "z", BAND) == pytest.approx(4.42 * weighed.std() ** 0.3, rel=2e-3)


def test_the_filter_form_does_not_depend_on_the_length_of_a_record():
    """Noise of one density, 30 s and 20 min."""
    values = 0.2 * np.random.default_rng(4).standard_normal(240_000)
    assert wz_filter(values[:6000], 0.005, "z", BAND) == pytest.approx(wz_filter(values, 0.005, "z", BAND), rel=0.02)


def test_the_line_form_of_broadband_vibration_falls_with_the_block_and_that_of_a_sine_does_not():
    """Blocks of 5 s read T^-0.05 of those of 20 s, a factor of 1.072, on noise."""
    noise = 0.1 * np.random.default_rng(1).standard_normal(200_000)
    long, short = (wz_lines(noise, 0.005, "z", BAND, block).mean() for block in (20.0, 5.0))
    assert short / long == pytest.approx(4**0.05, abs=5e-3)
    values, step = sine(6.0)
    long, short = (wz_lines(values, step, "z", BAND, block).mean() for block in (20.0, 5.0))
    assert short / long == pytest.approx(1.0, abs=1e-3)


@settings(max_examples=25, deadline=None)
@given(st.floats(2.0, 39.0), st.floats(0.0, 6.28), st.sampled_from("yz"))
def test_a_sine_between_two_lines_loses_next_to_nothing(frequency, phase, direction):
    """At most 0.15 % of the closed form and what the weighting changes over two lines, wherever the sine lies."""
    values, step = sine(frequency, duration=5.0, phase=phase)
    f = np.linspace(frequency - 0.2, frequency + 0.2, 41)
    around = 3.57 * (0.5**3 * line_weight(f, direction) / f) ** 0.1
    value = wz_lines(values, step, direction, BAND, 5.0)[0]
    assert around.min() * (1 - 1.5e-3) <= value <= around.max() * (1 + 5e-4)


def test_weightings():
    """Lateral over vertical 1.253 in the filter form; pieces of the line form; both go to nothing where they should."""
    f = np.array([1.0, 10.0])
    assert comfort_weight(f, "y") / comfort_weight(f, "z") == pytest.approx(np.full(2, 0.737 / 0.588), rel=1e-12)
    assert line_weight(np.array([1.0, 10.0, 30.0]), "y") == pytest.approx([0.8, 6.5, 1.0])
    assert ride_quality_weight(np.array([0.0]))[0] == 0.0
    at_1_hz = 1.14 * ((0.944**2 + 0.645**2) / (0.748**2 + 1.54256**2) * 3.55 / 4.55) ** 0.5
    assert ride_quality_weight(np.array([1.0])) == pytest.approx([at_1_hz], rel=1e-12)


def test_records_that_say_little():
    """Nothing shakes: 0; a constant or a slow drift: next to 0; shorter than a block: no block."""
    assert wz_filter(np.zeros(2000), 0.01, "z", BAND) == 0.0
    assert wz_filter(np.full(2000, 9.81), 0.01, "z", BAND) < 1e-3
    assert wz_lines(np.full(2000, 9.81), 0.01, "z", BAND, 5.0) == pytest.approx(np.zeros(7), abs=1e-3)
    assert wz_filter(np.linspace(0, 1, 2000), 0.01, "z", BAND) < 0.8  # a weighed rms of 3 mm/s2
    assert wz_lines(np.ones(499), 0.01, "z", BAND, 5.0).size == 0
    assert wz_filter(np.ones(1), 0.01, "z", BAND) == 0.0
    assert wz_lines(np.ones(5), 10.0, "z", BAND, 5.0).size in (0, 5)


def test_the_band_is_what_counts():
    """A sine outside the band leaves nothing, in both forms; a wider band takes it in."""
    values, step = sine(60.0)
    wide = (0.5, 80.0)
    assert wz_filter(values, step, "z", BAND) ** (1 / 0.3) < 0.06 * wz_filter(values, step, "z", wide) ** (1 / 0.3)
    assert wz_lines(values, step, "z", wide, 5.0).mean() > 4 * wz_lines(values, step, "z", BAND, 5.0).mean()
