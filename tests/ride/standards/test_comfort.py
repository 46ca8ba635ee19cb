"""Rows of comfort: what is printed with each value, which directions make a place, and why a number is empty."""

from dataclasses import fields

import numpy as np
import pytest

from fatigue.case.channels import Ride
from fatigue.results import RIDDEN
from fatigue.ride.standards.comfort import ComfortRow, comfort_rows
from fatigue.vibration.standards.en12299 import response
from tests.ride.standards.synthetic_channels import channel, noise, sine


def rows_of(records, ride=None):
    """Rows by index and form."""
    return {(row.channel, row.index, row.form): row for row in comfort_rows(records, ride or Ride())}


def test_fields_are_the_columns():
    """A row is a row of the table."""
    assert [field.name for field in fields(ComfortRow)] == [column.name for column in RIDDEN["comfort"]]


def test_form_band_and_block_stand_beside_each_value():
    """The sine of the source, in both forms."""
    rows = rows_of([channel(sine())])
    filtered, lines = rows["mid z", "sperling_wz", "filter"], rows["mid z", "sperling_wz", "line"]
    assert (filtered.value, lines.value) == pytest.approx((3.036, 3.068), abs=2e-3)
    assert (filtered.band_hz, lines.band_hz) == ("0.5-40", "0.5-40")
    assert np.isnan(filtered.block_s)
    assert lines.block_s == 5.0
    assert lines.highest >= lines.value
    assert np.isnan(filtered.highest)
    assert (filtered.short_record, lines.short_record) == (False, False)
    assert "GB 5599" in lines.edition
    assert (filtered.reason, lines.reason) == ("", "")


def test_band_and_block_are_those_of_the_case():
    """A user's own band and block."""
    ride = Ride(comfort_band_hz=(1.0, 30.0), comfort_block_s=10.0)
    rows = rows_of([channel(sine())], ride)
    assert rows["mid z", "sperling_wz", "line"].block_s == 10.0
    assert {row.band_hz for (_, index, _), row in rows.items() if "sperling" in index} == {"1-30"}


def test_recalled_constants_say_so():
    """Every row has its origin; the ride quality of the vehicle, the lines and EN 12299 are recalled."""
    rows = rows_of([channel(noise())])
    told = {key[1:]: row.edition for key, row in rows.items()}
    assert all(told.values())
    assert told["sperling_wz_ride_quality", "filter"].endswith("recalled")
    assert told["sperling_wz", "line"].endswith("recalled")
    assert told["en12299_n_mv", "Wb"].endswith("recalled")
    assert told["sperling_wz", "filter"].endswith("seen")


def test_the_mean_comfort_of_a_place():
    """Three directions of one place: 6 times the root of the sum of squares of percentiles, for sines."""
    records = [channel(sine(0.3 + 0.1 * k, 2.0 + k, 300.0), f"mid {d}", direction=d) for k, d in enumerate("xyz")]
    rows = rows_of(records)
    weightings = {"x": "Wd", "y": "Wd", "z": "Wb"}
    expected = [
        (0.3 + 0.1 * k) / np.sqrt(2) * abs(response(np.array([2.0 + k]), weightings[d])[0]) for k, d in enumerate("xyz")
    ]
    for d, value in zip("xyz", expected, strict=True):
        assert rows[f"mid {d}", "en12299_rms_p95", weightings[d]].value == pytest.approx(value, rel=5e-3)
    row = rows["mid", "en12299_n_mv", "Wd Wd Wb"]
    assert row.value == row.highest == pytest.approx(6 * np.linalg.norm(expected), rel=5e-3)
    assert (row.short_record, row.reason, row.band_hz, row.block_s) == (False, "", "0.4-100", 5.0)


def test_a_key_makes_a_place_whatever_the_names():
    """``place`` joins channels of any name; names join by what is before their direction."""
    names = {"x": "ch 17", "y": "ch 18", "z": "ch 19"}
    by_key = rows_of([channel(noise(), names[d], direction=d, place="seat 5") for d in "xyz"])
    assert np.isfinite(by_key["seat 5", "en12299_n_mv", "Wd Wd Wb"].value)
    for pattern in ("floor_mid_{}", "floor mid, {}", "mid.{}", "mid {}"):
        records = [channel(noise(), pattern.format(d.upper()), direction=d) for d in "xyz"]
        places = {record.position for record in records}
        assert len(places) == 1, pattern
        assert np.isfinite(rows_of(records)[places.pop(), "en12299_n_mv", "Wd Wd Wb"].value)
    assert channel(noise(), "z").position == "z"
    assert channel(noise(), "galaxy", direction="y").position == "galaxy"


@pytest.mark.parametrize(
    ("directions", "places", "reason"),
    [
        ("z", "aaa", "N_MV needs x, y and z of a place: x and y are missing"),
        ("yz", "aaa", "N_MV needs x, y and z of a place: x is missing"),
        ("xyz", "aab", "N_MV needs x, y and z of a place: z is missing"),
        ("xyyz", "aaaa", "more than one channel in y: give each place a name of its own"),
    ],
)
def test_a_missing_direction_is_named(directions, places, reason):
    """The others have their weighed rms; N_MV is empty and says why."""
    records = [
        channel(noise(), f"c{k}", direction=d, place=p)
        for k, (d, p) in enumerate(zip(directions, places, strict=False))
    ]
    rows = comfort_rows(records, Ride())
    means = [row for row in rows if row.index == "en12299_n_mv"]
    assert reason in [row.reason for row in means]
    assert all(np.isnan(row.value) for row in means)
    assert all(np.isfinite(row.value) for row in rows if row.index == "en12299_rms_p95")


def test_short_records_are_labelled():
    """29 s are short of the 5 min of EN 12299 and enough for Sperling; 4 s have no block; 12 s are short of both."""
    rows = rows_of([channel(noise(duration=29.0))])
    assert rows["mid z", "en12299_rms_p95", "Wb"].short_record
    assert rows["mid z", "en12299_rms_p95", "Wb"].reason == "29 s of a section of 300 s"
    assert not rows["mid z", "sperling_wz", "line"].short_record
    rows = rows_of([channel(noise(duration=12.0))])
    assert rows["mid z", "sperling_wz", "filter"].short_record
    rows = rows_of([channel(noise(duration=4.0))])
    for key in (("sperling_wz", "line"), ("en12299_rms_p95", "Wb")):
        assert np.isnan(rows["mid z", *key].value)
        assert rows["mid z", *key].short_record
        assert "the record of 4 s is shorter than a block of 5 s" in rows["mid z", *key].reason
    assert np.isfinite(rows["mid z", "sperling_wz", "filter"].value)


def test_a_slow_sampling_rate_ends_the_band():
    """100 Hz hear up to 50 Hz: 40 Hz is fine, 60 Hz is cut with the reason; 0.8 Hz hear nothing of the band."""
    at_100_hz = channel(noise(rate=100.0), rate=100.0)
    assert rows_of([at_100_hz])["mid z", "sperling_wz", "filter"].reason == ""
    row = rows_of([at_100_hz], Ride(comfort_band_hz=(0.5, 60.0)))["mid z", "sperling_wz", "filter"]
    assert row.band_hz == "0.5-50"
    assert row.reason == "sampled at 100 Hz: nothing is known above 50 Hz"
    assert np.isfinite(row.value)
    weighed = rows_of([at_100_hz])["mid z", "en12299_rms_p95", "Wb"]
    assert (weighed.band_hz, np.isfinite(weighed.value)) == ("0.4-50", True)
    assert "nothing is known above 50 Hz" in weighed.reason
    row = rows_of([channel(noise(rate=0.8), rate=0.8)])["mid z", "sperling_wz", "filter"]
    assert (row.band_hz, np.isnan(row.value)) == ("", True)
    assert row.reason
    row = rows_of([channel(noise(rate=0.8), rate=0.8)])["mid z", "en12299_rms_p95", "Wb"]
    assert (row.band_hz, np.isnan(row.value)) == ("", True)
    assert row.reason == "sampled at 0.8 Hz: nothing is known above 0.4 Hz; 60 s of a section of 300 s"


def test_what_has_no_index_says_why():
    """Sperling has no weighting along the track; a coordinate is no acceleration; other roles have no rows."""
    rows = rows_of([channel(noise(), "mid x", direction="x")])
    assert np.isnan(rows["mid x", "sperling_wz", "filter"].value)
    assert "across the track only" in rows["mid x", "sperling_wz", "line"].reason
    for row in comfort_rows([channel(noise(), is_acceleration=False)], Ride()):
        assert np.isnan(row.value)
        assert row.reason
    assert comfort_rows([channel(noise(), role=role) for role in ("bogie", "equipment", "other")], Ride()) == []


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("duration", [0.016, 0.1, 1.0, 5.0, 7.5])
@pytest.mark.parametrize("values", ["zeros", "constant", "noise"])
def test_no_number_is_empty_without_a_reason(duration, values):
    """Nothing, a constant and noise, from four samples on: a value, or why there is none, and no warning of numpy."""
    given = {"zeros": np.zeros, "constant": lambda n: np.full(n, 9.81)}
    samples = round(duration * 250)
    made = noise(duration=duration) if values == "noise" else given[values](samples)
    for row in comfort_rows([channel(made, f"mid {d}", direction=d) for d in "xyz"], Ride()):
        assert np.isfinite(row.value) or row.reason
        assert values == "noise" or np.isnan(row.value) or row.value < 0.02


def test_a_block_holds_a_period_of_the_lower_edge():
    """Blocks of 1 s have no line at 0.5 Hz; a record of 1 s has no period of it: both say so."""
    row = rows_of([channel(noise())], Ride(comfort_block_s=1.0))["mid z", "sperling_wz", "line"]
    assert (np.isnan(row.value), row.reason) == (True, "a block of 1 s is shorter than a period of 0.5 Hz")
    row = rows_of([channel(noise(duration=1.0))])["mid z", "sperling_wz", "filter"]
    assert (np.isnan(row.value), row.reason) == (True, "the record of 1 s is shorter than a period of 0.5 Hz")
    assert np.isfinite(rows_of([channel(noise(duration=2.0))])["mid z", "sperling_wz", "filter"].value)


def test_events_are_apart():
    """Directions of two events make no place together."""
    records = [channel(noise(), f"mid {d}", direction=d, event=e) for e, ds in (("a", "xy"), ("b", "z")) for d in ds]
    means = [row for row in comfort_rows(records, Ride()) if row.index == "en12299_n_mv"]
    assert [(row.event, np.isnan(row.value)) for row in means] == [("a", True), ("b", True)]
