"""The tables of two results beside each other: points, welds, and what makes the ratio of their lives."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.decide.compare.finished import Finished, Ints
from fatigue.decide.compare.matched.faces import SWAPPED, match_faces
from fatigue.decide.compare.matched.stations import MatchedStations, match_stations
from fatigue.decide.compare.matched.welds import MatchedWelds
from fatigue.decide.compare.ratios import EXACT, life_ratio
from fatigue.decide.compare.rules import Difference, differences
from fatigue.decide.compare.split import MODE, UNIT_LOAD, causes
from fatigue.decide.compare.words import MOST_MODES, Cause, largest_cause, mode_names, modes_of, why

MOST_ROWS = 2_000_000  # of causes of all points; where there would be more, those of each weld's worst point are kept
POINT, WELD = "point", "weld"
LOST, GAINED = "lost", "gained"
ELSEWHERE = " (of two points: another one is the worst there)"


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """A result beside the reference.

    Attributes
    ----------
    first, other : the results
    matched : which weld is which
    points : a row for each matched point; ``compare``
    welds : a row for each matched weld, the largest loss first; ``compare_welds``
    causes : what makes the ratios of welds, worst point over worst point, and of points; ``compare_causes``
    stations : stations of the other result, and how many of them no station of the first was matched to, by weld
    differences : what else differs
    face_assumed : why faces of one name were taken for one face; empty where normals tell
    every_point : whether ``causes`` has all points, else those that are the worst of their welds
    by_shear : points without causes, as a sum of shear decides about their life
    """

    first: Finished
    other: Finished
    matched: MatchedWelds
    points: pd.DataFrame
    welds: pd.DataFrame
    causes: pd.DataFrame
    unmatched_stations: Mapping[str, tuple[int, int]]
    differences: tuple[Difference, ...]
    face_assumed: str
    every_point: bool
    by_shear: int


def pair_of(a: Finished, b: Finished, matched: MatchedWelds) -> Pair:
    """Lay the matched welds of two results beside each other.

    Raises
    ------
    DataError : a table is damaged
    """
    number = {name: i for i, name in enumerate(b.points.names)}
    partner = np.array([number.get(matched.other.get(name, ""), -1) for name in a.points.names], np.int64)
    stations = match_stations(a.points, b.points, partner)
    face, assumed = match_faces(a, b, stations)
    rows_a, rows_b = _faces(stations, face)
    points = _points(a, b, rows_a, rows_b).assign(
        distance_mm=np.repeat(stations.distance, 2),
        comparable=np.repeat(stations.comparable, 2),
        face=np.repeat(face, 2),
    )
    some_a = np.flatnonzero(partner >= 0)
    worst_a, worst_b = a.worst[some_a], b.worst[partner[some_a]]
    toes = (worst_a >= 0) & (worst_b >= 0)
    worst_a, worst_b = worst_a[toes], worst_b[toes]
    at_worst = np.isin(rows_a, worst_a) | np.isin(rows_b, worst_b)
    is_exact = (points["basis"] == EXACT) & points["comparable"] & np.isfinite(a.points.life[rows_a])
    is_exact &= np.isfinite(b.points.life[rows_b])
    every_point = _rows_of_causes(a, b, int(is_exact.sum())) <= MOST_ROWS
    chosen = np.flatnonzero(is_exact if every_point else is_exact & at_worst)
    beside = np.full(len(a.points), -1)
    beside[rows_a] = rows_b
    of_welds = _points(a, b, worst_a, worst_b).assign(worst_moved=beside[worst_a] != worst_b)
    counted = np.flatnonzero(
        (of_welds["basis"] == EXACT) & np.isfinite(a.points.life[worst_a]) & np.isfinite(b.points.life[worst_b])
    )
    first = np.concatenate([worst_a[counted], rows_a[chosen]])
    second = np.concatenate([worst_b[counted], rows_b[chosen]])
    made = causes(a, b, first, second)
    pair = made.pop("pair").to_numpy()
    table = pd.DataFrame(
        {
            "result": b.letter,
            "scope": np.where(pair < len(counted), WELD, POINT),
            **a.points.keys(first[pair]),
            **{f"other_{name}": values for name, values in b.points.keys(second[pair]).items()},
        }
    )
    table = pd.concat([table, made], axis=1)
    welds = _welds(a, b, matched, of_welds, table[table["scope"] == WELD])
    return Pair(
        first=a,
        other=b,
        matched=matched,
        points=points,
        welds=welds,
        causes=table,
        unmatched_stations=_unmatched(b, stations),
        differences=tuple(differences(a, b, matched)),
        face_assumed=assumed,
        every_point=every_point,
        by_shear=len(chosen) - int(np.count_nonzero(np.unique(pair) >= len(counted))),
    )


def _faces(stations: MatchedStations, face: NDArray[np.object_]) -> tuple[Ints, Ints]:
    """Rows of the points of matched stations, top and bottom of the first in turn, and those of the other."""
    two = np.array([0, 1])
    turned = np.where(face == SWAPPED, 1, 0)[:, None]
    return (2 * stations.first[:, None] + two).ravel(), (2 * stations.second[:, None] + (two ^ turned)).ravel()


def _points(a: Finished, b: Finished, rows_a: Ints, rows_b: Ints) -> pd.DataFrame:
    """Pairs of points with their lives and the ratio of these."""
    life_a, life_b = a.points.life[rows_a], b.points.life[rows_b]
    log, basis = life_ratio(life_a, life_b, a.points.screened[rows_a], b.points.screened[rows_b])
    with np.errstate(over="ignore"):
        ratio = np.exp(log)
    return pd.DataFrame(
        {
            "result": b.letter,
            **a.points.keys(rows_a),
            **{f"other_{name}": values for name, values in b.points.keys(rows_b).items()},
            "toe": a.points.toe[rows_a],
            "other_toe": b.points.toe[rows_b],
            "life_km": life_a,
            "other_life_km": life_b,
            "life_ratio": ratio,
            "log_life_ratio": log,
            "basis": basis,
        }
    )


def _rows_of_causes(a: Finished, b: Finished, points: int) -> int:
    """How many rows the causes of some points have at most."""
    coordinates = len(a.frequency_hz) + len(a.record.get("unit_loads", [])) if a.is_diagnosed and b.is_diagnosed else 0
    return points * (1 + len({*a.passes, *b.passes}) * (3 + coordinates))


def _welds(a: Finished, b: Finished, matched: MatchedWelds, worst: pd.DataFrame, made: pd.DataFrame) -> pd.DataFrame:
    """A row for each weld: its worst point over that of the other, whether its verdict flips, and why."""
    ours, theirs = a.welds.loc[worst["weld"]], b.welds.loc[worst["other_weld"]]
    met, other_met = ours["fulfilled"].to_numpy(np.bool_), theirs["fulfilled"].to_numpy(np.bool_)
    table = worst.drop(columns=["toe", "other_toe"]).assign(
        matched_by=[matched.by[weld] for weld in worst["weld"]],
        utilisation=ours["utilisation"].to_numpy(),
        other_utilisation=theirs["utilisation"].to_numpy(),
        fulfilled=met,
        other_fulfilled=other_met,
        flip=np.where(met == other_met, "", np.where(met, LOST, GAINED)),
        curve=ours["curve"].to_numpy(),
        other_curve=theirs["curve"].to_numpy(),
    )
    of_weld, names = _by_weld(made), mode_names(a.record)
    each = zip(table["weld"], table["log_life_ratio"], table["worst_moved"], strict=True)
    said = [_cause(of_weld.get(weld, []), log, names, moved=moved) for weld, log, moved in each]
    of_cause = pd.DataFrame(said, columns=["cause_event", "cause_log_life_ratio", "cause_by", "why"])
    table = pd.concat([table, of_cause], axis=1)
    return table.sort_values("log_life_ratio", kind="stable", ignore_index=True)


def _by_weld(made: pd.DataFrame) -> dict[str, list[Cause]]:
    """Causes of each weld; of the modes of an event only the largest, which may be named."""
    sign = np.sign(made["log_life_ratio"])
    place = made.groupby(["weld", "event", "kind", sign], sort=False, dropna=False).cumcount()  # largest first
    some = made[(place < MOST_MODES) | ~made["kind"].isin((MODE, UNIT_LOAD))]
    found: dict[str, list[Cause]] = {}
    for weld, *cause in some[["weld", *Cause._fields]].itertuples(index=False, name=None):
        found.setdefault(weld, []).append(Cause(*cause))
    return found


def _cause(made: Sequence[Cause], log: float, names: Mapping[int, str], *, moved: bool) -> tuple[Any, ...]:
    """Event that moves a life most the way it went (empty: the limit), what it adds, by which modes, all in words."""
    largest = largest_cause(made, log)
    if largest is None:
        return None, np.nan, "", ""
    modes, said = modes_of(made, largest, names), why(made, log, names)
    return largest.event, largest.log_life_ratio, ", ".join(modes), f"{said}{ELSEWHERE * (moved and bool(said))}"


def _unmatched(b: Finished, stations: MatchedStations) -> dict[str, tuple[int, int]]:
    """Stations of each weld of the other result, and how many of them no point of the first stands beside."""
    weld = b.points.weld[b.points.stations]
    found = np.zeros(len(weld), np.bool_)
    found[stations.second] = True
    every = np.bincount(weld, minlength=len(b.points.names))
    alone = np.bincount(weld[~found], minlength=len(b.points.names))
    return {name: (int(n), int(k)) for name, n, k in zip(b.points.names, every, alone, strict=True)}
