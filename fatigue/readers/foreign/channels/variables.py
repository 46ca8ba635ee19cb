"""Channels among named arrays, as MATLAB and NumPy keep them: vectors and matrices beside a vector of time.

A structure is a group; its time is the vector in it with a name of time, else that of the structure around it. The
columns of a matrix, or its rows, whichever are as long as time, are channels named ``q(1)``, ``q(2)`` ... after it, or
by a list of as many names beside it. A structure of values, name and unit is a channel, and Simulink's structure with
time is a group. A matrix alone has time in its first column if that rises in even steps.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.units.channel_names import channel, seconds_per

_VALUES, _UNIT = ("values", "data", "value", "y", "samples"), ("unit", "units", "Unit", "Units")
_NAME = ("label", "name", "blockName", "title", "Name")
_NO_TIME = "none of its arrays is named time, and no matrix begins with an even time"


@dataclass(frozen=True, slots=True)
class Unreadable:
    """An object that cannot be read, by the name of its class."""

    kind: str


Variables: TypeAlias = Mapping[str, Any]
"""By name: an array of numbers, a text, a tuple of texts, ``Variables``, a list of these, or ``Unreadable``."""


@dataclass(frozen=True, slots=True, eq=False)
class _Column:
    """One channel found: where, its name and unit, its samples, and the time it stands on."""

    group: str
    channel: RecordedChannel
    samples: NDArray[np.generic]
    time: NDArray[np.float64] | None


def groups_of_variables(path: Path, variables: Variables) -> tuple[ChannelGroup, ...]:
    """Channels of all arrays, those on one time in one group.

    Raises
    ------
    DataError : complex numbers, a square matrix, objects in place of arrays, an array of no use beside time
    """
    found = list(_columns(path, "", variables, None))
    if not found:
        unreadable = list(_unreadable("", variables))
        what = "no array in it is a channel"
        if unreadable:
            name, kind = unreadable[0]
            what = f"{name} is an object of the class {kind}, which can be read by MATLAB alone"
        remedy = "Save time and values as plain arrays: t = x.Time; q = x.Data; save('run.mat', 't', 'q', '-v7.3')"
        raise DataError(Problem("no_channels", str(path), what, remedy))
    bases: list[list[_Column]] = []
    for one in found:
        same = next((some for some in bases if _same_base(some[0], one)), None)
        if same is None:
            bases.append([one])
        else:
            same.append(one)
    return tuple(
        ChannelGroup(
            some[0].group,
            tuple(one.channel for one in some),
            some[0].samples.size,
            some[0].time,
            partial(_values, [one.samples for one in some]),
            "" if some[0].time is not None else _NO_TIME,
        )
        for some in bases
    )


def _same_base(a: _Column, b: _Column) -> bool:
    if a.group != b.group or a.samples.size != b.samples.size:
        return False
    return a.time is b.time or (a.time is not None and b.time is not None and np.array_equal(a.time, b.time))


def _columns(path: Path, group: str, variables: Variables, around: NDArray[np.float64] | None) -> Iterator[_Column]:
    """Channels of one structure and of those in it; ``around`` is the time of the structure around it."""
    if "signals" in variables and "time" in variables:
        yield from _simulink(path, group, variables)
        return
    own = _time(path, group, variables)
    time = around if own is None else own
    if time is None and (alone := _alone(path, group, variables)) is not None:
        yield from alone
        return
    names = [value for key, value in variables.items() if isinstance(value, tuple)]
    for key, value in variables.items():
        called = f"{group}.{key}" if group else key
        if isinstance(value, np.ndarray) and not channel(key).is_time:
            yield from _of_array(
                path, group, key, value, time, names, _text(variables, (f"{key}_unit", f"{key}_units"))
            )
        elif isinstance(value, Mapping):
            yield from _of_structure(path, called, value, time)
        elif isinstance(value, list):
            for number, one in enumerate(value, 1):
                yield from _of_structure(path, f"{called}({number})", one, time)


def _of_structure(path: Path, called: str, one: Variables, time: NDArray[np.float64] | None) -> Iterator[_Column]:
    """A structure that is a channel, with values and perhaps name, unit and time, or one that holds channels."""
    values = next((one[key] for key in _VALUES if isinstance(one.get(key), np.ndarray)), None)
    if values is None or "signals" in one:
        yield from _columns(path, called, one, time)
        return
    own = _time(path, called, one)
    name = _text(one, _NAME) or called
    group = called if own is not None and own is not time else called.rpartition(".")[0]
    yield from _of_array(path, group, name, values, time if own is None else own, [], _text(one, _UNIT))


def _simulink(path: Path, group: str, variables: Variables) -> Iterator[_Column]:
    """Simulink's structure with time: signals with values, and a label."""
    time, signals = _time(path, group, variables), variables["signals"]
    for number, one in enumerate(signals if isinstance(signals, list) else [signals], 1):
        values = one.get("values") if isinstance(one, Mapping) else None
        if isinstance(values, np.ndarray):
            name = _text(one, ("label",)) or f"{group or 'signals'}({number})"
            yield from _of_array(path, group, name, values, time, [], "")


def _of_array(
    path: Path,
    group: str,
    name: str,
    values: NDArray[np.generic],
    time: NDArray[np.float64] | None,
    names: Sequence[tuple[str, ...]],
    unit: str,
) -> Iterator[_Column]:
    """Channels of one array, if it is as long as time."""
    samples = np.squeeze(values)
    where = f"{path}, array {f'{group}.{name}' if group else name!r}"
    if samples.ndim == 0 or samples.size < 2 or samples.dtype.kind not in "iufbc":
        return
    if samples.dtype.kind == "c":
        raise DataError(Problem("complex", where, "its numbers are complex", "Save real time histories"))
    if samples.ndim == 1:
        if time is None or samples.size == time.size:
            yield _Column(group, RecordedChannel(name, unit), samples, time)
        return
    if samples.ndim > 2 or time is None or time.size not in samples.shape:
        return
    if samples.shape[0] == samples.shape[1]:
        what = f"it has {samples.shape[0]} rows and as many columns: which of them are channels cannot be told"
        raise DataError(Problem("ambiguous", where, what, "Save another number of samples, or one vector per channel"))
    rows = samples.T if samples.shape[0] == time.size else samples
    listed = [some for some in names if len(some) == len(rows)]
    given = listed[0] if len(listed) == 1 else tuple(f"{name}({k + 1})" for k in range(len(rows)))
    for one, row in zip(given, rows, strict=True):
        yield _Column(group, RecordedChannel(one, unit), row, time)


def _time(path: Path, group: str, variables: Variables) -> NDArray[np.float64] | None:
    """The vector with a name of time [s], in the unit that its name states; None where there is none."""
    found = [
        (key, np.squeeze(value))
        for key, value in variables.items()
        if isinstance(value, np.ndarray) and channel(key).is_time and np.squeeze(value).ndim == 1 and value.size > 1
    ]
    if not found:
        return None
    key, value = found[0]
    where = f"{path}, array {f'{group}.{key}' if group else key!r}"
    if value.dtype.kind not in "iuf":
        raise DataError(Problem("no_numbers", where, f"time is of the type {value.dtype}", "Save seconds as numbers"))
    others = [name for name, other in found[1:] if other.shape != value.shape or not np.array_equal(other, value)]
    if others:
        what = f"{others[0]!r} is time, too, and differs"
        raise DataError(Problem("several_times", where, what, "Save one vector of time, or structures with one each"))
    unit = channel(key).unit or _text(variables, (f"{key}_unit", f"{key}_units"))
    factor = seconds_per(unit) if unit else 1
    if factor is None:
        raise DataError(Problem("time_unit", where, f"{unit!r} is no unit of time", "Save seconds"))
    return value.astype(np.float64) * float(factor)


def _alone(path: Path, group: str, variables: Variables) -> list[_Column] | None:
    """Channels of the only matrix, if its first column or row is an even time; None otherwise."""
    arrays = [(key, np.squeeze(value)) for key, value in variables.items() if isinstance(value, np.ndarray)]
    matrices = [(key, value) for key, value in arrays if value.ndim == 2 and value.dtype.kind in "iuf"]
    if len(matrices) != 1:
        return None
    (name, matrix) = matrices[0]
    rows = matrix.T if matrix.shape[0] >= matrix.shape[1] else matrix
    if len(rows) < 2 or not _is_even(rows[0].astype(np.float64)):
        return None
    names = [
        value for value in variables.values() if isinstance(value, tuple) and len(value) in (len(rows), len(rows) - 1)
    ]
    given = names[0][-(len(rows) - 1) :] if len(names) == 1 else tuple(f"{name}({k})" for k in range(1, len(rows)))
    time = rows[0].astype(np.float64)
    return [_Column(group, RecordedChannel(one), row, time) for one, row in zip(given, rows[1:], strict=True)]


def _is_even(values: NDArray[np.float64]) -> bool:
    """Whether values rise in even steps, as time does and no coordinate."""
    if values.size < 3 or not np.isfinite(values).all():
        return False
    step = (values[-1] - values[0]) / (values.size - 1)
    return bool(step > 0.0 and np.abs(np.diff(values) - step).max() < 1e-3 * step)


def _text(variables: Variables, keys: Sequence[str]) -> str:
    """First text of these names; empty where there is none."""
    return next((value.strip() for key in keys if isinstance(value := variables.get(key), str) and value.strip()), "")


def _unreadable(group: str, variables: Variables) -> Iterator[tuple[str, str]]:
    for key, value in variables.items():
        called = f"{group}.{key}" if group else key
        if isinstance(value, Unreadable):
            yield called, value.kind
        elif isinstance(value, Mapping):
            yield from _unreadable(called, value)


def _values(rows: Sequence[NDArray[np.generic]], at: Sequence[int]) -> NDArray[np.floating]:
    """Samples (k, t) of some channels."""
    return np.stack([rows[k].astype(np.float64) for k in at])
