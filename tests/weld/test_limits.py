"""Limits of what is doubted and refused about weld lines, on either side of each, at one node among sound ones."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.weld.line import LINE_COLUMNS, NODE_COLUMNS, stacked
from fatigue.weld.line_check import line_warnings, unfit_lines, warned_lines
from fatigue.weld.line_units import unit_problems, unit_warnings
from tests.weld.test_detection import assembly, plate, shell_mesh, welds
from tests.weld_lines import lines, ring, straight, weld_line

SOUND = straight([10.0] * 6)


def codes(line):
    """Warnings about a line: code and how many nodes, the first one included."""
    found = []
    for problem in line_warnings(line, "here"):
        first, _, more = problem.where.removeprefix("here, node ").partition(" and ")
        found.append((problem.code, int(first.split()[0]), int(more.split()[0]) + 1 if more else 1))
    return found


def at_node(column, at, value):
    """Give the sound line another value at one node."""
    values = getattr(SOUND, column).copy()
    values[at] = value
    return weld_line(SOUND.xyz, **{name: values if name == column else getattr(SOUND, name) for name in GIVEN})


GIVEN = ("outward", "normal", "thickness")
STEP = ("thickness_step", 102, 1)
UNEVEN = straight([8.0, 2.05, 12.0], thickness=[20.0, 21.0, 20.0, 20.0])


def tilted(degrees, at=2):
    """Lean one normal along the line."""
    angle = np.radians(degrees)
    return at_node("normal", at, [np.sin(angle), 0.0, np.cos(angle)])


def with_mid(fraction, beside=0.0):
    """A line of three edges of 10 mm whose second one has a mid-side node at a fraction of it."""
    x = np.array([[0.0, 0, 0], [10, 0, 0], [10 + 10 * fraction, 10 * beside, 0], [20, 0, 0], [30, 0, 0]])
    return weld_line(x, edge_mid=[0, 0, 1, 0, 0], thickness=5.0)


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (straight([10.0, 2.05, 10.0, 12.0]), []),  # medians of 10 and of 11 mm
        (straight([10.0, 1.95, 10.0, 12.0]), [("short_edge", 102, 1)]),
        (straight([10.0, 2.15, 12.0, 12.0]), [("short_edge", 102, 1)]),
        (straight([10.0, 2.25, 12.0, 12.0]), []),
        (straight([8.0, 2.05, 12.0], thickness=20.0), []),
        (straight([8.0, 1.95, 12.0], thickness=20.0), [("short_edge", 102, 1)]),
        (UNEVEN, [("short_edge", 102, 1), STEP]),
        (at_node("thickness", 1, 10.099), []),
        (at_node("thickness", 1, 10.101), [STEP]),
        (at_node("thickness", 1, 9.901), []),
        (at_node("thickness", 1, 9.899), [STEP]),
        (at_node("thickness", 0, 10.2), [("thickness_step", 102, 6)]),
        (with_mid(0.5495), []),
        (with_mid(0.5505), [("mid_off_centre", 103, 1)]),
        (with_mid(0.4495), [("mid_off_centre", 103, 1)]),
        (tilted(9.9), []),
        (tilted(10.1), [("normal_tilted", 103, 1)]),
        (tilted(-10.1), [("normal_tilted", 103, 1)]),
    ],
)
def test_limits_of_the_warnings(line, expected):
    """Short edges by the median and by the plate, steps of 1 %, mid-side nodes 5 % and normals 10 degrees off."""
    assert not unfit_lines(stacked([line])).size
    assert codes(line) == expected
    assert warned_lines(stacked([SOUND, line, SOUND])).tolist() == [1] * bool(expected)


@pytest.mark.parametrize(
    ("line", "refused"),
    [
        (with_mid(0.74), False),
        (with_mid(0.76), True),
        (with_mid(0.26), False),
        (with_mid(0.24), True),
        (with_mid(0.5, 0.49), False),
        (with_mid(0.5, 0.51), True),
        (tilted(84.0), False),
        (tilted(84.5), True),  # asin 0.1 is 5.74 degrees
        (at_node("outward", 3, [1.0, 0.0101, 0.0]), False),
        (at_node("outward", 3, [1.0, 0.0099, 0.0]), True),
        (at_node("outward", 3, [0.0, -0.5, 1.0]), True),
        (at_node("normal", 3, [0.0, 1.0, -0.01]), True),
        (weld_line([[0, 0, 0], [10, 0, 0], [0.05, 0.195, 0]], outward=[[0, 1, 0], [-1, 0, 0], [0, -1, 0]]), True),
        (weld_line([[0, 0, 0], [10, 0, 0], [0.05, 0.21, 0]], outward=[[0, 1, 0], [-1, 0, 0], [0, -1, 0]]), False),
    ],
)
def test_limits_of_the_refusals(line, refused):
    """Mid-side nodes in the middle half, normals along the line, vectors along it, and lines that turn back."""
    assert unfit_lines(stacked([SOUND, line, ring(6)])).tolist() == [1] * refused


def test_every_line_is_judged_by_its_own_median():
    """A fine line beside a coarse one: the edges of neither are short."""
    fine, coarse = straight([1.0] * 8, thickness=3.0), straight([40.0] * 4, thickness=3.0)
    assert warned_lines(stacked([coarse, fine, coarse])).size == 0
    short = straight([40.0, 40.0, 7.0, 40.0], thickness=3.0)
    assert warned_lines(stacked([fine, short, fine])).tolist() == [1]


@pytest.mark.parametrize(
    ("value", "find", "words"),
    [
        (3000.0, unit_problems, "node 104 (order 4): thickness_mm is 3000, no plate is welded so thick"),
        (500.0, unit_problems, "node 104 (order 4): thickness_mm is 500, no plate is welded so thick"),
        (0.004, unit_problems, "node 104 (order 4): thickness_mm is 0.004 on edges of 10 mm"),
        (0.3, unit_warnings, "node 104 (order 4): thickness_mm is 0.3, welded plates have"),
        (300.0, unit_warnings, "node 104 (order 4): thickness_mm is 300, welded plates have"),
    ],
)
def test_one_wrong_thickness_among_sound_ones(value, find, words):
    """A single node in the second of three welds is enough, and it is the one that is named."""
    wrong = at_node("thickness", 3, value)
    (problem,) = find(stacked([ring(8), wrong, SOUND]), "nodes.csv")
    assert problem.where.startswith("nodes.csv: weld W1, ")
    assert words in str(problem)
    assert "more" not in problem.where


@settings(deadline=None, max_examples=25)
@given(st.lists(lines(), min_size=1, max_size=5), st.data())
def test_some_lines_of_a_stack_are_the_stack_of_some_lines(some, data):
    """A view holds neither more nor less: every column, where each line begins, and each line by itself."""
    first = data.draw(st.integers(0, len(some)))
    end = data.draw(st.integers(first, len(some)))
    whole = stacked(some)
    view = whole.lines(slice(first, end))
    assert len(view) == end - first
    np.testing.assert_array_equal(view.begin, whole.begin[first : end + 1] - whole.begin[first])
    if end > first:
        expected = stacked(some[first:end])
        for name in (*NODE_COLUMNS, *LINE_COLUMNS, "begin"):
            np.testing.assert_array_equal(getattr(view, name), getattr(expected, name))
        assert view[0].weld == some[first].weld
        assert view[-1 + len(view)].node.tolist() == some[end - 1].node.tolist()


def bent(degrees, joined_by):
    """Two plates of 3 x 2 elements along x, the second turned about the common edge by an angle; properties 1 and 2."""
    flat, quads = plate((0, 1), range(0, 40, 10), range(0, 30, 10))
    up, more = plate((0, 1), range(0, 40, 10), range(0, 30, 10))
    angle = np.radians(degrees)
    up = np.column_stack([up[:, 0], -up[:, 1] * np.cos(angle), up[:, 1] * np.sin(angle)])
    mesh = assembly((flat, quads), (up, more))
    return mesh if joined_by == "weld" else shell_mesh(mesh.xyz, mesh.corner, np.ones(len(mesh.corner), int))


@pytest.mark.parametrize(
    ("degrees", "kind"), [(0, "flat"), (29, "flat"), (31, "corner"), (90, "corner"), (150, "corner")]
)
def test_plates_that_meet_at_less_than_30_degrees_are_one(degrees, kind):
    """A change of property in one plate is no weld; at a sharper turn it is one, and without the change a fold."""
    assert {c.kind for c in welds(bent(degrees, "weld"), ("tee", "corner", "flat", "fold"))} == {kind}
    folded = {c.kind for c in welds(bent(degrees, "fold"), ("tee", "corner", "flat", "fold"))}
    assert folded == ({"fold"} if kind == "corner" else set())


@pytest.mark.parametrize(("degrees", "goes_on"), [(0, True), (25, True), (35, False), (55, False)])
def test_a_line_goes_straight_on_through_a_crossing_within_30_degrees(degrees, goes_on):
    """Three walls on one plate meet at a node, one of them turned: two go on as one line, or all end there."""
    turn = np.radians(degrees)
    arms = [np.array([-1.0, 0, 0]), np.array([np.cos(turn), np.sin(turn), 0]), np.array([0.0, -1, 0])]
    xyz, quads = [[0.0, 0, 0]], []
    rim = [np.arctan2(a[1], a[0]) % (2 * np.pi) for a in arms]
    angles = sorted({*rim, *(np.linspace(0, 2 * np.pi, 12, endpoint=False) + 0.01)})
    for angle in angles:
        xyz += [[10 * np.cos(angle), 10 * np.sin(angle), 0], [20 * np.cos(angle), 20 * np.sin(angle), 0]]
    n = len(angles)
    pid = []
    for k in range(n):
        a, b = 1 + 2 * k, 1 + 2 * ((k + 1) % n)
        quads += [[0, a, b, -1], [a, a + 1, b + 1, b]]
        pid += [1, 1]
    for angle in rim:
        k = angles.index(angle)
        first = len(xyz)
        xyz += [[*xyz[at][:2], 10.0] for at in (0, 1 + 2 * k, 2 + 2 * k)]
        quads += [[0, 1 + 2 * k, first + 1, first], [1 + 2 * k, 2 + 2 * k, first + 2, first + 1]]
        pid += [2, 2]
    tops = np.array(xyz)
    _, which = np.unique(tops.round(9), axis=0, return_inverse=True)
    keep = np.unique(which.ravel(), return_index=True)[1]
    quads = np.array(quads)
    quads = np.where(quads < 0, -1, which.ravel()[quads])
    cuts = [c for c in welds(shell_mesh(tops[keep], quads, pid)) if c.pid == 1]
    sizes = sorted(c.line.node.size for c in cuts)
    assert sizes == ([3, 3, 5, 5] if goes_on else [3] * 6)
