"""Channels as a file of recordings holds them: in groups, each on one time base, with names and units as stated."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem


@dataclass(frozen=True, slots=True)
class RecordedChannel:
    """Name and unit of a channel as the file states them; empty where it states none.

    ``mode``, ``frequency`` and ``resolution`` are what the file says of it elsewhere than in the name, as in
    ``units.channel_names.Channel``: 0 and NaN where it says nothing.
    """

    name: str
    unit: str = ""
    mode: int = 0
    frequency: float = float("nan")
    resolution: float = float("nan")


@dataclass(frozen=True, slots=True, eq=False)
class ChannelGroup:
    """Channels on one time base; their values are read when they are asked for.

    Attributes
    ----------
    name : of the group, table, sheet or data set in the file; empty where the file is one group
    channels : (c,) names and units
    samples : number of samples of each channel
    time : (t,) instants [s] on the file's own clock, its start offset included; None where the file gives none
    values : of the channels at these positions, (k, t), in their own units, conversions of the file applied; NaN where
        the file marks a sample as missing
    without_time : why there is no time, and what would give it; empty where there is one
    warnings : about the group, met while its names were read
    """

    name: str
    channels: tuple[RecordedChannel, ...]
    samples: int
    time: NDArray[np.float64] | None
    values: Callable[[Sequence[int]], NDArray[np.floating]]
    without_time: str = ""
    warnings: tuple[Problem, ...] = ()

    @property
    def called(self) -> str:
        """Name the group as messages do: with its channels, samples and step."""
        name = f"group {self.name!r}" if self.name else "the file"
        count = f"{len(self.channels)} channel{'' if len(self.channels) == 1 else 's'}, {self.samples} samples"
        if self.time is None or self.samples < 2:
            return f"{name} ({count}{'' if self.time is not None else ', no time'})"
        step = (self.time[-1] - self.time[0]) / (self.samples - 1)
        return f"{name} ({count}, from {self.time[0]:.9g} s every {step:.6g} s)"

    def same_times(self, other: "ChannelGroup") -> bool:
        """Whether another group has its samples at the same instants, within 1e-6 of a step."""
        if self.time is None or other.time is None:
            return self.time is other.time and self.samples == other.samples
        if self.time.size != other.time.size:
            return False
        step = abs(self.time[-1] - self.time[0]) / max(self.time.size - 1, 1)
        return bool(np.abs(self.time - other.time).max(initial=0.0) <= 1e-6 * step)
