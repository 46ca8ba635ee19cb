"""The channels of the events as they are looked at: read, scaled, and cut to the kept part of their event."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.case import Case, Event
from fatigue.case.channels import Channel
from fatigue.errors import DataError, FatigueError, Problem, refuse
from fatigue.files.naming import missing_file
from fatigue.life.records.history import first_kept
from fatigue.life.records.unit_load import UniformGrid
from fatigue.readers.neutral.event.channel_file import read_channel, time_grid
from fatigue.ride.channel import ChannelRecord
from fatigue.shown import few
from fatigue.vibration.spikes import STANDS_OUT, spikes

LEAST_COVER = 0.99  # of the kept part of an event, below which a channel is said to be short
FEWEST_SAMPLES = 16  # of a channel within its event: fewer have no frequency to speak of


@dataclass(frozen=True, slots=True)
class Kept:
    """The kept part of an event on the clock of its history.

    ``start`` is the instant of its first kept sample [s], ``duration`` that of a pass [s], ``km_per_s`` the distance
    per time [km/s], NaN of an event counted by number.
    """

    event: str
    start: float
    duration: float
    km_per_s: float


def kept_parts(case: Case) -> list[Kept]:
    """The kept part of every event with channels, from the times of its history.

    Raises
    ------
    DataError : a history without times, or with uneven ones
    """
    return [_kept(case, event) for event in case.mission.event if event.channel]


def _kept(case: Case, event: Event) -> Kept:
    grid = time_grid(case.resolve(event.history or ""))
    skipped = min(first_kept(grid.step, event.start_s), grid.samples)
    duration = (grid.samples - skipped) * grid.step
    length = event.length_km
    if length is None and event.speed_km_h is not None:
        length = event.speed_km_h * duration / 3600.0
    km_per_s = np.nan if length is None or duration <= 0.0 else length / duration
    return Kept(event.name, grid.start + skipped * grid.step, duration, km_per_s)


def channel_records(case: Case) -> tuple[list[ChannelRecord], list[Problem]]:
    """All channels of all events in their order, and the warnings about them.

    Raises
    ------
    DataError : every channel that cannot be had, with file, column and row
    """
    refuse(DataError, missing_channel_files(case))
    events = [event for event in case.mission.event if event.channel]
    read: list[ChannelRecord] = []
    problems: list[Problem] = []
    parts = kept_parts(case)
    for event, kept in zip(events, parts, strict=True):
        for number, channel in enumerate(event.channel, 1):
            where = f"{case.path.name}: mission.event '{event.name}'.channel[{number}] ('{channel.name}')"
            try:
                read.append(_record(case, event, channel, kept, where))
            except FatigueError as error:
                problems += error.problems
    refuse(DataError, problems)
    return read, [
        *_short_warnings(case, read, parts),
        *_still_warnings(case, read),
        *_spike_warnings(case, read),
        *_modal_warnings(case),
    ]


def missing_channel_files(case: Case) -> Iterator[Problem]:
    """Refusal of every file of a channel, and of the table of limits, that is not there."""
    base = case.path.parent
    for i, event in enumerate(case.mission.event, 1):
        for j, channel in enumerate(event.channel, 1):
            if channel.history is not None and not case.resolve(channel.history).is_file():
                where = f"{case.path.name}: mission.event[{i}].channel[{j}].history"
                yield missing_file(case.resolve(channel.history), where, base=base)
    table = case.ride.vibration_table
    if table is not None and not case.resolve(table).is_file():
        yield missing_file(case.resolve(table), f"{case.path.name}: ride.vibration_table", base=base)


def _record(case: Case, event: Event, channel: Channel, kept: Kept, where: str) -> ChannelRecord:
    """One channel of one event.

    Raises
    ------
    DataError : the channel cannot be had
    """
    path = case.resolve(channel.history or event.history or "")
    samples = read_channel(path, channel.column, channel.unit, converted=channel.scale != 1.0)
    part = within(samples.grid, channel.shift_s, kept)
    if part.stop - part.start < FEWEST_SAMPLES:
        first, last = samples.grid.start + channel.shift_s, samples.grid.end + channel.shift_s
        what = f"{path.name} lasts from {first:.9g} to {last:.9g} s and has {max(part.stop - part.start, 0)} samples "
        what += (
            f"in the kept part of the event, which lasts from {kept.start:.9g} to {kept.start + kept.duration:.9g} s"
        )
        remedy = "Correct shift_s or start_s, or give a longer record"
        raise DataError(Problem("no_overlap", where, what, remedy))
    start = samples.grid.start + channel.shift_s + part.start * samples.grid.step
    return ChannelRecord(
        event=event.name,
        name=channel.name,
        role=channel.role,
        direction=channel.direction,
        is_acceleration=channel.is_acceleration,
        values=channel.factor * samples.values[part],
        step=samples.grid.step,
        start=start,
        km_per_s=kept.km_per_s,
        place=channel.place,
        ahead_s=start - kept.start,
    )


def within(grid: UniformGrid, shift_s: float, kept: Kept) -> slice:
    """Samples of a grid, moved by ``shift_s``, that lie in the kept part of an event, each with half a step of its own.

    Of the history of the event itself they are the samples that an assessment keeps.
    """
    begin = (kept.start - grid.start - shift_s) / grid.step
    first = max(0, int(np.ceil(begin - 0.5)))
    last = min(grid.samples, int(np.ceil(begin + kept.duration / grid.step - 0.5)))
    return slice(first, max(first, last))


def _short_warnings(case: Case, records: Sequence[ChannelRecord], parts: Sequence[Kept]) -> Iterator[Problem]:
    """Warning about channels that leave out some of the kept part of their event."""
    lasts = {kept.event: kept.duration for kept in parts}
    short = [(one.duration / lasts[one.event], one) for one in records if one.duration < LEAST_COVER * lasts[one.event]]
    if not short:
        return
    share, worst = min(short, key=lambda found: found[0])
    what = f"covers {share:.0%} of the kept part of event '{worst.event}', less than {LEAST_COVER:.0%}: what lies "
    what += "outside it is in no hot stretch"
    if len(short) > 1:
        others = (f"'{one.name}' of '{one.event}'" for _, one in short if one is not worst)
        what += f"; likewise {few(list(others))}"
    remedy = "Correct shift_s, or give a record that lasts as long as the event"
    yield Problem("short_channel", f"{case.path.name}: channel '{worst.name}'", what, remedy, len(short))


def _still_warnings(case: Case, records: Sequence[ChannelRecord]) -> Iterator[Problem]:
    """Warning about channels that do not vary."""
    still = [one for one in records if one.is_still]
    if still:
        named = few([f"'{one.name}' of '{one.event}'" for one in still])
        what = f"the channel does not vary: {named}"
        remedy = "Look whether it is the right column, and whether the sensor was connected"
        yield Problem("still_channel", f"{case.path.name}: channel '{still[0].name}'", what, remedy, len(still))


def _spike_warnings(case: Case, records: Sequence[ChannelRecord]) -> Iterator[Problem]:
    """Warning about single samples that no vibration makes: peaks, alarms and hot stretches rest on them."""
    found = [(one, at) for one in records if (at := spikes(one.values)).size]
    if not found:
        return
    places = [
        f"'{one.name}' of '{one.event}' at {one.start + at[0] * one.step:.6g} s ({one.values[at[0]]:.3g})"
        + (f" and {at.size - 1} more" if at.size > 1 else "")
        for one, at in found
    ]
    what = f"single samples stand out of all others, more than {STANDS_OUT:g} times the rms of the steps between "
    what += f"samples: {few(places)}"
    remedy = "Look at the record there and take out what is none of the vibration: peaks and the alarm rest on it"
    yield Problem("spiked_channel", f"{case.path.name}: channel '{found[0][0].name}'", what, remedy, len(found))


def _modal_warnings(case: Case) -> Iterator[Problem]:
    """Warning about modal coordinates that are said to be accelerations."""
    found = [
        (event, channel)
        for event in case.mission.event
        for channel in event.channel
        if channel.is_acceleration and channel.is_in(event.history) and re.fullmatch(r"q_-?\d+", channel.column)
    ]
    if found:
        event, channel = found[0]
        what = f"{channel.column} of {event.history} is a modal coordinate, and unit = {channel.unit!r} says it is "
        what += f"an acceleration ({len(found)} of the channels)"
        remedy = "Give unit = '-', or the column of the acceleration"
        yield Problem("modal_channel", f"{case.path.name}: channel '{channel.name}'", what, remedy, len(found))
