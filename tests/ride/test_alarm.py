"""Rows of the alarm: what it would have said, and channels that cannot set it off."""

from dataclasses import fields

import numpy as np
import pytest

from fatigue.case.channels import Alarm, Ride
from fatigue.results.columns import TABLES
from fatigue.ride.alarm import AlarmRow, alarm_rows
from fatigue.ride.flutter import tracked
from tests.ride.channels import RATE, START_S, hunting, record


def row(channel, **alarm):
    """Row of one channel."""
    ride = Ride(alarm=Alarm(**alarm))
    (found,) = alarm_rows([tracked(channel, ride)], ride)
    return found


def test_rows_have_the_columns():
    """Every column of the table is a field of the row, in order."""
    assert [f.name for f in fields(AlarmRow)] == [c.name for c in TABLES["alarm"]]


def test_strong_hunting_sets_it_off():
    """A burst of 9 m/s2 is one alarm, within a second of its start; 89 cycles reach the threshold."""
    found = row(record(hunting(rms=7.0)))
    assert found.alarms == 1
    assert found.first_alarm_s == pytest.approx(START_S + 20.3 + 6 / 7.8, abs=0.5)
    assert found.longest_run > 60
    assert found.peak_m_s2 == pytest.approx(7 * np.sqrt(2), rel=0.15)
    assert found.hot_km_share == pytest.approx(11.4 / 60, abs=0.02)
    assert found.reason is None


def test_weak_hunting_does_not():
    """A burst of 7 m/s2 passes 8 in no six cycles, hot as it is: no alarm is not no hunting."""
    found = row(record(hunting(rms=4.7)))
    assert found.alarms == 0
    assert np.isnan(found.first_alarm_s)
    assert found.hot_km_share > 0.1


def test_keys_of_the_case():
    """Threshold, cycles, band and filter of the case decide, and stand in the row."""
    channel = record(hunting(rms=4.7))
    found = row(channel, threshold_m_s2=5.0, cycles=10)
    assert (found.alarms, found.threshold_m_s2, found.cycles) == (1, 5.0, 10)
    assert row(channel, threshold_m_s2=5.0, cycles=100).alarms == 0
    assert row(channel, threshold_m_s2=5.0, band_hz=(0.5, 4.0)).alarms == 0
    later = row(channel, threshold_m_s2=5.0, filter="on_board")
    assert later.first_alarm_s > row(channel, threshold_m_s2=5.0).first_alarm_s


@pytest.mark.parametrize(
    ("channel", "reason"),
    [
        (record(hunting(), is_acceleration=False), "no acceleration"),
        (record(hunting(), direction="z"), "direction 'z'"),
        (record(hunting()[::10], step=10 / RATE), "sampled at 20 Hz: the band of the alarm reaches 10 Hz"),
        (record(hunting()[:700]), "3.5 s are too short: the filter of the alarm takes 4 s to settle"),
    ],
    ids=["coordinate", "vertical", "slow", "short"],
)
def test_channels_that_cannot_set_it_off(channel, reason):
    """A number that cannot be had is empty, with the reason."""
    found = row(channel)
    assert found.alarms is None
    assert np.isnan([found.peak_m_s2, found.longest_run, found.first_alarm_s]).all()
    assert found.reason.startswith(reason)


@pytest.mark.parametrize(("how", "said"), [("offline", "passes 72%, on board 85%"), ("on_board", "passes 85%")])
def test_hunting_near_the_edge_of_the_filter(how, said):
    """The filter lowers hunting of 9 Hz, which is said: 9.9 m/s2 set it off on board and not offline."""
    found = row(record(hunting(rms=7.0, f=9.0)), filter=how)
    assert found.reason == f"of hunting at 9 Hz the filter of 0.5 to 10 Hz {said}"
    assert (found.alarms > 0) == (how == "on_board")
    assert row(record(hunting(rms=0.0, f=9.0)), filter=how).reason is None


def test_only_bogies_have_an_alarm():
    """Floor and equipment have no row."""
    ride = Ride()
    channels = [tracked(record(hunting(), role=role), ride) for role in ("bogie", "equipment", "floor", "other")]
    assert len(alarm_rows(channels, ride)) == 1


def test_silence():
    """A silent channel has no alarm and no peak."""
    found = row(record(np.zeros(6000)))
    assert (found.alarms, found.peak_m_s2, found.longest_run) == (0, 0.0, 0.0)
