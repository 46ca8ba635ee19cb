"""What is asked of a comparison, and what of it the case and the records allow: event, band."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime

from fatigue.case import Case, Event, check_distance, event_length_km
from fatigue.errors import CaseError, DataError, Problem
from fatigue.gauges.exponent import exponent_problems
from fatigue.shown import few, visible
from fatigue.spectrum.moments import default_upper_hz


@dataclass(frozen=True, slots=True)
class Asked:
    """What a caller may ask for beside files.

    Attributes
    ----------
    km : measured distance of all records together [km]; None: from an odometer or a speed among the channels
    recorded_at : when the records were made, with its zone
    low_hz, high_hz : band; None: from 0 to the lower of 0.4 of the sampling rates and 1.5 x the highest normal mode
    max_lag_s : align the one record, which replays the simulation, within such a lag [s]; None: do not align
    bridge : longest gap of flagged samples that becomes a line
    exponent : of the pseudo-damage; None: of the curve of the case
    """

    km: float | None = None
    recorded_at: datetime | None = None
    low_hz: float | None = None
    high_hz: float | None = None
    max_lag_s: float | None = None
    bridge: int = 0
    exponent: float | None = None

    def problems(self) -> Iterator[Problem]:
        """What makes no sense whatever the files are."""
        for name, value in (("km", self.km), ("max_lag_s", self.max_lag_s)):
            if value is not None and not 0.0 < value < float("inf"):
                yield Problem("argument", name, f"{value} is no finite number above 0", "Give one, or leave it out")
        yield from exponent_problems(self.exponent)
        if self.bridge < 0:
            yield Problem("argument", "bridge", f"{self.bridge} samples are no gap", "Give 0 or more")
        if self.recorded_at is not None and self.recorded_at.tzinfo is None:
            what = f"{self.recorded_at.isoformat()} has no zone"
            yield Problem("bad_time", "recorded_at", what, "Write it as 2026-05-04T10:00:00+02:00")


def event_named(case: Case, name: str) -> Event:
    """Event of the mission that has a distance.

    Raises
    ------
    CaseError : there is no such event, or it is counted by number
    """
    found = next((event for event in case.mission.event if event.name == name), None)
    if found is None:
        known = few([f"'{visible(event.name)}'" for event in case.mission.event], 10)
        what = f"the mission has no event {visible(name)!r}"
        raise CaseError(Problem("unknown_event", "--event", what, f"It has {known}"))
    if found.length_km is None and found.speed_km_h is None:
        what = f"event '{visible(name)}' is counted by number and has no distance, and every number is per km"
        raise CaseError(Problem("no_distance", "--event", what, "Compare an event with speed_km_h or length_km"))
    return found


def km_of_pass(case: Case, event: Event, duration_s: float) -> float:
    """Distance of a pass of an event that has one [km].

    Raises
    ------
    CaseError : its length contradicts its speed
    """
    check_distance(event, duration_s, f"{case.path.name}: mission.event '{event.name}'")
    length = event_length_km(event, duration_s)
    assert length is not None
    return length


FEWEST_LINES = 8  # of the shortest record: fewer are no random process


def band_of(
    asked: Asked, rates_hz: Sequence[float], shortest_s: float, top_mode_hz: float | None
) -> tuple[float, float]:
    """Band [lo, hi) that measured and simulated strain have in common [Hz] (measured_data 2.2).

    Raises
    ------
    DataError : there is none, it goes beyond half a sampling rate, or the shortest record has too few lines in it
    """
    slowest = min(rates_hz)
    low = 0.0 if asked.low_hz is None else asked.low_hz
    high = default_upper_hz(1.0 / slowest, top_mode_hz) if asked.high_hz is None else asked.high_hz
    if not 0.0 <= low < high:
        what = f"there is no common band: it would go from {low:g} to {high:g} Hz, at {slowest:g} Hz of samples"
        raise DataError(Problem("no_common_band", "--band", what, "Give a lower end below the upper one"))
    if high > 0.5 * slowest * (1.0 + 1e-9):
        what = (
            f"{high:g} Hz is above half the lower sampling rate, {0.5 * slowest:g} Hz: there is no common band up to it"
        )
        raise DataError(Problem("no_common_band", "--band", what, "Give a lower upper end, or record faster"))
    if (high - low) * shortest_s < FEWEST_LINES:
        what = (
            f"the band from {low:g} to {high:g} Hz has {(high - low) * shortest_s:.3g} lines of the shortest record, "
        )
        what += f"which lasts {shortest_s:.4g} s"
        raise DataError(
            Problem("no_common_band", "--band", what, f"Widen it to {FEWEST_LINES} lines, or record longer")
        )
    return low, high
