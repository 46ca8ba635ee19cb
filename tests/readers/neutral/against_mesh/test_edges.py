"""Edges and mid-side nodes of weld lines are compared with the sides of the shells."""

from dataclasses import replace

import numpy as np
import pytest

from tests.readers.neutral.against_mesh.plates import ATTACHED, BASE, mesh, tee, told, weld_of
from tests.weld_lines import weld_line

LINEAR, PARABOLIC = tee(), tee(parabolic=True)


def without(line, at):
    """Leave out some nodes of a line."""
    names = ("order", "node", "xyz", "thickness", "normal", "outward", "edge_mid")
    return replace(line, **{name: np.delete(getattr(line, name), at, axis=0) for name in names})


def marks(line, *at):
    """Mark some nodes, and no others, as mid-side nodes."""
    return replace(line, edge_mid=np.isin(np.arange(line.node.size), at))


def test_lines_of_the_mesh_agree():
    """Linear and parabolic ones."""
    assert told(LINEAR, weld_of(LINEAR))[0] == []
    assert told(PARABOLIC, weld_of(PARABOLIC, mids=True))[0] == []


@pytest.mark.parametrize("at", [(1, 3, 5, 7, 9), (5,), (1,), (9,), (3, 7)])
def test_marks_on_linear_edges(at):
    """All, one, the first, the last, a few: corners of shells are no mid-side nodes."""
    codes, texts = told(LINEAR, marks(weld_of(LINEAR), *at))
    assert codes == ["mark_off_mesh"]
    more = f" and {len(at) - 1} more" if len(at) > 1 else ""
    assert f"(order {at[0] + 1}){more}: edge_mid marks a mid-side node, and the shells" in texts[0]


@pytest.mark.parametrize("forgotten", [tuple(range(1, 21, 2)), (9,), (1,), (19,), (5, 7)])
def test_unmarked_mid_side_nodes(forgotten):
    """All, one, the first, the last, neighbours."""
    line = weld_of(PARABOLIC, mids=True)
    codes, texts = told(PARABOLIC, marks(line, *(set(range(1, 21, 2)) - set(forgotten))))
    assert codes == ["mid_not_marked"]
    more = f" and {len(forgotten) - 1} more" if len(forgotten) > 1 else ""
    assert f"node {line.node[forgotten[0]]} (order {forgotten[0] + 1}){more}: the node is amid a side" in texts[0]


def test_marks_at_corners_instead_of_mid_side_nodes():
    """Every other node is marked, but the wrong ones; a ring may begin at one."""
    line = weld_of(PARABOLIC, mids=True)
    codes, _ = told(PARABOLIC, marks(line, *range(2, 20, 2)))
    assert "no_shell_edge" in codes or "mark_off_mesh" in codes


def test_mid_side_nodes_left_out():
    """A line of the corners alone lacks two thirds of the load."""
    codes, texts = told(PARABOLIC, weld_of(PARABOLIC))
    assert codes == ["mid_left_out"]
    assert "and 9 more: the line leaves out node " in texts[0]


def test_corners_alone_in_the_mesh_prove_nothing():
    """Tables of elements may hold corners only, beside lines with mid-side nodes."""
    corners = PARABOLIC.corners.copy()
    corners[:, 4:] = 0
    assert told(replace(PARABOLIC, corners=corners), weld_of(PARABOLIC, mids=True))[0] == []


def test_either_marks_fit_where_linear_shells_meet_parabolic_ones():
    """A wall of linear shells with a corner at each mid-side node of the plate below."""
    xyz = np.array(
        [[0, 0, 0], [20, 0, 0], [20, -20, 0], [0, -20, 0], [10, 0, 0], [20, -10, 0], [10, -20, 0], [0, -10, 0]]
    )
    wall = np.array([[0, 0, 20], [10, 0, 20], [20, 0, 20]])
    nodes = np.array([[1, 2, 3, 4, 5, 6, 7, 8], [1, 5, 10, 9, 0, 0, 0, 0], [5, 2, 11, 10, 0, 0, 0, 0]])
    both = mesh(np.vstack([xyz, wall]).astype(float), nodes, [BASE, ATTACHED, ATTACHED])
    line = weld_line(xyz[[0, 4, 1]].astype(float), thickness=BASE, node=[1, 5, 2])
    assert told(both, line)[0] == []
    assert told(both, marks(line, 1))[0] == []


def test_triangles_have_three_sides():
    """The fourth corner of a triangle is no node."""
    xyz = np.array([[0, 0, 0], [10, 0, 0], [20, 0, 0], [10, -10, 0]], dtype=float)
    triangles = mesh(xyz, np.array([[1, 2, 4], [2, 3, 4]]), [BASE, BASE])
    line = weld_line(xyz[:3], thickness=BASE, node=[1, 2, 3])
    assert told(triangles, line)[0] == []
    assert told(triangles, without(line, 1))[0] == ["no_shell_edge"]


def test_an_edge_that_no_shell_has():
    """A node is missing, or two are exchanged."""
    line = weld_of(LINEAR)
    codes, texts = told(LINEAR, without(line, 4))
    assert codes == ["no_shell_edge"]
    assert f"node {line.node[3]} (order 4): no shell of elements.csv has a side" in texts[0]
    assert f"to the next of the line, {line.node[5]}." in texts[0]


def test_the_closing_edge_is_an_edge():
    """A line round the plate is closed in truth, one along it is not."""
    x, y = LINEAR.xyz[:, 0], LINEAR.xyz[:, 1]
    rim = (LINEAR.xyz[:, 2] == 0) & ((x == 0) | (x == 100) | (np.abs(y) == 20))
    at = np.flatnonzero(rim)
    at = at[np.argsort(np.arctan2(y[at], x[at] - 50))]
    out = LINEAR.xyz[at] - [50.0, 0, 0]
    line = weld_line(LINEAR.xyz[at], outward=out, thickness=BASE, node=LINEAR.node[at], closed=True)
    assert told(LINEAR, line)[0] == []
    half = without(line, np.arange(5, 12))
    assert told(LINEAR, half)[0] == ["no_shell_edge"]
