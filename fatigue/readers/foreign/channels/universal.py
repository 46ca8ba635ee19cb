"""Time histories of a universal file, data sets 58 and 58b, read with the package pyuff; others are passed over."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.channels.quiet import quietly
from fatigue.readers.units.channel_names import seconds_per

_KINDS = {2: "auto spectra", 3: "cross spectra", 4: "frequency response functions", 6: "coherence", 12: "spectra"}
_TIME = (0, 17)  # unknown, or time, as specific data type of the abscissa
_HISTORY = (0, 1)  # general or unknown, or time response, as function type
_NOTHING = ("", "NONE")


def read_universal(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels of the file, those with the same instants in one group.

    Raises
    ------
    DataError : no data set 58, spectra in place of time histories, complex values, a damaged file
    """
    sets = _sets(path)
    if not sets:
        what = "the universal file has no data set 58, which holds time histories"
        raise DataError(Problem("no_channels", str(path), what, "Export the time histories as data sets 58"))
    refuse(DataError, [problem for one in sets if (problem := _problem(path, one)) is not None])
    names = _names(sets)
    groups: list[tuple[NDArray[np.float64], list[int]]] = []
    for number, one in enumerate(sets):
        time = _time(path, names[number], one)
        same = next((at for base, at in groups if base.size == time.size and np.array_equal(base, time)), None)
        if same is None:
            groups.append((time, [number]))
        else:
            same.append(number)
    return tuple(
        ChannelGroup(
            f"data set {at[0] + 1}" if len(groups) > 1 else "",
            tuple(RecordedChannel(names[k], _label(sets[k], "ordinate_axis_units_lab")) for k in at),
            time.size,
            time,
            partial(_values, [sets[k] for k in at]),
        )
        for time, at in groups
    )


def _sets(path: Path) -> list[Mapping[str, Any]]:
    """All data sets 58 of a file."""
    import pyuff  # noqa: PLC0415 - the package of this format alone

    with quietly(path, "pyuff", "uff_damaged"):
        file = pyuff.UFF(str(path))
        kinds = np.asarray(file.get_set_types())
        found = [file.read_sets(int(k)) for k in np.flatnonzero(kinds == 58)]
    return [one for one in found if isinstance(one, Mapping)]


def _problem(path: Path, one: Mapping[str, Any]) -> Problem | None:
    """Why a data set is no time history of real numbers; None if it is one."""
    where = f"{path}, data set 58 of {_label(one, 'id1')!r}"
    kind = int(one.get("func_type", 0))
    if kind not in _HISTORY:
        what = f"it holds {_KINDS.get(kind, f'functions of type {kind}')}, no time history"
        return Problem("no_channels", where, what, "Export time histories only")
    if int(one.get("abscissa_spec_data_type", 17)) not in _TIME:
        return Problem("no_time", where, "its abscissa is no time", "Export channels over time")
    data = np.asarray(one.get("data", ()))
    if np.iscomplexobj(data):
        return Problem("complex", where, "its values are complex", "Export time histories")
    promised = int(one.get("num_pts", data.size))
    if data.size != promised or data.size == 0:
        what = f"it has {data.size} samples, its header promises {promised}"
        return Problem("cut", where, what, "Copy the file again")
    return None


def _time(path: Path, name: str, one: Mapping[str, Any]) -> NDArray[np.float64]:
    """Instants [s] of a data set: its own, or even ones from its start."""
    count = len(one["data"])
    unit = _label(one, "abscissa_axis_units_lab")
    factor = seconds_per(unit) if unit else 1
    if factor is None:
        where, what = f"{path}, channel {name!r}", f"its abscissa is in {unit!r}, which is no unit of time"
        raise DataError(Problem("time_unit", where, what, "Export in s"))
    if int(one.get("abscissa_spacing", 1)) == 0:
        return np.asarray(one["x"], np.float64) * float(factor)
    start, step = float(one["abscissa_min"]), float(one["abscissa_inc"])
    return (start + step * np.arange(count, dtype=np.float64)) * float(factor)


def _names(sets: Sequence[Mapping[str, Any]]) -> list[str]:
    """Names of the channels: the first line of text by which they differ, else the node and its direction."""
    for line in ("id1", "id2", "id4", "id5"):  # the third is the date
        names = [_label(one, line) for one in sets]
        if all(names) and len(set(names)) == len(names):
            return names
    return [
        f"{_label(one, 'rsp_ent_name') or 'node'} {one.get('rsp_node', 0)} {_direction(one)}".strip() for one in sets
    ]


def _direction(one: Mapping[str, Any]) -> str:
    number = int(one.get("rsp_dir", 0))
    axis = ("", "x", "y", "z", "rx", "ry", "rz")[abs(number)] if abs(number) <= 6 else ""
    return f"-{axis}" if number < 0 else axis


def _label(one: Mapping[str, Any], key: str) -> str:
    text = str(one.get(key, "")).strip()
    return "" if text.upper() in _NOTHING else text


def _values(sets: Sequence[Mapping[str, Any]], at: Sequence[int]) -> NDArray[np.floating]:
    """Samples (k, t) of some channels."""
    return np.stack([np.asarray(sets[k]["data"], np.float64) for k in at])
