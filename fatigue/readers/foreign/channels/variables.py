"""Channels among named arrays, as MATLAB and NumPy keep them: vectors and matrices beside a vector of time.

A structure is a group; its time is the vector in it with a name of time, else that of the structure around it. Several
vectors of time are told apart by their lengths. The columns of a matrix, or its rows, whichever are as long as time,
are channels named ``q(1)``, ``q(2)`` ... after it, by a list of as many names beside it, or by as many numbers of
modes. A structure of values, name and unit is a channel, and Simulink's structure with time is a group. A matrix alone
has time in its first column if that rises in even steps. What is no channel is told.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.channels.variable_times import Time, time_in_first, times_of
from fatigue.readers.units.channel_names import channel

_VALUES, _UNIT = ("values", "data", "value", "y", "samples"), ("unit", "units", "Unit", "Units")
_NAME = ("label", "name", "blockName", "title", "Name")
_MODES = re.compile(r"(?:eigen)?modes?(?:_?(?:ids?|n(?:o|r|umber)s?))?\Z", re.IGNORECASE)
_NAMES = re.compile(r"(?:name|label|channel|signal)s?\Z", re.IGNORECASE)
_NO_TIME = "none of its arrays is named time, and no matrix begins with an even time"
_TIMELESS = "and there is no time"


@dataclass(frozen=True, slots=True)
class Unreadable:
    """What cannot be read, as messages call it: ``an object of the class timeseries``."""

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


@dataclass(frozen=True, slots=True)
class _Rest:
    """An array or object that is no channel, and why."""

    name: str
    why: str
    is_object: bool = False


_Found: TypeAlias = _Column | _Rest


def groups_of_variables(path: Path, variables: Variables, remedy: str) -> tuple[ChannelGroup, ...]:
    """Channels of all arrays, those on one time in one group; ``remedy`` says how to save time and values as arrays.

    Raises
    ------
    DataError : complex numbers, a square matrix, objects in place of arrays, no array of use beside time
    """
    found = list(_columns(path, "", variables, ()))
    rest = [one for one in found if isinstance(one, _Rest)]
    bases: list[list[_Column]] = []
    for one in found:
        if isinstance(one, _Column):
            same = next((some for some in bases if _same_base(some[0], one)), None)
            if same is None:
                bases.append([one])
            else:
                same.append(one)
    told = "; ".join(f"{one.name} {one.why}" for one in rest[:5]) + ("; ..." if len(rest) > 5 else "")
    if not bases:
        code = "no_time" if any(one.why.endswith(_TIMELESS) for one in rest) else "no_channels"
        what = "no array in it is a channel" + (f": {told}" if told else "")
        raise DataError(Problem(code, str(path), what, remedy))
    if not any(one.is_object for one in rest):
        remedy = "Nothing to do if they are no channels"
    warnings = (Problem("channels_left_out", str(path), f"left out: {told}", remedy),) if rest else ()
    return tuple(
        ChannelGroup(
            some[0].group,
            tuple(one.channel for one in some),
            some[0].samples.size,
            some[0].time,
            partial(_values, [one.samples for one in some]),
            "" if some[0].time is not None else _NO_TIME,
            warnings,
        )
        for some in bases
    )


def cells(some: Sequence[Any]) -> Any:
    """The cells of an array as one variable: a list of texts, structures, a matrix of vectors as long, or by number."""
    texts = ["" if isinstance(one, np.ndarray) and one.size == 0 else one for one in some]
    if texts and all(isinstance(one, str) for one in texts):
        return tuple(one.strip() for one in texts)
    if some and all(isinstance(one, dict) for one in some):
        return some[0] if len(some) == 1 else list(some)
    vectors = [np.squeeze(one) for one in some if isinstance(one, np.ndarray)]
    if len(vectors) == len(some) > 1 and vectors[0].size > 1 and len({(v.ndim, v.size) for v in vectors}) == 1:
        return np.stack(vectors) if vectors[0].ndim == 1 else {f"({k})": v for k, v in enumerate(vectors, 1)}
    return {f"({number})": one for number, one in enumerate(some, 1)}


def in_order(variables: Variables) -> Variables:
    """Variables with those of one name and a number in the order of these: files keep them by the alphabet."""
    stems: dict[str, int] = {}
    place = {
        name: (stems.setdefault(re.sub(r"\d+", "", name), len(stems)), [int(n) for n in re.findall(r"\d+", name)])
        for name in variables
    }
    return {name: variables[name] for name in sorted(variables, key=place.__getitem__)}


def _same_base(a: _Column, b: _Column) -> bool:
    if a.group != b.group or a.samples.size != b.samples.size:
        return False
    return a.time is b.time or (a.time is not None and b.time is not None and np.array_equal(a.time, b.time))


def _columns(path: Path, group: str, variables: Variables, around: Sequence[Time]) -> Iterator[_Found]:
    """Channels of one structure and of those in it; ``around`` are the times of the structure around it."""
    if "signals" in variables and "time" in variables:
        yield from _simulink(path, group, variables)
        return
    own = times_of(path, group, variables)
    times = own or around
    if not times and (alone := _alone(path, group, variables)) is not None:
        yield from alone
        return
    for key, value in variables.items():
        called = f"{group}.{key}" if group else key
        if isinstance(value, np.ndarray) and not any(time.name == key for time in own):
            unit = _text(variables, (f"{key}_unit", f"{key}_units"))
            yield from _of_array(path, group, key, value, times, variables, unit)
        elif isinstance(value, Mapping) and not any(time.name == key for time in own):
            yield from _of_structure(path, called, value, times)
        elif isinstance(value, list):
            for number, one in enumerate(value, 1):
                yield from _of_structure(path, f"{called}({number})", one, times)
        elif isinstance(value, Unreadable):
            yield _Rest(called, f"is {value.kind}, which cannot be read", True)


def _of_structure(path: Path, called: str, one: Variables, times: Sequence[Time]) -> Iterator[_Found]:
    """A structure that is a channel, with values and perhaps name, unit and time, or one that holds channels."""
    key = next((key for key in _VALUES if isinstance(one.get(key), np.ndarray)), None)
    own = times_of(path, called, one) if key is not None else ()
    if key is None or "signals" in one or _holds_more(one, key, own):
        yield from _columns(path, called, one, times)
        return
    name = _text(one, _NAME) or called
    group = called if own else called.rpartition(".")[0]
    yield from _of_array(path, group, name, one[key], own or times, {}, _text(one, _UNIT))


def _holds_more(one: Variables, key: str, times: Sequence[Time]) -> bool:
    """Whether a structure has arrays as large as its values, or structures: it is no single channel then."""
    size = one[key].size
    others = [value for name, value in one.items() if name != key and all(name != time.name for time in times)]
    return any(
        isinstance(value, Mapping | list) or (isinstance(value, np.ndarray) and value.size >= size > 1)
        for value in others
    )


def _simulink(path: Path, group: str, variables: Variables) -> Iterator[_Found]:
    """Simulink's structure with time: signals, each with values and a label."""
    times = times_of(path, group, variables)
    signals = variables["signals"]
    for number, one in enumerate(signals if isinstance(signals, list) else [signals], 1):
        if isinstance(one, Mapping) and isinstance(values := one.get("values"), np.ndarray):
            name = _text(one, _NAME) or _text(variables, ("blockName",)) or f"signal {number}"
            yield from _of_array(path, group, name, values, times, {}, _text(one, _UNIT))


def _of_array(
    path: Path,
    group: str,
    name: str,
    values: NDArray[np.generic],
    times: Sequence[Time],
    beside: Variables,
    unit: str,
) -> Iterator[_Found]:
    """Channels of one array, if it is as long as one of the times; names and numbers may stand ``beside`` it."""
    samples = np.squeeze(values)
    called = f"{group}.{name}" if group and not name.startswith(group) else name
    if samples.size < 2:
        return
    if samples.dtype.kind not in "iufbc":
        yield _Rest(called, f"holds no numbers ({samples.dtype})")
        return
    fitting = [time for time in times if samples.ndim <= 2 and time.seconds.size in samples.shape]
    if not fitting and _MODES.match(name):
        return
    if (times and not fitting) or (not times and samples.ndim > 1):
        shape = " x ".join(map(str, samples.shape))
        lengths = " or ".join(str(time.seconds.size) for time in times)
        yield _Rest(called, f"has {shape} values, " + (f"and time {lengths}" if times else _TIMELESS))
        return
    where = f"{path}, array {called!r}"
    if samples.dtype.kind == "c":
        raise DataError(Problem("complex", where, "its numbers are complex", "Save real time histories"))
    time = fitting[0] if fitting else None
    seconds = time.seconds if time else None
    if time is not None and len(times) > 1:
        group = f"{group}.{time.name}" if group else time.name
    if samples.ndim == 1:
        yield _Column(group, RecordedChannel(name, unit), samples, seconds)
        return
    if len(fitting) > 1 or samples.shape[0] == samples.shape[1]:
        what = f"it has {samples.shape[0]} rows and {samples.shape[1]} columns, both as many as samples"
        remedy = "Save another number of samples, or one vector per channel"
        raise DataError(Problem("ambiguous", where, f"{what}: which are channels cannot be told", remedy))
    rows = samples.T if seconds is not None and samples.shape[0] == seconds.size else samples
    for one, row in zip(_named(where, name, len(rows), unit, beside), rows, strict=True):
        yield _Column(group, one, row, seconds)


def _named(where: str, name: str, count: int, unit: str, beside: Variables) -> list[RecordedChannel]:
    """Channels of a matrix, by the lists of names, units and numbers of modes beside it that have as many entries.

    Raises
    ------
    DataError : several lists that may be its names
    """
    matrices = [
        key for key, v in beside.items() if isinstance(v, np.ndarray) and np.squeeze(v).ndim == 2 and count in v.shape
    ]
    lists = {key: value for key, value in beside.items() if isinstance(value, tuple) and len(value) == count}
    parts = {key: re.split(r"[_.]", key.lower()) for key in lists}
    own = [key for key in lists if name.lower() in parts[key]]
    shared = [key for key in lists if not any(other.lower() in parts[key] for other in matrices)]
    units = [key for key in own or shared if parts[key][-1] in ("unit", "units")]
    named = [key for key in own or shared if key not in units]
    chosen = [key for key in named if _NAMES.search(key)] or named
    if len(chosen) > 1:
        what = f"its channels may be named by {' or '.join(map(repr, chosen))}"
        raise DataError(Problem("ambiguous", where, what, f"Call the names {name}_names"))
    modes = _modes(count, beside)
    names = [f"{name}_{mode}" if mode else f"{name}({k})" for k, mode in enumerate(modes, 1)]
    if chosen:
        names = [one if own or len(matrices) < 2 else f"{name} {one}" for one in lists[chosen[0]]]
    each = lists[units[0]] if len(units) == 1 else (unit,) * count
    return [RecordedChannel(one, of, mode) for one, of, mode in zip(names, each, modes, strict=True)]


def _modes(count: int, beside: Variables) -> list[int]:
    """Numbers of modes from a vector called so, zeros where there is none."""
    for key, value in beside.items():
        if _MODES.match(key) and isinstance(value, np.ndarray) and value.size == count and value.dtype.kind in "iuf":
            numbers = value.ravel().astype(np.float64)
            if (numbers == np.round(numbers)).all() and numbers.min() >= 1 and np.unique(numbers).size == count:
                return [int(number) for number in numbers]
    return [0] * count


def _alone(path: Path, group: str, variables: Variables) -> list[_Column] | None:
    """Channels of the only matrix, if its first column or row is an even time; None otherwise."""
    arrays = [(key, np.squeeze(value)) for key, value in variables.items() if isinstance(value, np.ndarray)]
    matrices = [(key, value) for key, value in arrays if value.ndim == 2 and value.dtype.kind in "iuf"]
    if len(matrices) != 1:
        return None
    (name, matrix) = matrices[0]
    rows = matrix.T if matrix.shape[0] >= matrix.shape[1] else matrix
    where = f"{path}, array {f'{group}.{name}' if group else name!r}"
    time = time_in_first(where, rows)
    if time is None:
        return None
    with_time = [
        v for v in variables.values() if isinstance(v, tuple) and len(v) == len(rows) and channel(v[0]).is_time
    ]
    beside = {**variables, "": with_time[0][1:]} if len(with_time) == 1 else variables
    named = _named(where, name, len(rows) - 1, "", beside)
    return [_Column(group, one, row, time) for one, row in zip(named, rows[1:], strict=True)]


def _text(variables: Variables, keys: Sequence[str]) -> str:
    """First text of these names; empty where there is none."""
    return next((value.strip() for key in keys if isinstance(value := variables.get(key), str) and value.strip()), "")


def _values(rows: Sequence[NDArray[np.generic]], at: Sequence[int]) -> NDArray[np.floating]:
    """Samples (k, t) of some channels."""
    return np.stack([rows[k].astype(np.float64) for k in at])
