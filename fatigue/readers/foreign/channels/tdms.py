"""Channels of an NI TDMS file, read with the package nptdms.

The time of a channel is ``wf_start_offset + i wf_increment``, in ``wf_xunit_string``; where all channels have a stamp
``wf_start_time``, they stand on one clock that begins at the earliest of them. Channels without increment are on the
time that a channel of their group is, be it seconds or stamps.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.channels.own_time import with_own_time
from fatigue.readers.foreign.channels.quiet import quietly
from fatigue.readers.units.channel_names import channel as named
from fatigue.readers.units.channel_names import seconds_per

_UNITS = ("unit_string", "NI_UnitDescription", "Unit", "unit")
_NO_TIME = "its channels have no wf_increment, and none of them is named time"


@dataclass(frozen=True, slots=True)
class _Grid:
    """Number of samples, the first instant and the step [s]; or why there is no time."""

    samples: int
    start: float = 0.0
    step: float = 0.0
    without_time: str = ""

    @property
    def time(self) -> NDArray[np.float64] | None:
        return None if self.without_time else self.start + self.step * np.arange(self.samples, dtype=np.float64)


def read_tdms(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels of numbers, group by group; those of one group on several time bases make several.

    Raises
    ------
    DataError : a damaged file, an index without its file
    """
    with _opened(path) as file:
        begin = _earliest(file)
        warnings = _incomplete(path, file)
        return tuple(
            with_own_time(
                ChannelGroup(
                    name if number == 0 else f"{name}, other times {number}",
                    tuple(RecordedChannel(channel.name, _unit(channel)) for channel in channels),
                    grid.samples,
                    grid.time,
                    partial(_values, path, name, [channel.name for channel in channels]),
                    grid.without_time,
                    warnings,
                )
            )
            for name, bases in _by_times(file, begin)
            for number, (grid, channels) in enumerate(bases)
        )


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    import nptdms  # noqa: PLC0415 - the package of this format alone

    with quietly(path, "nptdms", "tdms_damaged"), path.open("rb") as data, nptdms.TdmsFile.open(data) as file:
        yield file


def _by_times(file: Any, begin: np.datetime64 | None) -> Iterator[tuple[str, list[tuple[_Grid, list[Any]]]]]:
    """Groups with their channels by time base; channels that hold no numbers are left out."""
    for group in file.groups():
        bases: dict[_Grid, list[Any]] = {}
        for channel in group.channels():
            if (_is_number(channel) or _is_stamps(channel)) and len(channel):
                bases.setdefault(_grid(channel, begin), []).append(channel)
        if bases:
            yield group.name, list(bases.items())


def _is_number(channel: Any) -> bool:
    return channel.dtype is not None and np.dtype(channel.dtype).kind in "iuf"


def _is_stamps(channel: Any) -> bool:
    """Whether a channel is time as stamps of date and time."""
    return channel.dtype is not None and np.dtype(channel.dtype).kind == "M" and named(channel.name).is_time


def _grid(channel: Any, begin: np.datetime64 | None) -> _Grid:
    step = _number(channel, "wf_increment")
    if not step > 0.0:
        return _Grid(len(channel), without_time=_NO_TIME)
    seconds, without = _abscissa(channel)
    if without:
        return _Grid(len(channel), without_time=without)
    start = _number(channel, "wf_start_offset") * seconds
    if begin is not None:
        start += float((_stamp(channel) - begin) / np.timedelta64(1, "ns")) * 1e-9
    return _Grid(len(channel), start, step * seconds)


def _abscissa(channel: Any) -> tuple[float, str]:
    """Seconds in the unit of increment and offset, and why they are no time: increments of a spectrum are in Hz."""
    unit, name = (str(channel.properties.get(key, "")).strip() for key in ("wf_xunit_string", "wf_xname"))
    if unit:
        factor = seconds_per(unit)
        return (0.0, f"its channels are over {unit}, not over time") if factor is None else (float(factor), "")
    if name and not named(name).is_time:
        return 0.0, f"its channels are over {name}, not over time"
    return 1.0, ""


def _number(channel: Any, key: str) -> float:
    """Property of a channel, 0 where it is none or no number."""
    value = channel.properties.get(key)
    return float(value) if isinstance(value, int | float | np.number) and np.isfinite(value) else 0.0


def _stamp(channel: Any) -> np.datetime64:
    """Stamp of the first sample; not a time where there is none, or the zero of the format's clock."""
    stamp = channel.properties.get("wf_start_time")
    stamp = getattr(stamp, "as_datetime64", lambda _: stamp)("ns")
    if not isinstance(stamp, np.datetime64) or stamp < np.datetime64("1905-01-01"):
        return np.datetime64("NaT")
    at: np.datetime64 = stamp.astype("datetime64[ns]")
    return at


def _earliest(file: Any) -> np.datetime64 | None:
    """The earliest stamp of all channels with steps, None where one has none."""
    stamps = [
        _stamp(channel)
        for group in file.groups()
        for channel in group.channels()
        if _number(channel, "wf_increment") > 0.0 and len(channel) and not _abscissa(channel)[1]
    ]
    return min(stamps) if stamps and not any(np.isnat(stamp) for stamp in stamps) else None


def _unit(channel: Any) -> str:
    if _is_stamps(channel):
        return "s"
    found = (channel.properties.get(key) for key in _UNITS)
    return next((unit.strip() for unit in found if isinstance(unit, str) and unit.strip()), "")


def _incomplete(path: Path, file: Any) -> tuple[Problem, ...]:
    """Warning about a file that ends within its last segment."""
    if not file.file_status.incomplete_final_segment:
        return ()
    what = "the file ends within its last segment, as a recording does that was not stopped; what is there is read"
    empty = [one.name for group in file.groups() for one in group.channels() if _is_number(one) and not len(one)]
    if empty:
        what += f", nothing of {', '.join(map(repr, empty[:8]))}" + (f" and {len(empty) - 8} more" * (len(empty) > 8))
    return (Problem("cut", str(path), what, "Copy the file again if the recording itself was complete"),)


def _values(path: Path, group: str, names: Sequence[str], at: Sequence[int]) -> NDArray[np.floating]:
    """Samples (k, t) of some channels, scaled as the file says; stamps in seconds from the first of them."""
    with _opened(path) as file:
        rows = [np.asarray(file[group][names[k]][:]) for k in at]
        return np.stack([_seconds(row) if row.dtype.kind == "M" else row.astype(np.float64) for row in rows])


def _seconds(stamps: NDArray[np.datetime64]) -> NDArray[np.float64]:
    return np.asarray((stamps - stamps[0]) / np.timedelta64(1, "us")) * 1e-6
