"""Bands of the rules of a ride that no channel reaches: its samples say nothing above half its sampling rate."""

from collections.abc import Iterator, Sequence

from fatigue.case import Case
from fatigue.errors import Problem
from fatigue.ride.channel import ChannelRecord

MARGIN = 1e-9  # relative: half the sampling rate itself is reached


def band_problems(case: Case, records: Sequence[ChannelRecord]) -> Iterator[Problem]:
    """Refusal of every band that the case states and none of its channels reaches.

    A band that some channels reach leaves the others without numbers, with the reason beside them; so do bands that are
    not stated.
    """
    rules = case.ride
    bogies = [one for one in records if one.role == "bogie"]
    floors = [one for one in records if one.role == "floor"]
    stated = (
        ("ride.hunting_band_hz", "hunting_band_hz" in rules.model_fields_set, rules.hunting_band_hz, list(records)),
        ("ride.comfort_band_hz", "comfort_band_hz" in rules.model_fields_set, rules.comfort_band_hz, floors),
        ("ride.alarm.band_hz", "band_hz" in rules.alarm.model_fields_set, rules.alarm.band_hz, bogies),
    )
    for key, is_stated, (_, upper), judged in stated:
        highest = max((0.5 / one.step for one in judged), default=None)
        if is_stated and highest is not None and upper > highest * (1.0 + MARGIN):
            what = (
                f"the upper edge of {upper:g} Hz is above {highest:g} Hz, half the sampling rate of the fastest channel"
            )
            yield Problem(
                "band", f"{case.path.name}: {key}", what, "Lower it, or give a channel that is sampled faster"
            )
