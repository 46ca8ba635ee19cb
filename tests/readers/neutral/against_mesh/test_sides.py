"""Elements of an assessed side that lie where the outward vector points to are told, whatever shares the node."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.readers.neutral.against_mesh.sides import side_warnings
from fatigue.readers.neutral.line_file import line_file
from fatigue.weld.element_forces import ElementForces
from fatigue.weld.line import stacked
from tests.readers.neutral.against_mesh.plates import tee, weld_of

TEE = tee()
LINE = weld_of(TEE)


def forces_of(plates, modes=(1, 2)):
    """Rows of element forces without any force: they tell which nodes an element has."""
    element, column = np.nonzero(plates.corners)
    node, element = plates.corners[element, column], plates.element[element]
    mode = np.repeat(modes, node.size)
    return ElementForces(mode, np.tile(node, len(modes)), np.tile(element, len(modes)), np.zeros((mode.size, 6)))


def side(plates, line, direction):
    """Elements that touch the line and lie in this direction of it."""
    touching = np.flatnonzero(np.isin(plates.corners, line.node).any(axis=1))
    centre = plates.xyz[plates.corners[touching, :4] - 1].mean(axis=1)
    return plates.element[touching[centre @ np.asarray(direction) > 1.0]]


def told(*pairs, plates=TEE):
    """Warnings about lines, each with the elements of its side."""
    lines = [replace(line, weld=f"W{i}") for i, (line, _) in enumerate(pairs, start=1)]
    sides = {line.weld: elements for line, (_, elements) in zip(lines, pairs, strict=True)}
    found = side_warnings(
        line_file(stacked(lines)), forces_of(plates), sides, plates, "weld_nodes.csv", "weld_elements.csv"
    )
    return [problem.code for problem in found], [str(problem) for problem in found]


BEHIND, AHEAD, ABOVE = side(TEE, LINE, [0, -1, 0]), side(TEE, LINE, [0, 1, 0]), side(TEE, LINE, [0, 0, 1])


def test_each_plate_side_seen_from_itself():
    """Three welds of one line, on both faces up."""
    other = replace(LINE, outward=-LINE.outward)
    wall = replace(LINE, normal=LINE.outward, outward=np.tile([0.0, 0.0, -1.0], (11, 1)))
    assert told((LINE, BEHIND), (other, AHEAD), (wall, ABOVE), (replace(LINE, normal=-LINE.normal), BEHIND))[0] == []


def test_an_outward_vector_into_the_side():
    """The plate goes on behind the weld, so only the list of elements can tell."""
    codes, texts = told((LINE, BEHIND), (LINE, AHEAD))
    assert codes == ["outward_into_plate"]
    assert texts[0] == (
        f"weld_nodes.csv: weld W2, node {LINE.node[0]} (order 1) and 10 more: the outward vector points into the "
        "assessed side that weld_elements.csv names: it lies where the vector points to, and not behind it. Give a "
        "vector from the assessed plate across the line: tension is read as compression now."
    )


@pytest.mark.parametrize("degrees", [35.0, 56.0, -80.0])
def test_a_normal_turned_against_the_side(degrees):
    """Nearer to the wall or not: the elements of the side are what counts."""
    turned = np.radians(degrees)
    normal = np.tile([0.0, -np.sin(turned), np.cos(turned)], (11, 1))
    codes, texts = told((replace(LINE, normal=normal), BEHIND))
    assert codes == ["normal_off_plate"]
    assert f"names is turned about the line by {abs(degrees):.0f} degrees" in texts[0]


def test_the_elements_of_the_wall_named_for_the_plate():
    """They stand at a right angle to the plane of the normal."""
    codes, texts = told((LINE, ABOVE))
    assert codes == ["normal_off_plate"]
    assert "by 90 degrees" in texts[0]


def test_nodes_without_coordinates_tell_nothing():
    """A mesh may hold some of the nodes only."""
    few = replace(TEE, node=TEE.node[:5], xyz=TEE.xyz[:5])
    found = side_warnings(line_file(stacked([LINE])), forces_of(TEE), {"W1": AHEAD}, few, "a", "b")
    assert found == []
