"""The mesh near a polyline: nodes within the tolerance of it, and the edges between them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.along.polyline import Polyline
from fatigue.weld.detection import Topology

LOCAL = 0.5  # of the local edge: the tolerance where none is given


@dataclass(frozen=True, slots=True, eq=False)
class Corridor:
    """Nodes and edges near a polyline; positions count the nodes of the corridor.

    Attributes
    ----------
    node : (m,) indices of the nodes in the mesh
    xyz : (m, 3) [mm]
    room : (m,) tolerance at each [mm]
    off, along : (m,) distance from the polyline, and length along it where that is nearest [mm]
    longest : (m,) longest edge of the corridor at each node [mm]; 0 without any
    ends : (k, 2) positions of the end nodes of the edges
    edge : (k,) these edges in the mesh
    size : (k,) their lengths [mm]
    """

    node: NDArray[np.int64]
    xyz: NDArray[np.float64]
    room: NDArray[np.float64]
    off: NDArray[np.float64]
    along: NDArray[np.float64]
    longest: NDArray[np.float64]
    ends: NDArray[np.int64]
    edge: NDArray[np.int64]
    size: NDArray[np.float64]


def local_edges(topo: Topology) -> NDArray[np.float64]:
    """Mean length of the edges at each node of a mesh, (n,) [mm]; 0 at a node without any, as mid-side nodes are."""
    ends, count = topo.ends, len(topo.mesh.xyz)
    size = np.linalg.norm(topo.mesh.xyz[ends[:, 1]] - topo.mesh.xyz[ends[:, 0]], axis=1)
    total = sum(np.bincount(ends[:, side], size, count) for side in range(2))
    number = sum(np.bincount(ends[:, side], minlength=count) for side in range(2))
    return np.divide(total, number, out=np.zeros(count), where=number > 0)


def tolerances(local: NDArray[np.float64], tolerance: float | None) -> NDArray[np.float64]:
    """Tolerance at each node [mm]: the given one, else half the local edge; -1 at a node without edges."""
    return np.where(local > 0.0, LOCAL * local if tolerance is None else tolerance, -1.0)


def corridor(topo: Topology, local: NDArray[np.float64], line: Polyline, tolerance: float | None) -> Corridor:
    """Nodes and edges of a mesh within the tolerance of a polyline."""
    xyz = topo.mesh.xyz
    room = tolerances(local, tolerance)
    near = _in_its_box(xyz, line, float(room.max(initial=0.0)))
    off, along = line.nearest(xyz[near])
    kept = off <= room[near]
    node, off, along = near[kept], off[kept], along[kept]
    position = np.full(len(xyz), -1)
    position[node] = np.arange(node.size)
    edge = np.flatnonzero((position[topo.ends] >= 0).all(axis=1))
    ends = position[topo.ends[edge]]
    size = np.linalg.norm(xyz[node[ends[:, 1]]] - xyz[node[ends[:, 0]]], axis=1)
    longest = np.zeros(node.size)
    for side in range(2):
        np.maximum.at(longest, ends[:, side], size)
    return Corridor(node, xyz[node], room[node], off, along, longest, ends, edge, size)


def _in_its_box(xyz: NDArray[np.float64], line: Polyline, room: float) -> NDArray[np.int64]:
    """Nodes in the box of the polyline, of which alone distances are computed."""
    low, high = line.points.min(axis=0) - room, line.points.max(axis=0) + room
    return np.flatnonzero(((xyz >= low) & (xyz <= high)).all(axis=1))
