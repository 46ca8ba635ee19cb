"""Whether a line that is given as open runs round, and whether one that is given as closed does not.

``closed`` decides about the last edge and about the treatment of weld ends. The ends of an open line that lie about one
edge apart are the mark of a ring whose ``closed = true`` was forgotten; a closing edge far longer than every other is
the mark of a line that was never closed.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line import Lines, is_closed, line_of_node
from fatigue.weld.line_geometry import edge_nodes, edge_points

Floats = NDArray[np.float64]

NEAR = 1.5  # longest of the edges at both ends and the median edge: a ring whose last edge is missing has about 1
FAR = 2.0  # longest of the other edges: a ring that lacks one node has less, one that lacks a quarter much more
ROUND = 0.5  # of the length: no closing edge is longer than that, and a line of few edges does not come back
FEWEST = 3  # edges of an open line: two that come so near to each other are a corner


def end_gaps(line: Lines) -> tuple[Floats, Floats]:
    """Distance of the ends of each line, on closed lines its last edge, (k,), and the edge it is compared with [mm].

    The edge is the longest of the first, the last and the median edge of an open line, and the longest of the other
    edges of a closed one.
    """
    chord, owner = _chords(line)
    nodes = edge_nodes(line)
    count = np.bincount(owner)
    end = np.cumsum(count)
    first = end - count
    closed = is_closed(line)
    last_node = nodes[end - 1, np.where(closed, 0, 2)]
    gap = np.linalg.norm(line.xyz[last_node] - line.xyz[nodes[first, 0]], axis=1)
    median = chord[np.lexsort((chord, owner))][first + (count - 1) // 2]
    others = chord.copy()
    others[(end - 1)[closed]] = 0.0
    of_open = np.maximum.reduce([chord[first], chord[end - 1], median])
    return gap, np.where(closed, np.maximum.reduceat(others, first), of_open)


def seems_closed(line: Lines) -> NDArray[np.bool_]:
    """Open lines whose ends lie about one edge apart, (k,)."""
    gap, edge = end_gaps(line)
    chord, owner = _chords(line)
    length, count = np.bincount(owner, chord), np.bincount(owner)
    seems: NDArray[np.bool_] = ~is_closed(line) & (count >= FEWEST) & (gap <= NEAR * edge) & (gap <= ROUND * length)
    return seems


def seems_open(line: Lines) -> NDArray[np.bool_]:
    """Closed lines whose last edge is far longer than every other, (k,)."""
    gap, edge = end_gaps(line)
    seems: NDArray[np.bool_] = is_closed(line) & (gap > FAR * edge)
    return seems


def _chords(line: Lines) -> tuple[Floats, NDArray[np.int64]]:
    """Length of the chord of each edge [mm] and its line, (e,) each."""
    points = edge_points(line)
    return np.linalg.norm(points[:, 2] - points[:, 0], axis=1), line_of_node(line)[edge_nodes(line)[:, 0]]
