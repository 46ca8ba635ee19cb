"""What is in a recording of any format: groups, channels, units, rates, starts and gaps."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fatigue.errors import Problem, given_path
from fatigue.readers.foreign.channels.group import ChannelGroup
from fatigue.readers.foreign.read import read_channels, recognise
from fatigue.readers.units.channel_names import channel

STEP_TOLERANCE = 1e-3  # of a step, as for histories


@dataclass(frozen=True, slots=True)
class ListedGroup:
    """One group: its channels with their units, and its time.

    Attributes
    ----------
    name : in the file, empty where the file is one group
    channels : names and units
    samples : of each channel
    start, step, duration : [s]; the step is (last - first) / (samples - 1) where steps are even, else the median one;
        NaN without time
    is_even : whether all steps are this one within a thousandth of it
    gaps : start and length of every step that is longer than one and a half [s]
    without_time : why there is no time; empty where there is one
    """

    name: str
    channels: tuple[tuple[str, str], ...]
    samples: int
    start: float
    step: float
    duration: float
    is_even: bool
    gaps: tuple[tuple[float, float], ...]
    without_time: str


@dataclass(frozen=True, slots=True)
class Recording:
    """A file of channels, by what it is called as a format."""

    path: Path
    kind: str
    groups: tuple[ListedGroup, ...]
    warnings: tuple[Problem, ...]

    def as_record(self) -> Mapping[str, Any]:
        """The same for machines; null where something is not known."""
        return {
            "file": str(self.path),
            "format": self.kind,
            "groups": [
                {
                    "group": one.name,
                    "samples": one.samples,
                    "start_s": _known(one.start),
                    "step_s": _known(one.step),
                    "duration_s": _known(one.duration),
                    "is_even": one.is_even,
                    "gaps": [{"from_s": begin, "length_s": length} for begin, length in one.gaps],
                    "without_time": one.without_time,
                    "channels": [{"channel": name, "unit": unit} for name, unit in one.channels],
                }
                for one in self.groups
            ],
            "warnings": [str(warning) for warning in self.warnings],
        }

    def as_text(self) -> str:
        """The same as lines: a line for each group, one for each of its channels."""
        lines = [f"{self.path.name} is {self.kind}"]
        for one in self.groups:
            name = f"group {one.name}: " if one.name else ""
            count = f"{len(one.channels)} channel{'s' * (len(one.channels) != 1)}, {one.samples} samples"
            time = one.without_time or f"from {one.start:.9g} s for {one.duration:.9g} s, every {one.step:.6g} s"
            if not one.without_time and one.step > 0:
                time += f" ({1.0 / one.step:.6g} Hz)" + ("" if one.is_even else ", in uneven steps")
            if one.gaps:
                begin, length = one.gaps[0]
                time += (
                    f"; {len(one.gaps)} gap{'s' * (len(one.gaps) != 1)}, the first at {begin:.9g} s of {length:.6g} s"
                )
            lines.append(f"{name}{count}, {time}")
            lines += [
                f"  {name}" + (f" [{unit}]" if unit and not channel(name).unit else "") for name, unit in one.channels
            ]
        return "\n".join([*lines, *(f"note   {warning}" for warning in self.warnings)])


def list_channels(path: Path | str) -> Recording:
    """What is in a file of channels; only the times of its groups are read.

    Raises
    ------
    DataError : any refusal of the readers
    """
    path = given_path(path, "path")
    groups = read_channels(path)
    warnings = dict.fromkeys(warning for group in groups for warning in group.warnings)
    return Recording(path, recognise(path).name, tuple(map(_listed, groups)), tuple(warnings))


def _listed(group: ChannelGroup) -> ListedGroup:
    channels = tuple((one.name, one.unit) for one in group.channels)
    if group.time is None or group.time.size < 2:
        reason = group.without_time or ("no time" if group.time is None else "")
        start = float("nan") if group.time is None or not group.time.size else float(group.time[0])
        return ListedGroup(group.name, channels, group.samples, start, float("nan"), float("nan"), False, (), reason)
    first, last = float(group.time[0]), float(group.time[-1])
    step = (last - first) / (group.time.size - 1)
    steps = np.diff(group.time)
    even = bool(step > 0.0 and np.abs(steps - step).max() <= STEP_TOLERANCE * step)
    gaps: tuple[tuple[float, float], ...] = ()
    if not even:
        step = float(np.median(steps))
        gaps = tuple((float(group.time[k]), float(steps[k])) for k in np.flatnonzero(steps > 1.5 * step))
    return ListedGroup(group.name, channels, group.samples, first, step, last - first, even, gaps, "")


def _known(value: float) -> float | None:
    return value if np.isfinite(value) else None
