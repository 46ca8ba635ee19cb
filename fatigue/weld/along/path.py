"""The mesh edges along a polyline: the shortest way from anchor to anchor within a corridor round it.

Anchors are the ends of the polyline, its corners, and places a few edges apart in between, each at the node nearest to
it; so the way can neither take a short cut nor turn back. In the corridor are the edges that stay within the tolerance
of the stretch between two anchors, by default half the local edge; an edge off the polyline counts as longer than it
is.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from fatigue.weld.along.polyline import Polyline
from fatigue.weld.detection import Topology

CORNER_DEG = 20.0
EDGES_APART = 4.0  # of anchors between corners
OFF_LINE = 10.0  # by which an edge at the rim of the corridor counts longer
LOCAL = 0.5  # of the local edge: the tolerance where none is given


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


def edges_along(topo: Topology, line: Polyline, tolerance: float | None = None) -> Along | Gap:
    """Edges of a mesh along a polyline, or the first place where there are none.

    Parameters
    ----------
    tolerance : distance from the polyline at which an edge still follows it [mm]; None: half the local edge
    """
    xyz, ends = topo.mesh.xyz, topo.ends
    size = np.linalg.norm(xyz[ends[:, 1]] - xyz[ends[:, 0]], axis=1)
    local = _local_edges(len(xyz), ends, size)
    room = np.where(local > 0.0, LOCAL * local if tolerance is None else tolerance, -1.0)
    near = _near(xyz, line, float(room.max(initial=0.0)))
    distance, along = np.full(len(xyz), np.inf), np.zeros(len(xyz))
    distance[near], along[near] = line.nearest(xyz[near])
    inside = distance <= room
    total = float(line.at[-1])
    if not inside.any():
        return _gap(topo, line, 0.0, total, room, local, -1)
    anchors = _anchors(line, float(np.median(local[inside])))
    chosen: list[int] = []
    for s in anchors:
        node = _nearest(xyz, inside, line.point(s))
        if node is not None and (not chosen or node != chosen[-1]):
            chosen.append(node)
    if line.closed and chosen[0] != chosen[-1]:
        chosen.append(chosen[0])
    nodes, at = [chosen[0]], float(along[chosen[0]])
    for begin, end in itertools.pairwise(chosen):
        way = _way(topo, line, begin, end, along, room, size, inside)
        if way is None:
            reached, last = _reached(topo, begin, inside, along)
            ahead = along[inside & (along > reached + 1e-9)]
            following = float(ahead.min()) if ahead.size else total
            return _gap(topo, line, reached, following - reached, room, local, last)
        nodes += way[1:]
        at = float(along[end])
    if len(nodes) < 2:
        return _gap(topo, line, 0.0, total, room, local, -1)
    missing = [s for s in _probes(line, nodes, xyz, local) if _uncovered(line, s, nodes, xyz, room)]
    if missing:
        return _gap(topo, line, missing[0], missing[-1] - missing[0], room, local, -1)
    edge_of = {(int(a), int(b)): k for k, (a, b) in enumerate(ends)}
    edges = [edge_of[min(a, b), max(a, b)] for a, b in itertools.pairwise(nodes)]
    before, behind = (0.0, 0.0) if line.closed else (float(along[nodes[0]]), total - at)
    return Along(nodes, edges, float(distance[nodes].max()), before, behind)


def _local_edges(count: int, ends: NDArray[np.int64], size: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean length of the edges at each node, 0 at a node without any."""
    total, number = np.zeros(count), np.zeros(count)
    for side in range(2):
        np.add.at(total, ends[:, side], size)
        np.add.at(number, ends[:, side], 1.0)
    return np.divide(total, number, out=np.zeros(count), where=number > 0)


def _near(xyz: NDArray[np.float64], line: Polyline, room: float) -> NDArray[np.int64]:
    """Nodes in the box of the polyline, of which alone distances are computed."""
    low, high = line.points.min(axis=0) - room, line.points.max(axis=0) + room
    return np.flatnonzero(((xyz >= low) & (xyz <= high)).all(axis=1))


def _anchors(line: Polyline, local: float) -> list[float]:
    """Lengths along the polyline of its ends, its corners, and places in between."""
    at = line.at
    fixed = sorted({0.0, float(at[-1]), *(float(at[k]) for k in line.corners(CORNER_DEG))})
    found = [fixed[0]]
    for first, last in itertools.pairwise(fixed):
        pieces = max(1, int((last - first) / (EDGES_APART * local)))
        found += np.linspace(first, last, pieces + 1)[1:].tolist()
    return found


def _nearest(xyz: NDArray[np.float64], inside: NDArray[np.bool_], place: NDArray[np.float64]) -> int | None:
    """Node of the corridor that is nearest to a place."""
    nodes = np.flatnonzero(inside)
    return int(nodes[np.linalg.norm(xyz[nodes] - place, axis=1).argmin()]) if nodes.size else None


def _way(
    topo: Topology,
    line: Polyline,
    begin: int,
    end: int,
    along: NDArray[np.float64],
    room: NDArray[np.float64],
    size: NDArray[np.float64],
    inside: NDArray[np.bool_],
) -> list[int] | None:
    """Nodes of the shortest way between two nodes in the corridor round the stretch between them; None without any."""
    xyz, ends = topo.mesh.xyz, topo.ends
    total = float(line.at[-1])
    first, last = float(along[begin]), float(along[end])
    if line.closed and last <= first:
        last = total
    slack = float(room[[begin, end]].max())
    stretch = line.between(max(0.0, first - slack), min(total, last + slack))
    usable = np.flatnonzero(inside[ends].all(axis=1))
    middle = xyz[ends[usable]].mean(axis=1)
    off, _ = stretch.nearest(middle)
    rim = room[ends[usable]].min(axis=1)
    fits = off <= rim
    usable, off, rim = usable[fits], off[fits], rim[fits]
    cost = size[usable] * (1.0 + OFF_LINE * (off / rim) ** 2)
    graph = csr_array((cost, (ends[usable, 0], ends[usable, 1])), shape=(len(xyz), len(xyz)))
    reach, before = dijkstra(graph, directed=False, indices=begin, return_predecessors=True)
    if not np.isfinite(reach[end]):
        return None
    way = [end]
    while way[-1] != begin:
        way.append(int(before[way[-1]]))
    return way[::-1]


def _reached(topo: Topology, begin: int, inside: NDArray[np.bool_], along: NDArray[np.float64]) -> tuple[float, int]:
    """How far along the polyline edges of the corridor lead from a node, and the node there."""
    ends = topo.ends[inside[topo.ends].all(axis=1)]
    count = len(inside)
    graph = csr_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count))
    reach = np.isfinite(dijkstra(graph, directed=False, indices=begin, unweighted=True))
    nodes = np.flatnonzero(reach)
    last = int(nodes[along[nodes].argmax()])
    return float(along[last]), last


def _probes(
    line: Polyline, nodes: list[int], xyz: NDArray[np.float64], local: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Lengths along the polyline, half an edge apart, at which an edge has to be near; the ends may stand out."""
    step = 0.5 * float(np.median(local[nodes]))
    _, along = line.nearest(xyz[[nodes[0], nodes[-1]]])
    first, last = (0.0, float(line.at[-1])) if line.closed else (float(along.min()), float(along.max()))
    return np.arange(first, last, step)


def _uncovered(line: Polyline, s: float, nodes: list[int], xyz: NDArray[np.float64], room: NDArray[np.float64]) -> bool:
    """Whether the edges found stay away from a place of the polyline."""
    off, _ = Polyline(xyz[nodes]).nearest(line.point(s)[None])
    return bool(off[0] > 2.0 * room[nodes].max())


def _gap(
    topo: Topology,
    line: Polyline,
    s: float,
    length: float,
    room: NDArray[np.float64],
    local: NDArray[np.float64],
    last: int,
) -> Gap:
    xyz = topo.mesh.xyz
    place = line.point(s)
    used = np.flatnonzero(local > 0.0)
    away = np.linalg.norm(xyz[used] - place, axis=1)
    nearest = int(used[away.argmin()])
    twins = (
        int((np.linalg.norm(xyz[used] - xyz[last if last >= 0 else nearest], axis=1) < 1e-3 * local[nearest]).sum()) - 1
    )
    return Gap(place, s, length, float(away.min()), float(room[nearest]), twins)
