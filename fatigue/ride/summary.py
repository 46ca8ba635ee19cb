"""What is said of a ride: event by event the hunting, what it meets, the alarm, comfort and equipment."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fatigue.errors import Problem
from fatigue.ride.alarm import AlarmRow
from fatigue.ride.coincidence import CoincidenceRow
from fatigue.ride.flutter import FlutterRow
from fatigue.ride.hot_damage import HotDamageRow
from fatigue.ride.tables import Rows, column_values
from fatigue.shown import few, shortened, visible

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
        """Text for people: a block for each event."""
        lines = [f"{visible(self.title)}: the ride, damage at {self.points}"]
        for event in self.events:
            lines += ["", f"'{shortened(visible(event))}'", *(f"  {line}" for line in self._event(event))]
        return "\n".join(lines)

    def _event(self, event: str) -> Iterator[str]:
        of = {name: [row for row in rows if row.event == event] for name, rows in self.tables.items()}
        flutter: list[FlutterRow] = of["flutter"]
        for channel in dict.fromkeys(row.channel for row in flutter):
            yield _hunting_text(channel, [row for row in flutter if row.channel == channel])
            if (event, channel) in self.worst:
                yield from _damage_text(self.worst[event, channel])
        yield from (_coincidence_text(row) for row in of["coincidence"])
        yield from (_alarm_text(row, self.worst.get((event, row.channel))) for row in of["alarm"])
        yield from _violated(of["stationarity"])
        for name in ("comfort", "equipment", "running"):
            yield from (_plain_text(name, row) for row in of.get(name, ()))


def _records(name: str, rows: Rows) -> list[dict[str, Any]]:
    columns = column_values(name, rows)
    return [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]


def _hunting_text(channel: str, rows: Sequence[FlutterRow]) -> str:
    hot = [row for row in rows if row.hot]
    length = sum(row.end_s - row.start_s for row in hot) / sum(row.end_s - row.start_s for row in rows)
    reason = rows[0].reason
    said = f" ({reason})" if reason else ""
    name = f"hunting of '{channel}'"
    if np.isnan(rows[0].rms):
        return f"{name}: cannot be had{said}"
    if not hot:
        return f"{name}: no hot stretch, dominant {_number(_longest(rows).frequency_hz)} Hz{said}"
    where = few([_span(row) for row in hot], 3)
    frequency = _number(float(np.median([row.frequency_hz for row in hot])))
    number = f"{len(hot)} hot stretch{'es' * (len(hot) > 1)}"
    return f"{name}: {number}, {length:.0%} of its length, {frequency} Hz: {where}{said}"


def _longest(rows: Sequence[FlutterRow]) -> FlutterRow:
    return max(rows, key=lambda row: row.end_s - row.start_s)


def _span(row: FlutterRow) -> str:
    if np.isnan(row.start_km):
        return f"{row.start_s:.4g} to {row.end_s:.4g} s"
    return f"km {row.start_km:.3f} to {row.end_km:.3f}"


def _damage_text(worst: HotDamageRow) -> Iterator[str]:
    """Where the event damages, of a channel with hot stretches."""
    if not np.isnan(worst.share_inside) and worst.length_share_inside > 0.0:
        times = "" if np.isnan(worst.intensity) else f", {_number(worst.intensity)} times as much per km as outside"
        place = f"{shortened(visible(worst.weld))}, node {worst.node} {worst.surface}"
        yield (
            f"  damage: {worst.share_inside:.0%} in the hot stretches, {worst.length_share_inside:.0%} of the length"
            f"{times} (at {place}, where the event damages most)"
        )


def _coincidence_text(row: CoincidenceRow) -> str:
    mode = f"'{row.equipment}' ({_number(row.frequency_hz)} Hz, damping {row.damping_ratio:.2g})"
    if np.isnan(row.amplification):
        return f"coincidence with {mode}: cannot be had ({row.reason})"
    text = f"coincidence of '{row.channel}', {_number(row.f_hunt_hz)} Hz, with {mode}: {row.flag}, "
    text += f"amplification {_number(row.amplification)}"
    if row.within != "hot":
        text += ", no hot stretch"
    if not np.isnan(row.coherence):
        text += f", coherence {row.coherence:.2f}, phase {row.phase_deg:.0f} deg"
    return text + (f" ({row.reason})" if row.reason else "")


def _alarm_text(row: AlarmRow, worst: HotDamageRow | None) -> str:
    rule = f"{row.cycles} cycles at {_number(row.threshold_m_s2)} m/s2"
    if row.alarms is None:
        return f"alarm of '{row.channel}': cannot be had ({row.reason})"
    text = f"alarm of '{row.channel}' ({rule}): {row.alarms or 'none'}, largest peak {_number(row.peak_m_s2)} m/s2"
    if worst is None or np.isnan(row.damage_share_inside_hot) or row.hot_km_share == 0.0:
        return text
    text += (
        f"; {row.damage_share_inside_hot:.0%} of the damage of '{row.event}' at {worst.weld} lies in hot stretches, "
        f"{row.hot_km_share:.0%} of its length"
    )
    return text + (": no alarm is not no damage" if row.told == "missed" else "")


def _violated(rows: Rows) -> Iterator[str]:
    for row in rows:
        if row.assumptions == "violated":
            yield f"'{row.channel}' is not what the frequency domain assumes: {row.reason}"


def _plain_text(name: str, row: Any) -> str:
    """A row of a table in words: what is known, with its unit left to the names of the columns."""
    values = {key: value for key, (value,) in column_values(name, [row]).items() if key not in ("event", "reason")}
    shown = [f"{key} {_number(value)}" for key, value in values.items() if _is_known(value)]
    return f"{name}: {', '.join(shown)}" + (f" ({row.reason})" if row.reason else "")


def _is_known(value: object) -> bool:
    return value is not None and value is not False and value == value  # noqa: PLR0124 (NaN)


def _number(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
