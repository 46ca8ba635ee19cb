"""Rows of comfort: Sperling's index of every channel of the floor in its forms, and the mean comfort of EN 12299."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, cast

import numpy as np

from fatigue.case.channels import Ride
from fatigue.ride.bands import heard
from fatigue.ride.channel import ChannelRecord
from fatigue.ride.standards.reasons import joined, tells_nothing, too_short, written
from fatigue.vibration.standards.comfort_data import comfort_data, standing
from fatigue.vibration.standards.en12299 import BAND_HZ, WEIGHTING, block_rms, mean_comfort, section_percentiles
from fatigue.vibration.standards.mirrored import Floats
from fatigue.vibration.standards.sperling import wz_filter, wz_lines

PERIODS = 10  # of the lower edge of the band in a record that is not short: 20 s from 0.5 Hz on


@dataclass(frozen=True, slots=True)
class ComfortRow:
    """One index of one channel of one event, or of a place with all its directions; fields are those of the table."""

    event: str
    channel: str
    direction: str
    index: str
    form: str
    band_hz: str
    block_s: float
    value: float
    highest: float
    short_record: bool
    edition: str
    reason: str


def comfort_rows(records: Sequence[ChannelRecord], ride: Ride) -> list[ComfortRow]:
    """Comfort of every channel with the role ``floor``, event by event: Sperling's index, then EN 12299."""
    rows: list[ComfortRow] = []
    floor = [record for record in records if record.role == "floor"]
    for event in dict.fromkeys(record.event for record in floor):
        of_event = [record for record in floor if record.event == event]
        for record in of_event:
            rows += _sperling(record, ride)
        for place in dict.fromkeys(record.position for record in of_event):
            rows += _en12299(place, [record for record in of_event if record.position == place])
    return rows


def _sperling(record: ChannelRecord, ride: Ride) -> list[ComfortRow]:
    """The index by its filter and by spectral lines, and the recalled one of the ride quality of the vehicle."""
    band, about = heard(ride.comfort_band_hz, record)
    short = record.duration < PERIODS / ride.comfort_band_hz[0]
    forms = [
        ("sperling_wz", "filter", "sperling_filter", np.nan),
        ("sperling_wz", "line", "sperling_line", ride.comfort_block_s),
        ("sperling_wz_ride_quality", "filter", "sperling_filter_ride_quality", np.nan),
    ]
    rows = []
    for index, form, origin, block_s in forms:
        why = tells_nothing(record) or too_short(record, ride.comfort_band_hz[0])
        if record.direction == "x":
            why = "Sperling's index has weightings across the track only, lateral and vertical"
        elif form == "line" and block_s * ride.comfort_band_hz[0] < 1 - 1e-9:
            why = f"a block of {block_s:g} s is shorter than a period of {ride.comfort_band_hz[0]:g} Hz"
        value = highest = np.nan
        if band is not None and not why:
            direction = cast(Literal["y", "z"], record.direction)
            if form == "filter":
                of_vehicle = origin == "sperling_filter_ride_quality"
                value = wz_filter(record.values, record.step, direction, band, of_vehicle=of_vehicle)
            elif (blocks := wz_lines(record.values, record.step, direction, band, block_s)).size:
                value, highest = float(blocks.mean()), float(blocks.max())
            else:
                why = f"the record of {record.duration:g} s is shorter than a block of {block_s:g} s"
        rows.append(
            ComfortRow(
                event=record.event,
                channel=record.name,
                direction=record.direction,
                index=index,
                form=form,
                band_hz=written(band),
                block_s=block_s,
                value=value,
                highest=highest,
                short_record=short or (form == "line" and record.duration < block_s),
                edition=standing(origin),
                reason=joined((why, about)),
            )
        )
    return rows


@dataclass(frozen=True, slots=True, eq=False)
class _Weighed:
    """Percentiles (s,) [m/s2] of the weighed rms of one channel, none if ``why`` says so, and what is said of them."""

    record: ChannelRecord
    percentiles: Floats
    why: str
    about: str


def _weighed(record: ChannelRecord) -> _Weighed:
    data = comfort_data()["en12299"]
    band, about = heard(BAND_HZ, record)
    of_section = f"{record.duration:.4g} s of a section of {data['section_s']:g} s" if _is_short(record) else ""
    if why := tells_nothing(record) or (about if band is None else ""):
        return _Weighed(record, np.array([]), why, of_section)
    blocks = block_rms(record.values, record.step, WEIGHTING[record.direction])
    if not blocks.size:
        why = f"the record of {record.duration:g} s is shorter than a block of {data['block_s']:g} s"
    return _Weighed(record, section_percentiles(blocks), why, joined((of_section, about)))


def _is_short(record: ChannelRecord) -> bool:
    return bool(record.duration < comfort_data()["en12299"]["section_s"] * (1 - 1e-9))


def _en12299(place: str, records: Sequence[ChannelRecord]) -> list[ComfortRow]:
    """Percentile of the weighed rms of every channel of a place, and the mean comfort where x, y and z are there."""
    weighed = [_weighed(record) for record in records]
    rows = [
        _en12299_row("en12299_rms_p95", w.record.name, [w.record], w.percentiles, joined((w.why, w.about)))
        for w in weighed
    ]
    why = _why_no_mean(weighed)
    values = np.array([])
    if not why:
        of = {w.record.direction: w.percentiles for w in weighed}
        values = mean_comfort(of["x"], of["y"], of["z"])
    reason = why or joined(dict.fromkeys(w.about for w in weighed))
    return [*rows, _en12299_row("en12299_n_mv", place, records, values, reason)]


def _why_no_mean(weighed: Sequence[_Weighed]) -> str:
    """Why the directions of a place give no mean comfort; empty if they do."""
    directions = [w.record.direction for w in weighed]
    if missing := [direction for direction in "xyz" if direction not in directions]:
        return f"N_MV needs x, y and z of a place: {' and '.join(missing)} {'are' if missing[1:] else 'is'} missing"
    if twice := [direction for direction in "xyz" if directions.count(direction) > 1]:
        return f"more than one channel in {' and '.join(twice)}: give each place a name of its own"
    if without := [w for w in weighed if w.why]:
        return f"{without[0].record.name}: {without[0].why}"
    if len({w.percentiles.size for w in weighed}) > 1:
        return "the channels of the place differ in length"
    return ""


def _en12299_row(index: str, channel: str, records: Sequence[ChannelRecord], values: Floats, reason: str) -> ComfortRow:
    directions = sorted({record.direction for record in records})
    slowest = max(records, key=lambda record: record.step)
    return ComfortRow(
        event=records[0].event,
        channel=channel,
        direction="".join(directions),
        index=index,
        form=" ".join(WEIGHTING[direction] for direction in directions),
        band_hz=written(heard(BAND_HZ, slowest)[0]),
        block_s=comfort_data()["en12299"]["block_s"],
        value=float(values.mean()) if values.size else np.nan,
        highest=float(values.max()) if values.size else np.nan,
        short_record=any(map(_is_short, records)),
        edition=standing("en12299"),
        reason=reason,
    )
