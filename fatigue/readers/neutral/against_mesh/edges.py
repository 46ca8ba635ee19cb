"""Whether consecutive nodes of weld lines are an edge of a shell, and mid-side nodes are marked as in the mesh."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.against_mesh.findings import Doubt, doubts
from fatigue.readers.neutral.against_mesh.shells import CORNERS, TouchingShells
from fatigue.weld.line import LineStack, is_closed, neighbours

Ids = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class _Sides:
    """Sides of shells by their two ends: those without a mid-side node, those with one and which, and their halves.

    Sides are numbers that ``key`` gives, ascending; ``mid`` are positions in ``node``, which is ascending.
    """

    node: Ids
    linear: Ids
    parabolic: Ids
    mid: Ids
    halves: Ids

    def key(self, a: Ids, b: Ids) -> Ids:
        """Number of each pair of nodes; -1 where a node is unknown."""
        places = []
        known = np.ones(a.size, dtype=bool)
        for ids in (a, b):
            place = np.searchsorted(self.node, ids).clip(max=self.node.size - 1)
            known &= self.node[place] == ids
            places.append(place)
        low, high = np.minimum(*places), np.maximum(*places)
        return np.where(known, low * self.node.size + high, -1)

    def has_mid(self, a: Ids, mid: Ids, b: Ids) -> NDArray[np.bool_]:
        """Whether a shell has the side from a to b with this mid-side node."""
        if not self.parabolic.size:
            return np.zeros(a.size, dtype=bool)
        key = self.key(a, b)
        place = np.searchsorted(self.parabolic, key).clip(max=self.parabolic.size - 1)
        has: NDArray[np.bool_] = (self.parabolic[place] == key) & (self.node[self.mid[place]] == mid)
        return has


def other_edges(lines: LineStack, shells: TouchingShells, file: str, elements_file: str) -> list[Doubt]:
    """Warnings of welds that mark other mid-side nodes than the shells have, leave some out, or leave the edges."""
    if not shells.element.size:
        return []
    sides = _sides(shells)
    before, after = neighbours(lines)
    here, next_ = lines.node, lines.node[after]
    key = sides.key(here, next_)
    has_next = np.ones(here.size, dtype=bool)
    has_next[lines.begin[1:] - 1] = is_closed(lines)
    linear, half = np.isin(key, sides.linear), np.isin(key, sides.halves)
    whole = np.isin(key, sides.parabolic)
    touched = np.isin(here, shells.node) & np.isin(next_, shells.node)
    marked = lines.edge_mid
    unmarked_pair = has_next & ~marked & ~marked[after]

    confirmed = marked & sides.has_mid(lines.node[before], here, next_)
    not_mid = marked & ~confirmed & (linear | linear[before])
    forgotten = unmarked_pair & half & ~linear
    is_mid = np.isin(here, shells.nodes[:, CORNERS:])
    forgotten_node = (forgotten & is_mid) | (forgotten[before] & is_mid)
    skipped = unmarked_pair & whole & ~linear & ~half
    no_edge = touched & unmarked_pair & ~linear & ~whole & ~half
    no_edge |= touched & marked & ~confirmed & ~not_mid

    def of_mark(worst: int, nodes: Ids) -> tuple[str, str]:
        what = f"edge_mid marks a mid-side node, and the shells of {elements_file} have corners there"
        return what, "Take the mark away: nodal forces of linear edges are solved as those of parabolic ones"

    def of_forgotten(worst: int, nodes: Ids) -> tuple[str, str]:
        what = f"the node is amid a side of a shell of {elements_file}, and edge_mid does not mark it"
        return what, "Mark it in edge_mid: nodal forces of parabolic edges are solved as those of linear ones"

    def of_skipped(worst: int, nodes: Ids) -> tuple[str, str]:
        at = int(np.flatnonzero(sides.parabolic == key[worst])[0])
        what = (
            f"the line leaves out node {sides.node[sides.mid[at]]}, which shells of {elements_file} have amid the side "
            f"to node {next_[worst]}"
        )
        return what, "Add the mid-side nodes with their forces, marked in edge_mid: they carry two thirds of the load"

    def of_no_edge(worst: int, nodes: Ids) -> tuple[str, str]:
        what = f"no shell of {elements_file} has a side from this node to the next of the line, {next_[worst]}"
        return what, "Check the order of the nodes, closed, and whether nodes of the line are missing"

    one = np.ones(here.size)
    return [
        *doubts(lines, not_mid, one, "mark_off_mesh", of_mark, file),
        *doubts(lines, forgotten_node, one, "mid_not_marked", of_forgotten, file),
        *doubts(lines, skipped, one, "mid_left_out", of_skipped, file),
        *doubts(lines, no_edge, one, "no_shell_edge", of_no_edge, file),
    ]


def _sides(shells: TouchingShells) -> _Sides:
    """Sides of the shells that touch weld lines."""
    corner, mid = shells.nodes[:, :CORNERS], shells.nodes[:, CORNERS:]
    last = np.roll(corner, -1, axis=1)
    triangle = corner[:, 3] == 0
    last[triangle, 2] = corner[triangle, 0]
    used = (corner != 0) & (last != 0)
    used[triangle, 3] = False
    a, m, b = corner[used], mid[used], last[used]
    node = np.unique(shells.nodes[shells.nodes != 0])
    nothing = np.zeros(0, dtype=np.int64)
    of = _Sides(node, nothing, nothing, nothing, nothing)
    with_mid = m != 0
    halves = np.concatenate([of.key(a[with_mid], m[with_mid]), of.key(m[with_mid], b[with_mid])])
    parabolic, one = np.unique(of.key(a[with_mid], b[with_mid]), return_index=True)
    return _Sides(
        node=node,
        linear=np.unique(of.key(a[~with_mid], b[~with_mid])),
        parabolic=parabolic,
        mid=np.searchsorted(node, m[with_mid])[one],
        halves=np.unique(halves),
    )
