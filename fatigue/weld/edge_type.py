"""Recognise nodal forces of parabolic elements on a line without mid-side nodes.

A constant line load on parabolic edges has the nodal forces l/6, 2l/3, l/6. Solved as linear edges of half the length
it comes out as 0, 2, 0, 2, ..., twice the stress. Connectivity is not at hand where forces come already summed, so the
forces themselves are asked: they bring a warning when the solved line load zigzags from node to node on linear edges,
and does not on parabolic ones.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.errors import Problem
from fatigue.weld.line import Lines, WeldLine, is_closed, neighbours
from fatigue.weld.line_geometry import step_lengths
from fatigue.weld.line_load import line_load

Floats = NDArray[np.float64]

ZIGZAG_SHARE = 0.5  # of the line load as linear edges; 0, 2, 0, 2 has sqrt(2), a smooth load next to nothing
ZIGZAG_DROP = 0.3  # of it left as parabolic edges; white noise over six components keeps more than half
SHORTEST = 5  # nodes: on a single parabolic edge one zigzag in three nodes proves nothing


def jumpy_lines(line: Lines, load: NDArray[np.float64]) -> NDArray[np.intp]:
    """Positions in a stack of the lines whose load, (n, ...), zigzags though they mark no mid-side nodes."""
    zigzag, norm = _norms(line, load)
    marked = np.logical_or.reduceat(line.edge_mid, line.begin[:-1])
    long_enough = np.diff(line.begin) >= SHORTEST
    return np.flatnonzero(long_enough & ~marked & (zigzag > ZIGZAG_SHARE * norm))


def edge_type_warnings(line: WeldLine, nodal: NDArray[np.floating], where: str) -> list[Problem]:
    """Warning ``edge_type`` if nodal forces, (n, ...), fit parabolic edges and the line marks none; else nothing."""
    load = line_load(line, nodal)
    if not jumpy_lines(line, load).size:
        return []
    parabolic = [replace(line, edge_mid=np.arange(line.node.size) % 2 == odd) for odd in (1, 0) if _pairs_up(line, odd)]
    zigzag, _ = _norms(line, load)
    if all(_norms(other, line_load(other, nodal))[0] > ZIGZAG_DROP * zigzag for other in parabolic):
        return []
    return [
        Problem(
            "edge_type",
            where,
            "the line load jumps up and down from node to node, and would not if every other node were the mid-side "
            "node of a parabolic edge",
            "Mark the mid-side nodes in edge_mid if the elements have them",
        )
    ]


def _pairs_up(line: WeldLine, odd: int) -> bool:
    """Whether every other node, from the second (1) or the first (0) on, lies amid its neighbours."""
    steps = step_lengths(line)[: line.node.size - (not line.closed)]
    if steps.size % 2 or (odd == 0 and not line.closed):
        return False
    pairs = np.roll(steps, 1 - odd).reshape(-1, 2)
    return bool(np.all(pairs.max(axis=1) < 3 * pairs.min(axis=1)))


def _norms(line: Lines, load: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Norms over each line, (k,), of the load's jumps and of the load, (n, ...).

    A jump is the difference between the value at a node and the one interpolated between its neighbours.
    """
    before, after = neighbours(line)
    to_next = step_lengths(line)
    to_last = to_next[before]
    a = to_next / (to_next + to_last)  # weight of the value before
    b = 1 - a
    square, with_next, across = dots = np.empty((3, len(load)))
    _dots(np.ascontiguousarray(load).reshape(len(load), -1), before, after, dots)
    jump = square + a**2 * square[before] + b**2 * square[after]
    jump -= 2 * (a * with_next[before] + b * with_next - a * b * across)
    is_open = ~is_closed(line)
    jump[line.begin[:-1][is_open]] = jump[line.begin[1:][is_open] - 1] = 0
    zigzag, norm = np.sqrt(np.add.reduceat(np.maximum([jump, square], 0), line.begin[:-1], axis=1))
    return zigzag, norm


@compiled("reassoc", "contract")  # sums in vector lanes
def _dots(load: Floats, before: NDArray[np.int64], after: NDArray[np.int64], dots: Floats) -> None:
    """Write products of each node's values, (n, c), with themselves, of them and the next, of the last and the next.

    ``dots`` is (3, n).
    """
    for i in range(len(load)):
        mine, last, following = load[i], load[before[i]], load[after[i]]
        square = with_next = across = 0.0
        for c in range(load.shape[1]):
            square += mine[c] * mine[c]
            with_next += mine[c] * following[c]
            across += last[c] * following[c]
        dots[0, i], dots[1, i], dots[2, i] = square, with_next, across
