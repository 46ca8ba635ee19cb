"""Hunting beside the modes of equipment: how close, what is amplified, and whether the channels vibrate together."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.case.channels import EquipmentMode, Ride
from fatigue.ride.channel import ChannelRecord
from fatigue.ride.flutter import NAN, Tracked
from fatigue.vibration.coincidence import (
    BAND_HZ,
    Coherence,
    amplification,
    coherence,
    common_grid,
    flag,
    oscillator_phase,
)


@dataclass(frozen=True, slots=True)
class CoincidenceRow:
    """Hunting of one channel beside one mode of equipment."""

    event: str
    channel: str | None
    equipment: str
    f_hunt_hz: float
    frequency_hz: float
    damping_ratio: float
    amplification: float
    within: str | None
    coherence: float
    averages: float
    chance_coherence: float
    coherence_event: float
    phase_deg: float
    oscillator_phase_deg: float
    flag: str | None
    reason: str | None


def is_of_hunting(record: ChannelRecord) -> bool:
    """Whether hunting is read from a channel: it is of a bogie, and lateral."""
    return record.role == "bogie" and record.direction == "y"


def coincidence_rows(
    event: str, channels: Sequence[Tracked], ride: Ride, records: Mapping[str, ChannelRecord]
) -> list[CoincidenceRow]:
    """Every lateral channel of a bogie beside every mode of equipment in ``ride``, for one event.

    ``channels`` are those of the event, ``records`` all of its channels by name. A mode has a row without numbers and
    with the reason where no channel shows hunting.
    """
    hunting = [of for of in channels if is_of_hunting(of.record)]
    if not hunting:
        why = "no channel of the event has the role 'bogie' and the direction 'y'"
        return [_without_hunting(event, None, mode, why) for mode in ride.equipment_mode]
    return [
        _without_hunting(event, of.record.name, mode, of.reason) if np.isnan(of.hunting_hz) else _row(of, mode, records)
        for of in hunting
        for mode in ride.equipment_mode
    ]


def _row(of: Tracked, mode: EquipmentMode, records: Mapping[str, ChannelRecord]) -> CoincidenceRow:
    f_hunt = of.hunting_hz
    spans = of.hot_spans or [(of.record.start, of.record.start + of.record.duration)]
    together, whole, reason = _vibrate_together(of, mode, records, spans)
    return CoincidenceRow(
        event=of.record.event,
        channel=of.record.name,
        equipment=mode.name,
        f_hunt_hz=f_hunt,
        frequency_hz=mode.frequency_hz,
        damping_ratio=mode.damping_ratio,
        amplification=amplification(f_hunt, mode.frequency_hz, mode.damping_ratio),
        within="hot" if of.hot.any() else "event",
        coherence=together.value if together else NAN,
        averages=together.averages if together else NAN,
        chance_coherence=together.significant if together else NAN,
        coherence_event=whole.value if whole else NAN,
        phase_deg=together.phase_deg if together else NAN,
        oscillator_phase_deg=oscillator_phase(f_hunt, mode.frequency_hz, mode.damping_ratio),
        flag=flag(f_hunt, mode.frequency_hz, mode.damping_ratio),
        reason=reason,
    )


def _vibrate_together(
    of: Tracked, mode: EquipmentMode, records: Mapping[str, ChannelRecord], spans: list[tuple[float, float]]
) -> tuple[Coherence | None, Coherence | None, str | None]:
    """Coherence within ``spans`` and over the event, with the channel of a mode, and why one is empty or in doubt."""
    other = records.get(mode.channel or "")
    cannot = _cannot_be_compared(of, mode, other)
    if other is None or cannot:
        return None, None, cannot
    upper = of.hunting_hz + BAND_HZ
    first, second, step, start = common_grid(
        (of.record.values, of.record.step, of.record.start), (other.values, other.step, other.start), upper
    )
    from_start = [(max(a - start, 0.0), b - start) for a, b in spans]
    together = coherence(first, second, step, of.hunting_hz, from_start)
    whole = coherence(first, second, step, of.hunting_hz, [(0.0, first.size * step)])
    doubt = None
    if together is None:
        within = "hot stretches" if of.hot.any() else "the time that both channels have"
        doubt = f"{within} hold fewer than four segments of 2 s: their coherence would mean nothing"
    elif np.isnan(together.value):
        doubt = "one of the two channels is silent"
    elif together.value < together.significant:
        doubt = f"a coherence below {together.significant:.2g} is chance: the phase means nothing"
    return together, whole, doubt


def _cannot_be_compared(of: Tracked, mode: EquipmentMode, other: ChannelRecord | None) -> str | None:
    """Why coherence and phase with the channel of a mode cannot be had; None where they can."""
    if mode.channel is None:
        return "the mode has no channel: coherence and phase cannot be had"
    if other is None:
        return f"the event has no channel '{mode.channel}', which is that of the mode"
    if other.name == of.record.name:
        return "the channel of the mode is the hunting channel itself"
    upper, slowest = of.hunting_hz + BAND_HZ, max(of.record.step, other.step)
    return f"sampled at {1 / slowest:.4g} Hz: nothing is known at {upper:.3g} Hz" if upper * slowest > 0.5 else None


def _without_hunting(event: str, channel: str | None, mode: EquipmentMode, reason: str | None) -> CoincidenceRow:
    return CoincidenceRow(
        event=event,
        channel=channel,
        equipment=mode.name,
        f_hunt_hz=NAN,
        frequency_hz=mode.frequency_hz,
        damping_ratio=mode.damping_ratio,
        amplification=NAN,
        within=None,
        coherence=NAN,
        averages=NAN,
        chance_coherence=NAN,
        coherence_event=NAN,
        phase_deg=NAN,
        oscillator_phase_deg=NAN,
        flag=None,
        reason=reason,
    )
