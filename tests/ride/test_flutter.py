"""Rows of hunting: stretches of a channel on the track, its slices, and what is said where nothing can be."""

from dataclasses import fields
from itertools import pairwise

import numpy as np
import pytest

from fatigue.case.channels import Ride
from fatigue.results.columns import TABLES
from fatigue.ride.flutter import FlutterRow, FlutterTrackRow, flutter_rows, flutter_track_rows, tracked
from tests.ride.channels import KM_PER_S, RATE, START_S, hunting, record

RIDE = Ride()


@pytest.mark.parametrize(("row", "table"), [(FlutterRow, "flutter"), (FlutterTrackRow, "flutter_track")])
def test_rows_have_the_columns(row, table):
    """Every column of the table is a field of the row, in order."""
    assert [f.name for f in fields(row)] == [c.name for c in TABLES[table]]


def test_a_burst_on_the_track():
    """A hot stretch lies where the burst is, in km and in file time, with its frequency and its rms in m/s2."""
    of = tracked(record(hunting()), RIDE)
    before, hot, after = flutter_rows(of)
    assert (before.hot, hot.hot, after.hot) == (False, True, False)
    assert hot.start_s == pytest.approx(START_S + 20.3, abs=0.5)
    assert hot.end_km - hot.start_km == pytest.approx(11.4 * KM_PER_S, abs=KM_PER_S)
    assert hot.start_km == pytest.approx((hot.start_s - START_S) * KM_PER_S)
    assert hot.frequency_hz == pytest.approx(7.8, abs=0.02)
    assert hot.rms == pytest.approx(3.0, rel=0.05)
    assert hot.peak > 3.0 * np.sqrt(2)
    assert hot.share > 0.85
    assert hot.reason is None
    assert of.hot_spans == [(hot.start_s, hot.end_s)]
    assert of.hot_length_share == pytest.approx(11.4 / 60, abs=0.02)
    assert of.hunting_hz == pytest.approx(7.8, abs=0.02)


def test_rows_tile_the_event():
    """The first stretch starts with the event, the last ends with it, and none leaves a gap."""
    rows = flutter_rows(tracked(record(hunting()), RIDE))
    assert rows[0].start_km == 0.0
    assert rows[-1].end_km == pytest.approx(60 * KM_PER_S)
    assert all(a.end_km == b.start_km for a, b in pairwise(rows))


def test_event_counted_by_number():
    """An event that has no km has its stretches in file time."""
    rows = flutter_rows(tracked(record(hunting(), km_per_s=np.nan), RIDE))
    assert np.isnan([r.start_km for r in rows]).all()
    assert rows[1].start_s == pytest.approx(START_S + 20.3, abs=0.5)


def test_slices():
    """There is a slice every 0.25 s, with what it was compared with; those of the burst are hot."""
    of = tracked(record(hunting()), RIDE)
    rows = flutter_track_rows(of)
    assert len(rows) == 233
    assert rows[0].time_s == START_S + 1.0
    assert np.diff([r.time_s for r in rows]) == pytest.approx(0.25)
    assert rows[10].km == pytest.approx((rows[10].time_s - START_S) * KM_PER_S)
    hot = [r for r in rows if r.hot]
    assert all(r.rms > 3 * r.reference_rms and r.share > 0.5 for r in hot)
    assert np.median([r.frequency_hz for r in hot]) == of.hunting_hz


def test_keys_of_the_case():
    """Factor, share and band of the case decide."""
    burst = record(hunting(rms=1.3))
    assert any(r.hot for r in flutter_rows(tracked(burst, RIDE)))
    assert not any(r.hot for r in flutter_rows(tracked(burst, Ride(hot_factor=9.0))))
    assert not any(r.hot for r in flutter_rows(tracked(burst, Ride(hot_share=0.95))))
    assert not any(r.hot for r in flutter_rows(tracked(burst, Ride(hunting_band_hz=(10.0, 20.0)))))


def test_hunting_from_end_to_end():
    """Beside its own median an event that hunts throughout is not hot, and says so; a reference finds it."""
    all_of_it = record(hunting(between=(0.0, 60.0)))
    (row,) = flutter_rows(tracked(all_of_it, RIDE))
    assert not row.hot
    assert "hunting from end to end looks like this" in row.reason
    assert 'reference_rms = { "bogie" = ... }' in row.reason
    (row,) = flutter_rows(tracked(all_of_it, Ride(reference_rms={"bogie": 0.3})))
    assert row.hot
    assert row.reason is None
    (row,) = flutter_rows(tracked(all_of_it, Ride(reference_rms={"another": 0.3})))
    assert not row.hot


def test_a_reference_may_cool_down():
    """A reference rms above the median raises the threshold."""
    assert not any(r.hot for r in flutter_rows(tracked(record(hunting()), Ride(reference_rms={"bogie": 2.0}))))


def test_much_of_the_event_is_hot():
    """From 40 % on the median is drawn up, which is said with the share."""
    rows = flutter_rows(tracked(record(hunting(between=(10.0, 36.0))), RIDE))
    assert any(r.hot for r in rows)
    assert all("draws up the median" in r.reason for r in rows)


def test_quiet_event_says_nothing():
    """Noise is one stretch that is not hot, without a remark."""
    (row,) = flutter_rows(tracked(record(hunting(rms=0.0)), RIDE))
    assert not row.hot
    assert row.reason is None
    assert row.rms == pytest.approx(0.3, rel=0.5)


def test_frequency_at_the_edge_of_the_band():
    """Hunting just beyond the band is hot at its edge, and says that the peak may be outside."""
    rows = flutter_rows(tracked(record(hunting(f=12.3, rms=5.0)), RIDE))
    assert any(r.hot for r in rows)
    assert "edge of hunting_band_hz" in rows[0].reason


def test_narrow_band():
    """A band no wider than the ridge makes every share 1."""
    assert "every share is 1" in tracked(record(hunting()), Ride(hunting_band_hz=(7.5, 8.5))).reason


@pytest.mark.parametrize(
    ("channel", "reason"),
    [
        (record(np.zeros(6000)), "nothing vibrates between 4 and 12 Hz"),
        (record(np.full(6000, 9.81)), "nothing vibrates between 4 and 12 Hz"),
        (record(hunting()[:900]), "4.5 s are too short: a hot stretch and a slice beside it take 4.75 s"),
        (record(hunting()[::25], step=25 / RATE), "sampled at 8 Hz: nothing is known above 4 Hz"),
    ],
    ids=["zeros", "constant", "short", "slow"],
)
def test_nothing_to_track(channel, reason):
    """A channel without a track has one row of its event, not hot, with the reason."""
    of = tracked(channel, RIDE)
    (row,) = flutter_rows(of)
    assert not row.hot
    assert np.isnan(row.frequency_hz)
    assert row.reason.startswith(reason)
    assert row.end_s == pytest.approx(START_S + channel.duration)
    assert of.hot_spans == []
    assert np.isnan(of.hunting_hz)


def test_band_that_is_clipped():
    """Of a slow channel the band ends at half its sampling rate: the same numbers below, with the reason."""
    slow = record(hunting()[::10], step=10 / RATE)
    of, inside = tracked(slow, RIDE), tracked(slow, Ride(hunting_band_hz=(4.0, 10.0)))
    assert of.reason == "sampled at 20 Hz: nothing is known above 10 Hz"
    assert inside.reason is None
    np.testing.assert_array_equal(of.track.frequency, inside.track.frequency)
    assert of.stretches == inside.stretches
    assert of.hot.any()


def test_slices_without_a_track():
    """A record that is too short has no slices."""
    assert flutter_track_rows(tracked(record(hunting()[:900]), RIDE)) == []
