"""What the alarm of a bogie would have said of a channel."""

from collections.abc import Sequence
from dataclasses import dataclass

from fatigue.case.channels import Alarm, Ride
from fatigue.ride.channel import ChannelRecord
from fatigue.ride.flutter import NAN, Tracked
from fatigue.vibration.alarm import PERIODS, cannot_be_filtered, count_alarms, filtered, passed

LEAST_PASSED = 0.9  # of the amplitude, below which peaks are to be read with it


@dataclass(frozen=True, slots=True)
class AlarmRow:
    """The alarm of one channel; ``alarms`` is None where it cannot be had.

    ``damage_share_inside_hot`` and ``told`` need the damage of the event: whoever knows it fills them in.
    """

    event: str
    channel: str
    alarms: int | None
    peak_m_s2: float
    first_alarm_s: float
    longest_run: float
    threshold_m_s2: float
    cycles: int
    hot_km_share: float
    damage_share_inside_hot: float
    told: str | None
    reason: str | None


def alarm_rows(channels: Sequence[Tracked], ride: Ride) -> list[AlarmRow]:
    """The alarm of every channel of a bogie; one that cannot set it off has the reason why."""
    return [_row(of, ride.alarm) for of in channels if of.record.role == "bogie"]


def _row(of: Tracked, rule: Alarm) -> AlarmRow:
    record, (low, high) = of.record, rule.band_hz
    reason = _has_none(record, (low, high))
    alarms, peak, first, longest = None, NAN, NAN, NAN
    if reason is None and record.is_still:
        alarms, peak, longest, reason = 0, 0.0, 0.0, "the channel does not vary: its sensor would tell nothing"
    elif reason is None:
        values, step = filtered(record.values, record.step, (low, high), rule.filter)
        count = count_alarms(values, step, rule.threshold_m_s2, rule.cycles)
        alarms, peak, longest = count.times.size, count.peak, count.longest_run
        first = record.start + float(count.times[0]) if alarms else NAN
        reason = _lowered(of, rule)
    return AlarmRow(
        event=record.event,
        channel=record.name,
        alarms=alarms,
        peak_m_s2=peak,
        first_alarm_s=first,
        longest_run=longest,
        threshold_m_s2=rule.threshold_m_s2,
        cycles=rule.cycles,
        hot_km_share=of.hot_length_share,
        damage_share_inside_hot=NAN,
        told=None,
        reason=reason,
    )


def _lowered(of: Tracked, rule: Alarm) -> str | None:
    """What the filter takes off hunting that lies near the edge of its band; None where there is none to speak of."""
    if not of.hot.any():
        return None
    low, high = rule.band_hz
    share = passed(of.hunting_hz, of.record.step, (low, high), rule.filter)
    if share >= LEAST_PASSED:
        return None
    said = f"of hunting at {of.hunting_hz:.3g} Hz the filter of {low:g} to {high:g} Hz passes {share:.0%}"
    if rule.filter == "on_board":
        return said
    return f"{said}, on board {passed(of.hunting_hz, of.record.step, (low, high), 'on_board'):.0%}"


def _has_none(record: ChannelRecord, band_hz: tuple[float, float]) -> str | None:
    """Why a channel cannot set off the alarm; None where it can."""
    if not record.is_acceleration:
        return "no acceleration: a threshold in m/s2 says nothing of it"
    if record.direction != "y":
        return f"direction '{record.direction}': the alarm is of the lateral acceleration, 'y'"
    cannot = cannot_be_filtered(record.values.size, record.step, band_hz)
    if cannot == "above_nyquist":
        return f"sampled at {1 / record.step:.4g} Hz: the band of the alarm reaches {band_hz[1]:g} Hz"
    if cannot == "short":
        return (
            f"{record.duration:.3g} s are too short: the filter of the alarm takes {PERIODS / band_hz[0]:g} s to settle"
        )
    return None
