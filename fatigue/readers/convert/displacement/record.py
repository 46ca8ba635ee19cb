"""The displacement of one node in one direction over time, as the simulation exports it."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.fe.results import is_sound
from fatigue.readers.foreign.read import read_coordinates
from fatigue.readers.units.coordinate_units import states_no_unit

Floats = NDArray[np.float64]

_IN_MM = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "inch": 25.4, "µm": 1e-3, "um": 1e-3}
_UNIT = re.compile(r"(?:\A|[_\s,/]|[\[(]\s*)(mm|cm|m|in|inch|[µμu]m)\s*[\])]?\s*\Z", re.IGNORECASE)
_OTHER_UNIT = re.compile(r"\[([^\]]*[^\W\d_][^\]]*)\]\s*\Z")


@dataclass(frozen=True, slots=True, eq=False)
class DisplacementRecord:
    """A displacement (t,) [mm] at its times [s]."""

    time: Floats
    value: Floats


def read_displacement(path: Path | str, unit_of_length: float) -> DisplacementRecord:
    """Read a table of time and one displacement, as text or Parquet.

    A unit at the end of the column's name (``displacement_mm``, ``uz [m]``) holds; without one it is
    ``unit_of_length`` [mm].

    Raises
    ------
    DataError : unreadable, no time, not one displacement, a unit that is no length, a value that is no number
    """
    table = read_coordinates(Path(path), None, None)
    if len(table.name) != 1:
        raise DataError(
            Problem(
                "not_one_displacement",
                str(path),
                f"{len(table.name)} columns beside time, '{table.name[0]}' and '{table.name[-1]}' among them",
                "Export time and one displacement: the columns time_s,displacement_mm",
            )
        )
    unit = _stated_unit(path, table.name[0], table.unit[0] if table.unit else "")
    value = _IN_MM.get(unit, unit_of_length) * table.q[0].astype(np.float64)
    if not is_sound(value).all():
        what = f"a value of {np.abs(table.q[0]).max():.3g} is no displacement"
        raise DataError(Problem("not_a_number", f"{path}, column {table.name[0]!r}", what, "Export again"))
    once = np.append(np.diff(table.time) > 0, True)  # of an instant written twice the later sample, as for coordinates
    return DisplacementRecord(table.time[once], value[once])


def _stated_unit(path: Path | str, name: str, unit: str) -> str:
    """Give the unit that the column's name or the row of units states; empty if neither does."""
    stated = _UNIT.search(name) or _OTHER_UNIT.search(name)
    label = stated[1] if stated else "" if states_no_unit(unit) else unit
    label = label.strip().lower().replace("μ", "µ")
    beside = "" if states_no_unit(unit) else unit.strip().lower().replace("μ", "µ")
    if label in _IN_MM and beside in _IN_MM and _IN_MM[label] != _IN_MM[beside]:
        what = f"its name states {label}, and the row of units or the metadata {beside}"
        raise DataError(Problem("header", f"{path}, column {name!r}", what, "Correct one of them"))
    if label and label not in _IN_MM:
        raise DataError(
            Problem(
                "no_length",
                f"{path}, column {name!r}",
                f"{label!r} is no unit of length that is known here",
                f"Export an elastic displacement in one of {', '.join(_IN_MM)}",
            )
        )
    return label
