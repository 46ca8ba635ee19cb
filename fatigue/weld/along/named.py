"""Cuts of a line given by points: named and directed by the line and not by the numbers of a mesh.

The name is that of the line, the property of the plate and a letter for its side: ``roof:p3a``. Sides of one property
have their letters by the direction across the line, so that another mesh gives each the same. Where a side is cut into
several lines they are counted along the polyline.
"""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fatigue.weld.along.polyline import Polyline
from fatigue.weld.cuts import WeldCut, letters
from fatigue.weld.line import WeldLine

_SAME_SIDE = 0.5  # cosine of the directions across the line of cuts of one side


def named_along(cuts: Sequence[WeldCut], line: Polyline, name: str) -> list[WeldCut]:
    """Cuts of one line with their names, each from the first point of the polyline on."""
    turned = [_directed(cut, line) for cut in cuts]
    by_pid: dict[int, list[WeldCut]] = defaultdict(list)
    for cut in turned:
        by_pid[cut.pid].append(cut)
    found = []
    for pid, some in sorted(by_pid.items()):
        for number, side in enumerate(_sides(some)):
            ordered = sorted(side, key=lambda cut: _start(cut, line))
            for count, cut in enumerate(ordered, 1):
                own = f"{name}:p{pid}{letters(number)}" + (f"_{count}" if len(ordered) > 1 else "")
                found.append(replace(cut, name=own, kind="line", line=replace(cut.line, weld=own)))
    return found


def _sides(cuts: Sequence[WeldCut]) -> list[list[WeldCut]]:
    """Cuts of one property by the side of the line they lie on, in the order of their directions."""
    groups: list[list[WeldCut]] = []
    for cut in cuts:
        own = _across(cut)
        same = next((group for group in groups if own @ _across(group[0]) > _SAME_SIDE), None)
        if same is None:
            groups.append([cut])
        else:
            same.append(cut)
    return sorted(groups, key=lambda group: tuple((-np.round(_across(group[0]), 1) + 0.0).tolist()))


def _across(cut: WeldCut) -> np.ndarray:
    """Mean direction into the plate, across the line; of a closed line at its first node."""
    outward = cut.line.outward[:1] if cut.line.closed else cut.line.outward
    mean = -outward.mean(axis=0)
    return np.asarray(mean / max(float(np.linalg.norm(mean)), 1e-300))


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


def _taken(line: WeldLine, order: np.ndarray) -> WeldLine:
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
