"""Recognise nodal forces of parabolic elements on a line without mid-side nodes.

A constant line load on parabolic edges has the nodal forces l/6, 2l/3, l/6: solved as linear edges of half the length
it comes out as 0, 2, 0, 2, ..., twice the stress. Connectivity is not at hand where forces come already summed, so the
forces themselves are asked: they are doubted when the solved line load zigzags from node to node as linear edges, and
does not as parabolic ones.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.weld.line import WeldLine, step_lengths
from fatigue.weld.line_load import line_load

ZIGZAG_SHARE = 0.5  # of the line load as linear edges; 0, 2, 0, 2 has sqrt(2), a smooth load next to nothing
ZIGZAG_DROP = 0.3  # of it left as parabolic edges; white noise over six components keeps more than half
SHORTEST = 5  # nodes: on a single parabolic edge one zigzag in three nodes proves nothing


def edge_type_warnings(line: WeldLine, nodal: NDArray[np.floating], where: str) -> list[Problem]:
    """Warn, with the code ``edge_type``, if nodal forces, (n, ...), fit parabolic edges and the line marks none."""
    if line.edge_mid.any() or line.node.size < SHORTEST:
        return []
    load = line_load(line, nodal).reshape(line.node.size, -1)
    zigzag = _zigzag(line, load)
    if zigzag <= ZIGZAG_SHARE * np.linalg.norm(load):
        return []
    parabolic = [replace(line, edge_mid=np.arange(line.node.size) % 2 == odd) for odd in (1, 0) if _pairs_up(line, odd)]
    if all(_zigzag(other, line_load(other, nodal).reshape(load.shape)) > ZIGZAG_DROP * zigzag for other in parabolic):
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
    steps = step_lengths(line)
    if steps.size % 2 or (odd == 0 and not line.closed):
        return False
    pairs = np.roll(steps, 1 - odd).reshape(-1, 2)
    return bool(np.all(pairs.max(axis=1) < 3 * pairs.min(axis=1)))


def _zigzag(line: WeldLine, load: NDArray[np.float64]) -> float:
    """Norm of the differences between each inner value, (n, k), and the one interpolated between its neighbours."""
    steps = step_lengths(line)
    at = np.arange(line.node.size) if line.closed else np.arange(1, line.node.size - 1)
    before, after = steps[at - 1, np.newaxis], steps[at, np.newaxis]
    neighbours = (after * load[at - 1] + before * load[(at + 1) % line.node.size]) / (before + after)
    return float(np.linalg.norm(load[at] - neighbours))
