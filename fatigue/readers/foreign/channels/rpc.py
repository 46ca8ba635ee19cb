"""Channels of an RPC III time history (.rsp, .drv, .tim), as MTS describes the format.

A header of blocks of 512 bytes has records of 128: a key of 32 and a value of 96 characters. The samples follow in
groups, channel after channel in each: ``PTS_PER_GROUP`` whole numbers of 16 bits or floating point numbers of 32. The
last group is filled up. A whole number times ``SCALE.CHAN_n`` is the value.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel

_BLOCK, _RECORD, _KEY = 512, 128, 32
_ORDER = {"BINARY_IEEE_LITTLE_END": "<", "BINARY_IEEE_BIG_END": ">", "BINARY": "<"}
_KINDS = {"SHORT_INTEGER": "i2", "FLOATING_POINT": "f4"}
_MOST_BLOCKS = 16_384  # 256 channels have some 500


@dataclass(frozen=True, slots=True)
class _Layout:
    """Where samples lie: in groups, channel after channel, ``last`` of each channel in the last one."""

    stored: np.dtype[np.generic]
    start: int
    channels: int
    group: int
    samples: int
    last: int
    is_filled: bool


def read_rpc(path: Path) -> tuple[ChannelGroup, ...]:
    """The channels of a time history; their samples are read when they are asked for.

    Raises
    ------
    DataError : another content than a time history, a header that lacks something or makes no sense, a file that is cut
    """
    with path.open("rb") as file:
        head = _header(path, file.read(_BLOCK * _MOST_BLOCKS))
    if (content := head.get("FILE_TYPE", "TIME_HISTORY")) != "TIME_HISTORY":
        what = f"the file holds {content.lower().replace('_', ' ')}, no time history"
        raise DataError(Problem("no_channels", str(path), what, "Export the time history"))
    order, kind = _choice(path, head, "FORMAT", _ORDER), _choice(path, head, "DATA_TYPE", _KINDS, "SHORT_INTEGER")
    channels = _whole(path, head, "CHANNELS", 1)
    group = _whole(path, head, "PTS_PER_GROUP", 1)
    samples = _samples(path, head, group)
    start = _BLOCK * _whole(path, head, "NUM_HEADER_BLOCKS", 1)
    step = _real(path, head, "DELTA_T")
    if not step > 0.0:
        _refuse(path, f"DELTA_T is {head['DELTA_T']}")
    stored = np.dtype(order + kind)
    last = samples - (-(-samples // group) - 1) * group  # of the last group, the rest of which is filling
    needed = start + stored.itemsize * channels * group * -(-samples // group)
    unfilled = start + stored.itemsize * channels * samples
    there = path.stat().st_size
    if there < needed and there != unfilled:
        what = (
            f"the file has {there} bytes; {channels} channels of {samples} samples, as its header says, take {needed}"
        )
        raise DataError(Problem("cut", str(path), what, "Copy the file again"))
    layout = _Layout(stored, start, channels, group, samples, last, is_filled=there >= needed)
    scale = np.ones(channels)
    if kind == "i2":
        scale = np.array([_real(path, head, f"SCALE.CHAN_{k + 1}") for k in range(channels)])
    values = partial(_values, path, layout, scale)
    named = tuple(_channel(head, k + 1) for k in range(channels))
    warnings = _filling(path, layout, _whole(path, head, "PTS_PER_FRAME", 1), step)
    return (ChannelGroup("", named, samples, step * np.arange(samples, dtype=np.float64), values, "", warnings),)


def _header(path: Path, head: bytes) -> dict[str, str]:
    """Values of the header by their keys."""
    first = _records(head[:_BLOCK])
    blocks = _whole(path, first, "NUM_HEADER_BLOCKS", 1)
    if blocks > _MOST_BLOCKS or len(head) < _BLOCK * blocks:
        what = f"its header is said to have {blocks} blocks of {_BLOCK} bytes, more than the file has"
        raise DataError(Problem("cut", str(path), what, "Copy the file again"))
    return _records(head[: _BLOCK * blocks])


def _records(head: bytes) -> dict[str, str]:
    found: dict[str, str] = {}
    for at in range(0, len(head) - _RECORD + 1, _RECORD):
        key, value = head[at : at + _KEY], head[at + _KEY : at + _RECORD]
        name = key.split(b"\0")[0].decode("cp1252", "replace").strip()
        if name:
            found.setdefault(name.upper(), value.split(b"\0")[0].decode("cp1252", "replace").strip())
    return found


def _samples(path: Path, head: Mapping[str, str], group: int) -> int:
    """Samples of each channel: frames, a half one behind them where the header says so; or their number itself."""
    frame = _whole(path, head, "PTS_PER_FRAME", 1)
    if group % frame:
        _refuse(path, f"a group of {group} samples is no whole number of frames of {frame}")
    samples = frame * _whole(path, head, "FRAMES", 0)
    if head.get("HALF_FRAMES", "0") not in ("", "0"):
        samples += frame // 2 * _whole(path, head, "HALF_FRAMES", 0)
    stated = _whole(path, head, "SAMPLES", 1) if "SAMPLES" in head else samples
    samples = min(samples, stated)  # the last frame may be filled up
    if samples < 1:
        _refuse(path, "the time history has no frames")
    return samples


def _channel(head: Mapping[str, str], number: int) -> RecordedChannel:
    return RecordedChannel(head.get(f"DESC.CHAN_{number}", ""), head.get(f"UNITS.CHAN_{number}", ""))


def _values(path: Path, layout: _Layout, scale: NDArray[np.float64], at: Sequence[int]) -> NDArray[np.floating]:
    """Samples (k, t) of the channels at some positions."""
    wanted = list(at)
    blocks, end = _stored(path, layout)
    found = np.concatenate([blocks[:, wanted].swapaxes(0, 1).reshape(len(wanted), -1), end[wanted]], axis=1)
    with np.errstate(invalid="ignore"):  # of numbers that are none, which are refused by their place
        return np.asarray(found * scale[wanted, None])


def _stored(path: Path, layout: _Layout) -> tuple[NDArray[Any], NDArray[Any]]:
    """Whole groups (g, c, n) as they are stored, and samples (c, last) of the last one."""
    channels, group = layout.channels, layout.group
    whole = (layout.samples - layout.last) // group
    rest = group if layout.is_filled else layout.last
    flat = np.memmap(path, layout.stored, "r", layout.start, (channels * (whole * group + rest),))
    blocks, end = flat[: whole * channels * group], flat[whole * channels * group :]
    return blocks.reshape(whole, channels, group), end.reshape(channels, rest)[:, : layout.last]


def _filling(path: Path, layout: _Layout, frame: int, step: float) -> tuple[Problem, ...]:
    """Warning about a last frame that seems to be filled up: no key says how many of its samples were recorded."""
    end = _stored(path, layout)[1][:, -frame - 1 :]  # a group may be the whole record
    held = int(np.cumprod((end == end[:, -1:]).all(axis=0)[::-1]).sum())  # samples that equal the last one
    is_zero = not end[:, -1].any()
    filled = held if is_zero else held - 1
    if not 2 <= filled < min(frame, layout.samples):
        return ()
    at = step * (layout.samples - filled)
    what = f"the last {filled} samples, from {at:.9g} s on, "
    what += (
        f"are {'0' if is_zero else 'those before them'} in all channels, as where a last frame of {frame} is filled up"
    )
    remedy = "If they were not recorded, export the record again so that it ends with a whole frame"
    return (Problem("filled_up", str(path), what, remedy),)


def _choice(path: Path, head: Mapping[str, str], key: str, known: Mapping[str, str], default: str = "") -> str:
    value = head.get(key, default).upper()
    if value not in known:
        _refuse(path, f"{key} is {value or 'missing'}, where {' or '.join(known)} is read")
    return known[value]


def _whole(path: Path, head: Mapping[str, str], key: str, least: int) -> int:
    value = head.get(key, "")
    if not (value.isascii() and value.isdecimal() and len(value) < 12 and int(value) >= least):
        _refuse(path, f"{key} is {value!r}, no whole number from {least} on" if value else f"{key} is missing")
    return int(value)


def _real(path: Path, head: Mapping[str, str], key: str) -> float:
    try:
        value = float(head.get(key, "").upper().replace("D", "E"))
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        _refuse(path, f"{key} is {head[key]!r}, no number" if head.get(key) else f"{key} is missing")
    return float(value)


def _refuse(path: Path, what: str) -> NoReturn:
    raise DataError(Problem("rpc_header", f"{path}, header", what, "Export the file again, as RPC III"))
