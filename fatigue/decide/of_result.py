"""What decisions read of a finished result: its points and welds as arrays, its case and mission from the record."""

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.pipeline.multiaxial.method import DECIDING
from fatigue.results import read_codes

Floats = NDArray[np.float64]
Record = Mapping[str, Any]

FACES = ("top", "bottom")
ROUNDING = 1e-9  # relative, of a stored sum


def counted_points(folder: Path) -> NDArray[np.bool_]:
    """Whether the cycles of each point (n,) were counted; else its damage is an upper bound.

    Raises
    ------
    DataError : the table is damaged
    """
    tier, tiers = read_codes(folder, "nodes", "screened")
    return np.array([name in ("", None) for name in [*tiers, ""]])[tier]


def damage_limits(welds: pd.DataFrame, names: Sequence[str], record: Record) -> Floats:
    """Damage sum (w,) allowed on welds by their names, rows of ``welds``; where none is on record, that of the mission.

    Older results have one limit for all.
    """
    limit = welds.set_index("weld")["damage_limit"].reindex(list(names)).astype(float)
    found: Floats = limit.fillna(record["mission"]["damage_limit"]).to_numpy(dtype=np.float64)
    return found


def attachment_lengths(welds: pd.DataFrame) -> Floats:
    """Length of what each weld (w,) attaches [mm]; +inf where it has none, as in results of older versions."""
    if "attachment_mm" not in welds:
        return np.full(len(welds), np.inf)
    length = welds["attachment_mm"].to_numpy(dtype=np.float64, na_value=np.nan)
    return np.where(np.isnan(length), np.inf, length)


def case_text(record: Record) -> str:
    """Text of the case as it was assessed."""
    return str(record["case_text"]).removeprefix("\ufeff")


def case_keys(record: Record) -> dict[str, Any]:
    """Keys of the case as it was assessed, by their tables."""
    return tomllib.loads(case_text(record))


def loops_of(record: Record) -> list[dict[str, Any]]:
    """Sequences of events that the mission runs through, each with ``name``, ``order`` and ``runs_per_km``."""
    return list(record["mission"].get("sequences", ()))  # results of older versions have none


def events_and_loops(record: Record) -> tuple[str, ...]:
    """Names of the events, then of the loops: the rows of a point in the table of damage, in their order."""
    events = (event["event"] for event in record["mission"]["events"])
    return (*events, *(loop["name"] for loop in loops_of(record)))


def is_sum_of_events(damage: Floats, of_events: Floats) -> NDArray[np.bool_]:
    """Whether the damage of points (n,) is what their events add up to; else another sum decides there, that of shear.

    >>> is_sum_of_events(np.array([2e-8, 3e-8, 0.0]), np.array([2e-8, 2e-8, 0.0]))
    array([ True, False,  True])
    """
    with np.errstate(invalid="ignore"):
        return np.asarray((np.abs(of_events - damage) <= ROUNDING * np.abs(damage)) | (of_events == damage))


def shear_method(record: Record) -> str:
    """Method by which a damage sum of shear may decide about the life of a point; empty where none does."""
    method = str(record["rules"].get("multiaxial", {}).get("method", ""))
    return method if method in DECIDING else ""
