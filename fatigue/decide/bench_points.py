"""Points of a finished result that a bench shall reproduce: their target damage, and what a unit of each load does."""

import difflib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.decide.bench_files import WantedPoint
from fatigue.decide.of_result import attachment_lengths, case_keys
from fatigue.errors import DataError, Problem
from fatigue.life.curves import DamageLaw
from fatigue.life.recorded_curve import recorded_size
from fatigue.life.rule import CycleRule
from fatigue.results import assessed, read_rows, read_welds, rows_of_welds
from fatigue.results.tables import readable, table_path

Floats = NDArray[np.float64]

_NODES = ["weld", "part", "order", "node", "surface", "toe", "thickness_mm", "damage_per_km", "screened"]
MOST_TOLD = 5  # of many points with the same fault


@dataclass(slots=True)
class Faults:
    """Faults of points, one problem of a kind, which names the first of them."""

    kinds: dict[str, tuple[str, str, list[str]]] = field(default_factory=dict)

    def add(self, code: str, what: str, remedy: str, point: str) -> None:
        """Note a fault of a point."""
        self.kinds.setdefault(code, (what, remedy, []))[2].append(point)

    def problems(self) -> Iterator[Problem]:
        """One problem of each kind."""
        for code, (what, remedy, points) in self.kinds.items():
            named = "; ".join(points[:MOST_TOLD])
            more = f"; and {len(points) - MOST_TOLD} more" if len(points) > MOST_TOLD else ""
            yield Problem(code, f"{named}{more}", what, remedy, len(points))


@dataclass(frozen=True, slots=True, eq=False)
class BenchPoints:
    """Points of a result.

    Attributes
    ----------
    key : (p) rows with weld, part, order, node and surface
    target : (p,) damage at the target mileage times the factor of the point
    factor : (p,)
    curve : (p) names of their curves
    size : (p,) factor of the thickness on the range
    rules : of each curve
    """

    key: pd.DataFrame
    target: Floats
    factor: Floats
    curve: tuple[str, ...]
    size: Floats
    rules: Mapping[str, CycleRule]

    def __len__(self) -> int:
        """Count the points."""
        return len(self.key)

    @property
    def side(self) -> Floats:
        """Sign (p,) of the bending stress at the face."""
        return np.where(self.key["surface"] == "top", 1.0, -1.0)

    @property
    def names(self) -> list[str]:
        """The points in words."""
        return [point_name(row) for row in self.key.itertuples(index=False)]


def point_name(row: Any) -> str:
    """Point in words."""
    return f"weld '{row.weld}', part {row.part}, order {row.order}, {row.surface}"


def units_of_coordinates(record: Mapping[str, Any]) -> dict[str, str]:
    """Units of the coordinates of a result by their names: unit loads first; modes have none."""
    body = case_keys(record)["body"]
    units = {f"u_{load['name']}": str(load["unit"]) for load in body.get("unit_load", [])}
    return units | {f"q_{mode}": "" for mode in record["modes"]["used"]}


def worst_wanted(folder: Path) -> tuple[WantedPoint, ...]:
    """The worst point of every weld, those that nothing damages left out."""
    welds = assessed(read_welds(folder))
    welds = welds[welds["utilisation"].gt(0.0)]
    return tuple(
        WantedPoint(
            weld=row.weld,
            order=int(row.worst_order),
            node=None,
            part=int(row.worst_part),
            surface=row.worst_surface,
            factor=1.0,
            where=f"weld '{row.weld}'",
        )
        for row in welds.itertuples(index=False)
    )


def points_of_result(folder: Path, record: Mapping[str, Any], wanted: Sequence[WantedPoint]) -> BenchPoints:
    """Points as a result has them.

    Raises
    ------
    DataError : points that the result does not have, that are asked for twice, or that give no target
    """
    names = list(dict.fromkeys(point.weld for point in wanted))
    rows = np.sort(np.concatenate([*rows_of_welds(folder, "nodes", names).values(), np.zeros(0, np.int64)]))
    nodes = read_rows(folder, "nodes", rows, _NODES).to_pandas()
    welds = read_welds(folder).set_index("weld")
    curve_of = welds["curve"]
    found, problems = _found(nodes, curve_of, wanted)
    faults = Faults()
    for point, row in zip(wanted, found, strict=True):
        if row is None:
            continue
        if row.screened:
            what = "a bound stands for its damage, not a count, so that there is no target"
            faults.add("bench_screened", what, "Assess with --exact, or choose counted points", point.where)
        elif not row.damage_per_km > 0.0:
            faults.add(
                "bench_no_damage", "nothing damages the point, so that there is no target", "Leave it out", point.where
            )
    problems += faults.problems()
    if problems:
        raise DataError(*problems)
    key = nodes.loc[[row.Index for row in found]].reset_index(drop=True)
    curves, factor = tuple(curve_of[key["weld"]]), np.array([point.factor for point in wanted])
    recorded = {name: record["curves"][name] for name in dict.fromkeys(curves)}
    attachment = attachment_lengths(welds.loc[key["weld"]])
    return BenchPoints(
        key=key[["weld", "part", "node", "order", "surface"]],
        target=key["damage_per_km"].to_numpy() * record["mission"]["target_km"] * factor,
        factor=factor,
        curve=curves,
        size=_sizes(key["thickness_mm"].to_numpy(), attachment, curves, recorded, record["rules"]["thickness_rule"]),
        rules={name: _rule(curve) for name, curve in recorded.items()},
    )


def _found(nodes: pd.DataFrame, curve_of: pd.Series, wanted: Sequence[WantedPoint]) -> tuple[list[Any], list[Problem]]:
    """Row of ``nodes`` of each point that is asked for, None where there is none, and what is wrong with them."""
    found: list[Any] = []
    problems = []
    taken: dict[int, str] = {}
    for point in wanted:
        found.append(None)
        of_weld = nodes[(nodes["weld"] == point.weld) & (nodes["surface"] == point.surface)]
        if of_weld.empty:
            near = difflib.get_close_matches(point.weld, curve_of.dropna().index, n=1)
            remedy = f"Write {near[0]!r}" if near else "Name a weld that was assessed, see `fatigue show`"
            what = f"the result has no weld '{point.weld}' that was assessed"
            problems.append(Problem("unknown_weld", point.where, what, remedy))
            continue
        at, value = ("order", point.order) if point.node is None else ("node", point.node)
        here = of_weld[(of_weld[at] == value) & ((of_weld["part"] == point.part) | (point.part is None))]
        if len(here) != 1:
            problems.append(_not_one(point, at, of_weld, here))
            continue
        (found[-1],) = here.itertuples()
        if (before := taken.setdefault(found[-1].Index, point.where)) != point.where:
            what = f"asks for the point of {before} again"
            problems.append(Problem("duplicate", point.where, what, "Keep one of the rows"))
    return found, problems


def _not_one(point: WantedPoint, at: str, of_weld: pd.DataFrame, here: pd.DataFrame) -> Problem:
    """Refusal of a place of a weld at which there is no point, or more than one."""
    value = point.order if at == "order" else point.node
    what = f"weld '{point.weld}' has no point at {at} {value}" + (f" of part {point.part}" if point.part else "")
    if here.empty:
        least, most = of_weld[at].min(), of_weld[at].max()
        return Problem("bench_unknown_point", point.where, what, f"Give one of its {at}s, {least} to {most}")
    parts, orders = (", ".join(map(str, sorted(set(here[name])))) for name in ("part", "order"))
    what = f"weld '{point.weld}' has {len(here)} points at {at} {value}, parts {parts}, orders {orders}"
    remedy = "Give the column part as well" if here["part"].nunique() == len(here) else "Give the column order"
    return Problem("bench_several_points", point.where, what, remedy)


def _sizes(
    thickness: Floats, attachment: Floats, curves: Sequence[str], recorded: Mapping[str, Any], thickness_rule: Any
) -> Floats:
    size = np.empty(len(thickness))
    for name, curve in recorded.items():
        some = np.array([other == name for other in curves])
        size[some] = recorded_size(name, curve, thickness[some], thickness_rule, attachment[some])
    return size


def _rule(recorded: Mapping[str, Any]) -> CycleRule:
    """From range to damage on a curve as the result used it, f_M and f(R) left out."""
    used = recorded["used"]
    slopes, log_constants, knees = (np.array(used[name], float) for name in ("slopes", "log_constants", "knees"))
    law, on_dS = DamageLaw(slopes, log_constants, knees, float(used["cutoff"])), recorded["applies"] == "dS"
    return CycleRule(law, on_dS, bending_factor=recorded.get("allowances", {}).get("bending_factor", "none"))


def unit_stress(folder: Path, points: BenchPoints, coordinates: Sequence[str]) -> tuple[Floats, Floats]:
    """Membrane and bending stress (p, c) of each point per unit of each coordinate, ends treated [MPa per unit].

    Raises
    ------
    DataError : the table of stresses lacks some of them, as in a result that an older version wrote
    """
    path = table_path(folder, "structural_stress")
    with readable(path):
        there = pq.read_schema(path).names
    names = [name for name in ("mode", "unit_load") if name in there]
    welds = list(dict.fromkeys(points.key["weld"]))
    rows = np.sort(np.concatenate([*rows_of_welds(folder, "structural_stress", welds).values()]))
    columns = ["weld", "part", "order", *names, "membrane_MPa", "bending_MPa"]
    table = read_rows(folder, "structural_stress", rows, columns).to_pandas()
    coordinate = "q_" + table["mode"].astype("Int64").astype(str)
    if "unit_load" in there:
        coordinate = coordinate.where(table["unit_load"].isna(), "u_" + table["unit_load"].astype(str))
    table = table.assign(coordinate=coordinate)
    table = table[table["coordinate"].isin(coordinates)].set_index(["weld", "part", "order", "coordinate"])
    wanted = [
        (row.weld, row.part, row.order, name) for row in points.key.itertuples(index=False) for name in coordinates
    ]
    missing = [one for one in wanted if one not in table.index]
    if missing:
        what = f"there is no stress of {missing[0][3]} at weld '{missing[0][0]}', order {missing[0][2]}"
        raise DataError(Problem("bench_no_stress", str(path), what, "Run the assessment again"))
    of_points = table.loc[wanted]
    shape = len(points), len(coordinates)
    return of_points["membrane_MPa"].to_numpy().reshape(shape), of_points["bending_MPa"].to_numpy().reshape(shape)
