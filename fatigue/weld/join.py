"""Weld lines of one plate side that join end to end, made one line: its nodes, and the elements it is seen from.

The line is what it would be had it never been cut: where two lines meet, thickness, normal and outward vector are the
means of both. The joined line has the elements of both lines, except round the node where they meet. There each line by
itself ends openly and takes the elements beyond its end, some of them behind the other line; the joined line has the
fan of the plate between its two edges and nothing else.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.weld.detection import SMOOTH_DEG
from fatigue.weld.line import NODE_COLUMNS, Vectors, WeldLine
from fatigue.weld.line_geometry import tangents, unit

SMOOTH = np.cos(np.radians(SMOOTH_DEG))


@dataclass(frozen=True, slots=True)
class Joint:
    """Where two lines meet: the node, the next element corner before and after it, and the two lines by position."""

    node: int
    before: int
    after: int
    lines: tuple[int, int]


def joined(lines: Sequence[WeldLine], names: Sequence[str], where: str) -> tuple[WeldLine, tuple[Joint, ...]]:
    """One open or closed line of lines joined end to end, turned where necessary, from its lower end on; its joints.

    Parameters
    ----------
    lines : two or more of one plate side, in any order
    names : what each is called in messages
    where : begins the place of a message

    Raises
    ------
    DataError : they do not join, more than two meet, they touch elsewhere, or are seen from different plate sides
    """
    for line, name in zip(lines, names, strict=True):
        if line.closed:
            raise _refusal(where, f"line {name} is closed and joins no other line")
    chain, is_closed = _chain(lines, names, where)
    turned = [_reversed(lines[at]) if is_turned else lines[at] for at, is_turned in chain]
    pairs = [*zip(range(len(chain)), range(1, len(chain)), strict=False)] + [(len(chain) - 1, 0)] * is_closed
    _check_nodes(lines, names, {int(turned[a].node[-1]) for a, _ in pairs}, where)
    for a, b in pairs:
        _check_side(turned[a], turned[b], names[chain[a][0]], names[chain[b][0]], where)
    line = _concatenated(turned, is_closed)
    if is_closed:
        line = _from_lowest(line)
    corner = line.node[~line.edge_mid].tolist()
    place = {node: k for k, node in enumerate(corner)}
    joints = []
    for a, b in pairs:
        node = int(turned[a].node[-1])
        k = place[node]
        before, after = corner[k - 1], corner[(k + 1) % len(corner)]
        runs_on = before == turned[a].node[~turned[a].edge_mid][-2]  # a ring that was turned as a whole runs back
        first, second = (a, b) if runs_on else (b, a)
        joints.append(Joint(node, before, after, (chain[first][0], chain[second][0])))
    return line, tuple(joints)


def joined_elements(
    sides: Sequence[NDArray[np.int64]], touching: Sequence[Collection[int]], fans: Sequence[set[int]]
) -> NDArray[np.int64]:
    """Elements of a joined line, ascending.

    Parameters
    ----------
    sides : elements of each line
    touching : for each joint, the elements of the lines that touch it
    fans : for each joint, the elements of the plate round it
    """
    elements: set[int] = set().union(*(side.tolist() for side in sides))
    for around, of_plate in zip(touching, fans, strict=True):
        elements -= set(around) - of_plate
    return np.array(sorted(elements.union(*fans)), dtype=np.int64)


def fan(around: Mapping[int, set[int]], joint: Joint, first: set[int], last: set[int]) -> set[int] | None:
    """Elements of the plate round a joint from the edge before it to the edge behind it; None where there is a gap.

    Parameters
    ----------
    around : nodes of each element of the joined sides that touches the joint
    first, last : elements of the side of the line before and behind the joint
    """
    reached = {e for e, nodes in around.items() if e in first and joint.before in nodes}
    goal = {e for e, nodes in around.items() if e in last and joint.after in nodes}
    waiting = list(reached)
    while waiting:
        here = around[waiting.pop()]
        for element, nodes in around.items():
            shared = (nodes & here) - {joint.node}
            if element not in reached and shared and joint.before not in shared and joint.after not in shared:
                reached.add(element)
                waiting.append(element)
    return reached if goal and goal <= reached else None


def _refusal(where: str, what: str) -> DataError:
    remedy = "Give the line another name, or put right what differs"
    return DataError(Problem("not_joined", where, what, remedy))


def _chain(lines: Sequence[WeldLine], names: Sequence[str], where: str) -> tuple[list[tuple[int, bool]], bool]:
    """Lines in order, each with whether it runs backwards, and whether they close."""
    ends: dict[int, list[int]] = {}
    for at, line in enumerate(lines):
        for node in (int(line.node[0]), int(line.node[-1])):
            ends.setdefault(node, []).append(at)
    for node, meeting in ends.items():
        if len(meeting) > 2:
            several = ", ".join(names[at] for at in meeting)
            raise _refusal(where, f"more than two lines end at node {node}: {several}")
    free = sorted(node for node, meeting in ends.items() if len(meeting) == 1)
    node = free[0] if free else min(ends)
    chain: list[tuple[int, bool]] = []
    left = set(range(len(lines)))
    while following := sorted(at for at in ends[node] if at in left):
        at = following[0]
        is_turned = int(lines[at].node[0]) != node
        chain.append((at, is_turned))
        left.remove(at)
        node = int(lines[at].node[0 if is_turned else -1])
    if left:
        apart = min(left)
        others = ", ".join(names[at] for at, _ in chain)
        first, last = lines[apart].node[0], lines[apart].node[-1]
        raise _refusal(where, f"line {names[apart]}, from node {first} to {last}, does not join {others}")
    return chain, not free


def _reversed(line: WeldLine) -> WeldLine:
    return replace(line, **{name: getattr(line, name)[::-1] for name in NODE_COLUMNS})


def _check_nodes(lines: Sequence[WeldLine], names: Sequence[str], meeting: set[int], where: str) -> None:
    """Refuse lines that touch elsewhere than where their ends meet."""
    owner: dict[int, int] = {}
    for at, line in enumerate(lines):
        for node in line.node.tolist():
            other = owner.setdefault(node, at)
            if other != at and node not in meeting:
                both = f"lines {names[other]} and {names[at]}"
                if set(line.node.tolist()) == set(lines[other].node.tolist()):
                    raise _refusal(where, f"{both} have the same nodes: they are two plate sides of one weld")
                raise _refusal(where, f"{both} touch at node {node}, not only end to end")


def _check_side(a: WeldLine, b: WeldLine, name_a: str, name_b: str, where: str) -> None:
    """Refuse lines that are not seen from one plate side at the node where the first ends and the second begins."""
    z_a, z_b = unit(a.normal[-1]), unit(b.normal[0])
    both, node = f"lines {name_a} and {name_b} at node {a.node[-1]}", a.node[-1]
    if z_a @ z_b <= -SMOOTH:
        raise _refusal(where, f"the top normal turns to the other face between {both}")
    if z_a @ z_b < SMOOTH:
        angle = np.degrees(np.arccos(np.clip(z_a @ z_b, -1.0, 1.0)))
        raise _refusal(where, f"the assessed plate turns by {angle:.0f} degrees between {both}: they are two plates")
    if _hand(a, -1) != _hand(b, 0):
        raise _refusal(where, f"lines {name_a} and {name_b} are seen from different sides of the weld at node {node}")


def _hand(line: WeldLine, at: int) -> bool:
    """Whether the assessed plate lies to the right of the line, seen from the top, at one of its ends."""
    across = np.cross(line.normal[at], tangents(line)[at])
    return bool(line.outward[at] @ across > 0)


def _concatenated(lines: Sequence[WeldLine], is_closed: bool) -> WeldLine:
    """Lay lines in order one behind the other, the node where two meet once."""
    columns: dict[str, Any] = {name: np.concatenate([getattr(line, name) for line in lines]) for name in NODE_COLUMNS}
    size = np.array([line.node.size for line in lines])
    end = np.cumsum(size)
    meeting = [(e - 1, e % end[-1]) for e in (end if is_closed else end[:-1]).tolist()]
    for last, first in meeting:
        columns["thickness"][first] = (columns["thickness"][last] + columns["thickness"][first]) / 2
        for name in ("normal", "outward"):
            columns[name][first] = _mean(columns[name][last], columns[name][first])
    kept = np.ones(end[-1], dtype=bool)
    kept[[last for last, _ in meeting]] = False
    columns = {name: column[kept] for name, column in columns.items()}
    columns["order"] = np.arange(1, columns["node"].size + 1)
    return replace(lines[0], **columns, closed=is_closed)


def _mean(a: Vectors, b: Vectors) -> Vectors:
    return np.asarray(unit(unit(a) + unit(b)))


def _from_lowest(ring: WeldLine) -> WeldLine:
    """Begin a ring at its lowest corner and run on to the lower of the two corners beside it."""
    corner = np.flatnonzero(~ring.edge_mid)
    lowest = int(np.argmin(ring.node[corner]))
    after, before = corner[(lowest + 1) % corner.size], corner[lowest - 1]
    at = np.roll(np.arange(ring.node.size), -corner[lowest])
    if ring.node[before] < ring.node[after]:
        at = np.append(at[0], at[:0:-1])
    columns: dict[str, Any] = {name: getattr(ring, name)[at] for name in NODE_COLUMNS if name != "order"}
    return replace(ring, **columns)
