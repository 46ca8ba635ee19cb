"""Which points have load spectra: the worst of every weld, or those of a list."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.results import assessed, number_groups, read_welds
from fatigue.why.points import Chosen

MOST_POINTS = 2000  # of a body of 1e6 points and 13 events, 64 classes of all would be 20 GB
FACES = ("top", "bottom")
Key = tuple[str, int, int, str]  # weld, part, order, surface


def worst_of_welds(folder: Path) -> Chosen:
    """The worst point of every weld, of more than ``MOST_POINTS`` welds those with the shortest lives."""
    welds = assessed(read_welds(folder))
    named = welds.head(MOST_POINTS)
    keys = named[["weld", "worst_part", "worst_order", "worst_surface"]].itertuples(index=False)
    found, _ = _rows_of(folder, [(str(w), int(part), int(order), str(face)) for w, part, order, face in keys])
    what = f"the worst point of every weld, {len(named)}"
    if len(named) < len(welds):
        what = f"the worst points of the {len(named)} of {len(welds)} welds with the shortest lives"
    return _chosen(np.array(found, dtype=np.int64), "worst of its weld", what)


def listed_points(folder: Path, path: Path) -> Chosen:
    """The points of a table with the columns ``weld``, ``order``, ``surface`` and, where a weld has several, ``part``.

    Raises
    ------
    DataError : unknown points, too many of them, or a table that is none
    """
    table = open_table(path, texts=("weld", "surface"))
    rows = rows_of_keys(folder, table, ())
    unique = np.unique(rows)
    if len(unique) > MOST_POINTS:
        what = f"names {len(unique)} points, {MOST_POINTS} are possible"
        raise DataError(Problem("too_many_points", path.name, what, "Name fewer, the worst of each weld for instance"))
    return _chosen(unique, "listed", f"the {len(unique)} points of {path.name}")


def rows_of_keys(folder: Path, table: Table, beside: tuple[str, ...]) -> NDArray[np.int64]:
    """Row in ``nodes.parquet`` of the point that each row of a table names; ``beside``: its other columns.

    Raises
    ------
    DataError : a point that the result does not have, or a table without its columns
    """
    table.expect(("weld", "order", "surface", *beside), ("part", "node"), strict=False)
    welds, orders, faces = table.texts("weld"), table.integers("order"), table.texts("surface")
    table.choices("surface", faces, FACES)
    parts = table.integers("part", default=1)
    node = table.integers("node", default=-1) if "node" in table.position else np.full(table.rows, -1)
    if not table.rows:
        table.problems.append(Problem("no_points", table.path.name, "has no rows", "Name at least one point"))
    table.refuse()
    keys = list(zip(welds, parts.tolist(), orders.tolist(), faces, strict=True))
    rows, nodes = _rows_of(folder, keys)
    for row, (key, found) in enumerate(zip(keys, rows, strict=True)):
        if found < 0:
            place = "weld {!r}, part {}, order {}, {}".format(*key)
            what, remedy = f"there is no point {place} in this result", "Take the keys from nodes.parquet of the result"
            table.problems.append(Problem("unknown_point", f"{table.path.name}: {table.row_name(row)}", what, remedy))
        elif node[row] not in (-1, nodes[row]):
            what = f"the point at this place has the node {nodes[row]}, not {node[row]}"
            remedy = "Take the keys from nodes.parquet of the result"
            table.problems.append(Problem("unknown_point", f"{table.path.name}: {table.row_name(row)}", what, remedy))
    refuse(DataError, _few(table.problems, table.path.name))
    return np.array(rows, dtype=np.int64)


def _few(problems: list[Problem], file: str, most: int = 10) -> list[Problem]:
    """The first of many mistakes of one kind, and how many more there are."""
    more = len(problems) - most
    if more <= 0:
        return problems
    what = f"{more} more rows name points that this result does not have"
    return [*problems[:most], Problem("unknown_point", file, what, "Take the keys from nodes.parquet", more)]


def _rows_of(folder: Path, keys: list[Key]) -> tuple[list[int], list[int]]:
    """Row of each key in the table of nodes, -1 where there is none, and the node there; the table is read once."""
    wanted, known, first = set(keys), dict[Key, tuple[int, int]](), 0
    welds = list(dict.fromkeys(weld for weld, *_ in keys))
    for group in number_groups(folder, "nodes", ("part", "order", "node"), {"weld": welds, "surface": FACES}):
        rows = np.flatnonzero(group["weld"] >= 0)
        columns = (group[name][rows].tolist() for name in ("weld", "part", "order", "surface", "node"))
        for row, weld, part, order, face, node in zip(rows.tolist(), *columns, strict=True):
            key = welds[weld], part, order, FACES[face]
            if key in wanted:
                known[key] = (first + row, node)
        first += len(group["weld"])
    found = [known.get(key, (-1, -1)) for key in keys]
    return [row for row, _ in found], [node for _, node in found]


def _chosen(rows: NDArray[np.int64], why: str, what: str) -> Chosen:
    rows = np.sort(rows)
    return Chosen(rows, np.full(len(rows), why, dtype=object), np.arange(len(rows)), what)
