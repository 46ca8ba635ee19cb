"""The weld lines of a case and the forces on them: nodal forces as they are, element forces summed per part."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.inputs import Inputs, Modes, column, flags
from fatigue.verify.recount.layout import Layout
from fatigue.verify.recount.line import CORNER_DEG, Line, LineStress, edges, kinks, line_stress
from fatigue.verify.recount.tables import FORCE_COLUMNS, read_pieces, read_rows_where

Floats = NDArray[np.float64]
Corners = dict[tuple[int, int], Floats]
"""Forces (m, 6) of each element corner, by element and node."""

_WELDS_AT_ONCE = 1000  # whose geometry is in memory


def layout(inputs: Inputs) -> Layout:
    """Find where the points are: the keys of all stations, without the forces and without keeping the geometry."""
    welds = tuple(inputs.frame("welds")["weld"].tolist())
    if "nodal_forces" in inputs.case["body"]:
        return _unsplit(inputs, welds)
    weld, part, order = [], [], []
    for first in range(0, len(welds), _WELDS_AT_ONCE):
        for line in _lines(inputs, welds[first : first + _WELDS_AT_ONCE]):
            for piece in split(line):
                weld.append(np.full(len(piece.order), welds.index(line.weld, first), dtype=np.int32))
                part.append(np.full(len(piece.order), piece.part, dtype=np.int64))
                order.append(piece.order)
    return Layout(welds, np.concatenate(weld), np.concatenate(part), np.concatenate(order))


def _unsplit(inputs: Inputs, welds: tuple[str, ...]) -> Layout:
    """Lay out lines whose forces are summed already; a kink is then no reason to split."""
    place = {name: i for i, name in enumerate(welds)}
    welds_of, orders = [], []
    for piece in read_pieces(inputs.path("weld_nodes"), ("weld", "order")):
        welds_of.append(piece["weld"].map(place).to_numpy(dtype=np.int32))
        orders.append(piece["order"].to_numpy(copy=True))  # of a piece, which need not stay for it
    weld, order = np.concatenate(welds_of), np.concatenate(orders)
    ascending = np.lexsort((order, weld))
    return Layout(welds, weld[ascending], np.ones(len(weld), dtype=np.int64), order[ascending])


def solved_lines(inputs: Inputs, modes: Modes, welds: Sequence[str]) -> list[LineStress]:
    """Read and solve every line part of some welds, in their order."""
    lines = _lines(inputs, welds)
    if "nodal_forces" in inputs.case["body"]:
        return list(_with_nodal_forces(lines, inputs, modes))
    return list(_with_element_forces(lines, inputs, modes))


def _lines(inputs: Inputs, welds: Sequence[str]) -> list[Line]:
    """Read the lines of some welds."""
    frame = inputs.frame("welds").set_index("weld").loc[list(welds)]
    by_weld = dict(tuple(read_rows_where(inputs.path("weld_nodes"), "weld", welds).groupby("weld")))
    return [
        _line(by_weld[weld], weld, closed=bool(closed), end_length=None if np.isnan(end) else float(end))
        for weld, closed, end in zip(welds, flags(frame, "closed"), column(frame, "end_length_mm"), strict=True)
    ]


def _line(rows: pd.DataFrame, weld: str, *, closed: bool, end_length: float | None) -> Line:
    rows = rows.sort_values("order")

    def vectors(stem: str, suffix: str = "") -> Floats:
        return np.stack([column(rows, f"{stem}{axis}{suffix}") for axis in "xyz"], axis=1)

    return Line(
        weld=weld,
        part=1,
        order=rows["order"].to_numpy(dtype=np.int64),
        node=rows["node"].to_numpy(dtype=np.int64),
        xyz=vectors("", "_mm"),
        thickness=column(rows, "thickness_mm"),
        normal=vectors("normal_"),
        outward=vectors("outward_"),
        edge_mid=flags(rows, "edge_mid"),
        closed=closed,
        end_length=end_length,
    )


def _with_nodal_forces(lines: list[Line], inputs: Inputs, modes: Modes) -> Iterator[LineStress]:
    """Solve lines whose forces are summed already; a kink is then no reason to split."""
    frame = read_rows_where(inputs.path("nodal_forces"), "weld", [line.weld for line in lines])
    frame = frame[frame["mode"].isin(modes.mode)]
    by_weld = dict(tuple(frame.groupby("weld")))
    for line in lines:
        rows = by_weld[line.weld].set_index(["node", "mode"])
        wanted = pd.MultiIndex.from_product([line.node, modes.mode])
        forces = rows.loc[wanted, FORCE_COLUMNS].to_numpy(dtype=float).reshape(len(line.node), len(modes.mode), 6)
        yield line_stress(line, forces * modes.force_factor[:, None])


def _with_element_forces(lines: list[Line], inputs: Inputs, modes: Modes) -> Iterator[LineStress]:
    """Split every line at its kinks and sum the forces of the assessed side's elements per part."""
    sides = read_rows_where(inputs.path("weld_elements"), "weld", [line.weld for line in lines])
    frame = read_rows_where(inputs.path("element_forces"), "element", sides["element"].unique().tolist())
    frame = frame[frame["mode"].isin(modes.mode)].sort_values("mode")
    for line in lines:
        elements = sides.loc[sides["weld"] == line.weld, "element"]
        rows = frame[frame["element"].isin(elements)]
        corners: Corners = {
            key: group[FORCE_COLUMNS].to_numpy(dtype=float) * modes.force_factor[:, None]
            for key, group in rows.groupby(["element", "node"])
        }
        for part, forces in _summed(split(line), corners):
            yield line_stress(part, forces)


def split(line: Line) -> list[Line]:
    """Cut a line at its kinks above 30 degrees; a corner node belongs to both parts."""
    n = len(line.node)
    corner = [int(i) for i in np.flatnonzero(kinks(line) > CORNER_DEG)]
    if not corner:
        return [line]
    cuts = [*corner, corner[0] + n] if line.closed else [0, *corner, n - 1]
    parts = []
    for number, (first, last) in enumerate(pairwise(cuts), start=1):
        at = np.arange(first, last + 1) % n
        parts.append(
            replace(
                line,
                part=number,
                order=line.order[at],
                node=line.node[at],
                xyz=line.xyz[at],
                thickness=line.thickness[at],
                normal=line.normal[at],
                outward=line.outward[at],
                edge_mid=line.edge_mid[at],
                closed=False,
                corner_ends=(line.closed or number > 1, line.closed or number < len(cuts) - 1),
            )
        )
    return parts


def _summed(parts: list[Line], corners: Corners) -> Iterator[tuple[Line, Floats]]:
    """Sum the element corners at the nodes of each part, those at a kink to the part that is nearest."""
    touching: dict[int, list[int]] = {}
    for element, node in corners:
        touching.setdefault(node, []).append(element)
    places: dict[int, list[tuple[int, int]]] = {}
    for p, part in enumerate(parts):
        for at, node in enumerate(part.node.tolist()):
            places.setdefault(node, []).append((p, at))
    for p, part in enumerate(parts):
        forces = []
        for at, node in enumerate(part.node.tolist()):
            share = dict.fromkeys(touching[node], 1.0)
            if len(places[node]) > 1:
                distance = {here: _crossings(_end_edge(parts, here), touching[node], corners) for here in places[node]}
                for e in share:
                    nearest = min(d[e] for d in distance.values())
                    share[e] = (distance[p, at][e] == nearest) / sum(d[e] == nearest for d in distance.values())
            forces.append(np.sum([share[e] * corners[e, node] for e in share], axis=0))
        yield part, np.array(forces)


def _end_edge(parts: list[Line], place: tuple[int, int]) -> set[int]:
    """Nodes of the edge with which a part begins or ends."""
    part, at = parts[place[0]], place[1]
    return set(part.node[edges(part)[0 if at == 0 else -1]].tolist())


def _crossings(edge: set[int], elements: list[int], corners: Corners) -> dict[int, int]:
    """Element edges to cross round a node from the element along ``edge`` to each other one."""
    nodes = {e: {n for element, n in corners if element == e} for e in elements}
    crossed = {e: 0 for e in elements if edge <= nodes[e]}
    for steps in range(1, len(elements) + 1):
        near = {e for e in elements if e not in crossed and any(len(nodes[e] & nodes[c]) > 1 for c in crossed)}
        crossed |= dict.fromkeys(near, steps)
    return {e: crossed.get(e, len(elements)) for e in elements}
