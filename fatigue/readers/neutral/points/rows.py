"""The point, read-out, coordinate and surface of every row of a table of modal stresses; each has exactly one row."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.points.stress_points import StressPoints
from fatigue.readers.neutral.tables import Table
from fatigue.shown import few
from fatigue.weld.beside.hot_spot import EDGE

FACES = ("top", "bottom")
SURFACES = (*FACES, "edge")
MOST_MODES = 8  # named in one message


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Where each of r rows belongs; a pair is a point with one of its read-outs.

    Attributes
    ----------
    names, surface : of the points, and of the two surfaces of each
    used : (r,) rows that are read; the others are of ignored modes, or of unit loads that the case does not have
    pair, face, coordinate : (r,) number of the pair, 0 or 1 (bottom), number of the coordinate
    point_of_pair, read_out_of_pair : of each pair, ascending
    given : (p, 2) surfaces that a point has
    """

    names: tuple[str, ...]
    surface: tuple[tuple[str, str], ...]
    used: NDArray[np.bool_]
    pair: NDArray[np.int32]
    face: NDArray[np.int8]
    coordinate: NDArray[np.int32]
    point_of_pair: NDArray[np.intp]
    read_out_of_pair: NDArray[np.int64]
    given: NDArray[np.bool_]


def looked_up(table: Table, points: StressPoints, coordinates: Coordinates, ignore_modes: Collection[int]) -> Rows:
    """Look up every row; a table is refused unless each (point, read-out, coordinate, surface) has exactly one.

    A point has the surfaces that any of its rows has.

    Raises
    ------
    DataError : as said
    """
    point = _points(table, points)
    face = _faces(table, points, point)
    read_out = table.integers("read_out", default=None if "read_out" in table.position else 1)
    coordinate, used = _coordinates(table, coordinates, ignore_modes)
    table.refuse()
    numbers = np.unique(read_out)
    of_all = point * np.int64(numbers.size) + np.searchsorted(numbers, read_out)
    there = np.bincount(of_all, minlength=len(points) * numbers.size) > 0
    pairs, pair = np.flatnonzero(there), (np.cumsum(there, dtype=np.int32) - np.int32(1))[of_all]
    del of_all, read_out
    given = np.zeros((len(points), 2), dtype=np.bool_)
    given[point, face] = True
    rows = Rows(
        names=points.name,
        surface=tuple(("edge", "") if kind == EDGE else FACES for kind in points.kind),
        used=used,
        pair=pair,
        face=face,
        coordinate=coordinate,
        point_of_pair=pairs // numbers.size,
        read_out_of_pair=numbers[pairs % numbers.size],
        given=given,
    )
    _refuse_incomplete(table, rows, coordinates)
    return rows


def _points(table: Table, points: StressPoints) -> NDArray[np.int32]:
    """Number of the point of each row, -1 where it is unknown; unknown points and points without rows are noted."""
    names, code = table.groups("point")
    table.known("point", names, code, set(points.name), points.file)
    there = set(names)
    absent = [name for name in points.name if name not in there]
    if absent and "point" not in table.spoilt:
        count = f"{len(absent)} points: " if len(absent) > 1 else ""
        what = f"no stress is given at {count}{few(absent)}"
        remedy = f"Add its rows, or remove it from {points.file}"
        table.problems.append(Problem("missing_id", table.where("point"), what, remedy))
    number = {name: i for i, name in enumerate(points.name)}
    return np.array([number.get(name, -1) for name in names], dtype=np.int32)[code]


def _faces(table: Table, points: StressPoints, point: NDArray[np.int32]) -> NDArray[np.int8]:
    """0 for top and edge, 1 for bottom; a surface that the kind of the point does not have is noted."""
    names, code = table.groups("surface")
    unknown = [name for name in names if name not in SURFACES]
    what = f"{unknown[0]!r} is not one of {', '.join(SURFACES)}" if unknown else ""
    of_unknown = np.isin(names, unknown)[code]
    table.report(of_unknown, "bad_value", "surface", what, f"Give one of {', '.join(SURFACES)}")
    has_edge = np.array([kind == EDGE for kind in points.kind])[point]
    wrong = (has_edge != np.isin(names, ["edge"])[code]) & (point >= 0)
    row = int(wrong.argmax())
    kind, has = points.kind[point[row]], "edge" if has_edge[row] else "top or bottom"
    what = f"point {points.name[point[row]]} is of kind {kind}, whose surface is {has}"
    table.report(wrong, "surface", "surface", what, f"Give {has}, or another kind")
    return np.isin(names, ["bottom"])[code].astype(np.int8)


def _coordinates(
    table: Table, coordinates: Coordinates, ignore_modes: Collection[int]
) -> tuple[NDArray[np.int32], NDArray[np.bool_]]:
    """Number of the coordinate of each row, 0 where it is not used; and which rows are."""
    names, code = table.groups("unit_load", default="")
    has_load = np.array([bool(name) for name in names])[code]
    mode = table.integers("mode", default=0 if has_load.any() else None)
    if has_load.any():
        has_mode = ~np.isnan(table.numbers("mode", default=np.nan))
        remedy = "Give one of them, and leave the other one empty"
        table.report(has_load & has_mode, "bad_value", "mode", "the row has a mode and a unit load", remedy)
        neither = ~(has_load | has_mode)
        table.report(neither, "missing_value", "mode", "the row has neither a mode nor a unit load", "Give one of them")
    of_mode = _of_modes(table, coordinates.modes.mode, mode, has_load, ignore_modes)
    first = coordinates.modes.mode.size
    place = {name: first + i for i, name in enumerate(coordinates.unit_loads)}
    others = [name for name in names if name and name not in place]
    if others:
        what = f"rows of {few([repr(name) for name in others])} are not used"
        remedy = "Define a [[body.unit_load]] of this name, unless the load is left out on purpose"
        table.warnings.append(Problem("unused_stress", table.where("unit_load"), what, remedy, len(others)))
    of_load = np.array([place.get(name, -1) for name in names], dtype=np.int32)[code]
    found = np.where(has_load, of_load, of_mode)
    return np.maximum(found, 0), found >= 0


def _of_modes(
    table: Table,
    modes: NDArray[np.int64],
    mode: NDArray[np.int64],
    has_load: NDArray[np.bool_],
    ignore_modes: Collection[int],
) -> NDArray[np.int32]:
    """Number of the mode of each row, -1 where it is ignored; an unknown one is noted."""
    at = np.searchsorted(modes, mode).clip(max=modes.size - 1).astype(np.int32)
    at[modes[at] != mode] = -1
    unknown = (at < 0) & ~has_load
    unknown[unknown] = ~np.isin(mode[unknown], list(ignore_modes))
    if unknown.any():
        what = f"modes {few(np.unique(mode[unknown]).tolist(), MOST_MODES)} are not in the table of modes"
        table.report(unknown, "unknown_id", "mode", what, "Add them there or to ignore_modes")
    return at


def _refuse_incomplete(table: Table, rows: Rows, coordinates: Coordinates) -> None:
    """Refuse a table with a (point, read-out, coordinate, surface) that is missing or there twice."""
    shape = (rows.point_of_pair.size, 2, len(coordinates))
    key = (rows.pair * np.int64(2) + rows.face) * shape[2] + rows.coordinate
    counts = np.bincount(key if rows.used.all() else key[rows.used], minlength=int(np.prod(shape))).reshape(shape)
    if counts.max(initial=0) > 1:
        again = np.flatnonzero(rows.used & (counts.ravel()[key] > 1))
        row = _first_repeat(key, again)
        first = int(again[key[again] == key[row]][0])
        where = table.where("point, read_out, mode, surface", row)
        what = f"{_slot(rows, coordinates, key[row])} repeats {table.row_name(first)}"
        table.problems.append(Problem("duplicate", where, what, "Keep one of the rows"))
    wanted = rows.given[rows.point_of_pair][:, :, None]
    missing = np.argwhere((counts == 0) & wanted)
    if missing.size:
        pair, face, coordinate = missing[0]
        at = _slot(rows, coordinates, (pair * 2 + face) * shape[2] + coordinate)
        points = np.unique(rows.point_of_pair[missing[:, 0]]).size
        rows_missing = "1 such row is" if len(missing) == 1 else f"{len(missing)} such rows are"
        what = f"no stress is given ({rows_missing} missing, at {points} point{'s' * (points > 1)})"
        remedy = "Write the stress of every point, read-out, mode, unit load and surface, zeros too"
        table.problems.append(Problem("missing_row", f"{table.path.name}: {at}", what, remedy))
    table.refuse()


def _first_repeat(key: NDArray[np.int64], rows: NDArray[np.intp]) -> int:
    """The first of some rows whose key an earlier one has."""
    _, first = np.unique(key[rows], return_index=True)
    repeats = np.ones(rows.size, dtype=np.bool_)
    repeats[first] = False
    return int(rows[repeats][0])


def _slot(rows: Rows, coordinates: Coordinates, key: int) -> str:
    """Name a (point, read-out, coordinate, surface)."""
    rest, coordinate = divmod(int(key), len(coordinates))
    pair, face = divmod(rest, 2)
    point = rows.point_of_pair[pair]
    of = coordinates.name(int(coordinates.number[coordinate]))
    return f"point {rows.names[point]}, read-out {rows.read_out_of_pair[pair]}, {of}, {rows.surface[point][face]}"
