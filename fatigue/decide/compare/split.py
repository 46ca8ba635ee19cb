"""Rows that say what makes the ratio of lives of some pairs of points, as the tables of both results have it."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.decide.compare.causes import added, log_ratio, split
from fatigue.decide.compare.finished import Finished, Ints
from fatigue.decide.of_result import FACES, is_sum_of_events
from fatigue.results import number_groups, read_codes

Floats = NDArray[np.float64]

LIMIT, EVENT, SEQUENCE, MISSION, PER_PASS, MODE, UNIT_LOAD = (
    "limit", "event", "sequence", "mission", "per_pass", "mode", "unit_load",
)  # fmt: skip
WHOLE = (LIMIT, EVENT, SEQUENCE)
"""Kinds that add up to the log ratio; mission and per_pass add up to their event, and so do modes with unit loads."""

AGREE = 1e-4  # of the damage of an event: what the modes have to add up to, before they are scaled to do so exactly
_KINDS = ("mode", "unit_load", "event", "sequence")  # of attribution.parquet, as they are read
_RANK = {kind: rank for rank, kind in enumerate((LIMIT, EVENT, SEQUENCE, MISSION, PER_PASS, MODE, UNIT_LOAD))}


@dataclass(frozen=True, slots=True, eq=False)
class Damages:
    """Damage of some points under the events that either result has; e of them, NaN where one has not the event.

    ``passes`` (e,) [1/km], ``per_pass`` (p, e), ``weighted`` (p, e) with 0 for NaN [1/km], ``total`` (p,) [1/km].
    """

    passes: Floats
    per_pass: Floats
    weighted: Floats
    total: Floats


def causes(a: Finished, b: Finished, rows_a: Ints, rows_b: Ints) -> pd.DataFrame:
    """What makes the ratio of lives of pairs of points, both of which are damaged and counted.

    Nothing is told of points whose damage is not the sum of their events, as a sum of shear decides there.
    Columns: ``pair`` (from 0), ``kind``, ``event``, ``mode``, ``unit_load``, ``value``, ``other_value``, ``unit`` and
    ``log_life_ratio``, what it adds to ``ln(life_B / life_A)``. Modes and unit loads stand where both results have a
    diagnosis of the point.

    Raises
    ------
    DataError : a table is damaged
    """
    events = list(dict.fromkeys([*a.passes, *b.passes]))
    of_a, of_b = _damages(a, rows_a, events), _damages(b, rows_b, events)
    sequences = a.sequences | b.sequences
    whole = np.array([SEQUENCE if event in sequences else EVENT for event in events], object)
    there = np.broadcast_to(~np.isnan(of_a.passes) | ~np.isnan(of_b.passes), of_a.weighted.shape)
    totals = of_a.total[:, None], of_b.total[:, None]
    parts = split(of_a.passes, of_b.passes, of_a.per_pass, of_b.per_pass, *totals)
    limits = a.limit[a.points.weld[rows_a]], b.limit[b.points.weld[rows_b]]
    of_limit = log_ratio(limits[1], limits[0])
    tables = [
        _rows(of_limit != 0.0, LIMIT, "-", *limits, of_limit),
        _rows(there, whole, "1/km", of_a.weighted, of_b.weighted, added(of_a.weighted, of_b.weighted, *totals)),
        _rows(~np.isnan(parts.mission), MISSION, "1/km", of_a.passes, of_b.passes, parts.mission),
        _rows(~np.isnan(parts.per_pass), PER_PASS, "-", of_a.per_pass, of_b.per_pass, parts.per_pass),
    ]
    if a.is_diagnosed and b.is_diagnosed:
        tables.append(_by_coordinate((a, b), (rows_a, rows_b), events, (of_a, of_b)))
    table = pd.concat([one for one in tables if len(one)] or tables[:1], ignore_index=True)
    is_sum = is_sum_of_events(a.points.damage[rows_a], of_a.total)
    is_sum &= is_sum_of_events(b.points.damage[rows_b], of_b.total)
    table = table[is_sum[table["pair"].to_numpy()]].copy()
    table["rank"] = table["kind"].map(_RANK)
    table["size"] = -table["log_life_ratio"].abs()
    table = table.sort_values(["pair", "event", "rank", "size"], kind="stable", ignore_index=True)
    names = np.array([*events, ""], object)  # a limit has the number -1
    return table.assign(event=names[table["event"]]).drop(columns=["rank", "size"])


def _damages(of: Finished, rows: Ints, events: list[str]) -> Damages:
    at = [events.index(event) for event in of.passes]
    passes, per_pass = np.full(len(events), np.nan), np.full((len(rows), len(events)), np.nan)
    passes[at] = list(of.passes.values())
    per_pass[:, at] = of.damage_per_pass(rows)
    weighted = np.nan_to_num(passes * per_pass)
    return Damages(passes, per_pass, weighted, weighted.sum(axis=1))


def _rows(
    some: NDArray[np.bool_], kind: str | NDArray[np.object_], unit: str, value: Floats, other: Floats, log: Floats
) -> pd.DataFrame:
    """Rows of those marked of all pairs (p,) or of all events of all pairs (p, e)."""
    at = np.nonzero(some)
    event = at[1] if len(at) == 2 else np.full(len(at[0]), -1)
    return pd.DataFrame(
        {
            "pair": at[0],
            "kind": kind if isinstance(kind, str) else kind[event],
            "event": event,
            "mode": pd.array([pd.NA] * len(event), dtype="Int64"),
            "unit_load": None,
            "value": np.broadcast_to(value, some.shape)[at],
            "other_value": np.broadcast_to(other, some.shape)[at],
            "unit": unit,
            "log_life_ratio": np.broadcast_to(log, some.shape)[at],
        }
    )


def _by_coordinate(
    results: tuple[Finished, Finished], rows: tuple[Ints, Ints], events: list[str], of: tuple[Damages, Damages]
) -> pd.DataFrame:
    """Rows of every mode and unit load of the events that both diagnoses tell of, or one and the other has not."""
    on = ["pair", "event", "mode", "unit_load"]
    told = np.ones(of[0].weighted.shape, np.bool_)
    sides = []
    for result, some, damages, name in zip(results, rows, of, ("value", "other_value"), strict=True):
        parts, whole = _attributed(result, some, events)
        fits = np.abs(whole - damages.weighted) <= AGREE * np.abs(damages.weighted)
        told &= fits | (damages.weighted == 0.0)
        scale = np.divide(damages.weighted, whole, out=np.zeros_like(whole), where=fits & (whole != 0.0))
        parts[name] = parts.pop("damage") * scale[parts["pair"], parts["event"]]
        sides.append(parts)
    table = sides[0].merge(sides[1], on=on, how="outer").fillna({"value": 0.0, "other_value": 0.0})
    pair, event = table["pair"].to_numpy(), table["event"].to_numpy()
    table = table[told[pair, event] & ((table["value"] != 0.0) | (table["other_value"] != 0.0))]
    pair = table["pair"].to_numpy()
    is_mode = table["unit_load"] == ""
    log = added(table["value"], table["other_value"], of[0].total[pair], of[1].total[pair])
    return table.assign(
        kind=np.where(is_mode, MODE, UNIT_LOAD),
        mode=table["mode"].astype("Int64").where(is_mode),
        unit_load=table["unit_load"].astype(object).where(~is_mode, None),
        unit="1/km",
        log_life_ratio=log,
    )


def _attributed(of: Finished, rows: Ints, events: list[str]) -> tuple[pd.DataFrame, Floats]:
    """Damage of every mode and unit load of every event at some points, and of whole events (p, e), NaN without.

    Both are weighted [1/km], as a diagnosis has them.
    """
    points, once = of.points, np.unique(rows)
    known = pd.MultiIndex.from_arrays([points.weld[once], points.part[once], points.order[once], once % 2])
    _, loads = read_codes(of.folder, "attribution", "unit_load")
    texts = {"weld": points.names, "surface": FACES, "event": events, "kind": _KINDS, "unit_load": loads}
    found = []
    for group in number_groups(of.folder, "attribution", ["part", "order", "mode", "damage_per_km"], texts):
        wanted = group["kind"] >= 0
        key = [group[name][wanted] for name in ("weld", "part", "order", "surface")]
        place = known.get_indexer(pd.MultiIndex.from_arrays(key))
        columns = {name: group[name][wanted] for name in ("kind", "event", "mode", "unit_load", "damage_per_km")}
        table = pd.DataFrame(columns | {"place": place})
        found.append(table[(place >= 0) & (table["event"] >= 0)])
    every = pd.concat(found, ignore_index=True)
    is_whole = every["kind"] >= _KINDS.index("event")
    whole = np.full((len(once), len(events)), np.nan)
    whole[every["place"][is_whole], every["event"][is_whole]] = every["damage_per_km"][is_whole]
    parts = every[~is_whole]
    names = np.array([*loads, ""], object)
    parts = pd.DataFrame(
        {
            "place": parts["place"],
            "event": parts["event"],
            "mode": parts["mode"].fillna(-1).astype(np.int64),
            "unit_load": names[parts["unit_load"]],
            "damage": parts["damage_per_km"],
        }
    )
    place = np.searchsorted(once, rows)
    pairs = pd.DataFrame({"place": place, "pair": np.arange(len(rows))})
    return pairs.merge(parts, on="place").drop(columns="place"), whole[place]
