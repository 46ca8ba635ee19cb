"""The weld lines of a case and the forces on them: nodal forces as they are, element forces summed per part."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.anew.joined import put_together, side_of, with_thickness
from fatigue.verify.recount.anew.line import CORNER_DEG, Line, RecountLineStress, edges, kinks, line_stress
from fatigue.verify.recount.inputs.case import RecountInputs, column, flags
from fatigue.verify.recount.inputs.columns import Column, about, at_stations, solid_columns
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates, forces_where
from fatigue.verify.recount.inputs.register import WeldEntry
from fatigue.verify.recount.inputs.tables import FORCE_COLUMNS, read_pieces, read_rows_where
from fatigue.verify.recount.layout import Layout

Floats = NDArray[np.float64]
Corners = dict[tuple[int, int], Floats]
"""Forces (m, 6) of each element corner, by element and node."""

_WELDS_AT_ONCE = 1000  # whose geometry is in memory


def layout(inputs: RecountInputs) -> Layout:
    """Where the points are: the keys of all stations, without the forces and without keeping the geometry."""
    welds = tuple(inputs.register.welds)
    if "nodal_forces" in inputs.case["body"]:
        return _unsplit(inputs, welds)
    weld, part, order = [], [], []
    for first in range(0, len(welds), _WELDS_AT_ONCE):
        for line in _lines(inputs, welds[first : first + _WELDS_AT_ONCE]):
            for of_part in split(line):
                weld.append(np.full(len(of_part.order), welds.index(line.weld, first), dtype=np.int32))
                part.append(np.full(len(of_part.order), of_part.part, dtype=np.int64))
                order.append(of_part.order)
    return Layout(welds, np.concatenate(weld), np.concatenate(part), np.concatenate(order))


def _unsplit(inputs: RecountInputs, welds: tuple[str, ...]) -> Layout:
    """Layout of lines whose forces are summed already; a kink is then no reason to split."""
    place = {inputs.register.welds[name].sources[0]: i for i, name in enumerate(welds)}
    welds_of, orders = [], []
    for whole in read_pieces(inputs.path("weld_nodes"), ("weld", "order")):
        rows = whole[whole["weld"].isin(place)]
        welds_of.append(rows["weld"].map(place).to_numpy(dtype=np.int32))
        orders.append(rows["order"].to_numpy(copy=True))  # the other columns need not stay for it
    weld, order = np.concatenate(welds_of), np.concatenate(orders)
    ascending = np.lexsort((order, weld))
    return Layout(welds, weld[ascending], np.ones(len(weld), dtype=np.int64), order[ascending])


def solved_lines(
    inputs: RecountInputs, coordinates: RecountCoordinates, welds: Sequence[str]
) -> list[RecountLineStress]:
    """Line parts of some welds, read and solved, in their order."""
    lines = _lines(inputs, welds)
    if "nodal_forces" in inputs.case["body"]:
        return list(_with_nodal_forces(lines, inputs, coordinates))
    return list(_with_element_forces(lines, inputs, coordinates))


def closed_welds(inputs: RecountInputs, welds: Sequence[str]) -> set[str]:
    """Which of some welds close: as the tables say, or, of several lines, as the lines meet."""
    entries = [inputs.register.welds[weld] for weld in welds]
    several = [entry.name for entry in entries if len(entry.sources) > 1]
    closed = {line.weld for line in _lines(inputs, several) if line.closed} if several else set()
    return closed | {entry.name for entry in entries if entry.closed and len(entry.sources) == 1}


def _lines(inputs: RecountInputs, welds: Sequence[str]) -> list[Line]:
    """Lines of some welds, read from their tables."""
    entries = [inputs.register.welds[weld] for weld in welds]
    sources = [source for entry in entries for source in entry.sources]
    by_weld = dict(tuple(read_rows_where(inputs.path("weld_nodes"), "weld", sources).groupby("weld")))
    lines_of_weld = [_source_lines(entry, by_weld) for entry in entries]
    return [lines[0] if len(lines) == 1 else put_together(lines)[0] for lines in lines_of_weld]


def _source_lines(entry: WeldEntry, by_weld: Mapping[str, pd.DataFrame]) -> list[Line]:
    """Lines in the tables that make a weld, under its name."""
    end_length = None if np.isnan(entry.end_length) else entry.end_length
    lines = [_line(by_weld[s], entry.name, closed=entry.closed, end_length=end_length) for s in entry.sources]
    return [with_thickness(line, entry.thickness.get(s)) for line, s in zip(lines, entry.sources, strict=True)]


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


def _with_nodal_forces(
    lines: list[Line], inputs: RecountInputs, coordinates: RecountCoordinates
) -> Iterator[RecountLineStress]:
    """Stress of lines whose forces are summed already; a kink is then no reason to split."""
    source = {line.weld: inputs.register.welds[line.weld].sources[0] for line in lines}
    solid = solid_columns(inputs, list(source.values()))
    frame = forces_where(inputs, coordinates, "nodal_forces", "weld", list(source.values()))
    by_weld = dict(tuple(frame.groupby("weld")))
    for line in lines:
        rows = by_weld[source[line.weld]].set_index(["node", "at"])
        columns = solid.get(source[line.weld])
        nodes = line.node.tolist() if columns is None else [node for station in line.node for node in columns[station]]
        wanted = pd.MultiIndex.from_product([nodes, range(len(coordinates))])
        forces = rows.loc[wanted, FORCE_COLUMNS].to_numpy(dtype=float).reshape(len(nodes), len(coordinates), 6)
        if columns is not None:
            forces = _column_sums(line, columns, dict(zip(nodes, forces, strict=True)))
        yield line_stress(line, forces * coordinates.force_factor[:, None])


def _with_element_forces(
    lines: list[Line], inputs: RecountInputs, coordinates: RecountCoordinates
) -> Iterator[RecountLineStress]:
    """Stress of the parts of every line, each with the forces of the assessed side's elements summed for it."""
    entries = {line.weld: inputs.register.welds[line.weld] for line in lines}
    sources = [source for entry in entries.values() for source in entry.sources]
    sides = read_rows_where(inputs.path("weld_elements"), "weld", sources)
    of_lines = dict(tuple(read_rows_where(inputs.path("weld_nodes"), "weld", sources).groupby("weld")))
    elements = sides["element"].unique().tolist()
    frame = forces_where(inputs, coordinates, "element_forces", "element", elements).sort_values("at")
    solid = solid_columns(inputs, sources)
    for line in lines:
        entry = entries[line.weld]
        own = [set(sides.loc[sides["weld"] == source, "element"].tolist()) for source in entry.sources]
        rows = frame[frame["element"].isin(set().union(*own))]
        columns = {at: nodes for source in entry.sources for at, nodes in solid.get(source, {}).items()}
        if len(own) > 1:
            seen = at_stations(rows, columns)
            nodes = {element: set(some) for element, some in seen.groupby("element")["node"]}
            to_join = _source_lines(entry, of_lines)
            rows = rows[rows["element"].isin(side_of(own, to_join, put_together(to_join)[1], nodes))]
        corners: Corners = {
            key: group[FORCE_COLUMNS].to_numpy(dtype=float) * coordinates.force_factor[:, None]
            for key, group in rows.groupby(["element", "node"])
        }
        for part, forces in _summed(split(line), _at_line(line, columns, corners) if columns else corners):
            yield line_stress(part, forces)


def _column_sums(line: Line, columns: Mapping[int, Column], forces: Mapping[int, Floats]) -> Floats:
    """Force and moment about mid-thickness at each station, (n, m, 6), of the forces at the nodes of its column."""
    sums = []
    for mid, station in zip(line.xyz, line.node.tolist(), strict=True):
        sums.append(sum(about(mid, at, forces[node]) for node, at in columns[station].items()))
    return np.array(sums)


def _at_line(line: Line, columns: Mapping[int, Column], corners: Corners) -> Corners:
    """Element corners with those in one column put together at its station, moments about mid-thickness."""
    place = {node: (station, at) for station, nodes in columns.items() for node, at in nodes.items()}
    mid = dict(zip(line.node.tolist(), line.xyz, strict=True))
    found: Corners = {}
    for (element, node), forces in corners.items():
        if node in place:
            station, at = place[node]
            key = (element, station)
            found[key] = found.get(key, np.zeros_like(forces)) + about(mid[station], at, forces)
        else:
            found[element, node] = forces
    return found


def split(line: Line) -> list[Line]:
    """Parts of a line between its kinks above 30 degrees; a corner node belongs to both parts."""
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
    """Each part with the element corners summed at its nodes; a corner at a kink goes to the nearest part."""
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
