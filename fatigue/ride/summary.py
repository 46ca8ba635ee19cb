"""What is said of a ride: event by event the hunting, what it meets, the alarm, comfort and equipment."""

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from math import isnan
from statistics import median
from typing import Any

from fatigue.errors import Problem
from fatigue.ride.alarm import AlarmRow
from fatigue.ride.coincidence import CoincidenceRow
from fatigue.ride.flutter import FlutterRow
from fatigue.ride.hot_damage import HotDamageRow
from fatigue.ride.standards.comfort import ComfortRow
from fatigue.ride.standards.equipment import EquipmentRow
from fatigue.ride.standards.running import RunningRow
from fatigue.ride.tables import Rows, column_values
from fatigue.shown import few, shortened, visible

WIDTH = 110
NOT_PRINTED = ("flutter_track",)  # four rows a second of every channel


@dataclass(frozen=True, slots=True)
class RideSummary:
    """What the channels of a ride say.

    ``tables`` are the rows of each table; ``points`` says at which points damage was looked at, ``worst`` is the one of
    them where each event damages most, by event and channel.
    """

    title: str
    events: tuple[str, ...]
    points: str
    tables: Mapping[str, Rows]
    worst: Mapping[tuple[str, str], HotDamageRow]
    warnings: tuple[Problem, ...]

    def as_record(self) -> dict[str, Any]:
        """Record for machines: the rows of every table but the track of the channels, which only the tables have."""
        printed = {name: _records(name, rows) for name, rows in self.tables.items() if name not in NOT_PRINTED}
        return {
            "title": self.title,
            "points": self.points,
            **printed,
            "warnings": [asdict(problem) for problem in self.warnings],
        }

    def as_text(self) -> str:
        """Text for people: a block for each event, and once what no event has."""
        lines = [f"{visible(self.title)}: the ride, damage at {self.points}"]
        rows = {event: self._of(event) for event in self.events}
        missing = {event: list(_not_had(rows[event])) for event in self.events}
        first, *others = missing.values()
        everywhere = [line for line in first if all(line in of for of in others)] if others else []
        for event in self.events:
            own = [line for line in missing[event] if line not in everywhere]
            lines += [
                "",
                f"'{shortened(visible(event))}'",
                *map(_wrapped, self._event(event, rows[event])),
                *map(_wrapped, own),
            ]
        if everywhere:
            lines += ["", "In every event", *map(_wrapped, everywhere)]
        return "\n".join(lines)

    def _of(self, event: str) -> dict[str, list[Any]]:
        return {name: [row for row in rows if row.event == event] for name, rows in self.tables.items()}

    def _event(self, event: str, of: Mapping[str, list[Any]]) -> Iterator[str]:
        flutter: list[FlutterRow] = of["flutter"]
        for channel in dict.fromkeys(row.channel for row in flutter):
            slices = [row.frequency_hz for row in of["flutter_track"] if row.channel == channel and row.hot]
            yield from _hunting_text(channel, [row for row in flutter if row.channel == channel], slices)
            if (event, channel) in self.worst:
                yield from _damage_text(self.worst[event, channel])
        yield from (_coincidence_text(row) for row in of["coincidence"] if not isnan(row.amplification))
        for alarm in of["alarm"]:
            if alarm.alarms is not None:
                yield _alarm_text(alarm)
        yield from (_comfort_text(row) for row in of["comfort"] if not isnan(row.value))
        yield from (_equipment_text(row) for row in of["equipment"] if not isnan(row.rms_m_s2))
        yield from (_running_text(row) for row in of["running"] if not isnan(row.value))
        for row in of["stationarity"]:
            if row.assumptions == "violated":
                yield f"'{row.channel}' is not what the frequency domain assumes: {row.reason}"


def _wrapped(line: str) -> str:
    """A line of a block, what is longer than the page continued below it."""
    indent = "  " + " " * (len(line) - len(line.lstrip()))
    return textwrap.fill(
        visible(line.lstrip()),
        WIDTH,
        initial_indent=indent,
        subsequent_indent=f"{indent}  ",
        break_long_words=False,
        break_on_hyphens=False,
    )


def _records(name: str, rows: Rows) -> list[dict[str, Any]]:
    columns = column_values(name, rows)
    return [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]


def _hunting_text(channel: str, rows: Sequence[FlutterRow], hot_hz: Sequence[float]) -> Iterator[str]:
    """Hot stretches of a channel, with the median of the frequencies of their slices."""
    hot = [row for row in rows if row.hot]
    length = sum(row.end_s - row.start_s for row in hot) / sum(row.end_s - row.start_s for row in rows)
    if all(isnan(row.frequency_hz) for row in rows):
        return
    text = f"hunting of '{channel}': "
    if hot:
        frequency = _number(median(hot_hz))
        where = few([_span(row) for row in hot], 3)
        text += f"{len(hot)} hot stretch{'es' * (len(hot) > 1)}, {length:.0%} of the record, {frequency} Hz: {where}"
    else:
        longest = max(rows, key=lambda row: row.end_s - row.start_s)
        text += f"no hot stretch, dominant frequency {_number(longest.frequency_hz)} Hz"
    yield text + _beside(rows[0].reason)


def _span(row: FlutterRow) -> str:
    if isnan(row.start_km):
        return f"{row.start_s:.4g} to {row.end_s:.4g} s"
    return f"km {row.start_km:.3f} to {row.end_km:.3f}"


def _damage_text(worst: HotDamageRow) -> Iterator[str]:
    """Where the event damages, of a channel with hot stretches."""
    if not isnan(worst.share_inside) and worst.length_share_inside > 0.0:
        times = "" if isnan(worst.intensity) else f", {_factor(worst.intensity)} times as much per km as outside"
        yield (
            f"  damage: {worst.share_inside:.0%} in them, {worst.length_share_inside:.0%} of the event{times} "
            f"({shortened(visible(worst.weld))}, node {worst.node} {worst.surface}, where the event damages most)"
        )


def _coincidence_text(row: CoincidenceRow) -> str:
    within = "" if row.within == "hot" else " (no hot stretch)"
    text = f"coincidence of '{row.channel}' at {_number(row.f_hunt_hz)} Hz{within} with '{row.equipment}' at "
    text += f"{_number(row.frequency_hz)} Hz, damping {row.damping_ratio:.2g}: {row.flag}, "
    text += f"amplification {_factor(row.amplification)}"
    if isnan(row.coherence):
        return text
    return f"{text}, coherence {row.coherence:.2f}, phase {row.phase_deg:.0f} deg{_beside(row.reason)}"


def _alarm_text(row: AlarmRow) -> str:
    rule = f"{row.cycles} cycles at {_number(row.threshold_m_s2)} m/s2"
    text = f"alarm of '{row.channel}' ({rule}): {row.alarms or 'none'}, largest peak {_number(row.peak_m_s2)} m/s2"
    text += _beside(row.reason)
    if isnan(row.damage_share_inside_hot) or row.hot_km_share == 0.0:
        return text
    text += f"; {row.damage_share_inside_hot:.0%} of the damage of '{row.event}' lies in hot stretches, "
    text += f"{row.hot_km_share:.0%} of its length"
    return text + (": no alarm is not no damage" if row.told == "missed" else "")


def _comfort_text(row: ComfortRow) -> str:
    text = (
        f"comfort of '{row.channel}' {row.direction}, {row.index} by {row.form}, {row.band_hz} Hz: {_number(row.value)}"
    )
    if not isnan(row.block_s):
        text += f", blocks of {_number(row.block_s)} s"
    if row.highest > row.value:
        text += f", the worst {_number(row.highest)}"
    return text + (", short record" if row.short_record else "") + _beside(row.reason)


def _equipment_text(row: EquipmentRow) -> str:
    text = f"vibration of '{row.channel}' {row.direction}: rms {_number(row.rms_m_s2)} m/s2"
    if row.vibration_class:
        text += f", limit {_number(row.limit_m_s2)} of class {row.vibration_class} ({row.edition})"
    if not isnan(row.asd_ratio):
        text += f", density {_factor(row.asd_ratio)} times that of the class at {_number(row.asd_ratio_hz)} Hz"
    return text + _beside(row.reason)


def _running_text(row: RunningRow) -> str:
    text = f"running behaviour of '{row.channel}' {row.direction}, {row.quantity}, {row.band_hz} Hz: "
    text += f"{_number(row.value)} {row.unit}"
    if not isnan(row.limit):
        text += f", limit {_number(row.limit)} ({row.edition})"
    return text + _beside(row.reason)


def _not_had(of: Mapping[str, Rows]) -> Iterator[str]:
    """What cannot be had, by the reason why."""
    missing: dict[str, list[str]] = {}
    for what, row, is_missing in _numbers(of):
        if is_missing:
            missing.setdefault(row.reason or "nothing to evaluate", []).append(what)
    for reason, found in missing.items():
        yield f"not had: {few(list(dict.fromkeys(found)), 6)} ({reason})"


def _numbers(of: Mapping[str, Rows]) -> Iterator[tuple[str, Any, bool]]:
    """Each number that a ride has in words, the row that holds it, and whether it is empty."""
    tracked = {row.channel for row in of["flutter"] if not isnan(row.frequency_hz)}
    yield from ((f"hunting of '{row.channel}'", row, row.channel not in tracked) for row in of["flutter"])
    for row in of["coincidence"]:
        yield f"coincidence with '{row.equipment}'", row, isnan(row.amplification)
        of_both = f"coherence and phase with '{row.equipment}'"
        yield of_both, row, isnan(row.coherence) and not isnan(row.amplification)
    yield from ((f"alarm of '{row.channel}'", row, row.alarms is None) for row in of["alarm"])
    yield from ((f"{row.index} of '{row.channel}'", row, isnan(row.value)) for row in of["comfort"])
    yield from ((f"vibration of '{row.channel}'", row, isnan(row.rms_m_s2)) for row in of["equipment"])
    yield from ((f"{row.quantity} of '{row.channel}'", row, isnan(row.value)) for row in of["running"])


def _beside(reason: str | None) -> str:
    """What a number is to be read with, in parentheses behind it."""
    return f" ({reason})" if reason else ""


def _number(value: float) -> str:
    return f"{value:.4g}"


def _factor(value: float) -> str:
    """A ratio with three figures, however large."""
    return f"{value:.3g}" if value < 1000.0 else f"{value:.0f}"
