"""Recognise nodal forces of parabolic elements on unmarked nodes, and of linear elements on marked mid-side nodes.

A constant line load on parabolic edges has the nodal forces l/6, 2l/3, l/6. Solved as linear edges of half the length
it comes out as 0, 2, 0, 2, ..., twice the stress; the other way round, as 2.25, 0.375, 2.25, ... Connectivity is not at
hand where forces come already summed, so the forces themselves are asked: they bring a warning when the solved line
load zigzags from node to node as the edges are marked, and does not with other marks. Where the whole line is marked
wrongly all of it zigzags; where a few nodes are, the load zigzags round them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.errors import Problem
from fatigue.weld.line import Lines, WeldLine, is_closed, neighbours
from fatigue.weld.line_geometry import step_lengths
from fatigue.weld.line_load import line_load

Floats = NDArray[np.float64]
Marks = NDArray[np.bool_]

ZIGZAG_SHARE = 0.5  # of the line load as it is marked; 0, 2, 0, 2 has sqrt(2), a smooth load next to nothing
ZIGZAG_DROP = 0.3  # of it left with other marks; white noise over six components keeps more than half
STRETCH_DROP = 0.2  # where stretches are marked one by one, which has more freedom to fit noise
OPPOSITE = 0.7  # cosine between jumps that follow each other; -1 of one pattern, about 0 of noise in many components
ROUNDS = 3  # of marking stretches anew
SHORTEST, SHORTEST_MARKED = 5, 3  # nodes: on a single edge that marks no mid-side node one zigzag proves nothing


def jumpy_lines(line: Lines, load: Floats) -> NDArray[np.intp]:
    """Positions in a stack of the lines whose load, (n, ...), zigzags, as a whole or at some of their nodes."""
    jump, square = _jumps(line, load)
    first = line.begin[:-1]
    marked = np.logical_or.reduceat(line.edge_mid, first)
    long_enough = np.diff(line.begin) >= np.where(marked, SHORTEST_MARKED, SHORTEST)
    as_a_whole = np.add.reduceat(jump, first) > ZIGZAG_SHARE**2 * np.add.reduceat(square, first)
    at_some = np.logical_or.reduceat(_zigzags(line, jump, square), first)
    return np.flatnonzero(long_enough & (as_a_whole | at_some))


def edge_type_warnings(line: WeldLine, nodal: NDArray[np.floating], where: str) -> list[Problem]:
    """Warning ``edge_type`` if nodal forces, (n, ...), fit other mid-side nodes than the line marks; else nothing."""
    load = line_load(line, nodal)
    if not jumpy_lines(line, load).size:
        return []
    zigzag = _zigzag(line, nodal)
    for marks in _other_marks(line):
        if _zigzag(replace(line, edge_mid=marks), nodal) <= ZIGZAG_DROP * zigzag:
            return [_problem(line, marks, where)]
    if not _can_be_mended(line, load):
        return []
    marks = _mended(line, nodal, load)
    if _zigzag(replace(line, edge_mid=marks), nodal) <= STRETCH_DROP * zigzag:
        return [_problem(line, marks, where)]
    return []


def _can_be_mended(line: WeldLine, load: Floats) -> bool:
    """Whether next to all jumps are in stretches that zigzag: marks change little elsewhere."""
    stretches = _stretches(line, _turning_zigzags(line, load))
    if not stretches:
        return False
    elsewhere, _ = _jumps(line, load)
    total = elsewhere.sum()
    elsewhere[np.concatenate(stretches)] = 0.0
    return bool(elsewhere.sum() <= 2 * STRETCH_DROP**2 * total)


def _other_marks(line: WeldLine) -> Iterator[Marks]:
    """Ways to mark the whole line: no mid-side node, or every other node from the second or from the first on."""
    if line.edge_mid.any():
        yield np.zeros_like(line.edge_mid)
    for odd in (1, 0):
        marks = np.arange(line.node.size) % 2 == odd
        if _pairs_up(line, odd) and not np.array_equal(marks, line.edge_mid):
            yield marks


def _mended(line: WeldLine, nodal: NDArray[np.floating], load: Floats) -> Marks:
    """Marks of a line after those stretches whose load zigzags are marked in the way that leaves the least of it.

    A stretch may reach too far at first, so what zigzags then is marked anew.
    """
    marks = line.edge_mid
    for _ in range(ROUNDS):
        before = marks
        for stretch in _stretches(line, _turning_zigzags(line, load)):
            ways = [marks, *_ways(line, marks, stretch)]
            marks = min(ways, key=lambda way: _zigzag(replace(line, edge_mid=way), nodal))
        if np.array_equal(marks, before):
            break
        load = line_load(replace(line, edge_mid=marks), nodal)
    return marks


def _stretches(line: WeldLine, zigzags: Marks) -> list[NDArray[np.int64]]:
    """Positions of the nodes of each stretch that zigzags, with a node more at both its ends."""
    n = line.node.size
    around = zigzags | np.roll(zigzags, 1) | np.roll(zigzags, -1)
    start = int(np.argmin(around)) if line.closed else 0
    at = (start + np.arange(n)) % n
    inside = np.concatenate([[False], around[at], [False]])
    first, end = np.flatnonzero(inside[1:] & ~inside[:-1]), np.flatnonzero(inside[:-1] & ~inside[1:])
    return [at[a:b] for a, b in zip(first, end, strict=True)]


def _ways(line: WeldLine, marks: Marks, stretch: NDArray[np.int64]) -> Iterator[Marks]:
    """Other ways to mark a stretch: not at all, or every other of its nodes that lie amid unmarked neighbours.

    Where a stretch reaches too far, its first or its last mark is one too many.
    """
    if marks[stretch].any():
        way = marks.copy()
        way[stretch] = False
        yield way
    for phase in (0, 1):
        added = _markable(line, marks, stretch[phase::2].tolist())
        for some in dict.fromkeys(tuple(added[a:b]) for a in (0, 1) for b in (len(added), len(added) - 1)):
            if some:
                way = marks.copy()
                way[list(some)] = True
                yield way


def _markable(line: WeldLine, marks: Marks, some: Sequence[int]) -> list[int]:
    """Those of some nodes, no two of them neighbours, that lie amid two unmarked neighbours and are not marked."""
    n, steps = line.node.size, step_lengths(replace(line, edge_mid=np.zeros_like(marks)))
    inner = [at for at in some if line.closed or 0 < at < n - 1]
    around = [(at, [at - 1, at, (at + 1) % n]) for at in inner]
    return [at for at, nodes in around if not marks[nodes].any() and _amid(steps[nodes[:2]])]


def _problem(line: WeldLine, marks: Marks, where: str) -> Problem:
    """Warning that the load would be smooth with other marks."""
    added, removed = np.flatnonzero(marks & ~line.edge_mid), np.flatnonzero(line.edge_mid & ~marks)
    jumps = "the line load jumps up and down from node to node, and would not if"
    if removed.size:
        nodes = f"node {line.node[removed[0]]}{_more(removed.size)}"
        others = f", and node {line.node[added[0]]}{_more(added.size)} were" if added.size else ""
        what = f"{jumps} {nodes} marked in edge_mid {'was' if removed.size == 1 else 'were'} no mid-side node{others}"
        remedy = "Take the marks in edge_mid away where the elements are linear: there they have no mid-side nodes"
        return Problem("edge_type", where, what, remedy)
    remedy = "Mark the mid-side nodes in edge_mid if the elements have them"
    if not line.edge_mid.any() and added.size >= (line.node.size - 1) // 2:
        what = f"{jumps} every other node were the mid-side node of a parabolic edge"
    else:
        what = f"{jumps} node {line.node[added[0]]}{_more(added.size)} were also a mid-side node of a parabolic edge"
    return Problem("edge_type", where, what, remedy)


def _more(count: int) -> str:
    return f" and {count - 1} more" if count > 1 else ""


def _pairs_up(line: WeldLine, odd: int) -> bool:
    """Whether every other node, from the second (1) or the first (0) on, lies amid its neighbours."""
    steps = step_lengths(replace(line, edge_mid=np.zeros_like(line.edge_mid)))[: line.node.size - (not line.closed)]
    if steps.size % 2 or (odd == 0 and not line.closed):
        return False
    return _amid(np.roll(steps, 1 - odd))


def _amid(steps: Floats) -> bool:
    """Whether each pair of steps is of two that are not too different to be the halves of one edge."""
    pairs = steps.reshape(-1, 2)
    return bool(np.all(pairs.max(axis=1) < 3 * pairs.min(axis=1)))


def _zigzag(line: WeldLine, nodal: NDArray[np.floating]) -> float:
    """Norm of the jumps of the line load of nodal forces."""
    jump, _ = _jumps(line, line_load(line, nodal))
    return float(np.sqrt(jump.sum()))


def _zigzags(line: Lines, jump: Floats, square: Floats) -> Marks:
    """Nodes, (n,), at which the load zigzags: there and at a neighbour it jumps by half of what it is around."""
    before, after = neighbours(line)
    is_open, ends = ~is_closed(line), np.zeros(line.node.size, dtype=bool)
    ends[line.begin[:-1][is_open]] = ends[line.begin[1:][is_open] - 1] = True
    inner = np.where(ends, 0.0, square)
    around = (square + inner[before] + inner[after]) / 3
    jumps = jump > ZIGZAG_SHARE**2 * around
    zigzags: Marks = jumps & (jumps[before] | jumps[after])
    return zigzags


def _turning_zigzags(line: WeldLine, load: Floats) -> Marks:
    """Nodes at which the load of a line zigzags and turns back: a jump and the next are nearly opposite.

    Wrong marks make one pattern of all components and modes; noise makes another of each.
    """
    before, after = neighbours(line)
    to_next = step_lengths(line)
    to_last = to_next[before]
    a = (to_next / (to_next + to_last))[:, np.newaxis]
    values = load.reshape(len(load), -1)
    jump = values - a * values[before] - (1 - a) * values[after]
    if not line.closed:
        jump[[0, -1]] = 0.0
    square = np.sum(jump**2, axis=1)
    turns = np.sum(jump * jump[after], axis=1) < -OPPOSITE * np.sqrt(square * square[after])
    zigzags: Marks = _zigzags(line, square, np.sum(values**2, axis=1)) & (turns | turns[before])
    return zigzags


def _jumps(line: Lines, load: Floats) -> tuple[Floats, Floats]:
    """Square of each node's jump and of the load there, (n,) each, summed over components and modes.

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
    return np.maximum(jump, 0), square


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
