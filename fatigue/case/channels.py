"""Channels beside the modal coordinates, and how a ride is judged by them: vibration, hunting, comfort, equipment."""

import difflib
import itertools
from collections.abc import Iterable, Iterator, Mapping
from os.path import normpath
from typing import Annotated, Any, Literal

from pydantic import Field

from fatigue.case.problems import clash, path_problems
from fatigue.case.table import Positive, Table, Text
from fatigue.errors import Problem

G_M_S2 = 9.80665  # standard acceleration of free fall, ISO 80000-3
Role = Literal["bogie", "equipment", "floor", "other"]
Direction = Literal["x", "y", "z"]
ChannelUnit = Literal["m/s2", "g", "-"]
Band = Annotated[tuple[float, ...], Field(strict=False, min_length=2, max_length=2)]


class Channel(Table):
    """One measured or simulated channel of an event."""

    name: Text = Field(description="a name of the channel, unique in its event")
    history: Text | None = Field(
        default=None, description="the file of the channel over time (.parquet or .csv), by default the event's"
    )
    column: Text = Field(description="its column in the file; a modal coordinate is 'q_<mode>'")
    unit: ChannelUnit = Field(
        description="the unit of the column: 'm/s2' or 'g' of an acceleration, '-' of anything else, as of a modal "
        "coordinate"
    )
    role: Role = Field(description="what it is of: 'bogie', 'equipment', 'floor' or 'other'")
    direction: Direction = Field(description="its direction: 'x' along the track, 'y' lateral or 'z' vertical")
    place: Text | None = Field(
        default=None,
        description="the place it is at, the same for the directions of one place; left out: its name without a last "
        "word that is its direction",
    )
    scale: float = Field(default=1.0, description="the factor [-] on its values")
    shift_s: float = Field(default=0.0, description="the time [s] added to the times of its file")

    @property
    def is_acceleration(self) -> bool:
        """Whether limits of accelerations mean anything to it."""
        return self.unit != "-"

    def is_in(self, history: str | None) -> bool:
        """Whether it is a column of the history of its event, by its file name in the case."""
        return self.history is None or (history is not None and normpath(self.history) == normpath(history))

    @property
    def factor(self) -> float:
        """From a value of the column to one of the channel: to m/s2 of an acceleration."""
        return self.scale * (G_M_S2 if self.unit == "g" else 1.0)

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({"history": self.history})
        if self.column == "time_s":
            yield clash("column", "'time_s' is the time of the file", "Name the column of the channel")
        if self.scale == 0.0:
            yield clash("scale", "scale = 0 leaves nothing of the channel", "Give a factor, or remove the channel")


class EquipmentMode(Table):
    """A mode of a suspended piece of equipment, which need not be a mode of the body."""

    name: Text = Field(description="a name of the mode, unique, as in 'converter, lateral'")
    frequency_hz: Positive = Field(description="its frequency [Hz] as it hangs in the vehicle (coupled), above 0")
    damping_ratio: Annotated[float, Field(gt=0, lt=1)] = Field(description="its damping ratio [-], above 0 and below 1")
    channel: Text | None = Field(
        default=None, description="the channel at the equipment, for coherence and phase; left out: neither is had"
    )


class Equipment(Table):
    """What the vibration of a piece of equipment is compared with."""

    channel: Text = Field(description="the channel at its mount, with the role 'equipment'")
    vibration_class: Text = Field(
        alias="class", description="the category and class of the table of limits, as in '1A'; it has no default"
    )
    mass_kg: Positive | None = Field(
        default=None, description="the mass [kg], which sets the band of frequencies; left out: that of a light piece"
    )


def _upside_down(key: str, band: tuple[float, ...]) -> Iterator[Problem]:
    """Refusal of two edges that are no band."""
    if not 0.0 < band[0] < band[1]:
        yield clash(
            key, f"{list(band)} is no band of frequencies", "Give the lower edge above 0 Hz, then the upper one"
        )


class Alarm(Table):
    """The rule of the bogie alarm."""

    threshold_m_s2: Positive = Field(default=8.0, description="the acceleration [m/s2] that peaks reach, above 0")
    cycles: Annotated[int, Field(ge=1)] = Field(
        default=6, description="how many cycles in a row reach it with both half cycles, at least 1"
    )
    band_hz: Band = Field(default=(0.5, 10.0), description="a list of the two edges [Hz] of the band-pass filter")
    filter: Literal["offline", "on_board"] = Field(
        default="offline", description="'offline' (forward and backward, no delay) or 'on_board' (forward only)"
    )

    def _contradictions(self) -> Iterator[Problem]:
        yield from _upside_down("band_hz", self.band_hz)


class Ride(Table):
    """How channels are judged."""

    hunting_band_hz: Band = Field(
        default=(4.0, 12.0), description="a list of the two edges [Hz] of the band in which hunting is looked for"
    )
    hot_factor: Positive = Field(
        default=3.0, description="a hot stretch has a rms above this many [-] medians of the event"
    )
    hot_share: Annotated[float, Field(gt=0, lt=1)] = Field(
        default=0.5, description="and more than this share [-] of the power of the band within 0.5 Hz of its peak"
    )
    reference_rms: Annotated[dict[str, float], Field(strict=False)] = Field(
        default={},
        description="a table from channel to the rms in the band (in m/s2 of an acceleration) that takes the place of "
        "the median, where more than half of a record is hot",
    )
    comfort_band_hz: Band = Field(
        default=(0.5, 40.0), description="a list of the two edges [Hz] of the band of the Sperling index"
    )
    comfort_block_s: Positive = Field(default=5.0, description="the length [s] of a block of the line form, above 0")
    vibration_table: Text | None = Field(
        default=None, description="a file of limits (.toml) that takes the place of the shipped table of equipment"
    )
    bogie_mass_t: Positive | None = Field(
        default=None, description="the mass [t] of a bogie with its wheelsets, for the limits of the running behaviour"
    )
    alarm: Alarm = Field(default=Alarm(), description="a [ride.alarm] table")
    equipment_mode: Annotated[tuple[EquipmentMode, ...], Field(strict=False)] = Field(
        default=(), description="one [[ride.equipment_mode]] table per mode of equipment that hunting may meet"
    )
    equipment: Annotated[tuple[Equipment, ...], Field(strict=False)] = Field(
        default=(), description="one [[ride.equipment]] table per channel whose vibration is compared with limits"
    )

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({"vibration_table": self.vibration_table})
        yield from _upside_down("hunting_band_hz", self.hunting_band_hz)
        yield from _upside_down("comfort_band_hz", self.comfort_band_hz)
        for channel, rms in self.reference_rms.items():
            if not rms > 0.0:
                yield clash(f"reference_rms.{channel}", f"{rms:g} is no rms", "Give a number above 0")


def no_channel_of_static_loads(channels: tuple[Channel, ...]) -> Iterator[Problem]:
    """Refusal of channels of an event without history."""
    if channels:
        what = f"channel '{channels[0].name}' is given for a static load case, which lasts no time"
        yield clash("channel", what, "Remove it, or give it to an event with a history")


def channel_problems(raw: Mapping[str, Any]) -> Iterator[Problem]:
    """Refusals about the channels together, on the file's own values, so that a mistake elsewhere hides none."""
    first: dict[str, tuple[str, Mapping[str, Any]]] = {}
    for place, event in _tables(_table(raw.get("mission")).get("event"), "mission.event"):
        of_event: set[str] = set()
        for where, channel in _tables(event.get("channel"), f"{place}.channel"):
            name = channel.get("name")
            if not isinstance(name, str):
                continue
            if name in of_event:
                what = f"{name!r} is already the name of a channel of the event"
                yield Problem("duplicate", f"{where}.name", what, "Give every channel of an event its own name")
            of_event.add(name)
            yield from _unlike(where, channel, *first.setdefault(name, (where, channel)))
    yield from _rules_of_no_channel(_table(raw.get("ride")), {name: channel for name, (_, channel) in first.items()})


def _unlike(where: str, channel: Mapping[str, Any], first: str, other: Mapping[str, Any]) -> Iterator[Problem]:
    """Refusals of what a channel is in one event and not in another: its name says that it is one thing."""
    for key in ("role", "direction"):
        one, two = channel.get(key), other.get(key)
        if isinstance(one, str) and isinstance(two, str) and one != two:
            what = f"{one!r}, and channel {channel['name']!r} is {two!r} at {first}"
            yield clash(f"{where}.{key}", what, "Make them equal, or give one of the channels another name")
    unit, before = channel.get("unit"), other.get("unit")
    if isinstance(unit, str) and isinstance(before, str) and (unit == "-") != (before == "-"):
        what = f"{unit!r}, and channel {channel['name']!r} is in {before!r} at {first}: one is no acceleration"
        yield clash(f"{where}.unit", what, "Make them equal, or give one of the channels another name")


def _rules_of_no_channel(ride: Mapping[str, Any], known: Mapping[str, Mapping[str, Any]]) -> Iterator[Problem]:
    """Refusals of rules for channels that no event has, or to which the rule means nothing; of names given twice."""
    reference = _table(ride.get("reference_rms"))
    for channel in reference:
        yield from _unknown(f"ride.reference_rms.{channel}", channel, known)
    modes, equipment = (list(_tables(ride.get(key), f"ride.{key}")) for key in ("equipment_mode", "equipment"))
    for where, table in itertools.chain(modes, equipment):
        name = table.get("channel")
        if not isinstance(name, str):
            continue
        yield from _unknown(f"{where}.channel", name, known)
        role = known.get(name, {}).get("role")
        if isinstance(role, str) and role != "equipment":
            what = f"channel {name!r} has the role {role!r}, not 'equipment'"
            yield clash(f"{where}.channel", what, "Name the channel at the equipment, or correct its role")
    for where, table in equipment:
        name = table.get("channel")
        if isinstance(name, str) and known.get(name, {}).get("unit") == "-":
            what = f"channel {name!r} has the unit '-', and the limits of equipment are those of accelerations"
            yield clash(f"{where}.channel", what, "Give its unit, 'm/s2' or 'g', or remove the table")
    yield from _twice(modes, ("name",))
    yield from _twice(equipment, ("channel", "class"))


def _twice(tables: Iterable[tuple[str, Mapping[str, Any]]], keys: tuple[str, ...]) -> Iterator[Problem]:
    """Refusal of tables that have the same texts under some keys as one before."""
    seen: set[tuple[str, ...]] = set()
    for where, table in tables:
        named = tuple(text for key in keys if isinstance(text := table.get(key), str))
        if named in seen:
            what = f"{', '.join(map(repr, named))} is there already"
            yield Problem("duplicate", f"{where}.{keys[0]}", what, "Keep one of them")
        seen |= {named} if len(named) == len(keys) else set()


def _unknown(where: str, name: str, known: Mapping[str, object]) -> Iterator[Problem]:
    """Refusal of a channel that no event has."""
    if name in known:
        return
    near = difflib.get_close_matches(name, known, n=1)
    there = f"the channels are {', '.join(known)}" if known else "no event has one"
    remedy = f"Write {near[0]!r}" if near else f"Give it to an event by [[mission.event.channel]]; {there}"
    yield Problem("unknown_channel", where, f"there is no channel {name!r}", remedy)


def _table(value: object) -> Mapping[str, Any]:
    return value if isinstance(value, dict) else {}


def _tables(value: object, where: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Tables of a list with their places; of what is no list of tables the models say so."""
    items = value if isinstance(value, list) else []
    return ((f"{where}[{number}]", item) for number, item in enumerate(items, 1) if isinstance(item, dict))
