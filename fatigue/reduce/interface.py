"""The interface of a body: named points where forces enter or motion is read, each of one node or of several."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.flexbody.structure import Structure
from fatigue.readers.neutral.body.interface_shapes import DIRECTIONS
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.shown import few

SIDES = ("external", "internal", "observed")
OBSERVED = "observed"
PARTED = str.maketrans(",;", "  ")


@dataclass(frozen=True, slots=True)
class InterfacePoint:
    """A point of the interface.

    ``nodes`` share its load evenly, and its motion is their mean: one node, or those of a pattern. ``node`` is the one
    it is named after. ``directions`` are 0, 1, 2 for displacements along x, y, z and 3, 4, 5 for rotations about them.
    ``side`` is external, internal or observed.
    """

    name: str
    node: int
    nodes: tuple[int, ...]
    side: str
    directions: tuple[int, ...]

    @property
    def is_loaded(self) -> bool:
        """Whether forces enter here."""
        return self.side != OBSERVED

    @property
    def components(self) -> str:
        """Directions as the table has them: ``123``."""
        return "".join(str(direction + 1) for direction in self.directions)


def read_interface(path: Path, *, strict: bool) -> tuple[tuple[InterfacePoint, ...], list[Problem]]:
    """Read ``name, node, side, components`` and, where present, ``pattern``: the nodes that share the load.

    ``components`` are digits 1 to 6, ``pattern`` node ids apart by blanks. Returned in the order of the file.

    Raises
    ------
    DataError : a name or a node listed twice, components or patterns not understood, no point where forces enter
    """
    table = open_table(path, texts=("name", "side", "components", "pattern"))
    table.expect(("name", "node", "side", "components"), ("pattern",), strict=strict)
    names, code = table.groups("name")
    node, side = table.integers("node"), table.texts("side")
    components, pattern = table.texts("components"), table.texts("pattern", default="")
    table.unique({"name": code}, {"name": names})
    table.choices("side", side, SIDES)
    directions = [_directions(text) for text in components]
    wrong = np.array([found is None for found in directions])
    what = f"{components[int(wrong.argmax())]!r} are no components"
    table.report(wrong, "bad_value", "components", what, "Give digits of 1 to 6, each once: 123 or 123456")
    shared = [_nodes(text) for text in pattern]
    wrong = np.array([found is None for found in shared])
    what = f"{pattern[int(wrong.argmax())]!r} is no list of nodes, each once"
    table.report(wrong, "bad_value", "pattern", what, "Give node ids with blanks between them")
    astray = np.array([bool(found) and n not in (found or ()) for n, found in zip(node.tolist(), shared, strict=True)])
    what = f"node {node[int(astray.argmax())]} is none of its pattern"
    table.report(astray, "bad_value", "node", what, "Name the point after a node that takes part in its load")
    table.refuse()
    points = tuple(
        InterfacePoint(names[code[i]], int(node[i]), shared[i] or (int(node[i]),), side[i], directions[i] or ())
        for i in range(table.rows)
    )
    table.problems.extend(_twice(table, points))
    table.refuse()
    if not any(point.is_loaded for point in points):
        what = "no point is external or internal, so that no force enters the body"
        raise DataError(Problem("no_interface", table.where("side"), what, "Name the points where forces enter"))
    return points, table.warnings


def _directions(text: str) -> tuple[int, ...] | None:
    """Directions of components such as ``123``; None where they are none."""
    digits = text.strip()
    if not digits or set(digits) - set("123456") or len(set(digits)) < len(digits):
        return None
    return tuple(sorted(int(digit) - 1 for digit in digits))


def _nodes(text: str) -> tuple[int, ...] | None:
    """Node ids of a pattern; None where they are none, or one of them is there twice."""
    parts = text.translate(PARTED).split()
    if not all(part.isdecimal() for part in parts):
        return None
    ids = tuple(int(part) for part in parts)
    return ids if len(set(ids)) == len(ids) else None


def _twice(table: Table, points: Sequence[InterfacePoint]) -> Iterator[Problem]:
    """Refusals of loaded points of the same nodes."""
    first: dict[frozenset[int], int] = {}
    for i, point in enumerate(points):
        if not point.is_loaded:
            continue
        before = first.setdefault(frozenset(point.nodes), i)
        if before != i:
            what = f"{point.name} loads the same nodes as {points[before].name} in {table.row_name(before)}"
            yield Problem("duplicate", table.where("node", i), what, "Keep one of the rows, or make one observed")


def missing_nodes(points: Sequence[InterfacePoint], node: NDArray[np.int64], file: str, model: str) -> list[Problem]:
    """Refusals of points whose nodes the model does not have; ``node`` are those that it has."""
    problems = []
    for point in points:
        absent = [n for n in point.nodes if n not in set(np.intersect1d(node, point.nodes).tolist())]
        if absent:
            of_pattern = len(point.nodes) > 1
            where = f"{file}: {point.name}, column {'pattern' if of_pattern else 'node'}"
            what = f"node{'s' * (len(absent) > 1)} {few(absent)} {'are' if len(absent) > 1 else 'is'} not in {model}"
            problems.append(Problem("unknown_id", where, what, "Correct the number, or take the mesh it belongs to"))
    return problems


def rows_of(structure: Structure, nodes: Sequence[int], direction: int) -> NDArray[np.int64]:
    """Rows (n,) of the structure of these nodes in one direction; fewer where it does not have them."""
    return np.flatnonzero(np.isin(structure.node, nodes) & (structure.direction == direction))


def missing_directions(points: Sequence[InterfacePoint], structure: Structure, file: str) -> list[Problem]:
    """Refusals of directions that the matrices have no rows for."""
    problems = []
    for point in points:
        short = [d for d in point.directions if len(rows_of(structure, point.nodes, d)) < len(point.nodes)]
        if short:
            where = f"{file}: {point.name}, column components"
            what = f"the model has no rows of {few([DIRECTIONS[d] for d in short], 6)} at its node"
            problems.append(Problem("unknown_id", where, what, "Leave these components out, or correct the node"))
    return problems


def place_of(point: InterfacePoint, structure: Structure) -> NDArray[np.float64]:
    """Place (3,) of a point: the mean of its nodes, where a load that they share evenly acts."""
    _, first = np.unique(structure.node, return_index=True)
    there = first[np.isin(structure.node[first], point.nodes)]
    return np.asarray(structure.xyz[there].mean(axis=0))


def motion_of(points: Sequence[InterfacePoint], structure: Structure) -> NDArray[np.float64]:
    """Rows C (d, n) that read the motion of points, point after point and direction after direction: ``C u``.

    Each is the mean of the nodes of a point. Its transpose is the unit load that does work with this motion.
    """
    rows = [(point, direction) for point in points for direction in point.directions]
    C = np.zeros((len(rows), len(structure.node)))
    for i, (point, direction) in enumerate(rows):
        C[i, rows_of(structure, point.nodes, direction)] = 1.0 / len(point.nodes)
    return C


def rotations_at_shells(points: Sequence[InterfacePoint], file: str) -> list[Problem]:
    """Warning about moments at single nodes of a shell: what such a node turns under one depends on the mesh."""
    turned = [p.name for p in points if p.is_loaded and len(p.nodes) == 1 and p.directions[-1] > 2]
    if not turned:
        return []
    what = f"moments enter at single shell nodes ({few(turned)}), whose rotation depends on the size of the elements"
    remedy = "Give components 123, or a pattern of nodes over the area that takes the moment"
    return [Problem("moment_at_node", f"{file}: column components", what, remedy, len(turned))]
