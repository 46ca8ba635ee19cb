"""Element nodal forces: the balance of each element, and their sum along a weld line.

Only the elements of one plate on one side of the line count. Elements that touch the line at one corner only are among
them: without these the resultant is wrong. Where a line is split at a kink, its corner node belongs to two parts, and
each element there has to be given to one of them.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from fatigue.errors import DataError, Problem, refuse
from fatigue.weld.line import WeldLine
from fatigue.weld.line_geometry import edges

BALANCE_RED = 1e-2  # of the largest term of an element: beyond it something is missing or of another frame
BALANCE_FLOOR = 1e-3  # of the mode's largest term: what hardly strains carries only the round-off of the others


@dataclass(frozen=True, slots=True, eq=False)
class ElementForces:
    """Forces and moments on the elements at their nodes, one row per mode, element and node, in global axes.

    The rows are kept in ascending order of element.

    Attributes
    ----------
    mode, node, element : (r,) ids
    force : (r, 6) force and moment on the element, per unit modal coordinate [N, N mm]
    """

    mode: NDArray[np.int64]
    node: NDArray[np.int64]
    element: NDArray[np.int64]
    force: NDArray[np.floating]

    def __post_init__(self) -> None:
        """Sort the rows by element unless they are."""
        if np.any(np.diff(self.element) < 0):
            order = np.argsort(self.element, kind="stable")
            for name in ("mode", "node", "element", "force"):
                object.__setattr__(self, name, getattr(self, name)[order])

    def rows(self, at: NDArray[np.int64] | NDArray[np.bool_]) -> "ElementForces":
        """Rows at the given positions, or the rows marked."""
        return ElementForces(self.mode[at], self.node[at], self.element[at], self.force[at])

    def of(self, elements: NDArray[np.int64]) -> "ElementForces":
        """Rows of the given elements."""
        wanted = np.unique(elements)
        begin, end = np.searchsorted(self.element, wanted), np.searchsorted(self.element, wanted, side="right")
        return self.rows(np.concatenate([np.arange(0), *map(np.arange, begin, end)]))


@dataclass(frozen=True, slots=True, eq=False)
class ElementBalance:
    """How far the forces of each element and mode are from equilibrium.

    Attributes
    ----------
    element, mode : (k,) ids
    force_residual : (k,) resultant force, relative to the largest nodal force
    moment_residual : (k,) resultant moment, relative to the largest nodal moment or moment of a nodal force; None
        where no coordinates are given
    """

    element: NDArray[np.int64]
    mode: NDArray[np.int64]
    force_residual: NDArray[np.float64]
    moment_residual: NDArray[np.float64] | None

    @property
    def worst(self) -> int:
        """Position of the largest residual."""
        residual = self.force_residual
        return int(np.argmax(residual if self.moment_residual is None else np.maximum(residual, self.moment_residual)))


def together(parts: Sequence[ElementForces]) -> ElementForces:
    """All rows of several element forces."""
    mode, node, element = (
        np.concatenate([getattr(one, name) for one in parts]) for name in ("mode", "node", "element")
    )
    return ElementForces(mode, node, element, np.concatenate([one.force for one in parts]))


def balance(forces: ElementForces, xyz: Mapping[int, NDArray[np.float64]] | None = None) -> ElementBalance:
    """Resultants of every element and mode, relative to its own largest term or 1e-3 of the mode's largest.

    Stiffness forces are in balance to the precision of the file. A residual near 1 means that corners are missing,
    that frames differ, or that inertia or damping forces are contained. ``xyz`` maps node ids to coordinates [mm].

    Raises
    ------
    DataError
        If ``xyz`` is given and lacks a node.
    """
    element, mode, group = _pairs(forces.element, forces.mode)
    force = forces.force[:, :3].astype(np.float64)
    force_residual = _residual(force, np.linalg.norm(force, axis=1), group, mode)
    if xyz is None:
        return ElementBalance(element, mode, force_residual, None)
    at = _coordinates(forces, xyz)
    centre = _sums(at, group) / np.bincount(group)[:, np.newaxis]
    of_force = np.cross(at - centre[group], force)
    moment = forces.force[:, 3:].astype(np.float64)
    largest = np.maximum(np.linalg.norm(of_force, axis=1), np.linalg.norm(moment, axis=1))
    return ElementBalance(element, mode, force_residual, _residual(of_force + moment, largest, group, mode))


def side_forces(
    parts: tuple[WeldLine, ...],
    elements: NDArray[np.int64],
    forces: ElementForces,
    modes: NDArray[np.int64],
    where: str,
    name: Callable[[int], str] = "mode {}".format,
) -> list[NDArray[np.float64]]:
    """Forces of the assessed side's elements summed at the nodes of each part of a line, (n, m, 6) each [N, N mm].

    At a corner an element belongs to the part from which the fewest element edges have to be crossed to reach it,
    beginning in the element along the part's last edge; one as near to both parts is shared half and half. So the
    parts always add up to the whole, and no coordinates are needed. ``name`` tells a mode in messages.

    Raises
    ------
    DataError
        If an element has no forces, a node of the line no element, or a row is missing or given twice.
    """
    side = forces.of(elements)
    line_nodes = np.concatenate([part.node for part in parts])
    refuse(DataError, gaps(np.setdiff1d(elements, side.element), np.setdiff1d(line_nodes, side.node), where))
    element, node, force = corner_table(side.rows(np.isin(side.node, line_nodes)), modes, where, name)
    summed = (_shares(parts, element, node, side) @ force.reshape(node.size, -1)).reshape(-1, modes.size, 6)
    return np.split(summed, np.cumsum([part.node.size for part in parts])[:-1])


def _pairs(
    a: NDArray[np.int64], b: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Distinct pairs of ids, (k,) and (k,), and the number of each row's pair, (r,)."""
    a_ids, a_at = np.unique(a, return_inverse=True)
    b_ids, b_at = np.unique(b, return_inverse=True)
    pairs, group = np.unique(a_at * b_ids.size + b_at, return_inverse=True)
    return a_ids[pairs // b_ids.size], b_ids[pairs % b_ids.size], group


def _sums(values: NDArray[np.float64], group: NDArray[np.int64]) -> NDArray[np.float64]:
    """Sum of the vectors of each group, (k, 3)."""
    return np.column_stack([np.bincount(group, component) for component in values.T])


def _residual(
    terms: NDArray[np.float64], size: NDArray[np.float64], group: NDArray[np.int64], mode: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Resultant of each group's terms, (k,), relative to the largest ``size`` in the group or the floor of its mode."""
    largest = np.zeros(mode.size)
    np.maximum.at(largest, group, size)
    modes, at = np.unique(mode, return_inverse=True)
    of_mode = np.zeros(modes.size)
    np.maximum.at(of_mode, at, largest)
    reference = np.maximum(largest, BALANCE_FLOOR * of_mode[at])
    resultant = np.linalg.norm(_sums(terms, group), axis=1)
    residual: NDArray[np.float64] = np.divide(resultant, reference, out=np.zeros_like(resultant), where=reference > 0)
    return residual


def _coordinates(forces: ElementForces, xyz: Mapping[int, NDArray[np.float64]]) -> NDArray[np.float64]:
    """Coordinates of each row's node, (r, 3)."""
    nodes, at = np.unique(forces.node, return_inverse=True)
    unknown = np.array([node for node in nodes.tolist() if node not in xyz])
    if unknown.size:
        what = f"node {unknown[0]}{_more(unknown.size)} has element forces and no coordinates"
        refuse(DataError, [Problem("unknown_node", "nodes", what, "Add the node to the table of nodes")])
    return np.array([xyz[node] for node in nodes.tolist()])[at]


def gaps(absent: NDArray[np.int64], bare: NDArray[np.int64], where: str) -> Iterator[Problem]:
    """Problems of elements without forces and of line nodes without elements."""
    if absent.size:
        what = f"element {absent[0]}{_more(absent.size)} of the assessed side has no forces"
        yield Problem("missing_element", where, what, "Request the element forces of the whole side")
    if bare.size:
        what = f"no element of the assessed side touches node {bare[0]}{_more(bare.size)} of the line"
        yield Problem("bare_node", where, what, "Complete weld_elements")


def corner_table(
    rows: ElementForces, modes: NDArray[np.int64], where: str, name: Callable[[int], str]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Arrange rows by element corner, (k,) elements and (k,) nodes, and mode, (k, m, 6); refuse gaps and repeats."""
    element, node, corner = _pairs(rows.element, rows.node)
    sorter = np.argsort(modes)
    at = sorter[np.searchsorted(modes, rows.mode, sorter=sorter).clip(max=modes.size - 1)]
    used = modes[at] == rows.mode
    count = np.zeros((node.size, modes.size), dtype=np.int64)
    np.add.at(count, (corner[used], at[used]), 1)
    for code, wrong, what, remedy in (
        ("missing_row", count == 0, "no row", "Request the forces of every mode"),
        ("repeated_row", count > 1, "more than one row", "Keep one row per mode, element and node"),
    ):
        if wrong.any():
            k, m = np.argwhere(wrong)[0]
            place = f"{where}, element {element[k]}, node {node[k]}, {name(int(modes[m]))}"
            others = _more(int(np.count_nonzero(wrong)))
            refuse(DataError, [Problem(code, place, f"{what} of element forces{others}", remedy)])
    force = np.empty((node.size, modes.size, 6))
    force[corner[used], at[used]] = rows.force[used]
    return element, node, force


def _shares(
    parts: tuple[WeldLine, ...], element: NDArray[np.int64], node: NDArray[np.int64], side: ElementForces
) -> csr_array:
    """Share of each element corner, (k,), in each node of the stacked parts, (n, k)."""
    places: dict[int, list[int]] = {}
    last_edge: dict[int, set[int]] = {}
    size = 0
    for part in parts:
        for place, name in enumerate(part.node.tolist(), start=size):
            places.setdefault(name, []).append(place)
        for place, edge in ((size, edges(part)[0]), (size + part.node.size - 1, edges(part)[-1])):
            last_edge[place] = set(part.node[list(edge)].tolist())
        size += part.node.size
    nearest = {
        name: _nearest({place: last_edge[place] for place in at}, elements_around(name, side))
        for name, at in places.items()
        if len(at) > 1
    }
    entries = [
        (place, k, 1 / len(at))
        for k, (name, owner) in enumerate(zip(node.tolist(), element.tolist(), strict=True))
        for at in [nearest[name][owner] if name in nearest else places[name]]
        for place in at
    ]
    row, column, share = zip(*entries, strict=True)
    return csr_array((share, (row, column)), shape=(size, node.size))


def elements_around(node: int, side: ElementForces) -> dict[int, set[int]]:
    """Nodes of each element that touches a node."""
    fan = side.of(side.element[side.node == node])
    nodes: dict[int, set[int]] = {}
    for element, name in zip(fan.element.tolist(), fan.node.tolist(), strict=True):
        nodes.setdefault(element, set()).add(name)
    return nodes


def _nearest(last_edge: dict[int, set[int]], around: dict[int, set[int]]) -> dict[int, list[int]]:
    """Parts nearest to each element round a corner; the parts that meet there are given by place and last edge."""
    crossed = {place: _edges_crossed(around, edge) for place, edge in last_edge.items()}
    nearest = {}
    for element in around:
        distance = {place: count.get(element, len(around)) for place, count in crossed.items()}
        nearest[element] = [place for place in distance if distance[place] == min(distance.values())]
    return nearest


def _edges_crossed(around: dict[int, set[int]], edge: set[int]) -> dict[int, int]:
    """Element edges to cross, round a node, from the elements that have ``edge`` to each that can be reached."""
    front = [element for element, nodes in around.items() if edge <= nodes]
    crossed = dict.fromkeys(front, 0)
    steps = 0
    while front:
        steps += 1
        front = [
            element
            for element, nodes in around.items()
            if element not in crossed and any(len(nodes & around[other]) > 1 for other in front)
        ]
        crossed.update(dict.fromkeys(front, steps))
    return crossed


def _more(count: int) -> str:
    """Words for how many others there are besides the one that is named."""
    return f" (and {count - 1} more)" if count > 1 else ""
