"""Cuts of a line given by points: named and directed by the line and not by the numbers of a mesh.

The name is that of the line, the property of the plate and a letter for its side: ``roof:p3a``. The property is that
where the line begins. Sides of one property have their letters by their angle round the line, so that another mesh
gives each the same. Where a side is cut into several lines they are counted along the polyline.
"""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.along.polyline import Polyline
from fatigue.weld.cuts import WeldCut, letters
from fatigue.weld.line import WeldLine
from fatigue.weld.mesh import ShellMesh

_SAME_SIDE = 0.5  # cosine of the directions across the line of cuts of one side
_FIRST_DEG = -37.0
"""Where angles round the line begin: at none that plates often have to the axes or to each other, so that the little by
which a side turns from mesh to mesh does not make the first the last."""


def named_along(cuts: Sequence[WeldCut], line: Polyline, name: str, mesh: ShellMesh) -> list[WeldCut]:
    """Cuts of one line with their names, each from the first point of the polyline on."""
    by_pid: dict[int, list[WeldCut]] = defaultdict(list)
    for cut in cuts:
        turned = _directed(cut, line)
        own = replace(turned, pid=_first_property(turned, mesh), pids=tuple(sorted({c.pid for c in cuts})))
        by_pid[own.pid].append(own)
    found = []
    for pid, some in sorted(by_pid.items()):
        for number, side in enumerate(_sides(some, line)):
            ordered = sorted(side, key=lambda cut: _start(cut, line))
            for count, cut in enumerate(ordered, 1):
                own_name = f"{name}:p{pid}{letters(number)}" + (f"_{count}" if len(ordered) > 1 else "")
                found.append(replace(cut, name=own_name, kind="line", line=replace(cut.line, weld=own_name)))
    return found


def _first_property(cut: WeldCut, mesh: ShellMesh) -> int:
    """Property of the plate at the first edge of the line: its elements may have several."""
    ends = np.searchsorted(mesh.node, cut.line.node[~cut.line.edge_mid][:2])
    rows = np.searchsorted(mesh.element, cut.elements)
    at_edge = rows[np.isin(mesh.corner[rows], ends).sum(axis=1) == 2]
    return int(mesh.pid[at_edge].min()) if at_edge.size else cut.pid


def _sides(cuts: Sequence[WeldCut], line: Polyline) -> list[list[WeldCut]]:
    """Cuts of one property by the side of the line they lie on, in the order of their angles round it."""
    groups: list[list[WeldCut]] = []
    for cut in cuts:
        own = _across(cut)
        same = next((group for group in groups if own @ _across(group[0]) > _SAME_SIDE), None)
        if same is None:
            groups.append([cut])
        else:
            same.append(cut)
    first, second = _round(line)

    def angle(group: list[WeldCut]) -> float:
        across = _across(group[0])
        return float((np.degrees(np.arctan2(across @ second, across @ first)) - _FIRST_DEG) % 360.0)

    return sorted(groups, key=angle)


def _round(line: Polyline) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Two directions across the line, from which angles round it are counted; the same if its points are reversed."""
    chain = line.chain
    ahead = chain[-1] - chain[0]
    if line.closed:
        ahead = _unit(chain[1] - chain[0]) - _unit(chain[-2] - chain[0])
    if np.linalg.norm(ahead) < 1e-3 * line.at[-1]:
        ahead = chain[1] - chain[0]
    ahead = _unit(ahead)
    ahead = ahead * np.sign(ahead[np.abs(ahead).argmax()])
    axis = np.eye(3)[2 if abs(ahead[2]) < 0.9 else 0]  # up, for a line that is not upright
    first = _unit(np.cross(axis, ahead))
    return first, np.cross(ahead, first)


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    return vector / max(float(np.linalg.norm(vector)), 1e-300)


def _across(cut: WeldCut) -> NDArray[np.float64]:
    """Mean direction into the plate, across the line; of a closed line at its first node."""
    outward = cut.line.outward[:1] if cut.line.closed else cut.line.outward
    return _unit(-outward.mean(axis=0))


def _start(cut: WeldCut, line: Polyline) -> float:
    return float(line.nearest(cut.line.xyz)[1].min())


def _directed(cut: WeldCut, line: Polyline) -> WeldCut:
    """Cut whose line runs as the polyline does, a closed one from the node nearest to its first point."""
    own = cut.line
    _, along = line.nearest(own.xyz)
    order = np.arange(own.node.size)
    steps = np.diff(along)
    if float(np.sign(steps).sum()) < 0.0:
        order = order[::-1]
    if own.closed:
        corners = np.flatnonzero(~own.edge_mid[order])
        away = np.linalg.norm(own.xyz[order][corners] - line.points[0], axis=1)
        order = np.roll(order, -int(corners[away.argmin()]))
    return replace(cut, line=_taken(own, order))


def _taken(line: WeldLine, order: NDArray[np.int64]) -> WeldLine:
    """Line whose nodes are in another order."""
    return replace(
        line,
        node=line.node[order],
        xyz=line.xyz[order],
        thickness=line.thickness[order],
        normal=line.normal[order],
        outward=line.outward[order],
        edge_mid=line.edge_mid[order],
    )
