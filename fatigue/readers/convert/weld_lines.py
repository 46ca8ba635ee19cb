"""Weld lines of an FE model: found in the mesh, or marked by node lists, node sets, plot elements and bars."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, given_path
from fatigue.files.whole import replacing
from fatigue.readers.convert.coordinate_lines import cuts_along, read_given_lines
from fatigue.readers.convert.joined_cuts import joined_cuts
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
from fatigue.weld.detection import CANDIDATES, WELDS, Key, Topology, classify, stacked_elements, topology
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
    topo = topology(model.mesh)
    lists, list_warnings = _node_lists(sources.node_lists)
    marked = dict(_marked_edges(model, topo, sources, lists))
    given, of_table = read_given_lines(sources.lines) if sources.lines else ([], [])
    taken = {edge: key[0] for edge, key in marked.items()}
    along, on_lines, doubts = cuts_along(topo, given, sources.lines or Path(), taken)
    list_warnings += [*of_table, *doubts]
    cuts = [*along, *trace(topo, marked)]
    marked |= {edge: (name, ()) for edge, name in on_lines.items()}
    detect = not marked if sources.detect is None else sources.detect
    if detect:
        found = {edge: key for edge, key in classify(topo).items() if edge not in marked}
        for kinds in (True, False):  # a line of candidates does not end one of welds
            cuts += trace(topo, {edge: key for edge, key in found.items() if (key[0] in WELDS) == kinds})
    elements = unconfirmed_elements(model)
    rows, unconfirmed = [], {}
    for cut in cuts:
        is_weld = cut.kind not in CANDIDATES or sources.candidates
        rows.append(proposed(cut, "assess" if is_weld else "candidate", "" if is_weld else _CANDIDATE_REASON[cut.kind]))
        unconfirmed[cut.name] = _unconfirmed(cut, elements)
    edited = open_register(sources.register, strict=False) if sources.register else None
    rows, warnings = merged(rows, edited) if edited else (rows, [])
    warnings = [*list_warnings, *warnings]
    by_name = {cut.name: cut for cut in cuts}
    final = [_settled(row, by_name.get(row.line), unconfirmed.get(row.line, "")) for row in rows]
    by_name = {row.line: _as_registered(by_name[row.line], row) for row in final if row.line in by_name}
    joined = joined_cuts(topo, final, by_name, sources.register)
    stacked = stacked_elements(model.mesh)
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
        unfinished.write_text(lines_text(found.cuts[row.line] for row in kept), "utf-8")
    try:
        again = find_welds(model, WeldSources(lines=lines))
    except DataError as error:  # as of plates that lie on one another: told, with the lines to correct
        return list(found.rows), list(error.problems)
    return moved(kept, found.cuts, {row.line: row for row in again.rows}, again.cuts, lines)


def no_welds(mesh: Path) -> Problem:
    """Refusal of a mesh that has nothing to list."""
    what = "the mesh has no weld lines: no edge where three shells, two properties or two planes meet"
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


def _settled(row: RegisterRow, cut: WeldCut | None, unconfirmed: str) -> RegisterRow:
    """Exclude what cannot be assessed: a thickness that has to be confirmed and is not, a line that makes no sense."""
    if cut is None or row.status != "assess":
        return row
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


def _marked_edges(
    model: FeModel, topo: Topology, sources: WeldSources, lists: Mapping[str, list[int]]
) -> Iterator[tuple[int, Key]]:
    """Edges that the user marked as welds."""
    edge_of = {(int(a), int(b)): k for k, (a, b) in enumerate(topo.ends)}
    index = {int(n): k for k, n in enumerate(model.mesh.node)}

    def edge(a: int, b: int) -> int | None:
        ends = sorted((index.get(a, -1), index.get(b, -1)))
        return edge_of.get((ends[0], ends[1]))

    for number in sources.sets:
        if number not in model.node_sets:
            known = ", ".join(str(s) for s in sorted(model.node_sets)) or "none"
            raise DataError(Problem("no_set", model.source, f"there is no SET {number}", f"Sets found: {known}"))
        inside = np.isin(model.mesh.node[topo.ends], model.node_sets[number]).all(axis=1)
        if not inside.any():
            raise DataError(
                Problem("empty_set", model.source, f"no shell edge lies in SET {number}", "Correct the set")
            )
        yield from ((int(k), (f"set{number}", ())) for k in np.flatnonzero(inside))
    for name in sources.markers:
        pairs = model.marker_edges.get(name.upper(), np.empty((0, 2), np.int64)).tolist()
        on_edges = [k for a, b in pairs if (k := edge(a, b)) is not None]
        if not on_edges:
            found = ", ".join(sorted(model.marker_edges)) or "none"
            raise DataError(
                Problem(
                    "no_marker", model.source, f"no {name.upper()} lies on a shell edge", f"Line cards found: {found}"
                )
            )
        yield from ((k, (name.lower(), ())) for k in on_edges)
    mids = set(model.mesh.node[np.unique(model.mesh.mid[model.mesh.mid >= 0])].tolist())
    for weld, nodes in lists.items():
        corners = [n for n in nodes if n not in mids]
        for a, b in pairwise(corners):
            k = edge(a, b)
            if k is None:
                where = f"{sources.node_lists}, weld {weld}"
                raise DataError(
                    Problem("no_edge", where, f"no shell edge joins the nodes {a} and {b}", "List neighbouring nodes")
                )
            yield k, (weld, ())


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
