"""All comparisons of weld lines with the mesh of a case."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.errors import Problem
from fatigue.readers.neutral.against_mesh.directions import astray
from fatigue.readers.neutral.against_mesh.edges import Sides, other_edges, sides_of
from fatigue.readers.neutral.against_mesh.findings import Finding, worst_first
from fatigue.readers.neutral.against_mesh.positions import moved_nodes, unknown_nodes
from fatigue.readers.neutral.against_mesh.shells import TouchingShells, arms, touching_shells
from fatigue.readers.neutral.against_mesh.thickness import other_thickness
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.weld.line import LineStack

NODES_AT_ONCE = 16_384  # of weld lines, as far as whole lines allow: memory does not grow with the body


@dataclass(frozen=True, slots=True)
class TableNames:
    """What the tables are called in messages."""

    lines: str
    nodes: str
    elements: str


def mesh_warnings(
    lines: LineStack, mesh: Mesh, names: TableNames, confirmed: Mapping[str, Sequence[float]], *, knows_sides: bool
) -> list[Problem]:
    """Warnings of welds that contradict the mesh, one for each weld and kind, the worst weld first.

    Parameters
    ----------
    confirmed : thicknesses that the user has confirmed, by weld [mm]
    knows_sides : whether the case names the elements of each plate side, by which directions are judged later
    """
    shells = touching_shells(mesh, lines.node)
    sides = sides_of(shells)
    found: list[Finding] = []
    begin = 0
    while begin < len(lines):
        end = int(np.searchsorted(lines.begin, lines.begin[begin] + NODES_AT_ONCE, side="right")) - 1
        end = max(end, begin + 1)
        some = lines.lines(slice(begin, end))
        found += _of_some(some, mesh, shells, sides, names, confirmed, knows_sides=knows_sides)
        begin = end
    return worst_first(found)


def _of_some(
    lines: LineStack,
    mesh: Mesh,
    shells: TouchingShells,
    sides: Sides,
    names: TableNames,
    confirmed: Mapping[str, Sequence[float]],
    *,
    knows_sides: bool,
) -> list[Finding]:
    found = unknown_nodes(lines, mesh, names.lines, names.nodes)
    moved, is_moved = moved_nodes(lines, mesh, names.lines, names.nodes)
    found += moved
    found += other_thickness(lines, shells, confirmed, names.lines, names.elements)
    if not knows_sides:
        at, shell = shells.pairs(lines.node)
        stays = ~np.repeat(is_moved, np.diff(lines.begin))[at]
        at, arm = arms(lines, at[stays], shells, shell[stays], mesh)
        found += astray(lines, at, arm, f"the nearest shell of {names.elements}", names.lines)
    return found + other_edges(lines, shells, sides, names.lines, names.elements)
