"""Rows of the running behaviour in the manner of EN 14363: accelerations of the body, and instability of a bogie."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.case.channels import Ride
from fatigue.ride.bands import heard
from fatigue.ride.channel import ChannelRecord
from fatigue.ride.standards.reasons import joined, tells_nothing, too_short, written
from fatigue.vibration.standards.mirrored import Floats, band_pass, filtered
from fatigue.vibration.standards.running import (
    body_band,
    bogie_limits,
    edition,
    instability_frequency,
    running_data,
    section_length,
    sections,
    sliding_rms,
)


@dataclass(frozen=True, slots=True)
class RunningRow:
    """One quantity of one channel of one event; fields are those of the table, and ``sections`` counts windows too."""

    event: str
    channel: str
    direction: str
    quantity: str
    band_hz: str = ""
    value: float = np.nan
    unit: str = "m/s2"
    mean: float = np.nan
    sections: int = 0
    length_m: float = np.nan
    limit: float = np.nan
    edition: str = ""
    reason: str = ""


def running_rows(records: Sequence[ChannelRecord], ride: Ride) -> list[RunningRow]:
    """Percentiles and rms of sections of every channel of the floor, sliding rms and peak of every one of a bogie."""
    rows: list[RunningRow] = []
    for record in records:
        if record.role == "floor":
            rows += _of_body(record)
        elif record.role == "bogie":
            rows += _of_bogie(record, ride)
    return rows


def _of_body(record: ChannelRecord) -> list[RunningRow]:
    data = running_data()["body"]
    length = section_length(record.km_per_s * 3600.0) if record.km_per_s > 0.0 else np.nan
    why = _no_band(record, data["band_hz"]) or _no_length(record, length, "section")
    largest = rms = np.array([])
    if not why:
        values = body_band(record.values, record.step)
        largest, rms = sections(values, _samples(record, length))
    rows = []
    for quantity, of_sections, limits in (
        ("body_percentile", largest, data["percentile_limit_m_s2"]),
        ("body_rms", rms, data["rms_limit_m_s2"]),
    ):
        limit = limits.get(record.direction, np.nan)
        no_limit = "" if np.isfinite(limit) else "no limit is at hand in this direction"
        rows.append(_row(record, quantity, data["band_hz"], of_sections, length, limit, joined((why, no_limit))))
    return rows


def _of_bogie(record: ChannelRecord, ride: Ride) -> list[RunningRow]:
    if record.direction != "y":
        return [_without(record, "sliding_rms", "instability is looked at in y")]
    data = running_data()
    no_mass = "" if ride.bogie_mass_t is not None else "no [ride] bogie_mass_t: no limit"
    rms_limit, peak_limit = (np.nan, np.nan) if ride.bogie_mass_t is None else bogie_limits(ride.bogie_mass_t)
    if ride.bogie_mass_t is not None and np.isnan(peak_limit):
        no_mass = f"no limit at a bogie mass of {ride.bogie_mass_t:g} t"
    wide = data["body"]["band_hz"]
    why = _no_band(record, wide)
    peaks = np.array([]) if why else np.array([np.abs(body_band(record.values, record.step)).max()])
    peak_row = _row(record, "bogie_peak", wide, peaks, np.nan, peak_limit, joined((why, no_mass)))
    hunting, about = heard(ride.hunting_band_hz, record)
    f0 = np.nan if hunting is None or record.is_still else instability_frequency(record.values, record.step, hunting)
    why = "" if hunting is None or np.isfinite(f0) else f"nothing moves between {written(hunting)} Hz"
    found = RunningRow(
        event=record.event,
        channel=record.name,
        direction=record.direction,
        quantity="instability_frequency",
        band_hz=written(hunting),
        value=f0,
        unit="Hz",
        reason=joined((why, about)),
    )
    half, window = data["bogie"]["half_band_hz"], data["bogie"]["window_m"]
    band = (max(f0 - half, wide[0]), f0 + half) if np.isfinite(f0) else None
    why = joined((why, about)) if band is None else _no_band(record, band) or _no_length(record, window, "window")
    windows = np.array([])
    if band is not None and not why:
        values = filtered(record.values, record.step, band_pass(*band))
        windows = sliding_rms(values, _samples(record, window), _samples(record, data["bogie"]["hop_m"]))
    return [found, _row(record, "sliding_rms", band, windows, window, rms_limit, joined((why, no_mass))), peak_row]


def _row(
    record: ChannelRecord,
    quantity: str,
    band: tuple[float, ...] | None,
    of_sections: Floats,
    length: float,
    limit: float,
    reason: str,
) -> RunningRow:
    return RunningRow(
        event=record.event,
        channel=record.name,
        direction=record.direction,
        quantity=quantity,
        band_hz=written(band),
        value=float(of_sections.max()) if of_sections.size else np.nan,
        mean=float(of_sections.mean()) if of_sections.size else np.nan,
        sections=of_sections.size,
        length_m=length,
        limit=limit,
        edition=edition() if np.isfinite(limit) else "",
        reason=reason,
    )


def _without(record: ChannelRecord, quantity: str, why: str) -> RunningRow:
    return RunningRow(record.event, record.name, record.direction, quantity, reason=why)


def _no_band(record: ChannelRecord, band: Sequence[float]) -> str:
    """Why a record cannot be filtered to a band: it is no acceleration, still, slow or short; empty: it can."""
    left, about = heard(tuple(band), record)
    return tells_nothing(record) or ("" if left == tuple(band) else about) or too_short(record, band[0])


def _no_length(record: ChannelRecord, length_m: float, what: str) -> str:
    """Why a record has no section or window of a length [m]: no distance, or too short; empty: it has."""
    if not record.km_per_s > 0.0:
        return "counted by number: it has no distance"
    if _samples(record, length_m) > record.values.size:
        covered = 1000.0 * record.km_per_s * record.duration
        return f"the record covers {covered:.4g} m, a {what} is {length_m:g} m"
    return ""


def _samples(record: ChannelRecord, length_m: float) -> int:
    """Samples of a length of the track, at least one."""
    return max(1, round(length_m / (1000.0 * record.km_per_s) / record.step))
