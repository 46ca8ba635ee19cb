"""Whether consecutive nodes of weld lines are an edge of a shell, and mid-side nodes are marked as in the mesh."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.against_mesh.findings import Finding, warnings_of
from fatigue.readers.neutral.against_mesh.shells import CORNERS, TouchingShells
from fatigue.weld.line import LineStack, is_closed, neighbours

Ids = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Sides:
    """Sides of shells between nodes of weld lines: those without a mid-side node, those with one, and their halves.

    Sides are numbers that ``key`` gives, ascending; ``node`` are the nodes of weld lines, ascending, ``mid`` the ids of
    the mid-side nodes.
    """

    node: Ids
    linear: Ids
    parabolic: Ids
    mid: Ids
    halves: Ids
    mids: Ids

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
        has: NDArray[np.bool_] = (key >= 0) & (self.parabolic[place] == key) & (self.mid[place] == mid)
        return has


def other_edges(lines: LineStack, shells: TouchingShells, sides: Sides, file: str, elements_file: str) -> list[Finding]:
    """Warnings of welds that mark other mid-side nodes than the shells have, leave some out, or leave the edges."""
    if not shells.element.size:
        return []
    before, after = neighbours(lines)
    here, next_ = lines.node, lines.node[after]
    key = sides.key(here, next_)
    has_next = np.ones(here.size, dtype=bool)
    has_next[lines.begin[1:] - 1] = is_closed(lines)
    linear, whole, half = (_among(key, some) for some in (sides.linear, sides.parabolic, sides.halves))
    touched = _among(here, shells.node) & _among(next_, shells.node)
    marked = lines.edge_mid
    unmarked_pair = has_next & ~marked & ~marked[after]

    confirmed = marked & sides.has_mid(lines.node[before], here, next_)
    not_mid = marked & ~confirmed & (linear | linear[before])
    forgotten = unmarked_pair & half & ~linear
    is_mid = _among(here, sides.mids)
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
            f"the line leaves out node {sides.mid[at]}, which shells of {elements_file} have amid the side "
            f"to node {next_[worst]}"
        )
        return what, "Add the mid-side nodes with their forces, marked in edge_mid: they carry two thirds of the load"

    def of_no_edge(worst: int, nodes: Ids) -> tuple[str, str]:
        what = f"no shell of {elements_file} has a side from this node to the next of the line, {next_[worst]}"
        return what, "Check the order of the nodes, closed, and whether nodes of the line are missing"

    one = np.ones(here.size)
    return [
        *warnings_of(lines, not_mid, one, "mark_off_mesh", of_mark, file),
        *warnings_of(lines, forgotten_node, one, "mid_not_marked", of_forgotten, file),
        *warnings_of(lines, skipped, one, "mid_left_out", of_skipped, file),
        *warnings_of(lines, no_edge, one, "no_shell_edge", of_no_edge, file),
    ]


def sides_of(shells: TouchingShells) -> Sides:
    """Sides of the shells that touch weld lines, as far as their ends are nodes of the lines."""
    corner, mid = shells.nodes[:, :CORNERS], shells.nodes[:, CORNERS:]
    last = np.roll(corner, -1, axis=1)
    triangle = corner[:, 3] == 0
    last[triangle, 2] = corner[triangle, 0]
    last[triangle, 3] = 0
    on_line = np.stack([_among(nodes, shells.node) for nodes in (corner, mid, last)])
    nothing = np.zeros(0, dtype=np.int64)
    keys = Sides(shells.node, nothing, nothing, nothing, nothing, nothing)

    def of(a: Ids, b: Ids, wanted: NDArray[np.bool_]) -> Ids:
        return keys.key(a[wanted], b[wanted])

    whole = on_line[0] & on_line[2]
    parabolic, mids = of(corner, last, whole & (mid != 0)), mid[whole & (mid != 0)]
    order = np.argsort(parabolic, kind="stable")
    halves = [of(corner, mid, on_line[0] & on_line[1]), of(mid, last, on_line[1] & on_line[2])]
    return Sides(
        node=shells.node,
        linear=np.sort(of(corner, last, whole & (mid == 0))),
        parabolic=parabolic[order],
        mid=mids[order],
        halves=np.sort(np.concatenate(halves)),
        mids=np.sort(mid[on_line[1]]),
    )


def _among(values: Ids, ascending: Ids) -> NDArray[np.bool_]:
    """Whether each value is one of those."""
    if not ascending.size:
        return np.zeros(values.shape, dtype=bool)
    place = np.searchsorted(ascending, values).clip(max=ascending.size - 1)
    found: NDArray[np.bool_] = ascending[place] == values
    return found
