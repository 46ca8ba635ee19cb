"""The cycles of very long lists for the page: those that are alike are one row, so that memory does not grow with them.

Cycles of one point and event are alike whose equivalent ranges are in the same of 100 classes a decade, their means in
the same class of ``MEAN_MPA`` and their bending ratios in the same tenth. Their counts and damages add up. The row has
the mean of their ranges to the power k, the slope of the curve, so that damage by the same slope stays; the other
columns are means. The most damaging cycle of each event stays by itself. What the damage of the cycles one by one adds
up to is found beside it.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.results import number_groups

MOST_ROWS = 1_000_000  # of the whole table of cycles that are listed one by one
PER_DECADE = 100
MEAN_MPA = 2.0
FACES = ("top", "bottom")

_KEYS = ("event", "dS_class", "mean_class", "ratio_class")
_SUMS = ("count", "damage", "range_k", "dS_k", "n_mean", "n_ratio")
_NUMBERS = (
    "part",
    "order",
    "start_s",
    "end_s",
    "range_MPa",
    "mean_MPa",
    "count",
    "bending_ratio",
    "equivalent_range_dS",
    "damage",
)


@dataclass(frozen=True, slots=True, eq=False)
class MergedCycles:
    """Merged rows of the table of cycles of one point, and its damage per km from all of its cycles, one by one."""

    rows: pd.DataFrame
    damage_per_km: float


@dataclass(frozen=True, slots=True, eq=False)
class ShownPoint:
    """A point whose cycles are shown: its place, slope k of its curve, damage of cycles by dS, passes of each event."""

    part: int
    order: int
    surface: str
    slope: float
    damage: Callable[[NDArray[np.float64]], NDArray[np.float64]]
    passes_per_km: Mapping[str, float]


def merged_cycles(folder: Path, points: Mapping[str, ShownPoint], events: Sequence[str]) -> dict[str, MergedCycles]:
    """Merged cycles of some welds' points, by weld; the table is read once, some rows at a time.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    names = list(points)
    passes = {weld: np.array([point.passes_per_km[event] for event in events]) for weld, point in points.items()}
    sums: dict[str, pd.DataFrame] = {}
    largest: dict[tuple[str, int], dict[str, Any]] = {}
    totals = dict.fromkeys(names, 0.0)
    texts = {"weld": names, "surface": FACES, "event": events}
    for group in number_groups(folder, "cycles", _NUMBERS, texts):
        table = pd.DataFrame(group)
        for number in np.unique(group["weld"][group["weld"] >= 0]).tolist():
            weld, point = names[number], points[names[number]]
            rows = table[
                (table["weld"] == number)
                & (table["part"] == point.part)
                & (table["order"] == point.order)
                & (table["surface"] == FACES.index(point.surface))
            ]
            if rows.empty:
                continue
            n = rows["count"].to_numpy()
            per_km = n * passes[weld][rows["event"].to_numpy()]
            totals[weld] += float(np.sum(per_km * point.damage(rows["equivalent_range_dS"].to_numpy())))
            _remember(largest, weld, rows)
            sums[weld] = _added([*([sums[weld]] if weld in sums else []), _classified(rows, point.slope)])
    return {
        weld: MergedCycles(
            _rows(some, [row for key, row in largest.items() if key[0] == weld], events, points[weld].slope),
            totals[weld],
        )
        for weld, some in sums.items()
    }


def _added(classes: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Sums of equal classes."""
    return pd.concat(classes).groupby(list(_KEYS), sort=True, as_index=False).sum()


def _classified(rows: pd.DataFrame, k: float) -> pd.DataFrame:
    """Classes of some cycles and what adds up in them."""
    n, S, dS = (rows[name].to_numpy() for name in ("count", "range_MPa", "equivalent_range_dS"))
    ratio = np.nan_to_num(rows["bending_ratio"].to_numpy())
    return pd.DataFrame(
        {
            "event": rows["event"].to_numpy(),
            "dS_class": np.floor(PER_DECADE * np.log10(np.maximum(dS, 1e-12))),
            "mean_class": np.floor(rows["mean_MPa"].to_numpy() / MEAN_MPA),
            "ratio_class": np.floor(10.0 * ratio),
            "count": n,
            "damage": rows["damage"].to_numpy(),
            "range_k": n * S**k,
            "dS_k": n * dS**k,
            "n_mean": n * rows["mean_MPa"].to_numpy(),
            "n_ratio": n * ratio,
        }
    )


def _remember(largest: dict[tuple[str, int], dict[str, Any]], weld: str, rows: pd.DataFrame) -> None:
    """Keep the most damaging cycle of each event, the first of equal ones."""
    each = rows["damage"] / rows["count"]
    for event, at in each.groupby(rows["event"]).idxmax().items():
        row = rows.loc[at].to_dict()
        before = largest.get((weld, int(event)))
        if before is None or row["damage"] / row["count"] > before["damage"] / before["count"]:
            largest[weld, int(event)] = row


def _rows(sums: pd.DataFrame, largest: list[dict[str, Any]], events: Sequence[str], k: float) -> pd.DataFrame:
    """Rows of the classes, the most damaging cycles taken out of theirs and put in front."""
    own = pd.DataFrame(largest)
    if len(own):
        taken = _classified(own, k)
        taken[list(_SUMS)] *= -1.0
        sums = _added([sums, taken])
    sums = sums[sums["count"] > 0.25]  # a count is 0.5 at least; rounding is left of a cycle that stood alone
    n = sums["count"]
    merged = pd.DataFrame(
        {
            "event": sums["event"].astype(int),
            "start_s": np.nan,
            "end_s": np.nan,
            "range_MPa": np.maximum(sums["range_k"] / n, 0.0) ** (1.0 / k),
            "mean_MPa": sums["n_mean"] / n,
            "count": n,
            "bending_ratio": sums["n_ratio"] / n,
            "equivalent_range_dS": np.maximum(sums["dS_k"] / n, 0.0) ** (1.0 / k),
            "damage": np.maximum(sums["damage"], 0.0),
        }
    )
    rows = pd.concat([own[list(merged.columns)], merged], ignore_index=True) if len(own) else merged
    return rows.assign(event=np.array(events, dtype=object)[rows["event"].astype(int)])
