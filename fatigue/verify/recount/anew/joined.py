"""Lines of one name put end to end once more, by walking from node to node; and the elements on their side."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.line import Line

COLUMNS = ("order", "node", "xyz", "thickness", "normal", "outward", "edge_mid")


@dataclass(frozen=True, slots=True)
class Meeting:
    """A node at which two lines meet: the edges of both that end there, as pairs of corner nodes."""

    node: int
    edges: tuple[frozenset[int], frozenset[int]]


def put_together(lines: Sequence[Line]) -> tuple[Line, list[Meeting]]:
    """One line of lines put end to end, and the nodes at which they meet.

    An open one begins at its lower end, a ring at its lowest corner and runs on to the lower of its two neighbours.
    """
    table = {name: np.concatenate([getattr(line, name) for line in lines]) for name in COLUMNS}
    rows: dict[int, list[int]] = {}
    for row, node in enumerate(table["node"].tolist()):
        rows.setdefault(node, []).append(row)
    next_to: dict[int, set[int]] = {node: set() for node in rows}
    for line in lines:
        for a, b in zip(line.node[:-1].tolist(), line.node[1:].tolist(), strict=True):
            next_to[a].add(b)
            next_to[b].add(a)
    corners = {node for node, at in rows.items() if not table["edge_mid"][at[0]]}
    ends = [node for node, others in next_to.items() if len(others) == 1]
    walk = [min(ends) if ends else min(corners)]
    while True:
        onward = sorted(next_to[walk[-1]] - set(walk), key=lambda n: _corner_beyond(walk[-1], n, next_to, corners))
        if not onward:
            break
        walk.append(onward[0])
    first = [rows[node][0] for node in walk]
    columns: dict[str, Any] = {name: table[name][first] for name in COLUMNS}
    columns["order"] = np.arange(1, len(walk) + 1)
    meetings = []
    for at, node in enumerate(walk):
        if len(rows[node]) > 1:
            columns["thickness"][at] = table["thickness"][rows[node]].mean()
            for name in ("normal", "outward"):
                columns[name][at] = sum(v / np.linalg.norm(v) for v in table[name][rows[node]])
            edges = [frozenset((node, _corner_beyond(node, n, next_to, corners))) for n in sorted(next_to[node])]
            meetings.append(Meeting(node, (edges[0], edges[1])))
    return replace(lines[0], **columns, closed=not ends), meetings


def side_of(
    elements: Sequence[set[int]], lines: Sequence[Line], meetings: Sequence[Meeting], nodes: dict[int, set[int]]
) -> set[int]:
    """Elements of both sides, without those that touch a meeting from behind the edges of the weld there.

    ``nodes`` gives the nodes of each element. Round a meeting, elements are coloured from the two along the edges of
    the weld on the assessed side; colour spreads over every edge that is no edge of the weld.
    """
    together: set[int] = set().union(*elements)
    kept = set(together)
    for meeting in meetings:
        around = {e for e in together if meeting.node in nodes[e]}
        coloured = {
            e
            for own, line in zip(elements, lines, strict=True)
            for edge in meeting.edges
            for e in own & around
            if edge <= nodes[e] and edge <= set(line.node.tolist())
        }
        spreads = True
        while spreads:
            spreads = False
            for e in around - coloured:
                for c in tuple(coloured):
                    shared = nodes[e] & nodes[c]
                    if len(shared) > 1 and not any(edge <= shared for edge in meeting.edges):
                        coloured.add(e)
                        spreads = True
                        break
        kept -= around - coloured
    return kept


def _corner_beyond(node: int, other: int, next_to: dict[int, set[int]], corners: set[int]) -> int:
    """Next element corner from a node towards a neighbour on the line."""
    while other not in corners:
        node, other = other, next(n for n in next_to[other] if n != node)
    return other


def with_thickness(line: Line, thickness: float | None) -> Line:
    """Line with the thickness that the user has confirmed [mm], or as it is."""
    values: NDArray[np.float64] = line.thickness if thickness is None else np.full(len(line.node), thickness)
    return replace(line, thickness=values)
