"""The mesh edges along a polyline: the shortest way past a row of anchors, within a corridor round it.

Anchors are the ends of the polyline, its corners, and places a few edges apart in between. The way passes near each in
turn, so that it can neither take a short cut nor turn back; at which node is left open, so that it is not drawn to a
plate beside the line whose nodes happen to lie nearer to an anchor. In the corridor are the edges that stay within the
tolerance of the stretch between two anchors, by default half the local edge; an edge off the polyline counts as longer
than it is.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from fatigue.weld.along.corridor import Corridor, corridor, tolerances
from fatigue.weld.along.polyline import Polyline
from fatigue.weld.detection import Topology

CORNER_DEG = 20.0
EDGES_APART = 4.0  # of anchors between corners
OFF_LINE = 10.0  # by which an edge at the rim of the corridor counts longer, and a way to the end of the polyline
END_EDGES = 2.0  # by which the mesh may fall short of an end of the polyline


@dataclass(frozen=True, slots=True, eq=False)
class Gap:
    """Where no mesh edges follow a polyline.

    Attributes
    ----------
    place : (3,) on the polyline, where the edges end [mm]
    s : length along the polyline there [mm]
    length : until edges follow again, or to the end of the polyline [mm]
    distance : of the nearest node of any edge from that place [mm]
    tolerance : there [mm]
    coincident : number of other nodes at the node where the edges end
    """

    place: NDArray[np.float64]
    s: float
    length: float
    distance: float
    tolerance: float
    coincident: int


@dataclass(frozen=True, slots=True, eq=False)
class Along:
    """The edges along a polyline.

    Attributes
    ----------
    nodes : node indices in order; a closed line repeats its first at the end
    edges : edges between them
    farthest : largest distance of a node from the polyline [mm]
    before, behind : by how much the first and the last node miss the ends of the polyline [mm], along it
    """

    nodes: list[int]
    edges: list[int]
    farthest: float
    before: float
    behind: float


@dataclass(frozen=True, slots=True)
class _Anchor:
    """Length along the polyline [mm], and whether the way goes as near to it as it can: at ends and corners."""

    s: float
    fixed: bool


@dataclass(frozen=True, slots=True, eq=False)
class _Stage:
    """Ways from the nodes near one anchor to those near the next: their costs, and the node before each."""

    reach: NDArray[np.float64]
    before: NDArray[np.int64]


def edges_along(
    topo: Topology, local: NDArray[np.float64], line: Polyline, tolerance: float | None = None
) -> Along | Gap:
    """Edges of a mesh along a polyline, or the first place where there are none.

    Parameters
    ----------
    local : (n,) mean edge at each node [mm], ``local_edges`` of the mesh
    tolerance : distance from the polyline at which an edge still follows it [mm]; None: half the local edge
    """
    near = corridor(topo, local, line, tolerance)
    total = float(line.at[-1])
    if not near.edge.size:
        return _gap(topo, line, 0.0, total, local, tolerance, -1)
    anchors = _anchors(line, float(np.median(local[near.node])))
    way = _way(near, line, anchors)
    if line.closed and isinstance(way, list) and way[0] != way[-1]:
        way = _way(near, line, anchors, seam=way[-1])
    if not isinstance(way, list):
        ahead = near.along[near.along > way[1] + 1e-9]
        following = float(ahead.min()) if ahead.size else total
        last = -1 if way[0] is None else int(near.node[way[0]])
        return _gap(topo, line, way[1], following - way[1], local, tolerance, last)
    if len(way) < 2:
        return _gap(topo, line, 0.0, total, local, tolerance, -1)
    nodes = near.node[way].tolist()
    if missing := _uncovered(line, near, way):
        return _gap(topo, line, missing[0], missing[-1] - missing[0], local, tolerance, -1)
    edge_of = {(int(a), int(b)): int(k) for (a, b), k in zip(near.ends, near.edge, strict=True)}
    edges = [edge_of[min(a, b), max(a, b)] for a, b in itertools.pairwise(way)]
    before, behind = (0.0, 0.0) if line.closed else (float(near.along[way[0]]), total - float(near.along[way[-1]]))
    return Along(nodes, edges, float(near.off[way].max()), before, behind)


def _anchors(line: Polyline, local: float) -> list[_Anchor]:
    """Ends and corners of the polyline, and places in between."""
    at = line.at
    fixed = sorted({0.0, float(at[-1]), *(float(at[k]) for k in line.corners(CORNER_DEG))})
    found = [_Anchor(fixed[0], fixed=True)]
    for first, last in itertools.pairwise(fixed):
        pieces = max(1, int((last - first) / (EDGES_APART * local)))
        found += [_Anchor(float(s), fixed=False) for s in np.linspace(first, last, pieces + 1)[1:-1]]
        found.append(_Anchor(last, fixed=True))
    return found


def _way(
    near: Corridor, line: Polyline, anchors: list[_Anchor], seam: int | None = None
) -> list[int] | tuple[int | None, float]:
    """Positions of the nodes of the shortest way past all anchors; where it ends, and how far along, without any.

    ``seam`` is the node at which a closed line begins and ends.
    """
    nodes, cost = _candidates(near, line, anchors[0], seam)
    if not nodes.size:
        return None, 0.0
    stages: list[_Stage] = []
    for anchor, following in itertools.pairwise(anchors):
        is_last = following is anchors[-1]
        wanted, extra = _candidates(near, line, following, seam if is_last else None)
        slack = float(near.longest[nodes].max())
        stage = _stage(near, line.between(max(0.0, anchor.s - slack), following.s + slack), nodes, cost)
        if not np.isfinite(stage.reach[wanted]).any():
            return _reached(near, int(nodes[cost.argmin()]))
        stages.append(stage)
        there = np.isfinite(stage.reach[wanted])
        nodes, cost = wanted[there], stage.reach[wanted[there]] + extra[there]
    way = [int(nodes[cost.argmin()])]
    for stage in reversed(stages):
        while (node := int(stage.before[way[-1]])) != len(near.node):
            way.append(node)
    return way[::-1]


def _candidates(
    near: Corridor, line: Polyline, anchor: _Anchor, seam: int | None
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Nodes at which the way may pass an anchor, and what each costs."""
    if seam is not None:
        return np.array([seam]), np.zeros(1)
    away = np.linalg.norm(near.xyz - line.point(anchor.s), axis=1)
    reach = np.maximum((END_EDGES if anchor.fixed else 1.0) * near.longest, near.room)
    nodes = np.flatnonzero((near.longest > 0.0) & (away <= reach))
    return nodes, OFF_LINE * away[nodes] if anchor.fixed else np.zeros(nodes.size)


def _stage(near: Corridor, stretch: Polyline, nodes: NDArray[np.int64], cost: NDArray[np.float64]) -> _Stage:
    """Shortest ways from some nodes, each reached at a cost, by the edges that stay near a stretch of the polyline."""
    off, _ = stretch.nearest(near.xyz[near.ends].mean(axis=1))
    rim = near.room[near.ends].min(axis=1)
    fits = off <= rim
    weight = near.size[fits] * (1.0 + OFF_LINE * (off[fits] / rim[fits]) ** 2)
    count = len(near.node)  # number of one node more, from which all begin
    rows = np.concatenate([near.ends[fits, 0], np.full(nodes.size, count)])
    columns = np.concatenate([near.ends[fits, 1], nodes])
    graph = csr_array((np.concatenate([weight, cost + 1.0]), (rows, columns)), shape=(count + 1, count + 1))
    reach, before = dijkstra(graph, directed=False, indices=count, return_predecessors=True)
    return _Stage(reach[:count] - 1.0, before[:count])


def _reached(near: Corridor, begin: int) -> tuple[int, float]:
    """The node farthest along the polyline to which edges of the corridor lead, and how far that is."""
    count = len(near.node)
    graph = csr_array((np.ones(len(near.ends)), (near.ends[:, 0], near.ends[:, 1])), shape=(count, count))
    reach = np.isfinite(dijkstra(graph, directed=False, indices=begin, unweighted=True))
    nodes = np.flatnonzero(reach)
    last = int(nodes[near.along[nodes].argmax()])
    return last, float(near.along[last])


def _uncovered(line: Polyline, near: Corridor, way: list[int]) -> list[float]:
    """Lengths along the polyline, half an edge apart, from which the way stays off; the ends may stand out."""
    chain = near.xyz[way]
    step = 0.5 * float(np.median(np.linalg.norm(np.diff(chain, axis=0), axis=1)))
    at = near.along[[way[0], way[-1]]]
    first, last = (0.0, float(line.at[-1])) if line.closed else (float(at.min()), float(at.max()))
    probes = np.arange(first, last, step)
    if not probes.size:
        return []
    off, _ = Polyline(chain).nearest(line.places(probes))
    return [float(s) for s in probes[off > 2.0 * near.room[way].max()]]


def _gap(
    topo: Topology,
    line: Polyline,
    s: float,
    length: float,
    local: NDArray[np.float64],
    tolerance: float | None,
    last: int,
) -> Gap:
    xyz = topo.mesh.xyz
    place = line.point(s)
    used = np.flatnonzero(local > 0.0)
    away = np.linalg.norm(xyz[used] - place, axis=1)
    nearest = int(used[away.argmin()])
    room = float(tolerances(local, tolerance)[nearest])
    end = last if last >= 0 else nearest
    twins = int((np.linalg.norm(xyz[used] - xyz[end], axis=1) < 1e-3 * local[nearest]).sum()) - 1
    return Gap(place, s, length, float(away.min()), room, twins)
