"""Running behaviour: band-pass, percentiles of sections, sliding rms, and the recalled limits."""

import numpy as np
import pytest

from fatigue.vibration.standards.running import (
    body_band,
    bogie_limits,
    edition,
    instability_frequency,
    section_length,
    sections,
    sliding_rms,
)


def test_the_limits_of_a_bogie():
    """12 - m/5, half of it for the sliding rms: 10.64 and 5.32 at 6.8 t; none from 60 t on."""
    assert bogie_limits(6.8) == pytest.approx((5.32, 10.64))
    assert bogie_limits(10.0) == pytest.approx((5.0, 10.0))
    assert np.isnan(bogie_limits(60.0)).all()
    assert edition() == "EN 14363, edition not seen; recalled"


def test_sections_are_longer_above_220_km_h():
    """500 m above, 250 m up to it."""
    assert [section_length(v) for v in (120.0, 220.0, 220.1, 420.0)] == [250.0, 250.0, 500.0, 500.0]


def test_the_band_of_the_body():
    """A sine of 2 Hz stays, one of 40 Hz and the quasi-static acceleration of a curve go."""
    t = np.arange(30 * 250) / 250
    kept = np.cos(2 * np.pi * 2.0 * t)
    values = 1.0 + kept + np.cos(2 * np.pi * 40.0 * t)
    assert body_band(values, 1 / 250)[250:-250] == pytest.approx(kept[250:-250], abs=0.01)


def test_percentiles_and_rms_of_sections():
    """A sine: rms 0.707, percentile next to 1; a pulse longer than 0.15 % of a section tells."""
    t = np.arange(5000) / 250
    largest, rms = sections(np.sin(2 * np.pi * 5.0 * t), 1000)
    assert rms == pytest.approx(np.full(5, np.sqrt(0.5)))
    assert largest == pytest.approx(np.full(5, 1.0), abs=3e-3)
    values = np.zeros(2000)
    values[1500:1510] = -3.0
    assert sections(values, 1000)[0].tolist() == [0.0, 3.0]
    assert sections(values, 2001)[0].size == 0
    assert sections(np.arange(1500.0), 1000)[1].size == 2


def test_the_sliding_rms():
    """A burst of one window reads its own rms where the window meets it; the record may be shorter than one."""
    values = np.zeros(1000)
    values[300:400] = 2.0
    rms = sliding_rms(values, 100, 10)
    assert rms.size == 91
    assert rms.max() == rms[30] == pytest.approx(2.0)
    assert rms[25] == pytest.approx(2.0 * np.sqrt(0.5))
    assert sliding_rms(values, 1001, 10).size == 0
    assert sliding_rms(values, 0, 10).size == 0


@pytest.mark.parametrize("frequency", [4.3, 7.77, 9.2, 11.6])
def test_the_frequency_of_instability(frequency):
    """Dominant frequency within 0.02 Hz under noise and a stronger motion outside the band."""
    t = np.arange(30 * 200) / 200
    values = np.sin(2 * np.pi * frequency * t) + 5 * np.sin(2 * np.pi * 1.1 * t) + 9.81
    values += 0.3 * np.random.default_rng(1).standard_normal(t.size)
    assert instability_frequency(values, 1 / 200, (4.0, 12.0)) == pytest.approx(frequency, abs=0.02)


def test_records_that_say_little():
    """Zeros have no dominant frequency; a band without a line of the record has none either."""
    assert np.isnan(instability_frequency(np.zeros(1000), 0.01, (4.0, 12.0)))
    assert np.isnan(instability_frequency(np.ones(3), 0.01, (4.0, 12.0)))
    assert np.isnan(instability_frequency(np.arange(100.0), 1.0, (4.0, 12.0)))
    assert np.isnan(instability_frequency(np.ones(1), 0.01, (4.0, 12.0)))
