"""The shells of a mesh that touch nodes of weld lines."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.weld.element_forces import ElementForces
from fatigue.weld.line import LineStack

Ids = NDArray[np.int64]
Floats = NDArray[np.float64]

CORNERS = 4  # first columns of the node ids of an element, before those of its mid-side nodes


@dataclass(frozen=True, slots=True, eq=False)
class TouchingShells:
    """Shells with a node on a weld line, e of them, and which touch which of the k nodes.

    Attributes
    ----------
    element : (e,) element ids
    nodes : (e, 8) node ids as in ``Mesh``, 0 where there are fewer
    thickness : (e,) thickness [mm], NaN where it is not known
    centre : (e, 3) mean of the corners [mm]
    node : (k,) ids of the nodes on weld lines that shells touch, ascending
    first : (k + 1,) where the shells of each begin in ``shell``
    shell : (p,) positions of shells
    """

    element: Ids
    nodes: Ids
    thickness: Floats
    centre: Floats
    node: Ids
    first: Ids
    shell: Ids

    def pairs(self, node: Ids) -> tuple[Ids, Ids]:
        """Positions among the given nodes, ascending, and of the shells that touch them, (q,) each."""
        if not self.node.size:
            return np.zeros(0, np.int64), np.zeros(0, np.int64)
        place = np.searchsorted(self.node, node).clip(max=self.node.size - 1)
        begin, end = self.first[place], self.first[place + 1]
        count = np.where(self.node[place] == node, end - begin, 0)
        at = np.repeat(np.arange(node.size), count)
        within = np.arange(at.size) - np.repeat(np.cumsum(count) - count, count)
        return at, self.shell[begin[at] + within]


def shells_of_forces(forces: ElementForces, mesh: Mesh) -> TouchingShells:
    """Elements with forces, all nodes of which the mesh has; of no known thickness."""
    one_mode = forces.mode == forces.mode[:1]
    element, node = forces.element[one_mode], forces.node[one_mode]
    place = np.searchsorted(mesh.node, node).clip(max=mesh.node.size - 1)
    known = ~np.isin(element, element[mesh.node[place] != node])
    element, node, place = element[known], node[known], place[known]
    ids, shell = np.unique(element, return_inverse=True)
    total = np.column_stack([np.bincount(shell, x, minlength=ids.size) for x in mesh.xyz[place].T])
    return _touching(
        element=ids,
        nodes=np.zeros((ids.size, mesh.corners.shape[1]), np.int64),
        thickness=np.full(ids.size, np.nan),
        centre=total / np.bincount(shell, minlength=ids.size)[:, np.newaxis],
        node=node,
        shell=shell,
    )


def touching_shells(mesh: Mesh, line_nodes: Ids) -> TouchingShells:
    """Shells of a mesh that touch any of the nodes, with a corner or with the middle of a side."""
    wanted = np.unique(line_nodes)
    rows = np.flatnonzero(np.isin(mesh.corners, wanted).any(axis=1))
    nodes = mesh.corners[rows]
    is_corner = nodes[:, :CORNERS, np.newaxis] != 0
    at_corners = mesh.xyz[np.searchsorted(mesh.node, nodes[:, :CORNERS]).clip(max=mesh.node.size - 1)]
    centre = np.sum(at_corners * is_corner, axis=1) / np.maximum(is_corner.sum(axis=1), 1)
    shell, column = np.nonzero(np.isin(nodes, wanted) & (nodes != 0))
    node = nodes[shell, column]
    return _touching(mesh.element[rows], nodes, mesh.thickness[rows], centre, node, shell)


def _touching(element: Ids, nodes: Ids, thickness: Floats, centre: Floats, node: Ids, shell: Ids) -> TouchingShells:
    """Shells, and which of them touches which node, in any order, (p,) each."""
    order = np.argsort(node, kind="stable")
    touched, first = np.unique(node[order], return_index=True)
    return TouchingShells(element, nodes, thickness, centre, touched, np.append(first, node.size), shell[order])


def arms(lines: LineStack, at: Ids, shells: TouchingShells, shell: Ids, mesh: Mesh) -> tuple[Ids, Floats]:
    """Vectors from nodes of lines, as the mesh has them, to the middle of shells, (q, 3) [mm]; and of which nodes."""
    place = np.searchsorted(mesh.node, lines.node[at]).clip(max=mesh.node.size - 1)
    known = mesh.node[place] == lines.node[at]
    return at[known], shells.centre[shell[known]] - mesh.xyz[place[known]]
