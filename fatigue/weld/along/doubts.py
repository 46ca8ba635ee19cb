"""What is doubtful about edges along a polyline: they turn where it does not, or other nodes lie on theirs."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fatigue.weld.along.path import Along
from fatigue.weld.along.polyline import Polyline
from fatigue.weld.cuts import STRAIGHT_DEG
from fatigue.weld.detection import Topology

COINCIDENT = 1e-3  # of the mean edge: nodes as near as that are at one place


def turns(topo: Topology, line: Polyline, found: Along) -> list[tuple[int, float]]:
    """Nodes (indices) at which the edges turn by 30 degrees more than the polyline does there, and their turn [deg]."""
    xyz = topo.mesh.xyz[found.nodes]
    steps = np.diff(xyz, axis=0)
    unit = steps / np.linalg.norm(steps, axis=1)[:, None]
    turn = np.degrees(np.arccos(np.clip((unit[1:] * unit[:-1]).sum(axis=1), -1.0, 1.0)))
    sharp = np.flatnonzero(turn > STRAIGHT_DEG)
    if not sharp.size:
        return []
    _, along = line.nearest(xyz)
    own = [line.turned_deg(*sorted((float(along[k]), float(along[k + 2])))) for k in sharp]
    return [
        (found.nodes[k + 1], float(turn[k]))
        for k, given in zip(sharp, own, strict=True)
        if turn[k] > given + STRAIGHT_DEG
    ]


def coincident(topo: Topology, local: NDArray[np.float64], found: Along) -> list[tuple[int, int]]:
    """Nodes (indices) of the edges, each with another node of the mesh's shells at the same place."""
    used = np.flatnonzero(local > 0.0)
    xyz = topo.mesh.xyz
    edge = float(np.linalg.norm(np.diff(xyz[found.nodes], axis=0), axis=1).mean())
    low, high = xyz[found.nodes].min(axis=0) - edge, xyz[found.nodes].max(axis=0) + edge
    others = np.setdiff1d(used[((xyz[used] >= low) & (xyz[used] <= high)).all(axis=1)], found.nodes)
    if not others.size:
        return []
    own = np.array(list(dict.fromkeys(found.nodes)))
    away, nearest = cKDTree(xyz[others]).query(xyz[own])
    return [(int(n), int(others[k])) for n, k, d in zip(own, nearest, away, strict=True) if d < COINCIDENT * edge]
