"""What a bench programme is asked for: the points it shall reproduce, and the blocks that the bench can run."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.of_result import FACES
from fatigue.errors import DataError, Problem
from fatigue.readers.neutral.tables import Table, open_table

Floats = NDArray[np.float64]

_COORDINATE = re.compile(r"(u_[A-Za-z][A-Za-z0-9_]*|q_-?\d+)(?:\s*[\[(]\s*(.*?)\s*[\])])?")


@dataclass(frozen=True, slots=True)
class WantedPoint:
    """A point of a result that is asked for: by ``order`` or by ``node``, ``part`` where a corner has two.

    ``factor`` is on its target damage, ``where`` the place it is asked for.
    """

    weld: str
    order: int | None
    node: int | None
    part: int | None
    surface: str
    factor: float
    where: str


@dataclass(frozen=True, slots=True, eq=False)
class Blocks:
    """Blocks of a bench: their names, and the range of every coordinate in every block.

    ``coordinate`` are names such as ``u_coupler`` or ``q_7``, ``ranges`` (b, c) are in their units, the sign the phase.
    """

    name: tuple[str, ...]
    coordinate: tuple[str, ...]
    ranges: Floats
    warnings: tuple[Problem, ...]


def read_points(path: Path) -> tuple[tuple[WantedPoint, ...], tuple[Problem, ...]]:
    """Points of a table, one a row, and warnings about the table.

    Columns are ``weld``, ``order`` or ``node``, ``surface``, optionally ``part`` and ``factor``.

    Raises
    ------
    DataError : everything that is wrong with the table
    """
    table = open_table(path, texts=("weld", "surface"))
    by_order = "order" in table.position or "node" not in table.position
    at = "order" if by_order else "node"
    table.expect(("weld", at, "surface"), ("part", "factor", "node"), strict=False)
    weld, surface, place = table.texts("weld"), table.texts("surface"), table.integers(at)
    table.choices("surface", surface, FACES)
    part, factor = table.integers("part", default=0), table.numbers("factor", default=1.0, above=0.0)
    table.refuse()
    points = tuple(
        WantedPoint(
            weld=weld[row],
            order=int(place[row]) if by_order else None,
            node=None if by_order else int(place[row]),
            part=int(part[row]) or None,
            surface=surface[row],
            factor=float(factor[row]),
            where=f"{path.name}: {table.row_name(row)}",
        )
        for row in range(table.rows)
    )
    return points, tuple(table.warnings)


def read_blocks(path: Path, units: Mapping[str, str]) -> Blocks:
    """Blocks of a table, one a row: an optional name in ``block``, and the range of each coordinate.

    ``units`` are those of the coordinates of the result by their names, empty where a coordinate has none. A column may
    state its unit in brackets. Coordinates without a column are at rest.

    Raises
    ------
    DataError : everything that is wrong with the table
    """
    table = open_table(path, texts=("block",))
    columns = {name: found for name in table.position if (found := _COORDINATE.fullmatch(name))}
    table.expect((), ("block", *columns), strict=False)
    _check_coordinates(table, {name: (found[1], found[2]) for name, found in columns.items()}, units)
    values = {found[1]: table.numbers(name, default=0.0).astype(np.float64) for name, found in columns.items()}
    names = table.texts("block", default="")
    names = [name or str(row + 1) for row, name in enumerate(names)]
    table.refuse()
    ranges = np.stack([*values.values()], axis=1)
    _check_blocks(table, names, ranges)
    table.refuse()
    return Blocks(tuple(names), tuple(values), ranges, tuple(table.warnings))


def _check_coordinates(table: Table, stated: Mapping[str, tuple[str, str | None]], units: Mapping[str, str]) -> None:
    """Note coordinates that the result does not have, those given twice, and units that are not theirs."""
    known = ", ".join(units)
    if not stated:
        what = "there is no column of a load"
        raise DataError(Problem("missing_column", table.path.name, what, f"Give the ranges of some of {known}"))
    seen: dict[str, str] = {}
    for column, (name, unit) in stated.items():
        if name not in units:
            what = f"the result has no {'unit load' if name[0] == 'u' else 'mode'} of this name"
            table.problems.append(Problem("unknown_id", table.where(column), what, f"Name one of {known}"))
        elif unit is not None and unit != units[name]:
            what = f"the unit is {unit!r}, and the forces of the result are per 1 {units[name] or 'of the mode'}"
            remedy = f"Convert the ranges to {units[name]}" if units[name] else "Remove the unit"
            table.problems.append(Problem("bench_unit", table.where(column), what, remedy))
        if name in seen:
            what = f"the load has another column, {seen[name]}"
            table.problems.append(Problem("duplicate_column", table.where(column), what, "Remove one of them"))
        seen[name] = column
    table.refuse()


def _check_blocks(table: Table, names: list[str], ranges: Floats) -> None:
    """Note names given twice, blocks at rest, and blocks that are others once more, perhaps in counter-phase."""
    first: dict[tuple[float, ...], int] = {}
    for row, (name, block) in enumerate(zip(names, ranges, strict=True)):
        if names.index(name) < row:
            what = f"block {name!r} has the name of {table.row_name(names.index(name))}"
            table.problems.append(Problem("duplicate", table.where("block", row), what, "Give it another name"))
        moves = block[block != 0.0]
        if not moves.size:
            where, remedy = f"{table.path.name}: {table.row_name(row)}", "Give it ranges, or remove it"
            table.problems.append(Problem("bench_idle_block", where, f"all ranges of block {name!r} are 0", remedy))
            continue
        same = first.setdefault(tuple((block * np.sign(moves[0])).tolist()), row)  # all signs turned: the same cycle
        if same < row:
            where, what = f"{table.path.name}: {table.row_name(row)}", f"block {name!r} is block {names[same]!r} again"
            table.problems.append(Problem("duplicate", where, what, "Keep one of the rows"))
