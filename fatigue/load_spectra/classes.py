"""What cycles are sorted into: edges of ranges and levels, equal for all rows of a table or as a file gives them."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.life.load_spectrum import LoadCycles, uniform_edges
from fatigue.readers.neutral.tables import Table, open_table

Floats = NDArray[np.float64]

MOST_CLASSES = 256  # a matrix of them takes half a megabyte

_EMPTY = float(np.finfo(np.float64).max)  # stands for a cell without an edge


@dataclass(frozen=True, slots=True, eq=False)
class Classes:
    """Edges of the classes [MPa]: of ranges (b + 1,), and of means, reversals and levels (l,)."""

    ranges: Floats
    levels: Floats


@dataclass(frozen=True, slots=True)
class Extent:
    """How far cycles reach: largest range, lowest and highest reversal; of none, 0, inf and -inf."""

    range: float = 0.0
    lowest: float = np.inf
    highest: float = -np.inf

    def over(self, others: Iterable["Extent"]) -> "Extent":
        """The extent of these cycles and others."""
        every = [self, *others]
        return Extent(max(e.range for e in every), min(e.lowest for e in every), max(e.highest for e in every))


def extent_of(cycles: LoadCycles) -> Extent:
    """Extent of some cycles."""
    if not len(cycles.range):
        return Extent()
    return Extent(float(cycles.range.max()), float(cycles.lowest.min()), float(cycles.highest.max()))


def classes_over(extent: Extent, classes: int, given: Path | None) -> Classes:
    """Classes over all cycles, ``classes`` of equal width; those of a file where it ``given`` has them.

    Raises
    ------
    DataError : the file is no table of edges
    """
    ranges = uniform_edges(0.0, extent.range, classes)
    lowest, highest = (0.0, 0.0) if extent.highest < extent.lowest else (extent.lowest, extent.highest)
    levels = uniform_edges(lowest, highest, classes)
    if given is None:
        return Classes(ranges, levels)
    of_file = read_edges(given)
    return Classes(of_file.get("range_MPa", ranges), of_file.get("level_MPa", levels))


def read_edges(path: Path) -> dict[str, Floats]:
    """Edges of a table with the columns ``range_MPa`` and ``level_MPa``, or one of them; the shorter ends in blanks.

    Raises
    ------
    DataError : no such column, edges that do not ascend, fewer than two or too many
    """
    table = open_table(path)
    names = [name for name in ("range_MPa", "level_MPa") if name in table.position] or ["range_MPa"]
    table.expect(names, (), strict=False)
    edges: dict[str, Floats] = {name: _column(table, name) for name in names}
    table.refuse()
    return edges


def _column(table: Table, name: str) -> Floats:
    values = table.numbers(name, default=_EMPTY).astype(np.float64)
    is_edge = values != _EMPTY
    end = int(is_edge.sum())
    beyond = is_edge & (np.arange(len(values)) >= end)
    table.report(beyond, "missing_value", name, "an edge stands below an empty cell", "Leave no gap between edges")
    values = values[:end]
    table.problems.extend(Problem("bad_edges", table.where(name, row), *said) for row, said in _mistakes(values, name))
    return values


def _mistakes(edges: Floats, name: str) -> Iterator[tuple[int | None, tuple[str, str]]]:
    """Row and words of each thing that is wrong with edges, the first of a kind."""
    steps = np.diff(edges)
    if (steps <= 0.0).any():
        row = int((steps <= 0.0).argmax()) + 1
        what = f"the edges do not ascend: {edges[row]:g} follows {edges[row - 1]:g}"
        yield row, (what, "Give each edge once, sorted from the smallest to the largest")
    if name == "range_MPa" and len(edges) and edges[0] < 0.0:
        yield 0, (f"{edges[0]:g} is below 0, which no range is", "Begin at 0 or above")
    if not 2 <= len(edges) <= MOST_CLASSES + 1:
        what = f"{len(edges)} edges make no classes" if len(edges) < 2 else f"{len(edges)} edges are too many"
        yield None, (what, f"Give between 2 and {MOST_CLASSES + 1}")


def check_edges(given: Path | None) -> None:
    """Refuse a file of edges before anything is counted."""
    if given is not None:
        read_edges(given)


def outside_warnings(extent: Extent, classes: Classes, given: Path | None) -> list[Problem]:
    """Warning that cycles lie outside the edges of a file, and are in no class therefore."""
    if given is None:
        return []
    found = []
    ranges, levels = classes.ranges, classes.levels
    if extent.range > ranges[-1]:
        what = f"ranges reach {extent.range:.4g} MPa, the last edge is {ranges[-1]:g}: cycles above it are in no class"
        remedy = "Give edges up to the largest range; exceedances, power sums of equivalent ranges and damage have them"
        found.append(Problem("outside_edges", f"{given.name}: column range_MPa", what, remedy))
    if ranges[0] > 0.0:
        what = f"the first edge is {ranges[0]:g} MPa: cycles below it are in no class"
        found.append(Problem("outside_edges", f"{given.name}: column range_MPa", what, "Begin at 0 to list them all"))
    if extent.lowest < levels[0] or extent.highest > levels[-1]:
        what = f"stresses lie between {extent.lowest:.4g} and {extent.highest:.4g} MPa, the edges between "
        what += f"{levels[0]:g} and {levels[-1]:g}: cycles beyond are in no class of means and reversals"
        found.append(Problem("outside_edges", f"{given.name}: column level_MPa", what, "Give edges over all of them"))
    return found
