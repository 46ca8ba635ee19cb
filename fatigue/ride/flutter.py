"""Hunting of a channel: its dominant frequency over the whole event, and the stretches in which it is hot."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.case.channels import Ride
from fatigue.ride.bands import heard
from fatigue.ride.channel import ChannelRecord
from fatigue.vibration.tracking import (
    RIDGE_HZ,
    SHORTEST_S,
    Stretch,
    Track,
    cannot_be_tracked,
    hot_slices,
    stretches,
    track,
)

NAN = float("nan")
MOSTLY = 0.75  # of an event under one frequency, though nothing stands out
MUCH_HOT = 0.4  # share of an event from which on its own median is no measure of what is usual
EDGE_HZ = 0.05


@dataclass(frozen=True, slots=True, eq=False)
class Tracked:
    """A channel of an event with its track, or the reason why it has none.

    Attributes
    ----------
    hot : which slices belong to a hot stretch, (slices,)
    stretches : they tile the event, hot and not hot by turns
    reference_rms : what the rms of a slice is compared with [unit of the record]
    reason : why there is no track, or what the stretches are to be read with
    """

    record: ChannelRecord
    track: Track | None
    hot: NDArray[np.bool_]
    stretches: tuple[Stretch, ...]
    reference_rms: float
    reason: str | None

    @property
    def hot_spans(self) -> list[tuple[float, float]]:
        """Start and end of every hot stretch, in file time of the event [s]."""
        start = self.record.start
        return [(start + s.start_s, start + s.end_s) for s in self.stretches if s.hot]

    @property
    def hot_length_share(self) -> float:
        """Share of the event that lies in hot stretches; NaN without a track."""
        if self.track is None:
            return NAN
        return sum(s.end_s - s.start_s for s in self.stretches if s.hot) / self.track.duration

    @property
    def hunting_hz(self) -> float:
        """Dominant frequency [Hz]: median of the hot slices or, where none is hot, of all; NaN where all is still."""
        if self.track is None:
            return NAN
        counts = self.hot if self.hot.any() else self.track.rms > 0
        return float(np.median(self.track.frequency[counts])) if counts.any() else NAN


@dataclass(frozen=True, slots=True)
class FlutterRow:
    """A stretch of a channel."""

    event: str
    channel: str
    start_km: float
    end_km: float
    start_s: float
    end_s: float
    frequency_hz: float
    share: float
    rms: float
    peak: float
    hot: bool
    reason: str | None


@dataclass(frozen=True, slots=True)
class FlutterTrackRow:
    """A slice of the track of a channel."""

    event: str
    channel: str
    time_s: float
    km: float
    frequency_hz: float
    share: float
    rms: float
    reference_rms: float
    hot: bool


def tracked(record: ChannelRecord, ride: Ride) -> Tracked:
    """Track of a channel in ``hunting_band_hz`` and its stretches, as ``ride`` says what is hot.

    A slice is compared with ``reference_rms`` of the channel or, where none is given, with the median of the event.
    """
    band, clipped = heard(ride.hunting_band_hz, record)
    if band is None:
        return _without_track(record, clipped)
    if cannot_be_tracked(record.values.size, record.step, band) is not None:
        why = f"{record.duration:.3g} s are too short: a hot stretch and a slice beside it take {SHORTEST_S:g} s"
        return _without_track(record, why)
    found = track(record.values, record.step, band)
    given = ride.reference_rms.get(record.name)
    reference = found.median_rms if given is None else given
    hot = hot_slices(found, ride.hot_factor, ride.hot_share, reference)
    parts = tuple(stretches(record.values, record.step, band, found, hot))
    result = Tracked(record, found, hot, parts, reference, None)
    said = [clipped, *_read_with(result, found, band, ride)]
    return replace(result, reason="; ".join(filter(None, said)) or None)


def _without_track(record: ChannelRecord, why: str) -> Tracked:
    return Tracked(record, None, np.zeros(0, dtype=np.bool_), (), NAN, why)


def flutter_rows(of: Tracked) -> list[FlutterRow]:
    """One row per stretch of a channel, hot or not: together they are the event; one row with the reason otherwise."""
    record = of.record
    parts = of.stretches or (Stretch(0.0, record.duration, NAN, NAN, NAN, NAN, hot=False),)
    return [
        FlutterRow(
            event=record.event,
            channel=record.name,
            start_km=record.km(part.start_s),
            end_km=record.km(part.end_s),
            start_s=record.start + part.start_s,
            end_s=record.start + part.end_s,
            frequency_hz=part.frequency,
            share=part.share,
            rms=part.rms,
            peak=part.peak,
            hot=part.hot,
            reason=of.reason,
        )
        for part in parts
    ]


def flutter_track_rows(of: Tracked) -> list[FlutterTrackRow]:
    """One row per slice of a channel; none without a track."""
    record, found = of.record, of.track
    if found is None:
        return []
    return [
        FlutterTrackRow(
            event=record.event,
            channel=record.name,
            time_s=record.start + time,
            km=record.km(time),
            frequency_hz=frequency,
            share=share,
            rms=rms,
            reference_rms=of.reference_rms,
            hot=hot,
        )
        for time, frequency, share, rms, hot in zip(
            found.time.tolist(),
            found.frequency.tolist(),
            found.share.tolist(),
            found.rms.tolist(),
            of.hot.tolist(),
            strict=True,
        )
    ]


def _read_with(of: Tracked, found: Track, band_hz: tuple[float, float], ride: Ride) -> list[str]:
    """What the stretches of a channel are to be read with; nothing where nothing is in doubt."""
    low, high = band_hz
    said = []
    if np.isnan(of.hunting_hz):
        return [f"nothing vibrates between {low:g} and {high:g} Hz"]
    remedy = f'give its rms of a sound event: reference_rms = {{ "{of.record.name}" = ... }} in [ride]'
    dominated = float(np.mean(found.share > ride.hot_share))
    if of.record.name not in ride.reference_rms:
        if of.hot_length_share > MUCH_HOT:
            said.append(
                f"{of.hot_length_share:.0%} of the event are hot, which draws up the median that they exceed: {remedy}"
            )
        elif not of.hot.any() and dominated > MOSTLY:
            said.append(
                f"one frequency dominates {dominated:.0%} of the event, and no stretch exceeds {ride.hot_factor:g} "
                f"times its median rms: hunting from end to end looks like this, and so does a "
                f"lightly damped mode; {remedy}"
            )
    if of.hot.any() and not low + EDGE_HZ < of.hunting_hz < high - EDGE_HZ:
        said.append(
            f"the largest density lies at {of.hunting_hz:.3g} Hz, the edge of hunting_band_hz: its peak may be outside"
        )
    if high - low <= 2 * RIDGE_HZ:
        said.append(f"{low:g} to {high:g} Hz are no wider than the ridge, {2 * RIDGE_HZ:g} Hz: every share is 1")
    return said
