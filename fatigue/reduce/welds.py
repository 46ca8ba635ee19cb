"""Weld lines of a body to reduce, and the elements of the assessed side of each."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.flexbody.shell import side_forces
from fatigue.flexbody.shell_mesh import NONE, ShellMesh
from fatigue.readers.neutral.against_mesh import TableNames, mesh_warnings
from fatigue.readers.neutral.body.lines import checked_lines, read_lines
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.body.welds import read_welds
from fatigue.readers.neutral.forces.element_forces import read_weld_elements
from fatigue.shown import few
from fatigue.weld.line import LineStack

Integers = NDArray[np.int64]

ENDINGS = (".parquet", ".csv")
TABLES = ("welds", "weld_nodes", "weld_elements")


@dataclass(frozen=True, slots=True, eq=False)
class Welds:
    """Weld lines, the assessed ``elements`` of each by name, and the ``files`` of welds, weld_nodes, weld_elements."""

    lines: LineStack
    elements: Mapping[str, Integers]
    files: tuple[Path, ...]

    def nodes(self, number: int) -> Integers:
        """Nodes of the line of this number, along it."""
        return np.asarray(self.lines.node[self.lines.begin[number] : self.lines.begin[number + 1]])


def read_welds_of(folder: Path, mesh: Mesh, body: ShellMesh, *, strict: bool) -> tuple[Welds | None, list[Problem]]:
    """Read ``welds, weld_nodes, weld_elements`` of a folder; None where it has none of them.

    ``mesh`` has the thickness that the ``body`` was computed with.

    Raises
    ------
    DataError : some of the tables are missing, wrong, or name nodes and elements that the body does not have
    """
    paths = {name: table_in(folder, name) for name in TABLES}
    there = {name: path for name, path in paths.items() if path is not None}
    if not there:
        return None, []
    if absent := [name for name in TABLES if name not in there]:
        what = f"{' and '.join(path.name for path in there.values())} is here, and no {' and no '.join(absent)}"
        remedy = "Give all three tables of welds, or none: without them no weld forces are written"
        raise DataError(Problem("missing_file", str(folder), what, remedy))
    welds, warnings = read_welds(there["welds"], None, strict=strict)
    lines, found = read_lines(there["weld_nodes"], welds, {weld.name for weld in welds}, strict=strict)
    warnings += found + checked_lines(lines, there["weld_nodes"].name)
    elements, found = read_weld_elements(there["weld_elements"], welds, strict=strict)
    of_lines, of_sides = there["weld_nodes"].name, there["weld_elements"].name
    refuse(DataError, _not_in_mesh(Welds(lines, elements, ()), body, of_lines, of_sides))
    names = TableNames(of_lines, "the nodes of the mesh", "the elements of the mesh")
    warnings += found + mesh_warnings(lines, mesh, names, {}, knows_sides=True)
    return Welds(lines, elements, tuple(there.values())), warnings


def table_in(folder: Path, name: str) -> Path | None:
    """The table of this name in a folder, Parquet or CSV; None where there is none.

    Raises
    ------
    DataError : there are both
    """
    found = [path for ending in ENDINGS if (path := folder / f"{name}{ending}").is_file()]
    if len(found) > 1:
        what = f"{found[0].name} and {found[1].name} are both here"
        raise DataError(Problem("two_files", str(folder), what, "Keep one of them"))
    return found[0] if found else None


def weld_forces(welds: Welds, body: ShellMesh, shapes: NDArray[np.float64]) -> Iterator[NDArray[np.float64]]:
    """Forces and moments (n, 6, m) on the assessed side of each weld at its nodes, K_e u_e summed, line by line."""
    for number, weld in enumerate(welds.lines.weld):
        yield side_forces(body, shapes, welds.elements[weld], welds.nodes(number))


def _not_in_mesh(welds: Welds, body: ShellMesh, of_lines: str, of_sides: str) -> Iterator[Problem]:
    """Refusals of nodes and elements that the body does not have, and of nodes that no assessed element touches."""
    take = "Correct the numbers, or take the mesh they belong to"
    for number, weld in enumerate(welds.lines.weld):
        node, elements = welds.nodes(number), welds.elements[weld]
        absent, gone = np.setdiff1d(node, body.node), np.setdiff1d(elements, body.element)
        if absent.size:
            what = f"no element of the mesh has node{'s' * (absent.size > 1)} {few(absent.tolist())}"
            yield Problem("not_in_mesh", f"{of_lines}: weld {weld}", what, take)
        if gone.size:
            what = f"the mesh has no element{'s' * (gone.size > 1)} {few(gone.tolist())}"
            yield Problem("not_in_mesh", f"{of_sides}: weld {weld}", what, take)
            continue
        corners = body.corners[np.searchsorted(body.element, elements)]
        alone = np.setdiff1d(np.setdiff1d(node, absent), body.node[corners[corners != NONE]])
        if alone.size:
            what = f"none of its elements touches node{'s' * (alone.size > 1)} {few(alone.tolist())} of the line"
            remedy = "Name the elements of the assessed side at every node: without one there is no force"
            yield Problem("no_element", f"{of_sides}: weld {weld}", what, remedy)
