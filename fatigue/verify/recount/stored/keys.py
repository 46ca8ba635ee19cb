"""The rows a table of a result should have against those it has: none dropped, none twice, none from elsewhere.

Tables are read row group by row group. As long as their rows come in the order in which they are written nothing is
kept; only of a table in another order, or with rows too few or too many, the row of every key is.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.results import number_groups, read_rows
from fatigue.verify.recount.layout import Layout, station_finder
from fatigue.verify.recount.stored.compare import ColumnCheck

Labels = Mapping[str, Sequence[Any]]  # of each further key column: texts, or numbers in ascending order


@dataclass(frozen=True, slots=True, eq=False)
class RowPlaces:
    """Where the rows of a table are.

    ``row_of`` is the row of each key in the order of the layout, -1 where it is missing; None: they are in this order.
    """

    check: ColumnCheck
    row_of: NDArray[np.int64] | None

    def of(self, keys: NDArray[np.integer]) -> NDArray[np.int64]:
        """Rows of some keys, given by their numbers."""
        return np.asarray(keys if self.row_of is None else self.row_of[keys], dtype=np.int64)

    def in_order(self, column: NDArray[Any]) -> NDArray[Any]:
        """Whole column of the table in the order of the keys."""
        return column if self.row_of is None else column[self.row_of]


def find_rows(folder: Path, table: str, body: Layout, labels: Labels, unit_loads: Sequence[str] = ()) -> RowPlaces:
    """Where the rows of a table are that has one for each station of a body and each combination of some labels.

    ``unit_loads`` are further values of the last label, of rows in which that is missing: names in a column of theirs.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    names = ["weld", "part", "order", *labels]
    texts = {"weld": body.welds} | {name: known for name, known in labels.items() if isinstance(known[0], str)}
    numbers = [name for name in names if name not in texts]
    alone, last = labels, names[-1]
    if unit_loads:
        texts, labels = texts | {"unit_load": unit_loads}, {**labels, last: [*labels[last], *unit_loads]}
    expected = len(body) * prod(len(known) for known in labels.values())
    find, row_of, done = None, None, 0
    twice: list[int] = []
    strangers: list[int] = []
    for columns in number_groups(folder, table, numbers, texts):
        rows = len(columns["weld"])
        places = [columns[name] if name in texts else _place(columns[name], alone[name]) for name in labels]
        if unit_loads:
            places[-1] = _either(places[-1], columns["unit_load"], columns[last], len(alone[last]))
        stations = [columns["weld"], columns["part"], columns["order"]]
        if row_of is None and done + rows <= expected and _as_written(body, labels, done, stations, places):
            done += rows
            continue
        if find is None or row_of is None:
            find, row_of = station_finder(body), np.full(expected, -1, dtype=np.int64)
            row_of[:done] = np.arange(done)
        key = _key(find(*stations), labels, places)
        strangers += (done + np.flatnonzero(key < 0)).tolist()
        known, first = np.unique(key[key >= 0], return_index=True)
        is_new = row_of[known] < 0
        row_of[known[is_new]] = done + np.flatnonzero(key >= 0)[first[is_new]]
        again = np.setdiff1d(np.flatnonzero(key >= 0), row_of[known] - done)
        twice += key[again].tolist()
        done += rows
    missing = np.arange(done, expected) if row_of is None else np.flatnonzero(row_of < 0)
    if twice or len(missing):
        where = f"first {_name(body, labels, (twice or missing.tolist())[0])}"
    elif strangers:
        (row,) = read_rows(folder, table, np.array(strangers[:1]), names).select(names).to_pylist()
        where = f"first {tuple(row.values())}"
    else:
        where = ""
    check = ColumnCheck(
        table=table,
        column=", ".join(names),
        unit="rows",
        compared=expected,
        difference=float(len(twice) + len(missing) + len(strangers)),
        tolerance=0.5,  # rows
        where=where,
        found=done,
        expected=expected,
    )
    return RowPlaces(check, row_of)


def _as_written(
    body: Layout, labels: Labels, first: int, stations: Sequence[NDArray[Any]], places: Sequence[NDArray[Any]]
) -> bool:
    """Whether some rows are those that come next, from the one with this number on."""
    at = np.arange(first, first + len(stations[0]))
    sizes = [len(known) for known in labels.values()]
    for place, size in zip(reversed(places), reversed(sizes), strict=True):
        at, expected = np.divmod(at, size)
        if not np.array_equal(place, expected):
            return False
    wanted: tuple[NDArray[Any], ...] = (body.weld, body.part, body.order)
    return all(np.array_equal(found, column[at]) for found, column in zip(stations, wanted, strict=True))


def _key(station: NDArray[np.int64], labels: Labels, places: Sequence[NDArray[Any]]) -> NDArray[np.int64]:
    """Numbers of keys in the order of the layout; -1 where a key is not known."""
    key, is_known = station, station >= 0
    for place, known in zip(places, labels.values(), strict=True):
        key, is_known = key * len(known) + place, is_known & (place >= 0)
    return np.where(is_known, key, -1)


def _place(values: NDArray[Any], known: Sequence[Any]) -> NDArray[np.int64]:
    """Place of numbers in an ascending list, -1 where they are not in it."""
    place = np.searchsorted(known, values).clip(max=len(known) - 1)
    return np.where(np.asarray(known)[place] == values, place, -1)


def _either(
    place: NDArray[np.int64], unit_load: NDArray[np.int64], number: NDArray[Any], numbers: int
) -> NDArray[np.int64]:
    """Place of a number or, where there is none, of a unit load behind them all; -1 where both are there."""
    is_load = np.isnan(number) & (unit_load >= 0)
    return np.where(is_load, numbers + unit_load, np.where(unit_load >= 0, -1, place))


def _name(body: Layout, labels: Labels, key: int) -> tuple[Any, ...]:
    """Key written out."""
    further: list[Any] = []
    for known in reversed([*labels.values()]):
        key, place = divmod(key, len(known))
        further.insert(0, known[place])
    return (*body.station(key), *further)
