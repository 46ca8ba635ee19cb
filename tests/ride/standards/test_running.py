"""Rows of the running behaviour: sections by speed, sliding rms about the dominant frequency, limits, and reasons."""

from dataclasses import fields

import numpy as np
import pytest

from fatigue.case.channels import Ride
from fatigue.results import RIDDEN
from fatigue.ride.standards.running import RunningRow, running_rows
from tests.ride.standards.synthetic_channels import channel, noise, sine

RIDE = Ride(bogie_mass_t=6.8)


def rows_of(record, ride=RIDE):
    """Rows by quantity."""
    return {row.quantity: row for row in running_rows([record], ride)}


def bogie(values, **other):
    """Lateral channel of a bogie."""
    return channel(values, "bogie y", "bogie", "y", **other)


def test_fields_are_the_columns():
    """A row is a row of the table."""
    assert [field.name for field in fields(RunningRow)] == [column.name for column in RIDDEN["running"]]


def test_the_body():
    """A sine of 1 m/s2 at 2 Hz, 360 km/h: 12 sections of 500 m, percentile 1, rms 0.707, recalled limits."""
    rows = rows_of(channel(2.0 + sine(1.0, 2.0), direction="y"))
    percentile, rms = rows["body_percentile"], rows["body_rms"]
    assert (percentile.sections, percentile.length_m, percentile.band_hz) == (12, 500.0, "0.4-10")
    assert percentile.mean == pytest.approx(1.0, abs=0.02)
    assert rms.mean == pytest.approx(np.sqrt(0.5), abs=0.01)
    assert rms.value >= rms.mean
    assert (percentile.limit, rms.limit) == (2.5, 0.5)
    assert rows_of(channel(noise()))["body_rms"].limit == 0.75
    assert percentile.edition == "EN 14363, edition not seen; recalled"
    assert percentile.reason == ""


def test_sections_are_shorter_at_low_speed():
    """180 km/h: 250 m."""
    row = rows_of(channel(noise(), speed=180.0))["body_rms"]
    assert (row.length_m, row.sections) == (250.0, 12)


def test_the_bogie():
    """Hunting of 6 m/s2 at 7.8 Hz for 2 s within a minute: f0, sliding rms above its limit of 5.32 / 2, peak."""
    values = noise(0.05)
    values[5000:5500] += sine(6.0, 7.8, 2.0)
    rows = rows_of(bogie(values))
    assert rows["instability_frequency"].value == pytest.approx(7.8, abs=0.05)
    assert rows["instability_frequency"].unit == "Hz"
    assert rows["sliding_rms"].value == pytest.approx(6.0 / np.sqrt(2), rel=0.02)
    assert (rows["sliding_rms"].sections, rows["sliding_rms"].length_m) == (591, 100.0)
    assert rows["bogie_peak"].value == pytest.approx(6.0, rel=0.1)
    assert (rows["sliding_rms"].limit, rows["bogie_peak"].limit) == pytest.approx((5.32, 10.64))
    low, high = map(float, rows["sliding_rms"].band_hz.split("-"))
    assert (low, high) == pytest.approx((5.8, 9.8), abs=0.05)


def test_without_the_mass_of_the_bogie_there_is_no_limit():
    """Values are there, limits are empty and say what to give; a mass from 60 t on has none."""
    rows = rows_of(bogie(noise()), Ride())
    assert np.isfinite(rows["sliding_rms"].value)
    assert np.isnan(rows["sliding_rms"].limit)
    assert rows["sliding_rms"].edition == ""
    assert "no [ride] bogie_mass_t" in rows["bogie_peak"].reason
    assert "60 t" in rows_of(bogie(noise()), Ride(bogie_mass_t=60.0))["bogie_peak"].reason


def test_an_event_counted_by_number_has_no_sections():
    """No distance: sections and windows are empty with the reason; frequency and peak are there."""
    rows = rows_of(bogie(noise(), speed=None))
    assert np.isnan(rows["sliding_rms"].value)
    assert "counted by number" in rows["sliding_rms"].reason
    assert np.isfinite([rows["instability_frequency"].value, rows["bogie_peak"].value]).all()
    rows = rows_of(channel(noise(), speed=None))
    assert "counted by number" in rows["body_rms"].reason
    assert np.isnan(rows["body_rms"].length_m)


def test_a_short_event_has_no_section():
    """4 s at 360 km/h are 400 m, 0.5 s are 50 m."""
    assert rows_of(channel(noise(duration=4.0)))["body_rms"].reason == "the record covers 400 m, a section is 500 m"
    row = rows_of(bogie(noise(duration=0.5)))["sliding_rms"]
    assert row.reason == "the record covers 50 m, a window is 100 m"


def test_a_record_without_a_period_of_the_band_has_no_peak():
    """2 s from 0.4 Hz on."""
    row = rows_of(bogie(noise(duration=2.0)))["bogie_peak"]
    assert (np.isnan(row.value), row.reason) == (True, "the record of 2 s is shorter than a period of 0.4 Hz")


def test_directions_without_a_limit():
    """Along the track the body has no limit; instability is looked at in y; other roles have no rows."""
    row = rows_of(channel(noise(), direction="x"))["body_rms"]
    assert np.isfinite(row.value)
    assert np.isnan(row.limit)
    assert row.reason == "no limit is at hand in this direction"
    rows = rows_of(channel(noise(), role="bogie", direction="z"))
    assert rows["sliding_rms"].reason == "instability is looked at in y"
    assert running_rows([channel(noise(), role=role) for role in ("equipment", "other")], RIDE) == []


def test_a_coordinate_has_a_frequency_and_no_limit():
    """Its dominant frequency is one of any unit."""
    rows = rows_of(bogie(sine(1.0, 9.2), is_acceleration=False))
    assert rows["instability_frequency"].value == pytest.approx(9.2, abs=0.02)
    assert np.isnan([rows["sliding_rms"].value, rows["bogie_peak"].value]).all()
    assert "no acceleration" in rows["sliding_rms"].reason


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("duration", [0.07, 1.0, 30.0])
@pytest.mark.parametrize("values", ["zeros", "constant", "noise"])
@pytest.mark.parametrize("rate", [3.0, 15.0, 20.0, 100.0])
def test_no_number_is_empty_without_a_reason(duration, values, rate):
    """Nothing, a constant and noise at any rate: numbers, or why there are none, and no warning of numpy."""
    given = {"zeros": np.zeros, "constant": lambda n: np.full(n, 9.81)}
    samples = max(1, round(duration * rate))
    made = noise(duration=samples / rate, rate=rate) if values == "noise" else given[values](samples)
    for record in (bogie(made, rate=rate), channel(made, rate=rate)):
        for row in running_rows([record], RIDE):
            assert np.isfinite(row.value) or row.reason
            assert values == "noise" or row.unit == "Hz" or not row.value > 1e-9
