"""Weld lines of an FE model: found in the mesh, or marked by node lists, node sets, plot elements and bars.

Those of solids are found on their skin, as those of shells on these, and become cuts through the plate beneath.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, given_path
from fatigue.files.whole import replacing
from fatigue.readers.convert.coordinate_lines import cuts_along, read_given_lines
from fatigue.readers.convert.joined_cuts import joined_cuts
from fatigue.readers.convert.lines.marked import marked_edges
from fatigue.readers.convert.lines.surfaces import (
    MEETS_SOLIDS,
    SHELL_ON_SOLID,
    joined_through,
    lines_of,
    rows_of,
    surfaces_of,
    through_all,
)
from fatigue.readers.convert.options import WeldSources
from fatigue.readers.convert.written_lines.moved_register import moved
from fatigue.readers.convert.written_lines.points import lines_text
from fatigue.readers.foreign.fe.model import FeModel, in_mm
from fatigue.readers.foreign.read import read_model
from fatigue.readers.neutral.register.register_file import open_register, register_text
from fatigue.readers.neutral.register.weld_register import RegisterRow, kind_of, merged, proposed
from fatigue.readers.neutral.tables import open_table
from fatigue.readers.units.systems import unit_system
from fatigue.weld.cuts import WeldCut, trace
from fatigue.weld.detection import CANDIDATES, WELDS, stacked_elements
from fatigue.weld.line_check import check_line


@dataclass(frozen=True, slots=True, eq=False)
class FoundWelds:
    """Every plate side of every weld line, and the register that says which are assessed.

    Attributes
    ----------
    cuts : by line name; named, faced and dimensioned as the register has it
    joined : by weld name, of lines that have one name and are one weld
    rows : the register
    warnings : about mesh, lists and register
    """

    cuts: dict[str, WeldCut]
    joined: dict[str, WeldCut]
    rows: tuple[RegisterRow, ...]
    warnings: tuple[Problem, ...]

    def assessed(self) -> list[tuple[RegisterRow, WeldCut]]:
        """Welds to assess, of joined lines the first row, with their cuts."""
        first: dict[str, RegisterRow] = {}
        for row in self.rows:
            if row.status == "assess":
                first.setdefault(row.weld, row)
        return [(row, self.joined.get(name) or self.cuts[row.line]) for name, row in first.items()]


def find_welds(model: FeModel, sources: WeldSources) -> FoundWelds:
    """Weld lines of a model in mm, with their register.

    Raises
    ------
    DataError : a marked line that is no line of mesh edges, an unknown set or marker, a bad register
    """
    surfaces = surfaces_of(model)
    lists, list_warnings = _node_lists(sources.node_lists)
    marked = marked_edges(model, surfaces, sources, lists)
    given, of_table = read_given_lines(sources.lines) if sources.lines else ([], [])
    list_warnings += of_table
    cuts: list[WeldCut] = []
    on_skin: dict[str, WeldCut] = {}
    faults: dict[str, str] = {}
    of_surface = list(zip(surfaces, marked, lines_of(surfaces, given), strict=True))
    alongs = [
        cuts_along(surface.topo, lines, sources.lines or Path(), {edge: key[0] for edge, key in own.items()})
        for surface, own, lines in of_surface
    ]
    detect = not (any(marked) or given) if sources.detect is None else sources.detect
    for (surface, own, _), (along, on_lines, doubts) in zip(of_surface, alongs, strict=True):
        list_warnings += doubts
        here = [*along, *trace(surface.topo, own)]
        if detect:
            known = own.keys() | on_lines.keys()
            found = {edge: key for edge, key in surface.edges().items() if edge not in known}
            for kinds in (True, False):  # a line of candidates does not end one of welds
                here += trace(surface.topo, {edge: key for edge, key in found.items() if (key[0] in WELDS) == kinds})
        if surface.skin is not None:
            on_skin |= {cut.name: cut for cut in here}
            here, of_solids = through_all(surface.skin, here)
            faults |= of_solids
        cuts += here
    faults |= {cut.name: MEETS_SOLIDS for cut in cuts if cut.kind == SHELL_ON_SOLID}
    elements = unconfirmed_elements(model)
    rows, unconfirmed = [], {}
    for cut in cuts:
        is_weld = cut.kind not in CANDIDATES or sources.candidates
        row = proposed(cut, "assess" if is_weld else "candidate", "" if is_weld else _CANDIDATE_REASON[cut.kind])
        rows.append(replace(row, surface="top") if cut.name in on_skin else row)  # the toe lies on the top surface
        unconfirmed[cut.name] = "" if cut.name in on_skin else _unconfirmed(cut, elements)
    edited = open_register(sources.register, strict=False) if sources.register else None
    rows, warnings = merged(rows, edited) if edited else (rows, [])
    warnings = [*list_warnings, *warnings]
    by_name = {cut.name: cut for cut in cuts}
    final = [
        _settled(row, by_name.get(row.line), unconfirmed.get(row.line, ""), faults.get(row.line, "")) for row in rows
    ]
    by_name = {row.line: _as_registered(by_name[row.line], row) for row in final if row.line in by_name}
    joined: dict[str, WeldCut] = {}
    for surface, of_own in zip(surfaces, rows_of(surfaces, final, on_skin, sources.register), strict=True):
        if surface.skin is None:
            joined |= joined_cuts(surface.topo, of_own, by_name, sources.register)
        else:
            first = {row.weld: row for row in reversed(of_own)}
            cuts_on_skin = {row.line: _as_registered(on_skin[row.line], row) for row in of_own}
            whole = joined_cuts(surface.topo, of_own, cuts_on_skin, sources.register)
            joined |= {
                name: _as_registered(joined_through(surface.skin, cut), first[name]) for name, cut in whole.items()
            }
    stacked = stacked_elements(model.mesh) if model.mesh.element.size else np.empty(0, np.int64)
    if stacked.size:
        warnings.append(
            Problem(
                "stacked_elements",
                model.source,
                f"{stacked.size} shells lie on the same nodes as another, element {stacked[0]} the first",
                "Their edges look like welds; exclude them in the register",
            )
        )
    return FoundWelds(by_name, joined, tuple(final), tuple(warnings))


def list_welds(
    mesh: Path | str,
    sources: WeldSources,
    units: str,
    out: Path | str | None,
    overwrite: bool,
    lines: Path | str | None = None,
) -> FoundWelds:
    """Weld lines of a model file; their register is written, to be edited and given back.

    Parameters
    ----------
    units : unit system of the model
    out : register to write; None: write nothing
    lines : table of the lines to write, as points in space for another mesh; None: write nothing. The register has the
        names of these lines then, so that it goes with them

    Raises
    ------
    DataError : as ``find_welds``; there are none; ``out`` exists, is not the register that was read, and may not be
        overwritten
    """
    mesh, out = given_path(mesh, "mesh"), None if out is None else given_path(out, "out")
    model = in_mm(read_model(mesh), unit_system(units, "units").length)
    found = find_welds(model, sources)
    if not found.rows:
        raise DataError(no_welds(mesh))
    rows, warnings = list(found.rows), list(found.warnings)
    if out is not None and out.exists() and out != sources.register and not overwrite:
        raise DataError(
            Problem("foreign_file", str(out), "the file exists", "Give it as the register too, or use --force")
        )
    if lines is not None:
        rows, of_lines = _written_lines(model, found, given_path(lines, "lines"), overwrite)
        warnings += of_lines
    if out is not None:
        with replacing(out) as unfinished:  # it may be the edited register that was read
            unfinished.write_text(register_text(rows), "utf-8")
    return replace(found, warnings=(*model.warnings, *warnings))


def _written_lines(
    model: FeModel, found: FoundWelds, lines: Path, overwrite: bool
) -> tuple[list[RegisterRow], list[Problem]]:
    """Write the lines that are no candidates as points in space; the register under the names these give, warnings."""
    if lines.exists() and not overwrite:
        raise DataError(Problem("foreign_file", str(lines), "the file exists", "Use --force to overwrite it"))
    kept = [row for row in found.rows if row.status != "candidate" and row.line in found.cuts]
    if not kept:
        raise DataError(Problem("no_welds", str(lines), "there are no lines but candidates", "Use --candidates"))
    with replacing(lines) as unfinished:
        unfinished.write_text(lines_text(_at_nodes(model, found.cuts[row.line]) for row in kept), "utf-8")
    try:
        again = find_welds(model, WeldSources(lines=lines))
    except DataError as error:  # as of plates that lie on one another: told, with the lines to correct
        return list(found.rows), list(error.problems)
    return moved(kept, found.cuts, {row.line: row for row in again.rows}, again.cuts, lines)


def _at_nodes(model: FeModel, cut: WeldCut) -> WeldCut:
    """Cut whose line is where its nodes are: of solids on the surface, not at mid-thickness."""
    xyz = model.mesh.xyz[np.searchsorted(model.mesh.node, cut.line.node)]
    return replace(cut, line=replace(cut.line, xyz=xyz))


def no_welds(mesh: Path) -> Problem:
    """Refusal of a mesh that has nothing to list."""
    what = "the mesh has no weld lines: no edge where three shells, two properties or two planes meet, "
    what += "none where faces of solids meet re-entrantly"
    return Problem("no_welds", str(mesh), what, "Mark the lines with --node-lists, --set or --marker")


_CANDIDATE_REASON = {
    "flat": "the property changes in one plane: perhaps no weld",
    "fold": "a fold of one property: perhaps bent sheet",
}


def unconfirmed_elements(model: FeModel) -> dict[int, str]:
    """Why the thickness of an element cannot be used unless it is confirmed, by element id."""
    mesh = model.mesh
    found = {
        int(e): model.unconfirmed_sections[int(p)]
        for e, p in zip(mesh.element, mesh.pid, strict=True)
        if int(p) in model.unconfirmed_sections
    }
    for e in mesh.element[~(mesh.thickness > 0)]:
        found.setdefault(int(e), f"element {e} has no thickness")
    return found | dict(model.unconfirmed_elements)


def _unconfirmed(cut: WeldCut, elements: Mapping[int, str]) -> str:
    """Say why the thickness of a cut has to be confirmed: the first element of each kind, and how many more."""
    kinds: dict[str, list[str]] = {}
    for reason in dict.fromkeys(elements[e] for e in cut.elements.tolist() if e in elements):
        kinds.setdefault(kind_of(reason), []).append(reason)
    return "; ".join(some[0] + (f" (and {len(some) - 1} more)" if len(some) > 1 else "") for some in kinds.values())


def _settled(row: RegisterRow, cut: WeldCut | None, unconfirmed: str, fault: str) -> RegisterRow:
    """Exclude what cannot be assessed: no cut, a thickness to be confirmed that is not, a line that makes no sense."""
    if cut is None or row.status != "assess":
        return row
    if fault:
        return replace(row, status="excluded", reason=fault)
    if unconfirmed and not row.confirmed:
        return replace(
            row,
            status="excluded",
            reason=f"{unconfirmed}; to assess it, enter thickness_mm, confirmed true and status assess",
        )
    try:
        check_line(_as_registered(cut, row).line, row.line)
    except DataError as error:
        return replace(row, status="excluded", reason="; ".join(problem.what for problem in error.problems))
    return row


def _as_registered(cut: WeldCut, row: RegisterRow) -> WeldCut:
    """Cut with the register's name, end length and, where confirmed, thickness."""
    line = replace(cut.line, weld=row.weld, end_length=float(row.end_length) if row.end_length else None)
    if row.confirmed:
        line = replace(line, thickness=np.full(line.node.size, row.thickness))
    return replace(cut, line=line)


def _node_lists(path: Path | None) -> tuple[dict[str, list[int]], list[Problem]]:
    """Nodes of every weld in order, a closed line repeats its first node at the end; and warnings about the table."""
    if path is None:
        return {}, []
    table = open_table(path, texts=("weld",))
    table.expect(("weld", "order", "node"), (), strict=False)
    names, code = table.groups("weld")
    order, node = table.integers("order"), table.integers("node")
    table.refuse()
    found = {}
    for at, name in enumerate(names):
        rows = np.flatnonzero(code == at)
        if rows.size:
            found[name] = node[rows[np.argsort(order[rows], kind="stable")]].tolist()
    return found, table.warnings
