"""Weld lines by coordinates: polylines of a table, the mesh edges along them, and what is doubtful about the match."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.tables import open_table
from fatigue.weld.along.corridor import local_edges
from fatigue.weld.along.doubts import coincident, turns
from fatigue.weld.along.named import named_along
from fatigue.weld.along.path import Along, Gap, edges_along
from fatigue.weld.along.polyline import Polyline
from fatigue.weld.cuts import WeldCut, trace
from fatigue.weld.detection import Topology

_FAR = 20.0  # times the size of the mesh: another unit of length
_ENDS = 1.0  # of the tolerance: a line that begins or ends further from a node is told


@dataclass(frozen=True, slots=True, eq=False)
class GivenLine:
    """A line of the table: its polyline [mm], and its tolerance [mm], None for half the local edge."""

    name: str
    polyline: Polyline
    tolerance: float | None


def read_given_lines(path: Path) -> tuple[list[GivenLine], list[Problem]]:
    """Lines of a table ``line, point, x_mm, y_mm, z_mm``, optional ``closed, tolerance_mm``; and warnings.

    Raises
    ------
    DataError : a point given twice, a line of one point, other values of ``closed`` or ``tolerance_mm`` within a line
    """
    table = open_table(path, texts=("line",))
    table.expect(("line", "point", "x_mm", "y_mm", "z_mm"), ("closed", "tolerance_mm"), strict=False)
    names, code = table.groups("line")
    point = table.integers("point")
    xyz = np.column_stack([table.numbers(f"{axis}_mm") for axis in "xyz"]).astype(np.float64)
    closed = table.flags("closed", default=False)
    tolerance = table.numbers("tolerance_mm", default=np.nan, above=0.0)
    table.unique({"line": code, "point": point}, {"line": names})
    table.refuse()
    found, problems = [], []
    for number, name in enumerate(names):
        rows = np.flatnonzero(code == number)
        rows = rows[np.argsort(point[rows], kind="stable")]
        where = f"{path}, line {name}"
        own = xyz[rows]
        given = tolerance[rows][np.isfinite(tolerance[rows])]
        if closed[rows].any() != closed[rows].all() or np.unique(given).size > 1:
            what = "its points say different things of closed or tolerance_mm"
            problems.append(Problem("line_differs", where, what, "Give one value for all points of a line"))
        is_closed = bool(closed[rows].all())
        if len(own) > 2 and np.array_equal(own[0], own[-1]):  # closed by repeating its first point
            own, is_closed = own[:-1], True
        kept = np.concatenate([[True], np.linalg.norm(np.diff(own, axis=0), axis=1) > 0.0])
        own = own[kept]
        if len(own) < (3 if is_closed else 2):
            what = f"it has {len(own)} point{'s' * (len(own) != 1)} that differ"
            problems.append(Problem("short_line", where, what, "Give at least two, three of a closed line"))
            continue
        found.append(GivenLine(name, Polyline(own, is_closed), float(given[0]) if given.size else None))
    refuse(DataError, problems)
    return found, table.warnings


def cuts_along(
    topo: Topology, lines: Sequence[GivenLine], path: Path, taken: Mapping[int, str]
) -> tuple[list[WeldCut], dict[int, str], list[Problem]]:
    """Cuts of the given lines, the line of each edge, and warnings; ``taken`` are edges of other marks by their names.

    Raises
    ------
    DataError : a line that no mesh edges follow, with the place; two lines on one edge
    """
    cuts: list[WeldCut] = []
    of_edge: dict[int, str] = {}
    problems: list[Problem] = []
    warnings: list[Problem] = []
    local = local_edges(topo) if lines else np.zeros(0)
    for line in lines:
        where = f"{path}, line {line.name}"
        found = edges_along(topo, local, line.polyline, line.tolerance)
        if isinstance(found, Gap):
            problems.append(_no_edges(where, found, topo, line))
            continue
        twice = next((edge for edge, count in Counter(found.edges).items() if count > 1), None)
        if twice is not None:
            a, b = topo.mesh.node[topo.ends[twice]]
            what = f"it goes along the edge between the nodes {a} and {b} twice"
            problems.append(Problem("line_turns_back", where, what, "Number its points in their order along the weld"))
            continue
        shared = next((edge for edge in found.edges if edge in taken or edge in of_edge), None)
        if shared is not None:
            other = taken.get(shared) or of_edge[shared]
            a, b = topo.mesh.node[topo.ends[shared]]
            what = f"the edge between the nodes {a} and {b} belongs to the line {other}, too"
            problems.append(Problem("edge_twice", where, what, "Move its points, or give it a smaller tolerance_mm"))
            continue
        of_edge |= dict.fromkeys(found.edges, line.name)
        own = trace(topo, dict.fromkeys(found.edges, (line.name, ())))
        cuts += named_along(own, line.polyline, line.name, topo.mesh)
        warnings += _doubts(where, found, topo, local, line)
    refuse(DataError, problems)
    return cuts, of_edge, warnings


def _no_edges(where: str, gap: Gap, topo: Topology, line: GivenLine) -> Problem:
    """Refusal of a line with a gap: where it is, how far the mesh is, and what may be the reason."""
    x, y, z = gap.place
    size = float(np.ptp(topo.mesh.xyz, axis=0).max())
    what = f"no mesh edges follow it from ({x:.6g}, {y:.6g}, {z:.6g}) mm on, {gap.s:.6g} mm along it, for "
    what += f"{gap.length:.6g} mm; the nearest node is {gap.distance:.6g} mm away (tolerance {gap.tolerance:.3g} mm)"
    remedy = "Move its points onto the mesh, add points where it bends, or give it a larger tolerance_mm"
    if gap.coincident > 0:
        what += f"; {gap.coincident} other nodes lie where the edges end"
        remedy = "Merge the nodes that coincide"
    elif gap.distance > _FAR * size or float(line.polyline.at[-1]) < size / 1e3:
        remedy = "Give its points in mm, in the basic frame of the model"
    elif gap.distance <= gap.tolerance:
        remedy = "End it there if the weld ends there, add points where it bends, or give it a larger tolerance_mm"
    return Problem("no_edges_along", where, what, remedy)


def _doubts(where: str, found: Along, topo: Topology, local: NDArray[np.float64], line: GivenLine) -> list[Problem]:
    """What is doubtful about a match: a node far off, ends that miss the ends of the line."""
    doubts = []
    xyz = topo.mesh.xyz[found.nodes]
    edge = float(np.linalg.norm(np.diff(xyz, axis=0), axis=1).mean())
    if found.farthest > 0.25 * edge:
        what = f"a node is {found.farthest:.3g} mm from it, a quarter of an edge or more"
        doubts.append(Problem("line_off_mesh", where, what, "Check its points, or the mesh"))
    for word, miss in (("begins", found.before), ("ends", found.behind)):
        if miss > _ENDS * (line.tolerance or 0.5 * edge):
            what = f"it {word} {miss:.3g} mm from the nearest node along it"
            doubts.append(Problem("line_end_off", where, what, "Check whether the weld is that long, or the mesh"))
    if sharp := turns(topo, line.polyline, found):
        node, turn = sharp[0]
        what = f"the edges along it turn by {turn:.0f} deg at node {topo.mesh.node[node]}, where it does not"
        what += f", and at {len(sharp) - 1} more" if len(sharp) > 1 else ""
        doubts.append(Problem("line_turns", where, what, "Look at it (--vtp); give points nearer to the nodes"))
    if apart := coincident(topo, local, found):
        own, other = topo.mesh.node[list(apart[0])]
        what = f"at {len(apart)} of its nodes lie others that are not merged: {other} at node {own}, the first"
        remedy = "Merge them if the plates there are joined: their sides are not assessed with it"
        doubts.append(Problem("nodes_apart", where, what, remedy))
    return doubts
