"""What the results of a fleet say of its conditions: damage per km or pass at points that all of them share."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.decide.fleet.fleet_file import Condition, Fleet
from fatigue.decide.of_result import FACES, counted_points, damage_limits, events_and_loops
from fatigue.errors import DataError, Problem, refuse
from fatigue.results import (
    ASSESSED,
    assessed,
    finished_result,
    number_groups,
    read_codes,
    read_table,
    read_welds,
    row_count,
)
from fatigue.shown import few, visible

Floats = NDArray[np.float64]

SAME_MM = 1e-3  # distance up to which two points are one
_RULES = ("thickness_rule", "extension", "knee_cycles", "mean_stress", "yield_MPa", "structural_stress", "weld_ends")
_KEY = ["weld", "part", "order", "surface"]


@dataclass(frozen=True, slots=True, eq=False)
class Result:
    """A result folder: as the fleet names it, where it is, its provenance, and its assessed welds."""

    name: str
    folder: Path
    record: Mapping[str, Any]
    welds: pd.DataFrame

    @property
    def events(self) -> tuple[str, ...]:
        """What a condition may be: its events, and what cycles across them add in a run of each loop."""
        return events_and_loops(self.record)

    @property
    def where(self) -> str:
        """The result in messages."""
        return f"results {self.name!r}"

    def is_by_number(self, event: str) -> bool:
        """Whether an event has no km: it is counted by number, or is what a sequence adds."""
        lengths = {one["event"]: one["length"] for one in self.record["mission"]["events"]}
        return lengths.get(event) is None


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """Points that all results of a fleet have, weld after weld.

    Attributes
    ----------
    key : (p) rows with weld, part, node, order, surface, toe
    weld : (p,) number of the weld of each
    names : of the welds
    limit : (w,) damage sum that each weld is allowed
    damage : (p, c) of each condition, per km, or per pass where it is counted by number
    is_bound : (p, c) whether that is an upper bound, of a point that was not counted
    """

    key: pd.DataFrame
    weld: NDArray[np.int64]
    names: tuple[str, ...]
    limit: Floats
    damage: Floats
    is_bound: NDArray[np.bool_]


def read_results(fleet: Fleet, *, no_lock: bool) -> dict[str, Result]:
    """Every result that the conditions name, once, by its name there.

    Raises
    ------
    DataError : one of them is not there, not finished, or mixed; an event that it does not have
    """
    results = {}
    for name in dict.fromkeys(condition.results for condition in fleet.condition):
        folder = fleet.resolve(name)
        record = finished_result(folder, ASSESSED, ("nodes", "damage", "welds"), no_lock=no_lock)
        results[name] = Result(name, folder, record, assessed(read_welds(folder)))
    refuse(DataError, _unknown_events(fleet.condition, results))
    return results


def _unknown_events(conditions: Sequence[Condition], results: Mapping[str, Result]) -> Iterator[Problem]:
    for number, one in enumerate(conditions, 1):
        events = results[one.results].events
        if one.event not in events:
            what = f"the result {one.results!r} has no event {visible(one.event)!r}"
            remedy = f"It has {few([repr(visible(name)) for name in events], 10)}"
            yield Problem("unknown_event", f"condition[{number}].event ({one.name!r})", what, remedy)


def shared_points(fleet: Fleet, results: Mapping[str, Result]) -> Points:
    """Points of the results with the damage of every condition.

    Raises
    ------
    DataError : results whose welds, points, curves or rules differ: their damage is no one sum
    """
    first, *others = results.values()
    refuse(DataError, (problem for other in others for problem in _other_rules(first, other)))
    keys = {name: _sorted_points(result, first) for name, result in results.items()}
    base = keys[first.name]
    refuse(DataError, (problem for other in others for problem in _other_points(first, base, other, keys[other.name])))
    shape = len(base), len(fleet.condition)
    damage, is_bound = np.empty(shape), np.empty(shape, np.bool_)
    for c, condition in enumerate(fleet.condition):
        result, key = results[condition.results], keys[condition.results]
        damage[:, c] = _damage(result, condition.event)[key.index.to_numpy()]
        is_bound[:, c] = key["screened"].to_numpy()
    number, names = pd.factorize(base["weld"].to_numpy())
    limit = damage_limits(first.welds, list(names), first.record)
    columns = ["weld", "part", "node", "order", "surface", "toe"]
    key = base.reset_index(drop=True)[columns]
    return Points(key, number.astype(np.int64), tuple(map(str, names)), limit, damage, is_bound)


def _sorted_points(result: Result, first: Result) -> pd.DataFrame:
    """Points of a result in the order of the welds of the first one; the index is their row in its table of nodes."""
    columns = ["part", "node", "order", "toe", "x_mm", "y_mm", "z_mm", "thickness_mm"]
    table = read_table(result.folder, "nodes", columns).to_pandas()
    weld, names = read_codes(result.folder, "nodes", "weld")
    face, faces = read_codes(result.folder, "nodes", "surface")
    table["weld"] = pd.Categorical.from_codes(weld, names)
    table["surface"] = pd.Categorical.from_codes(face, faces)
    table["screened"] = ~counted_points(result.folder)
    known = {name: place for place, name in enumerate(_in_order(first))}
    place = np.array([known.get(name, len(known)) for name in names], np.int64)[weld]
    side = np.array([FACES.index(name) for name in faces], np.int64)[face]
    return table.iloc[np.lexsort([side, table["order"], table["part"], place])]


def _in_order(result: Result) -> list[str]:
    """Welds in the order of the table of nodes."""
    codes, names = read_codes(result.folder, "nodes", "weld")
    return [names[code] for code in codes[np.sort(np.unique(codes, return_index=True)[1])]]


def _damage(result: Result, event: str) -> Floats:
    """Damage (p,) of an event per km, or per pass, in the rows of the table of nodes.

    Raises
    ------
    DataError : the table has other rows than one for each point and event
    """
    column = "damage_per_pass" if result.is_by_number(event) else "damage_per_km"
    groups = number_groups(result.folder, "damage", [column], {"event": [event]})
    found = np.concatenate([group[column][group["event"] == 0] for group in groups])
    if len(found) != (points := row_count(result.folder, "nodes")):
        what = f"has {len(found)} rows of the event {visible(event)!r} for {points} points"
        raise DataError(Problem("damaged_result", str(result.folder / "damage.parquet"), what, "Assess again"))
    return found


def _other_rules(first: Result, other: Result) -> Iterator[Problem]:
    """Refusals of a result that another curve or rule made."""
    welds = [one.welds.set_index("weld") for one in (first, other)]
    for name, curve, limit in welds[1][["curve", "damage_limit"]].itertuples():
        if name not in welds[0].index:
            continue  # told with the points
        ours = welds[0].loc[name]
        if curve != ours["curve"]:
            what = f"weld {visible(name)!r} is on the curve {curve!r}, in {first.where} on {ours['curve']!r}"
            yield Problem("fleet_curve", other.where, what, "Assess both on one curve")
        elif limit != ours["damage_limit"] and not (pd.isna(limit) and pd.isna(ours["damage_limit"])):
            what = f"weld {visible(name)!r} may reach a damage of {limit:g}, in {first.where} {ours['damage_limit']:g}"
            yield Problem("fleet_curve", other.where, what, "Assess both with one limit")
    for name, curve in other.record["curves"].items():
        ours = first.record["curves"].get(name)
        if ours is not None and ours["used"] != curve["used"]:
            keys = [key for key in curve["used"] if curve["used"][key] != ours["used"].get(key)]
            what = f"the curve {name!r} was used with other {few(keys)} than in {first.where}"
            yield Problem("fleet_curve", other.where, what, "Assess both with one survival, extension and factors")
    for rule in _RULES:
        one, two = first.record["rules"].get(rule), other.record["rules"].get(rule)
        if one != two:
            what = f"was assessed with {rule} = {two!r}, {first.where} with {one!r}"
            yield Problem("fleet_rule", other.where, what, "Assess both under one rule")


def _other_points(first: Result, base: pd.DataFrame, other: Result, points: pd.DataFrame) -> Iterator[Problem]:
    """Refusal of a result with other welds or points, by the first that differs."""
    welds = [list(dict.fromkeys(table["weld"].astype(str))) for table in (base, points)]
    remedy = "Assess both with one register; results of another body are no conditions of one fleet"
    for one, its, two, their in ((first, welds[0], other, welds[1]), (other, welds[1], first, welds[0])):
        missing = [visible(name) for name in its if name not in set(their)]
        if missing:
            what = f"does not have the weld {few(missing)} of {one.where}"
            yield Problem("fleet_register", two.where, what, remedy)
            return
    if len(base) != len(points):
        counts = [table["weld"].astype(str).value_counts() for table in (base, points)]
        name = next(name for name in welds[0] if counts[0][name] != counts[1][name])
        what = f"weld {visible(name)!r} has {counts[1][name]} points, in {first.where} {counts[0][name]}"
        yield Problem("fleet_points", other.where, what, remedy)
        return
    places = ["x_mm", "y_mm", "z_mm"]
    moved = np.sqrt(((base[places].to_numpy() - points[places].to_numpy()) ** 2).sum(axis=1)) > SAME_MM
    differs = {
        "is another point": np.any(
            [base[name].astype(str).to_numpy() != points[name].astype(str).to_numpy() for name in _KEY], axis=0
        ),
        f"lies more than {SAME_MM:g} mm away from it": moved,
        "has another plate thickness": base["thickness_mm"].to_numpy() != points["thickness_mm"].to_numpy(),
        "carries a toe in one of them only": base["toe"].to_numpy() != points["toe"].to_numpy(),
    }
    for how, where in differs.items():
        if where.any():
            at = base.iloc[int(where.argmax())]
            what = f"weld {visible(str(at['weld']))!r}, part {at['part']}, order {at['order']}, {at['surface']}"
            what += f" of {first.where}: the point here {how}"
            yield Problem("fleet_points", other.where, what, remedy, int(where.sum()))
            return
