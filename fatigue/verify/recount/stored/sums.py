"""What follows in the tables of a result from other rows, checked for all of them: sums over events, copies, quotients.

Nothing is counted here. A value that was spoiled, or rows that are not of the same run, show all the same.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.results import TABLES, number_groups, read_rows, read_table
from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.spectral import NEARLY_ALL
from fatigue.verify.recount.choice import worst_points
from fatigue.verify.recount.stored.compare import TOLERANCE, ColumnCheck, merged
from fatigue.verify.recount.stored.decisive import failed_by_checks
from fatigue.verify.recount.stored.histogram import KINDS as HISTOGRAM_KINDS
from fatigue.verify.recount.stored.rows import place
from fatigue.verify.recount.stored.runs import StoredRuns
from fatigue.verify.recount.stored.tables import Stored, is_counted, toes_and_utilisation, worst_of_welds

Floats = NDArray[np.float64]

ALL_ROWS = ", all rows"
PER_PASS = ("damage", "damage_dirlik", "damage_tb", "damage_tb_whole", "damage_same_ratio", "cycles")
OF_GOVERNING = ("mean_stress_MPa", "bending_ratio")
OF_WORST = ("life_km", "life_years", "utilisation", "fulfilled", "governing_event")
_NODES = ("damage_per_km", "life_km", "life_years", "utilisation", "fulfilled", "life_km_dirlik", "life_km_tb",
          "life_km_same_ratio", "dirlik_ratio", "max_range_MPa", "governing_event", *OF_GOVERNING)  # fmt: skip
_DAMAGE = (*(f"{name}_{per}" for name in PER_PASS for per in ("per_pass", "per_km")), "max_range_MPa", *OF_GOVERNING)
_ROWS_AT_ONCE = 1 << 18  # of the table of points and events


_SUMS = {"asme": "utilisation_asme", **{one: f"utilisation_path_{one}" for one in ("range", "length", "mlp")}}


class Sum(NamedTuple):
    """Values of a column and what other columns say they are: numbers, (n,), of some keys, (n,)."""

    table: str
    column: str
    found: NDArray[Any]
    expected: NDArray[Any]
    key: NDArray[np.int64]


def check_sums(stored: Stored, case: Mapping[str, Any], events: Sequence[RecountEvent]) -> list[ColumnCheck]:
    """Checks of every row of the tables of a result against other rows.

    Raises
    ------
    DataError : a table is damaged
    """
    checks = [_check(stored, events, one) for one in _sums(stored, case, events)]
    return merged(checks)


def check_load_factors(stored: Stored, toe: NDArray[np.bool_]) -> list[ColumnCheck]:
    """Check of the load factor of every weld against those of its points, of which some are at a toe, (p,).

    Raises
    ------
    DataError : a table is damaged
    """
    return [replace(_check(stored, (), _smallest_load_factors(stored, toe)), table="welds")]


def _sums(stored: Stored, case: Mapping[str, Any], events: Sequence[RecountEvent]) -> Iterator[Sum]:
    points = max(1, _ROWS_AT_ONCE // len(events))
    for first in range(0, stored.body.points, points):
        yield from _of_points(stored, case, events, np.arange(first, min(first + points, stored.body.points)))
    yield from _of_cycles(stored, len(events))
    if stored.histogram is not None:
        yield from _of_histograms(stored, stored.histogram, len(events))
    yield from _of_welds(stored, case)
    yield _smallest_load_factors(stored, toes_and_utilisation(stored)[0])


def _of_points(
    stored: Stored, case: Mapping[str, Any], events: Sequence[RecountEvent], points: NDArray[np.int64]
) -> Iterator[Sum]:
    """Columns of points as the columns of their events make them, and numbers per km as numbers per pass do."""
    e = len(events)
    keys = (points[:, None] * e + np.arange(e)).ravel()
    sums = [name for method, name in _SUMS.items() if case.get("multiaxial", {}).get("method") == method]
    node = _columns(read_rows(stored.folder, "nodes", stored.nodes.of(points), [*_NODES, *sums]))
    damage = {
        name: column.reshape(-1, e)
        for name, column in _columns(read_rows(stored.folder, "damage", stored.damage.of(keys), _DAMAGE)).items()
    }
    for name in PER_PASS:
        length = np.array([np.nan if event.length_km is None else event.length_km for event in events])
        per_km = damage[f"{name}_per_pass"] / length
        yield Sum("damage", f"{name}_per_km", damage[f"{name}_per_km"].ravel(), per_km.ravel(), keys)

    mission, weight = case["mission"], np.array([event.passes_per_km for event in events])
    limit, target = limits(stored, mission)[points // 2], mission["target_km"]
    share = weight * damage["damage_per_pass"]
    method = case.get("multiaxial", {}).get("method", "report")
    by_method = node[_SUMS[method]] * limit / target if method in _SUMS else np.full(len(points), np.nan)
    total, has_spectrum = np.fmax(share.sum(axis=1), by_method), ~np.isnan(damage["damage_dirlik_per_pass"])
    spectral = {
        name: np.where(
            has_spectrum.any(axis=1),
            np.where(has_spectrum, weight * damage[f"damage_{name}_per_pass"], 0.0).sum(axis=1),
            np.nan,
        )
        for name in ("dirlik", "tb", "tb_whole", "same_ratio")
    }
    with np.errstate(divide="ignore", invalid="ignore"):
        misses = 1.0 - spectral["tb"] / spectral["tb_whole"] > NEARLY_ALL
        expected = {
            "damage_per_km": total,
            "life_km": limit / total,
            "life_years": limit / total / mission["km_per_year"],
            "utilisation": total * target / limit,
            "fulfilled": (node["utilisation"] <= 1.0).astype(float),
            "life_km_same_ratio": limit / spectral["same_ratio"],
            **{f"life_km_{name}": np.where(misses, np.nan, limit / spectral[name]) for name in ("dirlik", "tb")},
            "dirlik_ratio": np.where(spectral["same_ratio"] > 0.0, spectral["dirlik"] / spectral["same_ratio"], np.nan),
            "max_range_MPa": damage["max_range_MPa"].max(axis=1),
        }
    for name, values in expected.items():
        yield Sum("nodes", name, node[name].astype(float), values, points)

    numbers = {event.name: i for i, event in enumerate(events)}
    governing = np.array([numbers.get(name, -1) for name in node["governing_event"].tolist()])
    named = np.flatnonzero(governing >= 0)  # a bound and a point at rest name none
    at = governing[named]
    yield Sum("nodes", "governing_event", share[named, at], share[named].max(axis=1, initial=0.0), points[named])
    for name in OF_GOVERNING:
        yield Sum("nodes", name, node[name][named], damage[name][named, at], points[named])


def limits(stored: Stored, mission: Mapping[str, Any]) -> Floats:
    """Largest Miner sum allowed at every station, by the curve of its weld."""
    of_mission = mission.get("damage_limit", 1.0)
    if "damage_limit" not in stored.welds:
        return np.full(len(stored.body), of_mission, dtype=np.float64)
    of_welds = stored.welds["damage_limit"].loc[list(stored.body.welds)].fillna(of_mission).to_numpy(float)
    return np.asarray(of_welds[stored.body.weld])


def _of_cycles(stored: Stored, events: int) -> Iterator[Sum]:
    """Damage of a pass as the damage of its cycles makes it."""
    cycles = stored.cycles
    of_run, row = np.zeros(len(cycles.point)), 0
    for columns in number_groups(stored.folder, "cycles", ["damage"], {}):
        values = columns["damage"]
        run = np.searchsorted(cycles.first, row + np.arange(len(values)), side="right") - 1
        low = run[0] if len(run) else 0
        held = np.bincount(run - low, values)
        of_run[low : low + len(held)] += held
        row += len(values)
    keys, which = np.unique(cycles.point * events + cycles.event, return_inverse=True)
    if len(keys):
        table = read_rows(stored.folder, "damage", stored.damage.of(keys), ["damage_per_pass"])
        yield Sum("cycles", "damage", np.bincount(which, of_run), _columns(table)["damage_per_pass"], keys)


def _of_histograms(stored: Stored, histogram: StoredRuns, events: int) -> Iterator[Sum]:
    """Cycles of a pass as the classes of either kind of range make them."""
    for kind in HISTOGRAM_KINDS:
        of_run, row = np.zeros(len(histogram.point)), 0
        for columns in number_groups(stored.folder, "histogram", ["count_per_pass"], {"kind": [kind]}):
            values = np.where(columns["kind"] == 0, columns["count_per_pass"], 0.0)
            run = np.searchsorted(histogram.first, row + np.arange(len(values)), side="right") - 1
            of_run += np.bincount(run, values, len(of_run))
            row += len(values)
        keys, which = np.unique(histogram.point * events + histogram.event, return_inverse=True)
        if len(keys):
            table = read_rows(stored.folder, "damage", stored.damage.of(keys), ["cycles_per_pass"])
            cycles = _columns(table)["cycles_per_pass"]
            yield Sum("histogram", "count_per_pass", np.bincount(which, of_run), cycles, keys)


def _of_welds(stored: Stored, case: Mapping[str, Any]) -> Iterator[Sum]:
    """Row of a weld as the row of its worst point makes it, which no counted point of a toe exceeds.

    Its verdict is that of the point unless a check that counts has failed.
    """
    welds = stored.welds.loc[list(stored.body.welds)]
    number = np.arange(len(welds))
    point = worst_of_welds(stored, number)
    there = point >= 0
    table = read_rows(stored.folder, "nodes", stored.nodes.of(point[there]), OF_WORST)
    failed = welds.index.isin(failed_by_checks(stored.folder, case))[there]
    for name, values in _columns(table).items():
        expected = values & ~failed if name == "fulfilled" else values
        yield Sum("welds", name, welds[name].to_numpy()[there], expected, number[there])
    toe, utilisation = toes_and_utilisation(stored)
    toe &= is_counted(stored)
    worst = worst_points(stored.body, toe, utilisation)
    number = number[toe[worst]]
    yield Sum("welds", "utilisation", welds["utilisation"].to_numpy()[number], utilisation[worst][number], number)


def _smallest_load_factors(stored: Stored, toe: NDArray[np.bool_]) -> Sum:
    """Load factor of a weld as the smallest one of its counted toe points makes it."""
    names = list(stored.body.welds)
    of_welds = stored.welds["load_factor"].loc[names].to_numpy()
    of_points = stored.nodes.in_order(read_table(stored.folder, "nodes", ["load_factor"])["load_factor"].to_numpy())
    severity = np.where(toe & is_counted(stored), of_points, np.inf)
    smallest = np.minimum.reduceat(severity, 2 * stored.body.first[:-1])
    return Sum("welds", "load_factor", of_welds, smallest, np.arange(len(names)))


def _check(stored: Stored, events: Sequence[RecountEvent], one: Sum) -> ColumnCheck:
    """Check of a column by the value that differs most from what it should be."""
    difference = _differences(one.found, one.expected)
    worst = int(difference.argmax()) if len(difference) else 0
    is_any = len(difference) > 0
    return ColumnCheck(
        table=one.table + ALL_ROWS,
        column=one.column,
        unit=next(column.unit for column in TABLES[one.table] if column.name == one.column),
        compared=len(difference),
        difference=float(difference[worst]) if is_any else 0.0,
        tolerance=TOLERANCE,
        where=_where(stored, events, one.table, int(one.key[worst])) if is_any else "",
        found=_plain(one.found[worst]) if is_any else None,
        expected=_plain(one.expected[worst]) if is_any else None,
    )


def _differences(found: NDArray[Any], expected: NDArray[Any]) -> Floats:
    """Relative differences, 1 between texts that differ, infinite between a number and none."""
    if object in (found.dtype, expected.dtype):
        return np.array(
            [float(a != b and not (pd.isna(a) and pd.isna(b))) for a, b in zip(found, expected, strict=True)]
        )
    found, expected = found.astype(np.float64), expected.astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.abs(found - expected) / np.abs(expected)
    same = (found == expected) | (np.isnan(found) & np.isnan(expected))
    return np.where(same, 0.0, np.where(np.isnan(relative), np.inf, relative))


def _where(stored: Stored, events: Sequence[RecountEvent], table: str, key: int) -> str:
    if table == "welds":
        return f"weld {stored.body.welds[key]}"
    if table == "nodes":
        return place(stored.body.key(key))
    return f"{place(stored.body.key(key // len(events)))}, event '{events[key % len(events)].name}'"


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _columns(table: pa.Table) -> dict[str, NDArray[Any]]:
    """Columns as arrays: numbers with NaN for none, texts with None."""
    return {name: table.column(name).to_numpy() for name in table.column_names}
