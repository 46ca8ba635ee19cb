"""The geometry of a weld line: its edges, their length, its local axes and its straight parts.

Every edge is treated as a parabola through three points, a linear edge being one whose middle point is the centre of
its chord: one set of formulas serves linear, parabolic and mixed lines, one at a time or in a stack.
"""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line import NODE_COLUMNS, Lines, Vectors, WeldLine, is_closed, line_of_node, neighbours, once

KINK_LIMIT = 30.0  # [deg] above it the traction may jump at the node, so the line is split there
KINK_TOLERANCE = 1e-6  # [deg] a regular 12-gon, whose corners turn by 30 degrees, is a smooth ring
LONGEST = 1e150  # of a vector whose length is computed as it is: its square is far from the largest double
GAUSS_POINT, GAUSS_WEIGHT = np.polynomial.legendre.leggauss(12)  # exact to round-off on arcs of 90 degrees an edge


@once
def edge_nodes(line: Lines) -> NDArray[np.int64]:
    """Positions of each edge's first, mid and last node, (e, 3); mid is -1 on a linear edge."""
    vertex = np.flatnonzero(~line.edge_mid)
    owner = line_of_node(line)[vertex]
    begins = np.flatnonzero(np.diff(owner, prepend=-1))
    last = np.roll(vertex, -1)
    ends = np.flatnonzero(np.diff(owner, append=-1))
    last[ends] = vertex[begins]
    is_edge = np.ones(vertex.size, dtype=bool)
    is_edge[ends] = is_closed(line)[owner[ends]]
    first, last = vertex[is_edge], last[is_edge]
    after = neighbours(line)[1][first]
    return np.column_stack([first, np.where(line.edge_mid[after], after, -1), last])


def edges(line: WeldLine) -> list[tuple[int, ...]]:
    """Positions on the line of the nodes of each edge: (end, end) or (end, mid, end); closed lines wrap."""
    return [(first, last) if mid < 0 else (first, mid, last) for first, mid, last in edge_nodes(line).tolist()]


@once
def edge_points(line: Lines) -> Vectors:
    """First, middle and last point of each edge, (e, 3, 3) [mm]; the middle of a linear edge is its centre."""
    nodes = edge_nodes(line)
    points: Vectors = line.xyz[nodes]
    linear = nodes[:, 1] < 0
    points[linear, 1] = (points[linear, 0] + points[linear, 2]) / 2
    return points


def edge_derivative(points: Vectors, xi: NDArray[np.float64]) -> Vectors:
    """dx/dxi of each edge at the local coordinates ``xi``, (g,) or (..., e, g), in [-1, 1]: (..., e, g, 3) [mm]."""
    half_chord = (points[:, 2] - points[:, 0]) / 2
    bend = points[:, 0] - 2 * points[:, 1] + points[:, 2]
    return half_chord[:, np.newaxis] + xi[..., np.newaxis] * bend[:, np.newaxis]


@once
def step_lengths(line: Lines) -> NDArray[np.float64]:
    """Arc length from each node to the next, (n,) [mm]; from the last of a ring to the first, of an open line 0."""
    nodes, points = edge_nodes(line), edge_points(line)
    steps = np.zeros(line.node.size)
    steps[nodes[:, 0]] = np.linalg.norm(points[:, 2] - points[:, 0], axis=1)
    parabolic = nodes[:, 1] >= 0
    for side, at in ((-1, 0), (1, 1)):
        speed = np.linalg.norm(edge_derivative(points[parabolic], (GAUSS_POINT + side) / 2), axis=-1)
        steps[nodes[parabolic, at]] = speed @ GAUSS_WEIGHT / 2
    return steps


@once
def arc_length(line: Lines) -> NDArray[np.float64]:
    """Arc length of each node from the first of its line, (n,) [mm]."""
    steps = step_lengths(line)
    return np.concatenate([np.cumsum(np.append(0.0, steps[a : b - 1])) for a, b in pairwise(line.begin)])


def length(line: WeldLine) -> float:
    """Length of the line [mm], on closed lines the whole way round."""
    return float(step_lengths(line).sum())


def lengths(line: Lines) -> NDArray[np.float64]:
    """Length of each line of the stack, (k,) [mm], on closed lines the whole way round."""
    steps = step_lengths(line)
    return np.array([steps[a:b].sum() for a, b in pairwise(line.begin)])


def local_axes(line: Lines) -> Vectors:
    """Local axes of each node, (n, 3, 3) with the rows x' along the line, y' out of the assessed plate, z' its normal.

    The tangent at a node is the normalised sum of the unit tangents of its two edges; z' is kept, y' is the in-plane
    normal to the line on the side of ``outward``, x' = y' x z'. One side holds for the whole line, so that an outward
    vector along one leg of a kink does no harm.
    """
    tangent = tangents(line)
    z = unit(line.normal)
    across = unit(np.cross(z, tangent))
    reach = np.add.reduceat(np.sum(unit(line.outward) * across, axis=1), line.begin[:-1])
    y = np.sign(reach)[line_of_node(line), np.newaxis] * across
    return np.stack([np.cross(y, z), y, z], axis=1)


def kink_angles(line: Lines) -> NDArray[np.float64]:
    """Angle by which the line turns at each node, (n,) [deg]; 0 at open ends and at mid-side nodes."""
    before, after = edge_tangents(line)
    turn = np.linalg.norm(np.cross(before, after), axis=1)
    angle: NDArray[np.float64] = np.degrees(np.arctan2(turn, np.sum(before * after, axis=1)))
    return angle


def corners(line: Lines) -> NDArray[np.bool_]:
    """Nodes where the line turns by more than 30 degrees, (n,)."""
    return kink_angles(line) > KINK_LIMIT + KINK_TOLERANCE


def split_at_kinks(line: WeldLine) -> tuple[WeldLine, ...]:
    """Open parts of a line split at its corners; a corner node belongs to both parts that meet there.

    A closed line begins anew at its first corner; without corners the line itself is the only part.
    """
    corner = np.flatnonzero(corners(line))
    if not corner.size:
        return (line,)
    n = line.node.size
    bounds = np.append(corner, corner[0] + n) if line.closed else np.concatenate([[0], corner, [n - 1]])
    parts = list(pairwise(bounds))
    return tuple(
        _part(
            line,
            number,
            np.arange(begin, end + 1) % n,
            corner_start=line.closed or number > 1 or line.corner_start,
            corner_end=line.closed or number < len(parts) or line.corner_end,
        )
        for number, (begin, end) in enumerate(parts, start=1)
    )


def _part(line: WeldLine, part: int, at: NDArray[np.int64], *, corner_start: bool, corner_end: bool) -> WeldLine:
    """Open part of a line with the nodes ``at``."""
    columns: dict[str, Any] = {name: getattr(line, name)[at] for name in NODE_COLUMNS}
    return replace(line, part=part, **columns, closed=False, corner_start=corner_start, corner_end=corner_end)


def unit(vectors: Vectors) -> Vectors:
    """Vectors of length 1 along the last axis; a zero vector stays zero."""
    with np.errstate(over="ignore"):
        length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    if np.any((length > LONGEST) | (length < 1.0 / LONGEST)):  # squares that overflow or vanish, or a zero vector
        _, exponent = np.frexp(np.abs(vectors).max(axis=-1, keepdims=True, initial=0.0))
        vectors = np.ldexp(vectors, -exponent)  # exact
        length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    units: Vectors = np.divide(vectors, length, out=np.zeros(vectors.shape), where=length > 0)
    return units


@once
def edge_tangents(line: Lines) -> tuple[Vectors, Vectors]:
    """Unit tangents before and after each node, (n, 3) each; zero where an open line has no edge."""
    first, mid, last = edge_nodes(line).T
    at_first, at_mid, at_last = np.moveaxis(unit(edge_derivative(edge_points(line), np.array([-1.0, 0.0, 1.0]))), 1, 0)
    before, after = np.zeros_like(line.xyz), np.zeros_like(line.xyz)
    after[first], before[last] = at_first, at_last
    parabolic = mid >= 0
    before[mid[parabolic]] = after[mid[parabolic]] = at_mid[parabolic]
    return before, after


def tangents(line: Lines) -> Vectors:
    """Unit tangent at each node, (n, 3): the normalised sum of the unit tangents before and after it."""
    before, after = edge_tangents(line)
    return unit(before + after)
