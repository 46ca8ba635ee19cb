"""The hot spots of a result, made of its tables of nodes and welds; nothing is stored of them.

What they say is in ``nodes.parquet``: a table of their own could only say it again, or something else. So the results
of earlier versions have them, too, and there is one definition, here.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.report.hot_spots.stretches import stretches
from fatigue.results import NODES, Column

_OF_WORST = (
    "node",
    "part",
    "order",
    "arc_length_mm",
    "x_mm",
    "y_mm",
    "z_mm",
    "thickness_mm",
    "life_km",
    "life_years",
    "utilisation",
    "fulfilled",
    "load_factor",
    "life_km_dirlik",
    "dirlik_ratio",
    "max_range_MPa",
    "equivalent_range_2e6_MPa",
    "bending_ratio",
    "governing_event",
    "at_end",
    "at_corner",
    "summed_corner",
)
NEEDED = ("weld", "surface", "toe", "screened", *_OF_WORST)  # columns of the table of nodes
_DICTIONARY = {column.name: column for column in NODES}
HOT_SPOTS = (
    Column("hot_spot", "int", "-", "rank among all hot spots, by the utilisation of the worst point"),
    Column("weld", "text", "-", "weld line"),
    Column("surface", "text", "-", "face of the assessed plate; each face has hot spots of its own"),
    Column("from_mm", "float", "mm", "arc length of the first station of the stretch"),
    Column("to_mm", "float", "mm", "arc length of its last station; below from_mm: through the start of a ring"),
    Column("length_mm", "float", "mm", "from the first station to the last, as fine as the stations stand; 0: one"),
    Column("stations", "int", "-", "stations of the stretch: connected, with half of the worst utilisation or more"),
    Column("not_counted", "int", "-", "those of them of which only an upper bound of the utilisation is known"),
    *(_DICTIONARY[name] for name in _OF_WORST),
)


@dataclass(frozen=True, slots=True, eq=False)
class HotSpots:
    """Hot spots with the columns ``HOT_SPOTS``, worst first, and where they are in the table of nodes.

    ``worst_row`` (k,) are rows of their worst points, ``of_row`` (n,) the rank of the hot spot of every row: 0 of a
    point in none, on a flank, where nothing damages, or no toe.
    """

    table: pd.DataFrame
    worst_row: NDArray[np.int64]
    of_row: NDArray[np.int64]


def hot_spots(nodes: pd.DataFrame, welds: pd.DataFrame) -> HotSpots:
    """Hot spots of the welds in a table of nodes: connected toe points of one face with half of the largest damage.

    Parameters
    ----------
    nodes : the columns ``NEEDED`` of the table of nodes, every weld with all its rows
    welds : ``weld``, ``closed``, ``parts`` and ``length_mm`` of the register
    """
    codes, names = pd.factorize(nodes["weld"])
    face = (nodes["surface"] == "bottom").to_numpy()
    along = np.lexsort((nodes["order"], nodes["part"], face, codes))
    sorted_ = nodes.iloc[along].reset_index(drop=True)
    of_weld = welds.set_index("weld").loc[list(names), ["closed", "parts", "length_mm"]]
    is_ring = (of_weld["closed"].astype(bool) & (of_weld["parts"] == 1)).to_numpy()[codes[along]]
    line = np.stack([codes[along], face[along], sorted_["part"]])
    before, behind = _neighbours(line, is_ring)
    damage = np.where(sorted_["toe"], sorted_["utilisation"], np.nan)
    found = stretches(damage, (sorted_["screened"].fillna("") == "").to_numpy(), before, behind)

    worst = sorted_.iloc[found.worst]
    by_damage = np.argsort(-worst["utilisation"].to_numpy(), kind="stable")
    rank = np.empty(len(by_damage) + 1, dtype=np.int64)
    rank[by_damage], rank[-1] = np.arange(1, len(by_damage) + 1), 0
    arc = sorted_["arc_length_mm"].to_numpy()
    circumference = of_weld["length_mm"].to_numpy()[codes[along]][found.worst]
    start, end = arc[found.first], arc[found.last]
    start, end = np.where(found.whole, 0.0, start), np.where(found.whole, circumference, end)
    inside = found.of_station >= 0
    bounded = inside & (sorted_["screened"].fillna("") != "").to_numpy()
    columns = {
        "hot_spot": rank[:-1],
        "weld": worst["weld"].to_numpy(),
        "surface": worst["surface"].to_numpy(),
        "from_mm": start,
        "to_mm": end,
        "length_mm": np.where(end >= start, end - start, end - start + circumference),
        "stations": np.bincount(found.of_station[inside], minlength=len(worst)),
        "not_counted": np.bincount(found.of_station[bounded], minlength=len(worst)),
        **{name: worst[name].to_numpy() for name in _OF_WORST},
    }
    of_row = np.empty(len(nodes), dtype=np.int64)
    of_row[along] = rank[found.of_station]
    table = pd.DataFrame(columns).iloc[by_damage].reset_index(drop=True)
    return HotSpots(table, along[found.worst][by_damage], of_row)


def _neighbours(line: NDArray[np.int64], is_ring: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Stations before and behind each one, -1 at the ends of a line; ``line`` (3, n) tells the lines apart."""
    n = line.shape[1]
    begins = np.ones(n, dtype=bool)
    begins[1:] = (line[:, 1:] != line[:, :-1]).any(axis=0)
    ends = np.append(begins[1:], True)[:n]
    first = np.flatnonzero(begins)
    number = np.cumsum(begins) - 1
    last = np.flatnonzero(ends)
    before = np.where(begins, np.where(is_ring, last[number], -1), np.arange(n) - 1)
    behind = np.where(ends, np.where(is_ring, first[number], -1), np.arange(n) + 1)
    return before, behind
