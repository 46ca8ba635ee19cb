"""The channels of a case as a dry run sees them: read, and in one line each."""

from dataclasses import dataclass

import numpy as np

from fatigue.case import Case
from fatigue.errors import DataError, Problem, refuse
from fatigue.ride.bands import band_problems
from fatigue.ride.records import channel_records
from fatigue.ride.standards.equipment import limits_of
from fatigue.shown import shortened, visible


@dataclass(frozen=True, slots=True)
class ChannelLine:
    """A channel of an event: samples in the kept part of the event, their rate [Hz], rms about the mean [``unit``]."""

    event: str
    channel: str
    role: str
    direction: str
    samples: int
    rate_hz: float
    rms: float
    unit: str

    def as_text(self) -> str:
        """The channel in words."""
        name, event = shortened(visible(self.channel)), shortened(visible(self.event))
        unit = "" if self.unit == "-" else f" {self.unit}"
        what = (
            f"{self.role} {self.direction}, {self.samples} samples at {self.rate_hz:.4g} Hz, rms {self.rms:.3g}{unit}"
        )
        return f"'{name}' of '{event}': {what}"


def checked_channels(case: Case) -> tuple[tuple[ChannelLine, ...], list[Problem]]:
    """A line for each channel of a case, and the warnings about them; both empty without channels.

    Raises
    ------
    DataError : every channel that cannot be had, and bands that no channel reaches
    """
    if not any(event.channel for event in case.mission.event):
        return (), []
    limits_of(case)
    records, warnings = channel_records(case)
    refuse(DataError, band_problems(case, records))
    lines = (
        ChannelLine(
            event=one.event,
            channel=one.name,
            role=one.role,
            direction=one.direction,
            samples=one.values.size,
            rate_hz=1.0 / one.step,
            rms=float(np.std(one.values)),
            unit="m/s2" if one.is_acceleration else "-",
        )
        for one in records
    )
    return tuple(lines), warnings
