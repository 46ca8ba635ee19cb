"""Channels of an ASAM MDF file of version 3 or 4, read with the package asammdf.

A group has a master channel, which has to be time. Conversions of the file are applied, samples that it marks as
invalid are missing; channels of text are left out, of arrays their elements are channels.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.channels.quiet import quietly
from fatigue.readers.units.channel_names import seconds_per

_NUMBERS_4, _NUMBERS_3 = frozenset(range(6)), frozenset({0, 1, 2, 3, 9, 10, 11, 12, 13, 14, 15, 16})
_TEXTS_4, _TEXTS_3 = frozenset({7, 8, 9, 10}), frozenset({11, 12})
_MASTERS = {2: "angle", 3: "distance", 4: "a count"}  # sync types of version 4; 1 is time


def read_mdf(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels of numbers, group by group, on the time of their master.

    Raises
    ------
    DataError : a damaged file, nothing but raw frames of a bus
    """
    with _opened(path) as file:
        groups = [group for number in range(len(file.groups)) if (group := _group(path, file, number)) is not None]
        groups = _with_own_names(groups)
        if not groups and any(_is_bus(group) for group in file.groups):
            what = "the file logs frames of a bus, not channels"
            remedy = "Decode it with its database (asammdf: extract_bus_logging), and give the result"
            raise DataError(Problem("no_channels", str(path), what, remedy))
    return tuple(groups)


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    import asammdf  # noqa: PLC0415 - the package of this format alone

    with quietly(path, "asammdf", "mdf_damaged"), asammdf.MDF(path) as file:
        yield file


def _group(path: Path, file: Any, number: int) -> ChannelGroup | None:
    """One group with its channels of numbers; None without any or without samples."""
    group = file.groups[number]
    is_new = str(file.version) >= "4"
    masters = {file.masters_db.get(number), *_masters(group, is_new)}
    wanted = [
        k
        for k, one in enumerate(group.channels)
        if k not in masters and _is_number(one, is_new) and not group.channel_dependencies[k]  # arrays have elements
    ]
    samples = int(group.channel_group.cycles_nr)
    if not wanted or not samples or _is_bus(group):
        return None
    name = str(getattr(group.channel_group, "acq_name", "") or getattr(group.channel_group, "comment", "") or "")
    time, without = _time(file, number, is_new)
    if time is not None and time.size != samples:
        what = f"group {number + 1} has {time.size} instants, its header promises {samples} samples"
        raise DataError(Problem("cut", str(path), what, "Copy the file again"))
    channels = tuple(RecordedChannel(str(group.channels[k].name), _unit(group.channels[k])) for k in wanted)
    called = name.strip().splitlines()[0][:60] if name.strip() and "<" not in name else f"{number + 1}"
    return ChannelGroup(called, channels, samples, time, partial(_values, path, number, wanted), without)


def _with_own_names(groups: Sequence[ChannelGroup]) -> list[ChannelGroup]:
    """Groups with names of their own: those that share one are counted."""
    names = [group.name for group in groups]
    return [
        replace(group, name=f"{group.name} ({names[: k + 1].count(group.name)})")
        if names.count(group.name) > 1
        else group
        for k, group in enumerate(groups)
    ]


def _masters(group: Any, is_new: bool) -> list[int]:
    """Positions of the master channels of a group, which may have one of time beside one of distance."""
    return [k for k, one in enumerate(group.channels) if int(one.channel_type) in ((2, 3) if is_new else (1,))]


def _time(file: Any, number: int, is_new: bool) -> tuple[NDArray[np.float64] | None, str]:
    """Instants [s] of a group, and why there are none."""
    channels, usual = file.groups[number].channels, file.masters_db.get(number)
    masters = sorted({*_masters(file.groups[number], is_new)} | ({usual} if usual is not None else set()))
    if not masters:
        return None, "the group has no master channel"
    kinds = [int(getattr(channels[k], "sync_type", 1)) if is_new else 1 for k in masters]
    at = next((k for k, kind in zip(masters, kinds, strict=True) if kind not in _MASTERS), None)
    if at is None:
        return None, f"its master channel {channels[masters[0]].name!r} is {_MASTERS[kinds[0]]}, not time"
    unit = _unit(channels[at])
    factor = seconds_per(unit) if unit else 1
    if factor is None:
        return None, f"its master channel {channels[at].name!r} is in {unit}, which is no unit of time"
    found = file.get_master(number) if at == usual else file.get(group=number, index=at).samples
    return np.asarray(found, np.float64) * float(factor), ""


def _is_number(one: Any, is_new: bool) -> bool:
    """Whether a channel holds numbers that are not turned into text."""
    kinds, texts = (_NUMBERS_4, _TEXTS_4) if is_new else (_NUMBERS_3, _TEXTS_3)
    conversion = getattr(one, "conversion", None)
    turned = conversion is not None and int(getattr(conversion, "conversion_type", 0)) in texts
    return int(one.data_type) in kinds and not turned


def _is_bus(group: Any) -> bool:
    """Whether a group holds raw frames of a bus."""
    return bool(getattr(group.channel_group, "flags", 0) & 0x2) and any(
        "DataFrame" in str(one.name) for one in group.channels
    )


def _unit(one: Any) -> str:
    conversion = getattr(one, "conversion", None)
    found = getattr(one, "unit", "") or (getattr(conversion, "unit", "") if conversion is not None else "")
    return str(found or "").strip()


def _values(path: Path, number: int, wanted: Sequence[int], at: Sequence[int]) -> NDArray[np.floating]:
    """Samples (k, t) of some channels, NaN where the file marks them as invalid."""
    with _opened(path) as file:
        rows = []
        for k in at:
            signal = file.get(group=number, index=wanted[k], ignore_invalidation_bits=True)  # else it drops them
            row = np.asarray(signal.samples).astype(np.float64)
            if row.ndim != 1:
                what = f"channel {signal.name!r} has arrays of {row.shape[1:]} values, no single ones"
                raise DataError(Problem("no_numbers", str(path), what, "Export its elements as channels"))
            invalid = signal.invalidation_bits
            if invalid is not None:
                row[np.asarray(invalid, np.bool_)] = np.nan
            rows.append(row)
        return np.stack(rows)
