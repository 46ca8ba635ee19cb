"""How the plate normal turns about a weld line from node to node.

Along a curved line the normal follows the tangent: on a ring round a tube it turns by 30 degrees from facet to facet,
and nothing is wrong. So it is carried from one node to the next by the smallest rotation that takes tangent to tangent,
and what is left is a turn about the line. On flat plates, tubes, cones and spheres nothing is left; on a saddle, as of
tube on tube, the turn is smooth. A node that is turned by itself stands out against its neighbours.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line import Lines, Vectors, is_closed, line_of_node, neighbours, once
from fatigue.weld.line_geometry import tangents, unit

Floats = NDArray[np.float64]

WINDOW = 5  # nodes: one wrong normal, or two, do not move the median of so many


@once
def turns(line: Lines) -> Floats:
    """Turn of the normal about the line from each node to the next, (n,) [deg] in (-180, 180].

    The turn behind the last node of an open line is 0.
    """
    tangent = tangents(line)
    z = line.normal - np.sum(line.normal * tangent, axis=1, keepdims=True) * tangent
    after = neighbours(line)[1]
    carried = _carried(unit(z), tangent, tangent[after])
    there = unit(z)[after]
    across = np.sum(np.cross(carried, there) * tangent[after], axis=1)
    angle: Floats = np.degrees(np.arctan2(across, np.sum(carried * there, axis=1)))
    angle[line.begin[1:] - 1] *= is_closed(line)
    return angle


def turned_from_neighbours(line: Lines) -> tuple[Floats, Floats]:
    """How far the normal of each node is turned about the line against the nodes around it, (n,) and (n,) [deg].

    First against the median of the nearest ``WINDOW`` nodes, which one turned node or two do not change; then from each
    node to the next, which shows where a longer stretch is turned. Both are beyond the even turn of these nodes, the
    median of the turns between them.
    """
    turn, size, closed = turns(line), np.diff(line.begin), is_closed(line)
    owner = line_of_node(line)
    first, n, ring = line.begin[:-1][owner], size[owner], closed[owner]
    at = np.arange(line.node.size) - first
    width = np.minimum(n, WINDOW)
    low = np.where(ring, -((width - 1) // 2), np.clip(at - WINDOW // 2, 0, n - width) - at)
    high = low + width - 1
    reach = WINDOW - 1
    steps = np.arange(-reach, reach)  # the turn from the node at this distance to the next one
    inside = (steps >= low[:, np.newaxis]) & (steps < high[:, np.newaxis])
    of_step = np.where(inside, turn[first[:, np.newaxis] + (at[:, np.newaxis] + steps) % n[:, np.newaxis]], np.nan)
    even = np.where(n > 3, _median(of_step), 0.0)  # of two turns none is the rule
    beyond = np.where(inside, of_step - even[:, np.newaxis], 0.0)
    behind, ahead = beyond[:, :reach], beyond[:, reach:]
    zero = np.zeros((line.node.size, 1))
    relative = np.hstack([-np.cumsum(behind[:, ::-1], axis=1)[:, ::-1], zero, np.cumsum(ahead, axis=1)])
    nodes = np.arange(-reach, reach + 1)
    among = (nodes >= low[:, np.newaxis]) & (nodes <= high[:, np.newaxis])
    alone = np.abs(_median(np.where(among, relative, np.nan)))
    step = np.abs(turn - even)
    step[line.begin[1:] - 1] *= closed
    return alone, step


def _carried(vector: Vectors, a: Vectors, b: Vectors) -> Vectors:
    """Vectors under the smallest rotation that takes the unit vector ``a`` to ``b``, which are not opposite."""
    both = a + b
    share = np.sum(both * vector, axis=1) / np.maximum(1.0 + np.sum(a * b, axis=1), 1e-12)
    turned: Vectors = vector - share[:, np.newaxis] * both + 2.0 * np.sum(a * vector, axis=1, keepdims=True) * b
    return turned


def _median(values: Floats) -> Floats:
    """Median of each row, (n,), without its NaN; 0 of a row that has nothing else."""
    ascending = np.sort(values, axis=1)
    count = np.maximum(np.count_nonzero(np.isfinite(values), axis=1), 1)
    row = np.arange(len(values))
    median: Floats = (ascending[row, (count - 1) // 2] + ascending[row, count // 2]) / 2
    return np.nan_to_num(median)
