"""Lines put end to end: what becomes of their nodes, and what does not join."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.weld.join import Joint, fan, joined, joined_elements
from fatigue.weld.line import WeldLine


def line(nodes, xyz, outward=(0.0, 1.0, 0.0), normal=(0.0, 0.0, 1.0), t=8.0, mid=(), closed=False):
    """A weld line through some points."""
    n = len(nodes)
    return WeldLine(
        weld="w",
        part=1,
        order=np.arange(1, n + 1),
        node=np.array(nodes),
        xyz=np.array(xyz, dtype=float),
        thickness=np.full(n, float(t)),
        normal=np.tile(np.array(normal, dtype=float), (n, 1)),
        outward=np.tile(np.array(outward, dtype=float), (n, 1)),
        edge_mid=np.isin(nodes, mid),
        closed=closed,
        end_length=None,
    )


def along_x(nodes, start, **more):
    """A straight line, 10 mm between its nodes."""
    return line(nodes, [(start + 10.0 * k, 0.0, 0.0) for k in range(len(nodes))], **more)


def turned(weld_line):
    """The same line from its other end."""
    names = ("node", "xyz", "thickness", "normal", "outward", "edge_mid")
    return replace(weld_line, **{name: getattr(weld_line, name)[::-1] for name in names})


THREE = (
    along_x([1, 2, 3], 0.0, t=6.0),
    along_x([3, 4, 9], 20.0, t=8.0),
    along_x([9, 10], 40.0, t=8.0, outward=(1.0, 1.0, 0.0)),
)


@pytest.mark.parametrize("order", list(permutations(range(3))))
@pytest.mark.parametrize("backwards", [(), (0,), (1,), (0, 1, 2)])
def test_any_order_and_direction(order, backwards):
    """From the lower end on; where two meet the means of both."""
    lines = [turned(THREE[k]) if k in backwards else THREE[k] for k in order]
    found, joints = joined(lines, [f"L{k}" for k in order], "register: weld a")
    assert found.node.tolist() == [1, 2, 3, 4, 9, 10]
    assert found.order.tolist() == [1, 2, 3, 4, 5, 6]
    assert found.xyz[:, 0].tolist() == [0.0, 10.0, 20.0, 30.0, 40.0, 50.0]
    assert found.thickness.tolist() == [6.0, 6.0, 7.0, 8.0, 8.0, 8.0]
    assert np.allclose(found.outward[4], np.array([np.sin(np.pi / 8), np.cos(np.pi / 8), 0.0]), atol=1e-15)
    assert not found.closed
    at = {k: order.index(k) for k in range(3)}
    assert set(joints) == {Joint(3, 2, 4, (at[0], at[1])), Joint(9, 4, 10, (at[1], at[2]))}


def ring(first=0):
    """A square of four lines with mid-side nodes, seen from outside."""
    corner = [(0, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0)]
    outward = [(0, 1, 0), (-1, 0, 0), (0, -1, 0), (1, 0, 0)]
    nodes = [[7, 21, 5], [5, 22, 6], [6, 23, 8], [8, 24, 7]]
    lines = []
    for k in range(4):
        a, b = np.array(corner[k], float), np.array(corner[(k + 1) % 4], float)
        lines.append(line(nodes[k], [a, (a + b) / 2, b], outward[k], mid=(21, 22, 23, 24)))
    return lines[first:] + lines[:first]


@pytest.mark.parametrize("first", range(4))
def test_a_ring_begins_at_its_lowest_corner(first):
    """And runs on to the lower corner beside it, whatever comes first; mid-side nodes stay between their corners."""
    lines = ring(first)
    found, joints = joined([turned(lines[0]), *lines[1:]], list("abcd"), "w")
    assert found.closed
    assert found.node.tolist() == [5, 22, 6, 23, 8, 24, 7, 21]
    assert found.edge_mid.tolist() == [False, True] * 4
    assert {(j.node, j.before, j.after) for j in joints} == {(5, 7, 6), (6, 5, 8), (8, 6, 7), (7, 8, 5)}


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([THREE[0], THREE[2]], "line L1, from node 9 to 10, does not join L0"),
        ([*THREE[:2], line([3, 11], [(20, 0, 0), (20, 9, 0)])], "more than two lines end at node 3: L0"),
        ([THREE[0], THREE[0]], "lines L0 and L1 have the same nodes: they are two plate sides of one weld"),
        ([along_x([1, 2, 3], 0.0), line([3, 5, 2, 8], [(20, 0, 0), (20, 9, 0), (10, 0, 0), (10, -9, 0)])],
         "lines L0 and L1 touch at node 2, not only end to end"),
        ([THREE[0], along_x([3, 4], 20.0, outward=(0, -1, 0))], "seen from different sides of the weld at node 3"),
        ([THREE[0], along_x([3, 4], 20.0, normal=(0, 0, -1))], "the top normal turns to the other face between"),
        ([THREE[0], along_x([3, 4], 20.0, normal=(0, -1, 1))], "the assessed plate turns by 45 degrees between"),
        ([replace(ring()[0], closed=True), THREE[0]], "line L0 is closed and joins no other line"),
    ],
)  # fmt: skip
def test_what_does_not_join(lines, words):
    """Each in one line with the lines and the node."""
    with pytest.raises(DataError) as caught:
        joined(lines, [f"L{k}" for k in range(len(lines))], "r.csv: weld a")
    (problem,) = caught.value.problems
    assert words in problem.what
    assert problem.where == "r.csv: weld a"


def test_the_plate_round_a_corner():
    """An inner corner of 90 degrees has one element, although both lines alone take some behind the other."""
    #  7 8 9      the weld comes up from 2 to 5 and turns to the left, to 4: element 1 is inside the corner
    #  4 5 6
    #  1 2 3
    around = {1: {1, 2, 5, 4}, 2: {2, 3, 6, 5}, 3: {4, 5, 8, 7}, 4: {5, 6, 9, 8}}
    joint = Joint(5, 2, 4, (0, 1))
    up, left = {1, 3}, {1, 2}  # each with the element behind the other line
    inner = fan(around, joint, up, left)
    assert inner == {1}
    sides = [np.array([1, 3, 10]), np.array([1, 2, 11])]
    assert joined_elements(sides, [around], [inner]).tolist() == [1, 10, 11]
    assert fan(around, joint, {2, 4}, {3, 4}) == {2, 3, 4}
    gap = {element: nodes for element, nodes in around.items() if element != 4}
    assert fan(gap, joint, {2}, {3}) is None
