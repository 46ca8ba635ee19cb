"""The band of frequencies that a record leaves of the one that is asked for: nothing above half its sampling rate."""

from collections.abc import Iterator, Sequence

from fatigue.case import Case
from fatigue.errors import Problem
from fatigue.ride.channel import ChannelRecord

MARGIN = 1e-9  # relative: half the sampling rate itself is reached


def heard(band: tuple[float, ...], record: ChannelRecord) -> tuple[tuple[float, float] | None, str]:
    """Band [Hz] up to half the sampling rate, None if nothing is left of it; and what is to be said about it."""
    low, high = band
    half = 0.5 / record.step
    if high <= half * (1 + MARGIN):
        return (low, high), ""
    said = f"sampled at {1 / record.step:.4g} Hz: nothing is known above {half:.4g} Hz"
    return ((low, half) if low < half * (1 - MARGIN) else None), said


def band_problems(case: Case, records: Sequence[ChannelRecord]) -> Iterator[Problem]:
    """Refusal of every band that the case states and of which no channel leaves anything.

    A band that reaches above half the sampling rate of a channel is clipped there, with the reason in its rows; so are
    bands that are not stated, of which a channel may leave nothing.
    """
    rules = case.ride
    bogies = [one for one in records if one.role == "bogie"]
    floors = [one for one in records if one.role == "floor"]
    stated = (
        ("ride.hunting_band_hz", "hunting_band_hz" in rules.model_fields_set, rules.hunting_band_hz, list(records)),
        ("ride.comfort_band_hz", "comfort_band_hz" in rules.model_fields_set, rules.comfort_band_hz, floors),
        ("ride.alarm.band_hz", "band_hz" in rules.alarm.model_fields_set, rules.alarm.band_hz, bogies),
    )
    for key, is_stated, band, judged in stated:
        if is_stated and judged and all(heard(band, one)[0] is None for one in judged):
            highest = max(0.5 / one.step for one in judged)
            what = f"the lower edge of {band[0]:g} Hz is not below {highest:.4g} Hz, half the sampling rate of the "
            what += "fastest channel"
            remedy = "Lower it, or give a channel that is sampled faster"
            yield Problem("band", f"{case.path.name}: {key}", what, remedy)
