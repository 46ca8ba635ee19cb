"""Calibrations of channels over time: reading = factor x raw + offset, how it was proved, and whether its sign was."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.gauges.measured.channel_file import Channel
from fatigue.readers.neutral.tables import open_table

METHODS = ("shunt", "factory", "dead load")
SHUNT_TOLERANCE, ROUNDING = 0.03, 1e-9
TEXTS = ("channel", "valid_from", "method")
NUMBERS = ("offset", "shunt_ue_expected", "shunt_ue_read")


@dataclass(frozen=True, slots=True)
class Calibration:
    """How raw samples of a channel become readings from some time on.

    Attributes
    ----------
    factor, offset : reading = factor x raw + offset [ue per raw unit, ue; MPa of channels in MPa]
    valid_from : from when; None: of a channel without calibration, which is in ue or MPa as it is
    method : shunt, factory or dead load
    shunt_share : shunt that was read over the one expected; NaN: not known
    sign_checked : whether its sign was proved by hand or a known load
    """

    factor: float
    offset: float
    valid_from: datetime | None
    method: str
    shunt_share: float
    sign_checked: bool

    @property
    def shunt_is_off(self) -> bool:
        """Whether the shunt is more than ``SHUNT_TOLERANCE`` off."""
        return abs(self.shunt_share - 1.0) > SHUNT_TOLERANCE + ROUNDING


AS_IT_IS = Calibration(1.0, 0.0, None, "", np.nan, sign_checked=False)


def read_calibrations(path: Path, *, strict: bool = False) -> tuple[dict[str, list[Calibration]], list[Problem]]:
    """Read the table of calibrations, of each channel the oldest first, and the warnings about it.

    Raises
    ------
    DataError : a time without zone, the same one twice, a factor of 0, an unknown method
    """
    table = open_table(path, texts=TEXTS)
    table.expect(("channel", "valid_from", "factor"), ("method", *NUMBERS, "sign_checked"), strict=strict)
    channels, times = table.texts("channel"), table.texts("valid_from")
    methods = table.texts("method", default="")
    table.choices("method", methods, ("", *METHODS))
    factor = table.numbers("factor")
    table.report(factor == 0.0, "bad_value", "factor", "a factor of 0 makes nothing of every sample", "Give the factor")
    offset = table.numbers("offset", default=0.0)
    expected, read = (table.numbers(name, default=np.nan) for name in NUMBERS[1:])
    table.report(expected == 0.0, "bad_value", NUMBERS[1], "a shunt of 0 proves nothing", "Give what it makes")
    checked = table.flags("sign_checked", default=False)
    instants = [_instant(text) for text in times]
    bad = np.array([instant is None for instant in instants], dtype=np.bool_)
    what = f"{times[int(bad.argmax())]!r} is no time with its zone" if bad.any() else ""
    table.report(bad, "bad_time", "valid_from", what, "Write it as 2026-05-04T10:00:00+02:00 or with Z for UTC")
    table.refuse()
    found: dict[str, list[Calibration]] = {}
    for i, (channel, instant) in enumerate(zip(channels, instants, strict=True)):
        row = Calibration(
            float(factor[i]), float(offset[i]), instant, methods[i], float(read[i] / expected[i]), bool(checked[i])
        )
        known = found.setdefault(channel, [])
        if any(one.valid_from == instant for one in known):
            what = f"channel {channel!r} has a calibration from {times[i]} already"
            table.problems.append(Problem("duplicate", table.where("valid_from", i), what, "Keep one of the rows"))
        known.append(row)
    table.refuse()
    for rows in found.values():
        rows.sort(key=lambda one: one.valid_from or datetime.min)
    return found, table.warnings


def calibrations_of(
    channels: Sequence[Channel],
    known: Mapping[str, Sequence[Calibration]],
    path: Path | None,
    recorded_at: datetime | None,
) -> dict[str, Calibration]:
    """The calibration of every channel when its records were made.

    Raises
    ------
    DataError
        a channel in V or mV/V without one, several without knowing when, none that is old enough, one of no channel
    """
    found: dict[str, Calibration] = {}
    problems: list[Problem] = []
    for channel in channels:
        chosen = _valid(channel, known.get(channel.name, ()), recorded_at)
        if isinstance(chosen, Problem):
            problems.append(chosen)
        else:
            found[channel.name] = chosen
    names = [channel.name for channel in channels]
    for name in known:
        if name not in names:
            what = f"there is no channel of strain {name!r}"
            where = "calibration" if path is None else path.name
            problems.append(Problem("unknown_channel", where, what, "Correct the name, or remove its rows"))
    refuse(DataError, problems)
    return found


def calibration_warnings(of: Mapping[str, Calibration]) -> Iterator[Problem]:
    """What the calibrations of channels leave open."""
    unchecked = [name for name, one in of.items() if not one.sign_checked]
    if unchecked:
        what = f"the sign of {len(unchecked)} of {len(of)} channels was not checked: {', '.join(unchecked[:12])}"
        what += "" if len(unchecked) <= 12 else " ..."
        remedy = "Push by hand or put on a known load, and set sign_checked: damage does not tell a wrong sign"
        yield Problem("sign_unchecked", "calibration", what, remedy, len(unchecked))
    for name, one in of.items():
        if one.shunt_is_off:
            what = f"the shunt reads {one.shunt_share:.3f} of what it should, more than {SHUNT_TOLERANCE:.0%} off"
            remedy = "Look at gauge factor, lead wires and bridge: it is pure gain, and nothing else shows it"
            yield Problem("shunt_off", f"channel '{name}'", what, remedy)


def _valid(channel: Channel, rows: Sequence[Calibration], at: datetime | None) -> Calibration | Problem:
    if not rows:
        if channel.unit in ("ue", "MPa"):
            return AS_IT_IS
        what = f"is in {channel.unit}, and has no calibration that makes strain of it"
        return Problem("no_calibration", channel.where, what, "Add its row to the table of --calibration")
    if at is None:
        if len(rows) == 1:
            return rows[0]
        what = f"has {len(rows)} calibrations, and when the records were made is not known"
        return Problem("when_recorded", channel.where, what, "Give --recorded-at, with its zone")
    valid = [row for row in rows if row.valid_from is not None and row.valid_from <= at]
    if valid:
        return valid[-1]
    assert rows[0].valid_from is not None
    what = f"has no calibration before {rows[0].valid_from.isoformat()}, and was recorded at {at.isoformat()}"
    return Problem("no_calibration", channel.where, what, "Add the calibration that held then")


def _instant(text: str) -> datetime | None:
    """Time of a text in ISO 8601, None of one without zone."""
    try:
        instant = datetime.fromisoformat(text)
    except ValueError:
        return None
    return None if instant.tzinfo is None else instant
