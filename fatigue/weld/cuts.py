"""From weld edges to assessable cuts: a line of nodes, the one plate side it is seen from, and the side's elements.

A weld edge with three shells is seen from three sides. Each side is followed along the weld on its own: from an edge to
the next one as long as the plate goes on round the node between them. The elements met on the way, those touching a
node at one corner only among them, are the assessed side (a cut from the other side has other elements and other
forces; at an open end the elements ahead that lie on the same side of the line belong to it as well).
"""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.detection import Key, Topology
from fatigue.weld.line import WeldLine
from fatigue.weld.line_geometry import unit
from fatigue.weld.mesh import NONE

STRAIGHT_DEG = 30.0
"""Where weld lines cross, a line goes on straight ahead within this angle or ends."""
_AHEAD = np.cos(np.radians(60.0))


@dataclass(frozen=True, slots=True, eq=False)
class WeldCut:
    """One plate side of one weld line.

    Attributes
    ----------
    name : kind, first and last node, assessed property and a letter; the same in every run on the same mesh
    kind : "tee", "corner", "flat", "fold", "solid_toe", or what marked it
    pids : properties that meet at the weld
    pid : property of the assessed plate
    line : the weld line, its normals on the side of the attached plate if there is one
    elements : element ids of the assessed side
    columns : of solids, the node ids through the thickness beneath each node of the line, the line's own first
    """

    name: str
    kind: str
    pids: tuple[int, ...]
    pid: int
    line: WeldLine
    elements: NDArray[np.int64]
    columns: tuple[tuple[int, ...], ...] = ()


def trace(topo: Topology, keys: dict[int, Key]) -> list[WeldCut]:
    """Cuts of weld edges joined to lines, one for each plate side.

    Lines of one key are joined; they end at branches unless they go straight on, where the kind or the properties
    change, and where the plate side does not go on. Kinks stay in a line: the line is split there when it is assessed.
    """
    walker = _Walker(topo, keys)
    left = {side for edge in keys for side in topo.sides_of(edge)}
    cuts = []
    for side in sorted(left):
        if side in left:
            chain, is_closed = walker.chain(side)
            left.difference_update(s for s, _, _ in chain)
            cuts.append(_cut(walker, chain, is_closed))
    return _named(cuts)


class _Walker:
    """Goes from one side of a weld edge to the next, and round nodes from element to element."""

    def __init__(self, topo: Topology, keys: dict[int, Key]) -> None:
        self.topo, self.keys = topo, keys
        self.at_node: dict[int, list[int]] = defaultdict(list)
        for edge in keys:
            for node in topo.ends[edge]:
                self.at_node[int(node)].append(edge)

    def other_end(self, edge: int, node: int) -> int:
        a, b = self.topo.ends[edge].tolist()
        return int(b if node == a else a)

    def away(self, edge: int, node: int) -> NDArray[np.float64]:
        """Unit vector along an edge away from one of its nodes."""
        xyz = self.topo.mesh.xyz
        return unit(xyz[self.other_end(edge, node)] - xyz[node])

    def chain(self, start: int) -> tuple[list[tuple[int, int, int]], bool]:
        """Sides of one line in order, each with its first and last node, and whether the line is closed."""
        edge = int(self.topo.edge[start])
        a, b = (int(n) for n in self.topo.ends[edge])
        forward = [(start, a, b)]
        seen = {start}
        while (step := self.step(forward[-1][0], forward[-1][2])) is not None and step not in seen:
            seen.add(step)
            node = forward[-1][2]
            forward.append((step, node, self.other_end(int(self.topo.edge[step]), node)))
        if step == start and len(forward) > 2 and forward[-1][2] == a:
            return _from_lowest(forward), True
        backward: list[tuple[int, int, int]] = []
        node = a
        side = start
        while (step := self.step(side, node)) is not None and step not in seen:
            seen.add(step)
            before = self.other_end(int(self.topo.edge[step]), node)
            backward.append((step, before, node))
            side, node = step, before
        chain = backward[::-1] + forward
        ids = self.topo.mesh.node
        if ids[chain[0][1]] > ids[chain[-1][2]]:
            chain = [(side, last, first) for side, first, last in chain[::-1]]
        return chain, False

    def step(self, side: int, node: int) -> int | None:
        """Side of the next edge on the same plate, beyond ``node``; None where there is none."""
        edge = int(self.topo.edge[side])
        following = self.next_edge(edge, node)
        if following is None or self.next_edge(following, node) != edge:
            return None
        reached = self.round_node(side, node, {edge, following})
        found = [s for s in self.topo.sides_of(following) if s // 4 in reached]
        return found[0] if len(found) == 1 else None

    def next_edge(self, edge: int, node: int) -> int | None:
        """Edge of the same key that continues ``edge``: the only other one, or the one straight ahead; else None."""
        others = [e for e in self.at_node[node] if e != edge and self.keys[e] == self.keys[edge]]
        if len(others) <= 1:
            return others[0] if others else None
        back = self.away(edge, node)
        straight = min(others, key=lambda e: float(back @ self.away(e, node)))
        is_straight = back @ self.away(straight, node) < -np.cos(np.radians(STRAIGHT_DEG))
        return straight if is_straight else None

    def round_node(self, side: int, node: int, blocked: set[int]) -> set[int]:
        """Elements of one plate round a node, reached from a side's element without crossing the blocked edges."""
        topo, end = self.topo, self.topo.ends.item  # plain numbers: a lookup in a row of numpy costs ten of them
        reached = {side // 4}
        waiting = [side // 4]
        while waiting:
            element = waiting.pop()
            for at in range(4 * element, 4 * element + 4):
                edge = topo.edge.item(at)
                if edge == NONE or edge in blocked or (end(edge, 0) != node and end(edge, 1) != node):
                    continue
                for neighbour in topo.sides_of(edge):
                    if neighbour // 4 not in reached and topo.is_smooth(at, neighbour):
                        reached.add(neighbour // 4)
                        waiting.append(neighbour // 4)
        return reached

    def beyond_end(self, side: int, node: int) -> set[int]:
        """Elements at the open end of a line that lie on the assessed side of it.

        Elements ahead of the end belong to this line, unless the weld goes on there as another line, which then has
        them. An element that straddles the line's extension evenly counts on either side, which cannot be unsafe.
        """
        topo = self.topo
        edge = int(topo.edge[side])
        reached = self.round_node(side, node, {edge})
        ahead = -self.away(edge, node)
        goes_on = any(
            e != edge and ahead @ self.away(e, node) > _AHEAD and any(s // 4 in reached for s in topo.sides_of(e))
            for e in self.at_node[node]
        )
        kept = {side // 4}
        for element in reached:
            arm = topo.centroid[element] - topo.mesh.xyz[node]
            size = np.linalg.norm(arm)
            if arm @ topo.inward[side] > -1e-6 * size and not (goes_on and arm @ ahead > -1e-6 * size):
                kept.add(element)
        return kept


def plate_round(topo: Topology, cut: WeldCut, node: int, before: int, after: int) -> set[int]:
    """Elements of the plate of a cut round one of its ends, up to an edge of the weld that begins there.

    ``node`` is the end, ``before`` and ``after`` the other nodes of the last edge of the cut and of that edge; all are
    ids, as the elements returned are.
    """
    ids = topo.mesh.node
    at, first, last = np.searchsorted(ids, [node, before, after]).tolist()
    edges = [int(np.flatnonzero((topo.ends == sorted((at, other))).all(axis=1))[0]) for other in (first, last)]
    start = next(side for side in topo.sides_of(edges[0]) if topo.mesh.element[side // 4] in cut.elements)
    reached = _Walker(topo, {}).round_node(start, at, set(edges))
    return {int(topo.mesh.element[element]) for element in reached}


def _from_lowest(loop: list[tuple[int, int, int]]) -> list[tuple[int, int, int]]:
    """Loop that begins at its lowest node, so that it does not depend on where it was found."""
    at = min(range(len(loop)), key=lambda k: loop[k][1])
    return loop[at:] + loop[:at]


def _cut(walker: _Walker, chain: list[tuple[int, int, int]], is_closed: bool) -> WeldCut:
    """Weld line and assessed elements of a chain of sides."""
    topo = walker.topo
    mesh = topo.mesh
    sides = [side for side, _, _ in chain]
    elements: set[int] = {side // 4 for side in sides}
    for k, (side, first, _) in enumerate(chain):
        if k > 0 or is_closed:
            elements |= walker.round_node(side, first, {int(topo.edge[side]), int(topo.edge[sides[k - 1]])})
        else:
            elements |= walker.beyond_end(side, first)
    if not is_closed:
        elements |= walker.beyond_end(chain[-1][0], chain[-1][2])
    normal = _side_normals(topo, sides)
    nodes, node_sides, edge_mid = _line_nodes(mesh.mid.reshape(-1), chain, is_closed)
    place = {side: k for k, side in enumerate(sides)}
    kind, pids = walker.keys[int(topo.edge[sides[0]])]
    line = WeldLine(
        weld="",
        part=1,
        order=np.arange(1, len(nodes) + 1),
        node=mesh.node[nodes],
        xyz=mesh.xyz[nodes],
        thickness=np.array([mesh.thickness[[s // 4 for s in group]].mean() for group in node_sides]),
        normal=unit(np.array([normal[[place[s] for s in group]].sum(axis=0) for group in node_sides])),
        outward=unit(np.array([-topo.inward[group].sum(axis=0) for group in node_sides])),
        edge_mid=np.array(edge_mid),
        closed=is_closed,
        end_length=None,
    )
    return WeldCut("", kind, pids, int(mesh.pid[sides[0] // 4]), line, np.sort(mesh.element[sorted(elements)]))


def _line_nodes(
    mid: NDArray[np.int64], chain: list[tuple[int, int, int]], is_closed: bool
) -> tuple[list[int], list[list[int]], list[bool]]:
    """Node indices along a line, the sides that meet at each, and which are mid-side nodes."""
    nodes: list[int] = []
    node_sides: list[list[int]] = []
    is_mid: list[bool] = []
    for k, (side, first, _) in enumerate(chain):
        nodes.append(first)
        node_sides.append([chain[k - 1][0], side] if k > 0 or is_closed else [side])
        is_mid.append(False)
        if mid[side] != NONE:
            nodes.append(int(mid[side]))
            node_sides.append([side])
            is_mid.append(True)
    if not is_closed:
        nodes.append(chain[-1][2])
        node_sides.append([chain[-1][0]])
        is_mid.append(False)
    return nodes, node_sides, is_mid


def _side_normals(topo: Topology, sides: list[int]) -> NDArray[np.float64]:
    """Normals of the elements along a line, all turned the same way, towards the attached plate if there is one."""
    normal = topo.normal[[side // 4 for side in sides]].copy()
    for k in range(1, len(sides)):
        if normal[k] @ normal[k - 1] < 0:
            normal[k] *= -1
    attached = 0.0
    for side, n in zip(sides, normal, strict=True):
        others = [s for s in topo.sides_of(int(topo.edge[side])) if s != side and not topo.is_smooth(side, s)]
        attached += float(topo.inward[others].sum(axis=0) @ n) if others else 0.0
    return -normal if attached < -1e-6 * len(sides) else normal


def _named(cuts: Iterable[WeldCut]) -> list[WeldCut]:
    """Cuts with their names; the letters of cuts with equal ends follow their lowest element."""
    groups: dict[str, list[WeldCut]] = defaultdict(list)
    for cut in cuts:
        ends = f"{cut.line.node[0]}_loop" if cut.line.closed else f"{cut.line.node[0]}_{cut.line.node[-1]}"
        groups[f"{cut.kind}_{ends}_p{cut.pid}"].append(cut)
    named = []
    for stem, group in groups.items():
        for number, cut in enumerate(sorted(group, key=lambda c: tuple(c.elements.tolist()))):
            name = stem + letters(number)
            named.append(replace(cut, name=name, line=replace(cut.line, weld=name)))
    return sorted(named, key=lambda c: c.name)


def letters(number: int) -> str:
    """Letters a, b, ..., z, aa, ab, ... for the numbers 0, 1, ..."""
    text = ""
    while True:
        text = chr(ord("a") + number % 26) + text
        number = number // 26 - 1
        if number < 0:
            return text
