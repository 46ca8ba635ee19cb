"""Which of named arrays are time: vectors with such a name, structures of values, the first column of a matrix."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.units.channel_names import channel, seconds_per


@dataclass(frozen=True, slots=True, eq=False)
class Time:
    """A vector of time (t,) [s], and the name of its array."""

    name: str
    seconds: NDArray[np.float64]


def times_of(path: Path, group: str, variables: Mapping[str, Any]) -> tuple[Time, ...]:
    """Vectors with a name of time, of different lengths, in the unit that its name or a text beside it states.

    A structure with a name of time and ``values`` or ``data`` is one, as SIMPACK writes it.

    Raises
    ------
    DataError : two of one length that differ, no numbers, a unit that is none of time
    """
    found: dict[int, Time] = {}
    for key, value in variables.items():
        vector, unit = _vector(variables, key, value)
        if vector is None or not channel(key).is_time or vector.ndim != 1 or vector.size < 2:
            continue
        where = f"{path}, array {f'{group}.{key}' if group else key!r}"
        if vector.dtype.kind not in "iuf":
            what = f"time is of the type {vector.dtype}"
            raise DataError(Problem("no_numbers", where, what, "Save seconds as numbers"))
        factor = seconds_per(unit) if unit else 1
        if factor is None:
            raise DataError(Problem("time_unit", where, f"{unit!r} is no unit of time", "Save seconds"))
        _refuse_dates(where, vector)
        time = Time(key, vector.astype(np.float64) * float(factor))
        other = found.setdefault(vector.size, time)
        if not np.array_equal(other.seconds, time.seconds):
            what = f"{other.name!r} is time, too, as long, and differs"
            raise DataError(Problem("several_times", where, what, "Rename what is no time, or save one structure each"))
    return tuple(found.values())


def _refuse_dates(where: str, vector: NDArray[np.generic]) -> None:
    """Refuse MATLAB's date numbers, days since the year 0, which would be taken for seconds."""
    first, last = float(vector[0]), float(vector[-1])
    if 7e5 < first < 8e5 and 0.0 < last - first < 2e-5 * vector.size:
        what = f"{first:.9g} to {last:.9g} look like date numbers, days since the year 0"
        raise DataError(Problem("date_column", where, what, "Save seconds: t = (t - t(1)) * 86400"))


def time_in_first(where: str, rows: NDArray[np.generic]) -> NDArray[np.float64] | None:
    """The first row of a matrix if it rises in even steps, as time does and no coordinate; None otherwise.

    Raises
    ------
    DataError : it counts the samples, which may be seconds or not
    """
    if len(rows) < 2 or rows.shape[1] < 3:
        return None
    first: NDArray[np.float64] = rows[0].astype(np.float64)
    step = (first[-1] - first[0]) / (first.size - 1)
    if not np.isfinite(first).all() or not step > 0.0 or np.abs(np.diff(first) - step).max() >= 1e-3 * step:
        return None
    if first[0] in (0.0, 1.0) and step == 1.0:
        what = (
            f"its first column counts {first[0]:.0f}, {first[1]:.0f}, {first[2]:.0f}: samples or seconds cannot be told"
        )
        raise DataError(Problem("no_time", where, what, "Save the time in seconds as an array of its own: t"))
    return first


def _vector(variables: Mapping[str, Any], key: str, value: Any) -> tuple[NDArray[np.generic] | None, str]:
    """Values of an array or of a structure of values, and their unit; None for anything else."""
    unit = channel(key).unit
    if isinstance(value, Mapping):
        values = next((value[name] for name in ("values", "data") if isinstance(value.get(name), np.ndarray)), None)
        stated = next((value[name] for name in ("unit", "units") if isinstance(value.get(name), str)), "")
        return (None if values is None else np.squeeze(values)), unit or stated.strip()
    beside = (variables.get(f"{key}{ending}") for ending in ("_unit", "_units"))
    stated = next((text.strip() for text in beside if isinstance(text, str)), "")
    return (np.squeeze(value) if isinstance(value, np.ndarray) else None), unit or stated
