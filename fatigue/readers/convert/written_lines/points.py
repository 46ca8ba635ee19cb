"""Weld lines of a mesh as a table of points in space, to be given for another mesh."""

import csv
from collections.abc import Iterable, Iterator
from io import StringIO
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.along.thinned import thinned
from fatigue.weld.cuts import WeldCut
from fatigue.weld.line import WeldLine

_Edge = tuple[int, int]


def lines_text(cuts: Iterable[WeldCut]) -> str:
    """Table of the lines of some cuts: every edge once, however many plate sides are seen from it."""
    written: set[_Edge] = set()
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["line", "point", "x_mm", "y_mm", "z_mm", "closed"])
    names: dict[str, int] = {}
    for cut in sorted(cuts, key=lambda cut: -cut.line.node.size):  # one that goes on before those that end at corners
        for xyz, closed in _unwritten(cut.line, written):
            stem = cut.name.rpartition(":")[0] if cut.kind == "line" else cut.name.rpartition("_p")[0]
            names[stem] = names.get(stem, 0) + 1
            name = stem if names[stem] == 1 else f"{stem} {names[stem]}"
            for number, place in enumerate(thinned(xyz, closed=closed).points, 1):
                writer.writerow([name, number, *(f"{x:.9g}" for x in place), str(closed).lower()])
    return out.getvalue()


def _unwritten(line: WeldLine, written: set[_Edge]) -> Iterator[tuple[NDArray[np.float64], bool]]:
    """Nodes (n, 3) of the stretches of a line whose edges are not written yet, and whether each is closed."""
    order = [*range(line.node.size), *([0] if line.closed else [])]
    corners = [k for k, at in enumerate(order) if not line.edge_mid[at]]
    edges = [_edge(*line.node[[order[a], order[b]]].tolist()) for a, b in pairwise(corners)]
    new = [edge not in written for edge in edges]
    written.update(edges)
    if line.closed and all(new):
        yield line.xyz, True
        return
    if line.closed and new[0] and new[-1]:  # begin where the stretch that is left begins
        turn = new.index(False)
        whole = order[:-1]
        order = [*whole[corners[turn] :], *whole[: corners[turn]], whole[corners[turn]]]
        corners = [k for k, at in enumerate(order) if not line.edge_mid[at]]
        new = [*new[turn:], *new[:turn]]
    begin = None
    for k, is_new in enumerate([*new, False]):
        if is_new and begin is None:
            begin = k
        elif not is_new and begin is not None:
            yield line.xyz[order[corners[begin] : corners[k] + 1]], False
            begin = None


def _edge(a: int, b: int) -> _Edge:
    return (min(a, b), max(a, b))
