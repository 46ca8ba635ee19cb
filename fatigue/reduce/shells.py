"""A model of shells from the neutral tables: nodes, elements, properties, and weld lines with their assessed sides."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from fatigue.errors import DataError, Problem, refuse
from fatigue.flexbody.mass import rigid_mass, rigid_motions
from fatigue.flexbody.shell import structure
from fatigue.flexbody.shell_mesh import NONE, ShellMesh
from fatigue.readers.neutral.against_mesh import TableNames, mesh_warnings
from fatigue.readers.neutral.body.lines import checked_lines, read_lines
from fatigue.readers.neutral.body.mesh import Mesh, read_mesh
from fatigue.readers.neutral.body.welds import read_welds
from fatigue.readers.neutral.forces.element_forces import read_weld_elements
from fatigue.reduce.model import Model, WeldSides, refuse_other_units, table_in
from fatigue.reduce.sections import Sections, read_sections
from fatigue.shown import few
from fatigue.stages import stage
from fatigue.weld.line import LineStack

Integers = NDArray[np.int64]

OTHER_THICKNESS = 1e-3  # relative, between a mesh and its properties: as somebody may write it down
WELDS = ("welds", "weld_nodes", "weld_elements")


def read_shells(folder: Path, properties: Path | None, welds: Path | None, *, strict: bool) -> Model:
    """Model of the tables ``nodes, elements, properties`` of a folder, ``welds, weld_nodes, weld_elements`` if there.

    Parameters
    ----------
    properties : a table in place of that of the folder
    welds : folder of the tables of welds, by default the same one

    Raises
    ------
    DataError : a table is missing, or wrong, or contradicts another
    """
    nodes, elements = _needed(folder, "nodes"), _needed(folder, "elements")
    sections_file = properties or _needed(folder, "properties")
    raw, warnings = read_mesh(nodes, elements, strict=strict)
    sections, found = read_sections(sections_file, strict=strict)
    warnings += found
    mesh = shell_mesh(raw, sections, (nodes.name, elements.name, sections_file.name))
    if properties is None:
        warnings += _other_thickness(raw, mesh, elements.name, sections_file.name)
    refuse(DataError, unconnected(mesh, elements.name))
    stage("assembling %d elements, %d degrees of freedom", len(mesh.element), 6 * len(mesh.node))
    body = structure(mesh)
    mass = rigid_mass(body.M, rigid_motions(body.xyz, body.direction))[0, 0]
    refuse_other_units(mesh.xyz, float(mass), f"{nodes.name}, {sections_file.name}")
    tables = {"nodes.parquet": nodes_table(raw), "elements.parquet": elements_table(raw, mesh)}
    files = [nodes, elements, sections_file]
    sides, weld_tables, weld_files, found = _welds(welds or folder, raw, mesh, strict=strict)
    no_forces = None if sides else _no_welds(welds or folder)
    return Model(
        body,
        (*files, *weld_files),
        nodes.name,
        mesh,
        sides,
        no_forces,
        tables | weld_tables,
        (*warnings, *found),
    )


def shell_mesh(raw: Mesh, sections: Sections, names: tuple[str, str, str]) -> ShellMesh:
    """Mesh of linear shells with their sections; nodes of no element are left out. ``names`` are those of the tables.

    Raises
    ------
    DataError : elements with mid-side nodes or corners twice, of no area, or of a property that there is not
    """
    _, file, of_sections = names
    refuse(DataError, _bad_elements(raw, file))
    at = np.searchsorted(sections.pid, raw.pid).clip(max=len(sections.pid) - 1)
    unknown = sections.pid[at] != raw.pid
    if unknown.any():
        absent = np.unique(raw.pid[unknown])
        what = f"propert{'ies' if absent.size > 1 else 'y'} {few(absent.tolist())} of {int(unknown.sum())} elements "
        what += f"(the first is {raw.element[unknown][0]}) {'are' if absent.size > 1 else 'is'} not there"
        remedy = f"Add {'their rows' if absent.size > 1 else 'its row'}, or correct pid in {file}"
        raise DataError(Problem("unknown_id", f"{of_sections}: column pid", what, remedy))
    corners = raw.corners[:, :4]
    node = np.unique(corners[corners > 0])
    placed = np.where(corners > 0, np.searchsorted(node, corners), NONE)
    xyz = raw.xyz[np.searchsorted(raw.node, node)]
    refuse(DataError, _flat(raw.element, xyz, placed, file))
    values = (getattr(sections, name)[at] for name in ("thickness", "bending_thickness", "E", "nu", "rho", "nsm"))
    return ShellMesh(node, xyz, raw.element, placed, *values)


def _bad_elements(raw: Mesh, file: str) -> Iterator[Problem]:
    """Refusals of elements that are no linear shells."""
    parabolic = (raw.corners[:, 4:] > 0).any(axis=1)
    if parabolic.any():
        what = f"it has mid-side nodes{_and_more(parabolic)}, and shells of three and four nodes are computed here"
        remedy = "Give K and M of the FE program, or a mesh of linear shells"
        yield Problem("parabolic", f"{file}: element {raw.element[parabolic][0]}", what, remedy)
    corners = np.sort(raw.corners[:, :4], axis=1)
    twice = ((corners[:, 1:] == corners[:, :-1]) & (corners[:, 1:] > 0)).any(axis=1)
    if twice.any():
        what = f"a node is twice among its corners{_and_more(twice)}"
        yield Problem("collapsed", f"{file}: element {raw.element[twice][0]}", what, "Give a triangle: n4 empty")


def _flat(element: Integers, xyz: NDArray[np.float64], corners: Integers, file: str) -> Iterator[Problem]:
    """Refusals of elements without area, and of quadrilaterals that cross themselves or turn in."""
    at = np.where(corners == NONE, corners[:, :1], corners)
    p = xyz[at]
    normal = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    normal = np.where((corners[:, 3] == NONE)[:, None], np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), normal)
    edge = np.linalg.norm(np.roll(p, -1, axis=1) - p, axis=2).max(axis=1)
    area = np.linalg.norm(normal, axis=1) / 2
    flat = area < 1e-8 * edge**2
    if flat.any():
        what = f"its area is {area[flat][0]:.3g} mm2{_and_more(flat)}"
        yield Problem("no_area", f"{file}: element {element[flat][0]}", what, "Correct its nodes, or take it out")
        return
    turn = np.cross(np.roll(p, -1, axis=1) - p, np.roll(p, 1, axis=1) - p)
    turned_in = (np.einsum("ecj,ej->ec", turn, normal) <= 0.0).any(axis=1) & (corners[:, 3] != NONE)
    if turned_in.any():
        what = f"its corners cross each other or turn inwards{_and_more(turned_in)}"
        remedy = "Number the corners around the element, and split one that turns inwards"
        yield Problem("turned_in", f"{file}: element {element[turned_in][0]}", what, remedy)


def _and_more(wrong: NDArray[np.bool_]) -> str:
    more = int(wrong.sum()) - 1
    return f" (and {more} more element{'s' * (more > 1)})" if more else ""


def unconnected(mesh: ShellMesh, file: str) -> Iterator[Problem]:
    """Refusal of parts that no element joins to the rest of the body, with nodes of the smallest."""
    corners = mesh.corners
    pairs = np.concatenate([np.stack([corners[:, 0], corners[:, k]], axis=1) for k in (1, 2, 3)])
    pairs = pairs[pairs[:, 1] != NONE]
    joined = sparse.coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(mesh.node),) * 2)
    yield from apart(*connected_components(joined, directed=False), mesh.node, file)


def apart(parts: int, part: NDArray[np.integer], node: Integers, file: str) -> Iterator[Problem]:
    """Refusal of a body in several parts, ``part`` (n,) saying which each node is in."""
    if parts > 1:
        size = np.bincount(part)
        smallest = node[part == size.argmin()]
        what = f"the body is in {parts} parts that nothing joins; the smallest has the node{'s' * (smallest.size > 1)} "
        what += few(np.unique(smallest).tolist())
        raise_remedy = "Join the parts (common nodes), or leave those out that are no part of the body"
        yield Problem("unconnected", file, what, raise_remedy)


def _other_thickness(raw: Mesh, mesh: ShellMesh, file: str, of_sections: str) -> Iterator[Problem]:
    """Warning about elements whose own thickness is another than that of their property."""
    other = np.abs(raw.thickness - mesh.thickness) > OTHER_THICKNESS * mesh.thickness  # False where it is not known
    if other.any():
        first = int(other.argmax())
        what = f"thickness_mm is {raw.thickness[first]:g}, and {mesh.thickness[first]:g} of its property "
        what += f"{raw.pid[first]} in {of_sections}, which is taken{_and_more(other)}"
        where = f"{file}: element {raw.element[first]}"
        yield Problem("other_thickness", where, what, "Correct one of them", int(other.sum()))


def _welds(
    folder: Path, raw: Mesh, mesh: ShellMesh, *, strict: bool
) -> tuple[WeldSides | None, dict[str, pa.Table], tuple[Path, ...], list[Problem]]:
    """Weld lines and sides, their tables, files and warnings; nothing where the folder has no tables of welds."""
    paths = {name: table_in(folder, name) for name in WELDS}
    there = {name: path for name, path in paths.items() if path is not None}
    if not there:
        return None, {}, (), []
    if absent := [name for name in WELDS if name not in there]:
        what = f"there is {', '.join(path.name for path in there.values())}, and no {' nor '.join(absent)}"
        remedy = "Give all three tables, or none: without welds no weld forces are written"
        raise DataError(Problem("missing_file", str(folder), what, remedy))
    welds, warnings = read_welds(there["welds"], None, strict=strict)
    lines, found = read_lines(there["weld_nodes"], welds, {weld.name for weld in welds}, strict=strict)
    warnings += found + checked_lines(lines, there["weld_nodes"].name)
    sides, found = read_weld_elements(there["weld_elements"], welds, strict=strict)
    warnings += found
    names = TableNames(there["weld_nodes"].name, "the mesh", "elements.parquet")
    refuse(DataError, _not_in_mesh(lines, sides, mesh, names.lines, there["weld_elements"].name))
    warnings += mesh_warnings(lines, _as_computed(raw, mesh), names, {}, knows_sides=True)
    tables = {f"{name}.csv": _whole(there[name]) for name in ("welds", "weld_nodes")}
    return WeldSides(lines, sides), tables, tuple(there.values()), warnings


def _not_in_mesh(
    lines: LineStack, sides: Mapping[str, Integers], mesh: ShellMesh, of_lines: str, of_sides: str
) -> Iterator[Problem]:
    """Refusals of welds whose nodes or elements the mesh does not have, or of nodes that no assessed element touches."""
    for number, weld in enumerate(lines.weld):
        node = lines.node[lines.begin[number] : lines.begin[number + 1]]
        elements = sides[weld]
        absent, gone = np.setdiff1d(node, mesh.node), np.setdiff1d(elements, mesh.element)
        if absent.size:
            what = f"node{'s' * (absent.size > 1)} {few(absent.tolist())} of weld {weld} belong to no element"
            remedy = "Correct the numbers, or take the mesh they are of"
            yield Problem("not_in_mesh", f"{of_lines}: weld {weld}", what, remedy)
        if gone.size:
            what = f"element{'s' * (gone.size > 1)} {few(gone.tolist())} of weld {weld} are not in the mesh"
            remedy = "Correct the numbers, or take the mesh they are of"
            yield Problem("not_in_mesh", f"{of_sides}: weld {weld}", what, remedy)
        if not (absent.size or gone.size):
            corners = mesh.corners[np.searchsorted(mesh.element, elements)]
            alone = np.setdiff1d(node, mesh.node[corners[corners != NONE]])
            if alone.size:
                what = f"none of its elements touches node{'s' * (alone.size > 1)} {few(alone.tolist())}, so that no "
                what += "force would be there"
                remedy = "Name the elements of the assessed side at every node of the line"
                yield Problem("no_element", f"{of_sides}: weld {weld}", what, remedy)


def nodes_table(raw: Mesh) -> pa.Table:
    """Table of the nodes of a mesh."""
    return pa.table({"node": raw.node, **{f"{a}_mm": raw.xyz[:, k] for k, a in enumerate("xyz")}})


def elements_table(raw: Mesh, mesh: ShellMesh) -> pa.Table:
    """Table of the elements with the thickness they were computed with."""
    corners = {f"n{k + 1}": raw.corners[:, k] for k in range(4)}
    return pa.table({"element": raw.element, "pid": raw.pid, **corners, "thickness_mm": mesh.thickness})


def _as_computed(raw: Mesh, mesh: ShellMesh) -> Mesh:
    """The mesh with the thickness it was computed with."""
    return Mesh(raw.node, raw.xyz, raw.element, raw.corners, raw.pid, mesh.thickness)


def _whole(path: Path) -> pa.Table:
    """All of a table as it stands."""
    return pa_csv.read_csv(path) if path.suffix == ".csv" else pq.read_table(path)


def _needed(folder: Path, name: str) -> Path:
    found = table_in(folder, name)
    if found is None:
        what = f"there is no {name}.parquet and no {name}.csv"
        remedy = "Give a folder with nodes, elements and properties, or with K, M and dof.csv"
        raise DataError(Problem("missing_file", str(folder), what, remedy))
    return found


def _no_welds(folder: Path) -> Problem:
    what = "there are no tables of welds, so no weld forces were written"
    remedy = "Add welds, weld_nodes and weld_elements, or name their folder with --welds"
    return Problem("no_weld_forces", str(folder), what, remedy)
