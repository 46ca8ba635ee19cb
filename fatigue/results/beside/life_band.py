"""How sure the life of a point is: its rows of the table of bands, and what they say in words."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pandas as pd

from fatigue.results.rows import read_rows, rows_of_welds
from fatigue.results.tables import table_path

POINT = ("weld", "part", "order", "surface")
LIVES = ("life_km_p50", "life_km_p90", "life_km_p97_7", "life_km_p99")
AT_LEAST = "non_stationary"  # a band, and at least this wide

SHORT_REASONS: Mapping[str, str] = MappingProxyType(
    {
        "screened": "bound only",
        "no_damage": "no damage",
        "shear": "shear decides",
        "short_record": "record too short",
        "single_pass": "single passes",
        "across_events": "cycles across events",
        AT_LEAST: "at least",
    }
)
"""In a cell of a table: why there is no band, or what is to be said of it."""

REASONS: Mapping[str, str] = MappingProxyType(
    {
        "screened": "the point was not counted, its life is a proven lower bound",
        "no_damage": "no cycle does damage",
        "shear": "shear decides about its life, and pieces of time hold cycles of the normal stress only",
        "short_record": "the records are too short to know how the damage scatters: by more than 25 % from one to the "
        "next, or it is not known",
        "single_pass": "events counted by number make more than 5 % of the damage, and one manoeuvre says nothing of "
        "the next",
        "across_events": "cycles across events make more than 5 % of the damage, and no piece of a record holds them",
        AT_LEAST: "the stress is not stationary, so that the band is at least this wide",
    }
)
"""In a sentence: the same in full."""

WHAT_IT_IS_NOT = "It says nothing about other track, other wheels or other seasons than those of the records."


@dataclass(frozen=True, slots=True)
class BandOfPoint:
    """Life of a point [km]: 90 % band by the load, and lives at survivals; NaN where there is none, ``reason`` why."""

    life_km: float
    low_km: float
    high_km: float
    lives_km: Mapping[str, float]
    reason: str
    line_survival: float
    line_life_km: float

    @property
    def has_band(self) -> bool:
        """Whether the scatter of the load is known."""
        return bool(np.isfinite(self.low_km))

    @property
    def has_lives(self) -> bool:
        """Whether the curve has a scatter, so that there are lives at survivals."""
        return not np.isnan(self.lives_km[LIVES[0]])

    def as_record(self) -> dict[str, Any]:
        """Record for machines; what is not there is null."""
        return {
            "life_km_load_low": _or_none(self.low_km),
            "life_km_load_high": _or_none(self.high_km),
            **{name: _or_none(value) for name, value in self.lives_km.items()},
            "band_reason": self.reason or None,
            "line_survival_at_target": _or_none(self.line_survival),
            "line_life_km_p50": _or_none(self.line_life_km),
        }


class Bands:
    """Bands of some points; ``rows`` are theirs in the table."""

    def __init__(self, rows: pd.DataFrame) -> None:
        self._rows = {key: _of_row(row) for key, row in zip(_keys(rows), rows.to_dict("records"), strict=True)}

    def __len__(self) -> int:
        """Count the points."""
        return len(self._rows)

    def of(self, weld: str, part: int, order: int, surface: str) -> BandOfPoint | None:
        """Band of one point; None where it has no row."""
        return self._rows.get((str(weld), int(part), int(order), str(surface)))

    def of_points(self, points: pd.DataFrame, prefix: str = "") -> list[BandOfPoint | None]:
        """Bands of the points of a frame whose columns of part, order and surface have some prefix."""
        return [self._rows.get(key) for key in _keys(points, prefix)]


def worst_of(welds: pd.DataFrame) -> pd.DataFrame:
    """Worst points of some welds of the register, as ``read_bands`` takes points."""
    return welds[["weld", *(f"worst_{name}" for name in POINT[1:])]].set_axis(list(POINT), axis=1)


def read_bands(folder: Path, points: pd.DataFrame) -> Bands | None:
    """Bands of some points, of which a frame has weld, part, order and surface; None of a result without the table.

    A table of all points of a train is read weld by weld, and no more of it kept than is asked for.

    Raises
    ------
    DataError : the table is damaged
    """
    if not table_path(folder, "band").exists():
        return None
    wanted, welds = set(_keys(points)), [str(weld) for weld in points["weld"].unique()]
    numbers = np.sort(np.concatenate([np.zeros(0, np.int64), *rows_of_welds(folder, "band", welds).values()]))
    at = [key in wanted for key in _keys(read_rows(folder, "band", numbers, list(POINT)).to_pandas())]
    return Bands(read_rows(folder, "band", numbers[np.array(at, dtype=np.bool_)]).to_pandas())


def _keys(rows: pd.DataFrame, prefix: str = "") -> list[tuple[str, int, int, str]]:
    part, order, surface = (rows[f"{prefix}{name}"] for name in POINT[1:])
    of_rows = zip(rows["weld"], part, order, surface, strict=True)
    return [(str(weld), int(one), int(at), str(face)) for weld, one, at, face in of_rows]


def _of_row(row: dict[Any, Any]) -> BandOfPoint:
    return BandOfPoint(
        life_km=float(row["life_km"]),
        low_km=float(row["life_km_load_low"]),
        high_km=float(row["life_km_load_high"]),
        lives_km={name: float(row[name]) for name in LIVES},
        reason="" if pd.isna(row["band_reason"]) else str(row["band_reason"]),
        line_survival=float(row["line_survival_at_target"]),
        line_life_km=float(row["line_life_km_p50"]),
    )


def _or_none(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
