"""A weld line: its nodes, its edges, its local axes and its straight parts.

Every edge is treated as a parabola through three points, a linear edge being one whose middle point is the centre of
its chord: one set of formulas serves linear, parabolic and mixed lines. A body has thousands of lines of a few dozen
nodes, so whatever is computed by node or by edge takes one line or a stack of them.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import wraps
from itertools import pairwise
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

Vectors = NDArray[np.float64]

KINK_LIMIT = 30.0  # [deg] above it the traction may jump at the node, so the line is split there
KINK_TOLERANCE = 1e-6  # [deg] a regular 12-gon, whose corners turn by 30 degrees, is a smooth ring
GAUSS_POINT, GAUSS_WEIGHT = np.polynomial.legendre.leggauss(12)  # exact to round-off on arcs of 90 degrees an edge


@dataclass(frozen=True, slots=True, eq=False)
class WeldLine:
    """One weld line, or one straight part of a line split at its kinks.

    Attributes
    ----------
    weld, part : name of the weld; number of the part, from 1
    order, node : (n,) position along the weld and node id
    xyz : (n, 3) coordinates [mm]
    thickness : (n,) thickness of the assessed plate [mm]
    normal : (n, 3) normal of the assessed plate on its top side, any length
    outward : (n, 3) any vector from the assessed plate across the line
    edge_mid : (n,) mid-side node of a parabolic edge
    closed : whether the last node is joined to the first, which is not repeated
    end_length : length of the end treatment [mm]; None: the plate thickness; 0: none
    corner_start, corner_end : whether the part begins or ends at a kink of the weld instead of a weld end
    kept : what has been computed of the line, see ``once``
    """

    weld: str
    part: int
    order: NDArray[np.int64]
    node: NDArray[np.int64]
    xyz: Vectors
    thickness: NDArray[np.float64]
    normal: Vectors
    outward: Vectors
    edge_mid: NDArray[np.bool_]
    closed: bool
    end_length: float | None
    corner_start: bool = False
    corner_end: bool = False
    kept: dict[str, Any] = field(default_factory=dict, init=False, repr=False)

    @property
    def begin(self) -> NDArray[np.int64]:
        """Position of the first node, and the number of nodes."""
        return np.array([0, self.node.size])


@dataclass(frozen=True, slots=True, eq=False)
class LineStack:
    """Weld lines laid one after another, k lines with n nodes in all; single lines are cut out when asked for.

    Attributes
    ----------
    weld, part : (k,) name of the weld and number of the part
    closed, corner_start, corner_end : (k,) as in ``WeldLine``
    end_length : (k,) length of the end treatment [mm]; NaN: the plate thickness; 0: none
    begin : (k + 1,) position of each line's first node in the stack, and n
    order, node, xyz, thickness, normal, outward, edge_mid : as in ``WeldLine``, of all nodes
    kept : what has been computed of the lines, see ``once``
    """

    weld: tuple[str, ...]
    part: NDArray[np.int64]
    closed: NDArray[np.bool_]
    end_length: NDArray[np.float64]
    corner_start: NDArray[np.bool_]
    corner_end: NDArray[np.bool_]
    begin: NDArray[np.int64]
    order: NDArray[np.int64]
    node: NDArray[np.int64]
    xyz: Vectors
    thickness: NDArray[np.float64]
    normal: Vectors
    outward: Vectors
    edge_mid: NDArray[np.bool_]
    kept: dict[str, Any] = field(default_factory=dict, init=False, repr=False)

    def __len__(self) -> int:
        """Count the lines."""
        return len(self.weld)

    def __getitem__(self, number: int) -> WeldLine:
        """Cut out one line, a view of its nodes."""
        nodes = slice(int(self.begin[number]), int(self.begin[number + 1]))
        length_given = float(self.end_length[number])
        return WeldLine(
            weld=self.weld[number],
            part=int(self.part[number]),
            **{name: getattr(self, name)[nodes] for name in NODE_COLUMNS},
            closed=bool(self.closed[number]),
            end_length=None if np.isnan(length_given) else length_given,
            corner_start=bool(self.corner_start[number]),
            corner_end=bool(self.corner_end[number]),
        )

    def __iter__(self) -> Iterator[WeldLine]:
        """Cut out one line after the other."""
        return (self[number] for number in range(len(self)))

    def lines(self, some: slice) -> "LineStack":
        """Take some neighbouring lines, a view of their nodes."""
        first, end, _ = some.indices(len(self))
        nodes = slice(int(self.begin[first]), int(self.begin[end]))
        return LineStack(
            **{name: getattr(self, name)[some] for name in LINE_COLUMNS},
            begin=self.begin[first : end + 1] - self.begin[first],
            **{name: getattr(self, name)[nodes] for name in NODE_COLUMNS},
        )


Lines: TypeAlias = WeldLine | LineStack
NODE_COLUMNS = ("order", "node", "xyz", "thickness", "normal", "outward", "edge_mid")
LINE_COLUMNS = ("weld", "part", "closed", "end_length", "corner_start", "corner_end")
Computed = TypeVar("Computed")


def once(compute: Callable[[Lines], Computed]) -> Callable[[Lines], Computed]:
    """Compute something of a line or stack at the first call and keep it there: half of the rest is computed from it.

    What is returned must not be changed.
    """

    @wraps(compute)
    def kept(line: Lines) -> Computed:
        if compute.__name__ not in line.kept:
            line.kept[compute.__name__] = compute(line)
        found: Computed = line.kept[compute.__name__]
        return found

    return kept


def stacked(lines: Sequence[WeldLine]) -> LineStack:
    """Lay lines one after another."""
    return LineStack(
        weld=tuple(line.weld for line in lines),
        part=np.array([line.part for line in lines]),
        closed=np.array([line.closed for line in lines]),
        end_length=np.array([np.nan if line.end_length is None else line.end_length for line in lines]),
        corner_start=np.array([line.corner_start for line in lines]),
        corner_end=np.array([line.corner_end for line in lines]),
        begin=np.cumsum([0, *(line.node.size for line in lines)]),
        **{name: np.concatenate([getattr(line, name) for line in lines]) for name in NODE_COLUMNS},
    )


def line_of_node(line: Lines) -> NDArray[np.int64]:
    """Which line of the stack each node belongs to, (n,)."""
    return np.repeat(np.arange(line.begin.size - 1), np.diff(line.begin))


def neighbours(line: Lines) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Positions of the nodes before and after each node, (n,) each; closed and open lines wrap alike."""
    n = line.node.size
    before, after = np.arange(-1, n - 1), np.arange(1, n + 1)
    before[line.begin[:-1]], after[line.begin[1:] - 1] = line.begin[1:] - 1, line.begin[:-1]
    return before, after


def is_closed(line: Lines) -> NDArray[np.bool_]:
    """Whether each line of the stack is closed, (k,)."""
    return np.atleast_1d(line.closed)


def end_lengths(line: Lines) -> NDArray[np.float64]:
    """Length of the end treatment given for each line of the stack, (k,) [mm]; NaN: the plate thickness."""
    if isinstance(line, WeldLine):
        return np.array([np.nan if line.end_length is None else line.end_length])
    return line.end_length


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
    """Split a line at its corners into open parts; a corner node belongs to both parts that meet there.

    A closed line begins anew at its first corner; without corners the line itself is the only part.
    """
    corner = np.flatnonzero(corners(line))
    if not corner.size:
        return (line,)
    n = line.node.size
    cuts = np.append(corner, corner[0] + n) if line.closed else np.concatenate([[0], corner, [n - 1]])
    pieces = list(pairwise(cuts))
    return tuple(
        _piece(
            line,
            number,
            np.arange(begin, end + 1) % n,
            corner_start=line.closed or number > 1 or line.corner_start,
            corner_end=line.closed or number < len(pieces) or line.corner_end,
        )
        for number, (begin, end) in enumerate(pieces, start=1)
    )


def _piece(line: WeldLine, part: int, at: NDArray[np.int64], *, corner_start: bool, corner_end: bool) -> WeldLine:
    """Take the nodes ``at`` of a line as an open part."""
    return replace(
        line,
        part=part,
        order=line.order[at],
        node=line.node[at],
        xyz=line.xyz[at],
        thickness=line.thickness[at],
        normal=line.normal[at],
        outward=line.outward[at],
        edge_mid=line.edge_mid[at],
        closed=False,
        corner_start=corner_start,
        corner_end=corner_end,
    )


def unit(vectors: Vectors) -> Vectors:
    """Vectors of length 1."""
    scaled: Vectors = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return scaled


@once
def edge_tangents(line: Lines) -> tuple[Vectors, Vectors]:
    """Return the unit tangents before and after each node, (n, 3) each; zero where an open line has no edge."""
    first, mid, last = edge_nodes(line).T
    at_first, at_mid, at_last = np.moveaxis(unit(edge_derivative(edge_points(line), np.array([-1.0, 0.0, 1.0]))), 1, 0)
    before, after = np.zeros_like(line.xyz), np.zeros_like(line.xyz)
    after[first], before[last] = at_first, at_last
    parabolic = mid >= 0
    before[mid[parabolic]] = after[mid[parabolic]] = at_mid[parabolic]
    return before, after


def tangents(line: Lines) -> Vectors:
    """Return the unit tangent at each node, (n, 3): the normalised sum of those before and after it."""
    before, after = edge_tangents(line)
    return unit(before + after)
