"""Every line that cannot be assessed is refused with place, value and remedy."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from fatigue.errors import DataError
from fatigue.weld.line_check import check_line, line_warnings
from tests.weld_lines import lines, moved, ring, rotations, straight, weld_line

WHERE = "nodes.csv, weld W1"
STEPS = [10.0, 10, 10, 10]


def refusal(line):
    """Return the problems ``check_line`` raises, as text."""
    with pytest.raises(DataError) as caught:
        check_line(line, WHERE)
    return str(caught.value)


def changed(line, column, at, value):
    """Change one value of a column."""
    values = getattr(line, column).copy()
    values[at] = value
    return replace(line, **{column: values})


@given(lines(), rotations())
@settings(deadline=None, max_examples=30)
def test_sound_lines_pass(line, rotation):
    """Arcs and rings with linear and parabolic edges are fit for assessment in any attitude."""
    check_line(moved(line, rotation, np.array([1e4, -2e3, 5e2])), WHERE)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            weld_line([[0, 0, 0]]),
            "nodes.csv, weld W1: 1 node, a line needs 2 or more. Add the missing nodes.",
        ),
        (
            weld_line([[0, 0, 0], [1, 0, 0]], closed=True),
            "nodes.csv, weld W1: 2 nodes, a closed line needs 3 or more. Add the missing nodes.",
        ),
        (
            straight(STEPS, node=[7, 8, 9, 8, 5]),
            (
                "nodes.csv, weld W1, node 8 (order 2) and 1 more: the node occurs more than once on the line. "
                "Name every node once."
            ),
        ),
        (
            ring(5, node=[1, 2, 3, 4, 1]),
            (
                "nodes.csv, weld W1, node 1 (order 1) and 1 more: the node occurs more than once on the line. "
                "Do not repeat the first node of a closed line."
            ),
        ),
        (
            straight(STEPS, edge_mid=[0, 1, 0, 0, 1]),
            (
                "nodes.csv, weld W1, node 105 (order 5): a mid-side node begins or ends an open line. "
                "Let the line end at an element corner or correct edge_mid."
            ),
        ),
        (
            straight(STEPS, edge_mid=[0, 1, 1, 0, 0]),
            (
                "nodes.csv, weld W1, node 102 (order 2): two mid-side nodes follow each other. "
                "Add the element corner between them or correct edge_mid."
            ),
        ),
        (
            changed(straight(STEPS), "thickness", [2, 3], -8.0),
            (
                "nodes.csv, weld W1, node 103 (order 3) and 1 more: thickness_mm is -8. "
                "Give the thickness of the assessed plate, a positive number."
            ),
        ),
        (
            changed(straight(STEPS), "thickness", 0, np.nan),
            (
                "nodes.csv, weld W1, node 101 (order 1): thickness_mm is nan. "
                "Give the thickness of the assessed plate, a positive number."
            ),
        ),
        (
            changed(straight(STEPS), "xyz", (1, 2), np.nan),
            (
                "nodes.csv, weld W1, node 102 (order 2): x_mm, y_mm, z_mm hold a value that is no finite number. "
                "Correct the value."
            ),
        ),
        (
            changed(straight(STEPS), "normal", (1, 2), np.inf),
            (
                "nodes.csv, weld W1, node 102 (order 2): normal_x, normal_y, normal_z hold a value that is no finite "
                "number. Correct the value."
            ),
        ),
        (
            changed(straight(STEPS), "outward", (4, 0), np.nan),
            (
                "nodes.csv, weld W1, node 105 (order 5): outward_x, outward_y, outward_z hold a value that is no "
                "finite number. Correct the value."
            ),
        ),
        (
            changed(straight(STEPS), "normal", 3, 0.0),
            "nodes.csv, weld W1, node 104 (order 4): the normal is zero. Give the top normal of the plate.",
        ),
        (
            changed(straight(STEPS), "outward", 3, 0.0),
            (
                "nodes.csv, weld W1, node 104 (order 4): the outward vector is zero. "
                "Give a vector from the assessed plate across the line."
            ),
        ),
        (
            straight([10.0, 0, 10]),
            (
                "nodes.csv, weld W1, node 102 (order 2): the next node of the line has the same coordinates. "
                "Merge coincident nodes or correct the coordinates."
            ),
        ),
        (
            changed(ring(6), "xyz", 5, [100.0, 0, 0]),
            (
                "nodes.csv, weld W1, node 106 (order 6): the next node of the line has the same coordinates. "
                "Merge coincident nodes or correct the coordinates."
            ),
        ),
        (
            straight([2.0, 10], edge_mid=[0, 1, 0]),
            (
                "nodes.csv, weld W1, node 102 (order 2): the mid-side node lies outside the middle half of its edge, "
                "or far beside it. Check edge_mid, the order of the nodes and their coordinates."
            ),
        ),
        (
            weld_line([[0, 0, 0], [5, 6, 0], [10, 0, 0]], edge_mid=[0, 1, 0]),
            (
                "nodes.csv, weld W1, node 102 (order 2): the mid-side node lies outside the middle half of its edge, "
                "or far beside it. Check edge_mid, the order of the nodes and their coordinates."
            ),
        ),
        (
            weld_line([[0, 0, 0], [10, 0, 0], [5, 0, 0]]),
            (
                "nodes.csv, weld W1, node 102 (order 2): the line turns back on itself. "
                "Check the order, or make two welds of the line."
            ),
        ),
        (
            changed(straight(STEPS), "normal", 1, [1.0, 0, 0.05]),
            (
                "nodes.csv, weld W1, node 102 (order 2): the normal points along the line. "
                "Give the normal of the assessed plate."
            ),
        ),
        (
            changed(straight(STEPS), "normal", [2, 3], [0.0, 0, -1]),
            (
                "nodes.csv, weld W1, node 102 (order 2) and 1 more: the normal turns to the other side before the "
                "next node. Let all normals of a line point to the same side of the plate, its top."
            ),
        ),
        (
            changed(straight(STEPS), "outward", 2, [1.0, 0, 1]),
            (
                "nodes.csv, weld W1, node 103 (order 3): the outward vector has no part in the plane of the plate "
                "and normal to the line. Give a vector from the assessed plate across the line."
            ),
        ),
        (
            changed(straight(STEPS), "outward", 4, [0.0, -1, 0]),
            (
                "nodes.csv, weld W1, node 105 (order 5): the outward vector points to the other side of the line "
                "than at most of its nodes. Let all outward vectors of a line point out of the assessed plate."
            ),
        ),
    ],
)
def test_refusals(line, message):
    """Each refusal names the first node, the finding and what to do."""
    assert refusal(line) == message


def test_all_problems_at_once():
    """Mistakes in different columns are reported together."""
    line = changed(straight(STEPS, thickness=0.0), "normal", 1, 0.0)
    assert "thickness_mm is 0" in refusal(line)
    assert "the normal is zero" in refusal(line)


def test_flipped_normals_are_found_across_the_joint_of_a_ring():
    """The last node of a closed line neighbours the first."""
    message = refusal(changed(ring(6), "normal", 5, [0.0, 0, -1]))
    assert "node 105 (order 5) and 1 more: the normal turns" in message


def test_an_even_line_gives_no_warning():
    """Even edges longer than a tenth of the thickness, one thickness, right angles: nothing to say."""
    assert line_warnings(straight(STEPS), WHERE) == []


@pytest.mark.parametrize(
    ("line", "code", "message"),
    [
        (
            straight([10.0, 1.5, 10]),
            "short_edge",
            (
                "nodes.csv, weld W1, node 102 (order 2): the next edge is shorter than 0.2 of the median edge, 10 "
                "mm, or 0.1 of the thickness (shortest 1.5 mm). "
                "Mesh the line evenly: short edges amplify the noise of the nodal forces."
            ),
        ),
        (
            straight([0.9, 0.9]),
            "short_edge",
            (
                "nodes.csv, weld W1, node 101 (order 1) and 1 more: the next edge is shorter than 0.2 of the median "
                "edge, 0.9 mm, or 0.1 of the thickness (shortest 0.9 mm). "
                "Mesh the line evenly: short edges amplify the noise of the nodal forces."
            ),
        ),
        (
            straight(STEPS, thickness=[8, 8, 8, 12, 12]),
            "thickness_step",
            (
                "nodes.csv, weld W1, node 104 (order 4) and 1 more: thickness_mm varies along the line from 8 to 12. "
                "End one weld and begin another where the plate changes."
            ),
        ),
        (
            straight([4.0, 6], edge_mid=[0, 1, 0]),
            "mid_off_centre",
            (
                "nodes.csv, weld W1, node 102 (order 2): the mid-side node lies off the centre of its edge. "
                "Check edge_mid and the coordinates."
            ),
        ),
        (
            changed(straight(STEPS), "normal", 2, [1.0, 0, 1]),
            "normal_tilted",
            (
                "nodes.csv, weld W1, node 103 (order 3): the plate normal is up to 45 degrees off the right angle to "
                "the line. Check normal_x, normal_y and normal_z."
            ),
        ),
    ],
)
def test_warnings(line, code, message):
    """Each doubt names the first node, the finding and what to do; the line passes all the same."""
    check_line(line, WHERE)
    (warning,) = line_warnings(line, WHERE)
    assert (warning.code, str(warning)) == (code, message)


@pytest.mark.parametrize("length", [1e200, 1e-200, 5e-324, 1.7e308])
@pytest.mark.parametrize("column", ["normal", "outward"])
def test_a_vector_of_an_odd_length(column, length):
    """Its direction is used, and the length told in one warning; no square overflows on the way."""
    line = straight(STEPS)
    line = changed(line, column, 2, length * getattr(line, column)[2])
    check_line(line, WHERE)
    (problem,) = line_warnings(line, WHERE)
    assert problem.code == "vector_length"
    assert problem.where == "nodes.csv, weld W1, node 103 (order 3)"
    assert f"{column}_x, {column}_y, {column}_z make a vector of" in problem.what


@pytest.mark.parametrize("length", [1e-6, 1e-3, 1e5, 1e9])
def test_vectors_of_mesh_edges_and_their_products_pass(length):
    """Nobody has to normalise."""
    assert line_warnings(straight(STEPS, normal=(0.0, 0.0, length), outward=(0.0, length, 0.0)), WHERE) == []


@pytest.mark.parametrize("value", [1e101, -1e200, 1.7e308])
def test_a_coordinate_without_square(value):
    """It is refused with its place before anything is computed of it."""
    line = straight(STEPS)
    line = changed(line, "xyz", 1, [value, 0.0, 0.0])
    assert refusal(line).startswith("nodes.csv, weld W1, node 102 (order 2): a coordinate is ")
