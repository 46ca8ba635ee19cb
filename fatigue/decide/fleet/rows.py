"""Rows of the tables of a fleet."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.decide.fleet.percentiles import percentiles
from fatigue.decide.fleet.summed import PointVariance, Scatter, Summed, largest_part, variance_of_unit
from fatigue.decide.fleet.units import damage_of_units, life_in_years

Floats = NDArray[np.float64]

MOST_POINT_ROWS = 2_000_000  # of fleet_points, points times units: some 400 MB while they are written
_KEY = ["weld", "part", "node", "order", "surface"]


@dataclass(frozen=True, slots=True)
class UnitRow:
    """Columns of ``fleet_units``."""

    rank: int
    unit: str
    km_per_year: float
    weld: str
    part: int
    node: int
    order: int
    surface: str
    damage_per_year: float
    life_years: float
    life_km: float
    is_bound: bool
    life_years_at_most: float
    fulfilled: bool | None
    governing_condition: str
    governing_share: float
    damage_cv: float


def unit_rows(of: Summed, scatter: Scatter, names: Sequence[str], target_years: float | None) -> tuple[UnitRow, ...]:
    """Units with their worst welds, that with the shortest life first."""
    shortest = of.life.min(axis=0)
    rows = []
    for rank, unit in enumerate(np.argsort(shortest, kind="stable").tolist(), 1):
        weld = int(of.governing[unit])
        point = int(of.worst.point[weld, unit])
        km, damage = float(of.distances.km[unit]), max(0.0, float(of.worst.damage[weld, unit]))
        life = float(of.life[weld, unit])
        condition, share = largest_part(of.points.damage[point], of.distances.distance[unit], names)
        error = np.sqrt(variance_of_unit(of, scatter, unit, point).total) if scatter.is_known else np.nan
        rows.append(
            UnitRow(
                rank=rank,
                unit=of.distances.units[unit],
                km_per_year=km,
                **_key_of(of, point),
                damage_per_year=damage,
                life_years=life,
                life_km=life * km if km > 0.0 else np.nan,
                is_bound=bool(of.worst.is_bound[weld, unit]),
                life_years_at_most=float(of.at_most[:, unit].min()),
                fulfilled=None if target_years is None else bool(life >= target_years),
                governing_condition=condition,
                governing_share=share,
                damage_cv=float(error / damage) if damage > 0.0 else np.nan,
            )
        )
    return tuple(rows)


def _key_of(of: Summed, point: int) -> dict[str, Any]:
    found = of.points.key.iloc[point]
    return {
        "weld": str(found["weld"]),
        "part": int(found["part"]),
        "node": int(found["node"]),
        "order": int(found["order"]),
        "surface": str(found["surface"]),
    }


def weld_rows(of: Summed, names: Sequence[str], target_years: float | None) -> pd.DataFrame:
    """Worst point of every weld for every unit, unit by unit."""
    welds, units = of.life.shape
    point = of.worst.point.T.ravel()
    distance = np.repeat(of.distances.distance, welds, axis=0)
    parts = of.points.damage[point] * distance
    damage, life = np.maximum(of.worst.damage.T.ravel(), 0.0), of.life.T.ravel()
    most = parts.argmax(axis=1)
    share = np.divide(parts.max(axis=1), damage, out=np.full(len(damage), np.nan), where=damage > 0.0)
    table = of.points.key.iloc[point][_KEY].reset_index(drop=True)
    table.insert(0, "unit", np.repeat(np.array(of.distances.units, object), welds))
    return table.assign(
        damage_per_year=damage,
        life_years=life,
        is_bound=of.worst.is_bound.T.ravel(),
        life_years_at_most=of.at_most.T.ravel(),
        fulfilled=np.full(welds * units, None) if target_years is None else life >= target_years,
        governing_condition=np.where(damage > 0.0, np.array(names, object)[most], ""),
        governing_share=share,
    )


def point_rows(of: Summed) -> pd.DataFrame | None:
    """Every point for every unit, unit by unit; None where these would be too many rows."""
    points, units = len(of.points.key), len(of.distances.units)
    if points * units > MOST_POINT_ROWS:
        return None
    damage = damage_of_units(of.points.damage, of.distances.distance).T.ravel()
    bound = of.points.is_bound.astype(np.float64) @ (of.distances.distance > 0.0).T.astype(np.float64) > 0.0
    limit = np.tile(of.points.limit[of.points.weld], units)
    table = pd.concat([of.points.key] * units, ignore_index=True)
    table.insert(0, "unit", np.repeat(np.array(of.distances.units, object), points))
    return table.assign(damage_per_year=damage, life_years=life_in_years(damage, limit), is_bound=bound.T.ravel())


@dataclass(frozen=True, slots=True)
class PercentileRow:
    """Columns of ``fleet_percentiles``."""

    weld: str
    percentile: float
    life_years: float
    damage_per_year: float
    utilisation_per_year: float
    units_with_bound: int


def percentile_rows(of: Summed, percent: Sequence[float]) -> tuple[PercentileRow, ...]:
    """Percentiles over the units: of the worst weld of each, then of every weld, that with the shortest lives first."""
    units = np.arange(len(of.distances.units))
    damage, utilisation = of.worst.damage[of.governing, units], of.utilisation[of.governing, units]
    bound = int(of.worst.is_bound[of.governing, units].sum())
    rows = list(_percentiles("", of.life.min(axis=0), damage, utilisation, bound, percent))
    for weld in np.argsort(-of.utilisation.max(axis=1), kind="stable").tolist():
        name, bound = of.points.names[weld], int(of.worst.is_bound[weld].sum())
        rows += _percentiles(name, of.life[weld], of.worst.damage[weld], of.utilisation[weld], bound, percent)
    return tuple(rows)


def _percentiles(
    weld: str, life: Floats, damage: Floats, utilisation: Floats, bound: int, percent: Sequence[float]
) -> Iterator[PercentileRow]:
    found = (percentiles(values, percent).tolist() for values in (life, damage, utilisation))
    for p, of_life, of_damage, of_utilisation in zip(percent, *found, strict=True):
        yield PercentileRow(weld, float(p), of_life, of_damage, of_utilisation, bound)


@dataclass(frozen=True, slots=True)
class VarianceRow:
    """Columns of ``fleet_variance``."""

    of: str
    unit: str
    weld: str
    part: int
    node: int
    order: int
    surface: str
    condition: str
    source: str
    variance_per_year2: float
    share: float


def variance_rows(of: Summed, found: Sequence[PointVariance], names: Sequence[str]) -> tuple[VarianceRow, ...]:
    """Parts of every variance, condition by condition; sources that say nothing anywhere are left out."""
    rows = []
    for one in found:
        total, unit = one.variance.total, "" if one.unit is None else of.distances.units[one.unit]
        for source in ("distance", "damage", "both"):
            parts = getattr(one.variance, source)
            if parts.any():
                rows += [
                    VarianceRow(
                        of="units" if one.unit is None else "unit",
                        unit=unit,
                        **_key_of(of, one.point),
                        condition=name,
                        source=source,
                        variance_per_year2=float(part),
                        share=float(part) / total,
                    )
                    for name, part in zip(names, parts, strict=True)
                ]
    return tuple(rows)
