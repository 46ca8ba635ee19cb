"""Whether the nodes of weld lines are in the mesh, and at the same places."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.against_mesh.findings import SAME_FACTOR, Finding, one_factor, unit_of, warnings_of
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.weld.line import LineStack, line_of_node
from fatigue.weld.line_geometry import edge_nodes, edge_points

Floats = NDArray[np.float64]

OF_EDGE = 0.01  # of the mean edge of the line: forces per length are wrong by as much, stress by 1 %, life by 4 %
SAME_SHAPE = 1e-3  # relative, of the distances between the nodes: what is left is a shift or a turn
ROUNDING = 4 * float(np.finfo(np.float32).eps)  # of the largest coordinate: either table may be in single precision


def unknown_nodes(lines: LineStack, mesh: Mesh, file: str, nodes_file: str) -> list[Finding]:
    """Warning of each weld with nodes that the mesh does not have."""
    absent = ~np.isin(lines.node, mesh.node)
    share = np.bincount(line_of_node(lines), absent, minlength=len(lines)) / np.diff(lines.begin)

    def words(worst: int, nodes: NDArray[np.int64]) -> tuple[str, str]:
        return f"the node is not in {nodes_file}", "Correct the node numbers, or give the nodes of the same mesh"

    return warnings_of(lines, absent, share[line_of_node(lines)], "not_in_mesh", words, file)


def moved_nodes(lines: LineStack, mesh: Mesh, file: str, nodes_file: str) -> tuple[list[Finding], NDArray[np.bool_]]:
    """Warning of each weld whose nodes lie elsewhere in the mesh, and whether they do, (k,)."""
    there, known = _places(lines, mesh)
    owner = line_of_node(lines)
    of_line = owner[edge_nodes(lines)[:, 0]]
    chord = np.linalg.norm(edge_points(lines)[:, 2] - edge_points(lines)[:, 0], axis=1)
    edge = np.bincount(of_line, chord) / np.bincount(of_line)
    largest = np.maximum(np.abs(lines.xyz), np.where(known[:, np.newaxis], np.abs(there), 0.0)).max(axis=1)
    away = np.where(known, np.linalg.norm(lines.xyz - there, axis=1), 0.0)
    moved = away > OF_EDGE * edge[owner] + ROUNDING * largest

    def words(worst: int, nodes: NDArray[np.int64]) -> tuple[str, str]:
        a, b = lines.begin[owner[worst]], lines.begin[owner[worst] + 1]
        shape = _shape(lines.xyz[a:b], there[a:b], known[a:b], nodes_file)
        here, other = (", ".join(f"{x:g}" for x in place[worst].tolist()) for place in (lines.xyz, there))
        what = f"x, y, z are {here} mm and in {nodes_file} {other} mm, {away[worst]:.3g} mm apart{shape}"
        return what, "Give both tables of one mesh, in mm and in one frame: the line loads follow from the weld table"

    found = warnings_of(lines, moved, away / edge[owner], "moved_in_mesh", words, file)
    return found, np.logical_or.reduceat(moved, lines.begin[:-1])


def _places(lines: LineStack, mesh: Mesh) -> tuple[Floats, NDArray[np.bool_]]:
    """Where the mesh has each node, (n, 3) [mm], and whether it has it."""
    place = np.searchsorted(mesh.node, lines.node).clip(max=mesh.node.size - 1)
    return mesh.xyz[place], mesh.node[place] == lines.node


def _shape(here: Floats, there: Floats, known: NDArray[np.bool_], nodes_file: str) -> str:
    """Say how the shape of a line in the weld table compares with the one in the mesh."""
    steps = [(i, j) for i, j in pairwise(np.flatnonzero(known).tolist())]
    if not steps:
        return ""
    i, j = np.array(steps).T
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.linalg.norm(here[i] - here[j], axis=1) / np.linalg.norm(there[i] - there[j], axis=1)
    factor = one_factor(ratio) if np.isfinite(ratio).all() else None
    if factor is None or (abs(factor - 1) <= SAME_FACTOR and np.abs(ratio - 1).max() > SAME_SHAPE):
        return ""
    if abs(factor - 1) <= SAME_SHAPE:
        return "; the line has the same shape there, shifted or turned"
    return f"; the line is {factor:.4g} times as long here{unit_of(factor, 'the weld table', nodes_file)}"
