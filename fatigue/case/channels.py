"""Channels beside the modal coordinates, and how a ride is judged by them: vibration, hunting, comfort, equipment."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from fatigue.case.problems import clash, path_problems
from fatigue.case.table import Positive, Table, Text
from fatigue.errors import Problem

Role = Literal["bogie", "equipment", "floor", "other"]
Direction = Literal["x", "y", "z"]
ChannelUnit = Literal["m/s2", "g", "-"]


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
    scale: float = Field(default=1.0, description="the factor [-] on its values")
    shift_s: float = Field(default=0.0, description="the time [s] added to the times of its file")

    @property
    def is_acceleration(self) -> bool:
        """Whether limits of accelerations mean anything to it."""
        return self.unit != "-"

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({"history": self.history})
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


class Alarm(Table):
    """The rule of the bogie alarm."""

    threshold_m_s2: Positive = Field(default=8.0, description="the acceleration [m/s2] that peaks reach, above 0")
    cycles: Annotated[int, Field(ge=1)] = Field(
        default=6, description="how many cycles in a row reach it with both half cycles, at least 1"
    )
    band_hz: Annotated[tuple[float, ...], Field(strict=False, min_length=2, max_length=2)] = Field(
        default=(0.5, 10.0), description="a list of the two edges [Hz] of the band-pass filter"
    )
    filter: Literal["offline", "on_board"] = Field(
        default="offline", description="'offline' (forward and backward, no delay) or 'on_board' (forward only)"
    )


class Ride(Table):
    """How channels are judged."""

    hunting_band_hz: Annotated[tuple[float, ...], Field(strict=False, min_length=2, max_length=2)] = Field(
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
    comfort_band_hz: Annotated[tuple[float, ...], Field(strict=False, min_length=2, max_length=2)] = Field(
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
