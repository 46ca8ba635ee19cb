"""What is kept of the checks of some welds or points: one long array, a row of it for a row of ``checks.parquet``."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

TEXTS = ("weld", "point", "check", "side", "surface", "component", "curve", "governing_event", "note")
NUMBERS = (
    "direction_deg",
    "range_max_MPa",
    "damage_per_km",
    "damage_sum",
    "damage_limit",
    "utilisation_stress",
    "limit_value",
    "value",
    "normal_part",
    "shear_part",
    "R",
    "amplitude_MPa",
    "allowed_amplitude_MPa",
    "plane_range_MPa",
)
PLACES = ("part", "order")
NOT_ASSESSED = -1  # of ``fulfilled``; else 0 or 1
NOWHERE = -1  # of ``part`` and ``order``

CheckRows = NDArray[Any]


def no_rows() -> CheckRows:
    """Not a single row."""
    return check_rows(0)


def check_rows(
    rows: int,
    *,
    check: object = "",
    weld: object = "",
    part: object = NOWHERE,
    order: object = NOWHERE,
    point: object = "",
    side: object = "",
    surface: object = "",
    direction_deg: object = np.nan,
    component: object = "",
    curve: object = "",
    range_max_MPa: object = np.nan,
    damage_per_km: object = np.nan,
    damage_sum: object = np.nan,
    damage_limit: object = np.nan,
    utilisation_stress: object = np.nan,
    limit_value: object = 1.0,
    value: object = np.nan,
    normal_part: object = np.nan,
    shear_part: object = np.nan,
    R: object = np.nan,
    amplitude_MPa: object = np.nan,
    allowed_amplitude_MPa: object = np.nan,
    plane_range_MPa: object = np.nan,
    fulfilled: object = NOT_ASSESSED,
    governing_event: object = "",
    note: object = "",
) -> CheckRows:
    """So many rows (r,) as a structured array; every column is one value for all of them, or (r,) of them.

    The columns are those of ``checks.parquet``; what follows from them, and from the curve, is not kept. Texts are as
    wide as the longest of them. ``fulfilled`` is 1, 0 or ``NOT_ASSESSED``.
    """
    given = dict(locals())
    values = {name: np.asarray(given[name], dtype=np.str_) for name in TEXTS}
    values |= {name: np.asarray(given[name], dtype=np.float64) for name in NUMBERS}
    values |= {name: np.asarray(given[name], dtype=np.int64) for name in PLACES}
    values["fulfilled"] = np.asarray(given["fulfilled"], dtype=np.int8)
    wide = {name: np.dtype(f"U{max(1, values[name].dtype.itemsize // 4)}") for name in TEXTS}
    kinds = [(name, wide.get(name, value.dtype)) for name, value in values.items()]
    array = np.empty(rows, dtype=kinds)
    for name, column in values.items():
        array[name] = column
    return array


def joined(some: Sequence[CheckRows]) -> CheckRows:
    """Rows of several checks, one after the other."""
    return np.concatenate([no_rows(), *some])
