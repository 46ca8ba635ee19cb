"""Time histories of a universal file, data sets 58 and 58b, read with the package pyuff; others are passed over.

A data set states the unit of its values as a label; displacements without one are in the length of data set 164.
"""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.channels.coordinates import called_q
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel
from fatigue.readers.foreign.channels.quiet import quietly
from fatigue.readers.units.channel_names import channel, seconds_per

_KINDS = {
    2: "auto spectra",
    3: "cross spectra",
    4: "frequency response functions",
    5: "transmissibilities",
    6: "coherence",
    7: "auto correlation",
    8: "cross correlation",
    9: "power spectral densities",
    10: "energy spectral densities",
    12: "spectra",
}
_UNKNOWN, _TIME = 0, 17  # specific data types of the abscissa
_DISPLACEMENT = 8  # specific data type of the ordinate
_GENERAL, _HISTORY = 0, 1  # function types: general or unknown, time response
_IEEE = 2  # of the formats of floating point numbers in 58b; 1 is DEC, 3 is IBM
_LENGTHS = {1.0: "m", 100.0: "cm", 1000.0: "mm", 39.37: "in", 3.2808: "ft"}  # by how many there are in a metre
_NOTHING = ("", "NONE")


def read_universal(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels of the file, those with the same instants in one group.

    Raises
    ------
    DataError : no data set 58, spectra in place of time histories, complex values, a damaged file
    """
    found, length = _sets(path)
    if not found:
        what = "the universal file has no data set 58, which holds time histories"
        raise DataError(Problem("no_channels", str(path), what, "Export the time histories as data sets 58"))
    others = [(one, what) for one in found if (what := _other(one))]
    sets = [one for one in found if not _other(one)]
    if not sets:
        raise DataError(*(_refused(path, one, what) for one, what in others[:5]))
    refuse(DataError, [problem for one in sets if (problem := _damage(path, one)) is not None])
    names = _names(sets)
    groups: list[tuple[NDArray[np.float64], list[int]]] = []
    for number, one in enumerate(sets):
        time = _time(path, names[number], one)
        same = next((at for base, at in groups if base.size == time.size and np.array_equal(base, time)), None)
        if same is None:
            groups.append((time, [number]))
        else:
            same.append(number)
    warnings = _left_out(path, others)
    return tuple(
        ChannelGroup(
            f"data set {at[0] + 1}" if len(groups) > 1 else "",
            tuple(RecordedChannel(names[k], _unit(sets[k], length)) for k in at),
            time.size,
            time,
            partial(_values, [sets[k] for k in at]),
            warnings=warnings,
        )
        for time, at in groups
    )


def _sets(path: Path) -> tuple[list[Mapping[str, Any]], str]:
    """All data sets 58 of a file, and the unit of length that its data set 164 states."""
    import pyuff  # noqa: PLC0415 - the package of this format alone

    with quietly(path, "pyuff", "uff_damaged"):
        file = pyuff.UFF(str(path))
        kinds = np.asarray(file.get_set_types())
        found = [file.read_sets(int(k)) for k in np.flatnonzero(kinds == 58)]
        units = [file.read_sets(int(k)) for k in np.flatnonzero(kinds == 164)[:1]]
    per_metre = float(units[0]["length"]) if units and "length" in units[0] else np.nan
    length = next((unit for many, unit in _LENGTHS.items() if np.isclose(per_metre, many, rtol=1e-4)), "")
    return [one for one in found if isinstance(one, Mapping)], length


def _other(one: Mapping[str, Any]) -> str:
    """What a data set holds in place of a time history of real numbers; empty if it is one."""
    kind, abscissa = int(one.get("func_type", _GENERAL)), int(one.get("abscissa_spec_data_type", _TIME))
    if kind not in (_GENERAL, _HISTORY):
        return f"it holds {_KINDS.get(kind, f'functions of type {kind}')}, no time history"
    if abscissa not in (_UNKNOWN, _TIME):
        return "its abscissa is no time"
    label, unit = _label(one, "abscissa_axis_lab"), _label(one, "abscissa_axis_units_lab")
    if (kind, abscissa) == (_GENERAL, _UNKNOWN) and seconds_per(unit) is None and not channel(label).is_time:
        return "it is a general function, and nothing says that its abscissa is time"
    return "its values are complex" if np.iscomplexobj(np.asarray(one.get("data", ()))) else ""


def _refused(path: Path, one: Mapping[str, Any], what: str) -> Problem:
    where = f"{path}, data set 58 of {_label(one, 'id1')!r}"
    return Problem("no_channels", where, what, "Export channels over time, as time responses of real numbers")


def _left_out(path: Path, others: Sequence[tuple[Mapping[str, Any], str]]) -> tuple[Problem, ...]:
    """Warning about data sets that are passed over beside time histories."""
    if not others:
        return ()
    one, said = others[0]
    many = f"{len(others)} data sets 58 that are no time histories are" if len(others) > 1 else "a data set 58 is"
    what = f"{many} left out; that of {_label(one, 'id1')!r}: {said}"
    return (Problem("channels_left_out", str(path), what, "Nothing, unless they are channels over time"),)


def _damage(path: Path, one: Mapping[str, Any]) -> Problem | None:
    """Why the values of a data set cannot be what was written; None if they can."""
    where = f"{path}, data set 58 of {_label(one, 'id1')!r}"
    if one.get("binary") and int(one.get("fp_format", _IEEE)) != _IEEE:
        what = (
            f"its numbers are in the floating point format {one['fp_format']} (1 is DEC, 3 is IBM), which is not read"
        )
        return Problem("uff_damaged", where, what, "Export it as IEEE, or as text")
    data = np.asarray(one.get("data", ()))
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
    """Names of the channels: the line of text that calls all q, else the first by which they differ, else the node."""
    lines = [[_label(one, line) for one in sets] for line in ("id1", "id2", "id4", "id5")]  # the third is the date
    nodes = [
        f"{_label(one, 'rsp_ent_name') or 'node'} {one.get('rsp_node', 0)} {_direction(one)}".strip() for one in sets
    ]
    differ = [names for names in (*lines, nodes) if all(names) and len(set(names)) == len(names)]
    return next((names for names in differ if all(map(called_q, names))), differ[0] if differ else nodes)


def _direction(one: Mapping[str, Any]) -> str:
    number = int(one.get("rsp_dir", 0))
    axis = ("", "x", "y", "z", "rx", "ry", "rz")[abs(number)] if abs(number) <= 6 else ""
    return f"-{axis}" if number < 0 else axis


def _label(one: Mapping[str, Any], key: str) -> str:
    text = str(one.get(key, "")).strip()
    return "" if text.upper() in _NOTHING else text


def _unit(one: Mapping[str, Any], length: str) -> str:
    """Unit of the values: the label of the data set, for displacements without one that of the file."""
    is_length = int(one.get("ordinate_spec_data_type", 0)) == _DISPLACEMENT
    return _label(one, "ordinate_axis_units_lab") or (length if is_length else "")


def _values(sets: Sequence[Mapping[str, Any]], at: Sequence[int]) -> NDArray[np.floating]:
    """Samples (k, t) of some channels."""
    return np.stack([np.asarray(sets[k]["data"], np.float64) for k in at])
