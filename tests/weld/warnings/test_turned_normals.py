"""Normals that are turned about the weld stand out against their neighbours; smooth curvature does not."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from fatigue.weld.line import stacked
from fatigue.weld.line_check import TURNED_ALONE, TURNED_STEP, check_line, line_warnings, warned_lines
from fatigue.weld.line_geometry import tangents
from fatigue.weld.warnings.turned_normals import turned_from_neighbours, turns
from tests.weld_lines import lines, moved, ring, rotations, straight, weld_line

WHERE = "nodes.csv, weld W1"


def turned(line, at, degrees):
    """Turn the normals of some nodes about the line."""
    normal, tangent = line.normal.copy(), tangents(line)
    for i in np.atleast_1d(at):
        normal[i] = Rotation.from_rotvec(np.radians(degrees) * tangent[i]).apply(normal[i])
    return replace(line, normal=normal)


def tube(n, slope=0.0):
    """A weld round a tube of n facets, or a cone, seen from the tube."""
    line = ring(n)
    return replace(line, normal=line.outward + np.array([0.0, 0.0, slope]), outward=np.tile([0.0, 0.0, 1.0], (n, 1)))


def saddle(n, ratio):
    """The weld of a tube of this share of the other's diameter on that other, seen from the other."""
    angle = 2 * np.pi * np.arange(n) / n
    x, y = ratio * np.cos(angle), ratio * np.sin(angle)
    z = np.sqrt(1 - y**2)
    normal, inside = np.column_stack([0 * y, y, z]), -np.column_stack([x, y, 0 * z])
    return weld_line(50 * np.column_stack([x, y, z]), normal=normal, outward=inside, closed=True)


@pytest.mark.parametrize("line", [tube(12), tube(4), tube(6, slope=1.0), ring(5), straight([10.0] * 6)])
def test_round_and_flat_plates_do_not_turn(line):
    """A tube of facets of 30 degrees, a square one, a cone, a ring on a plate: carried along, the normal stays."""
    assert np.abs(turns(line)).max() < 1e-9
    assert line_warnings(line, WHERE) == []
    check_line(line, WHERE)


@pytest.mark.parametrize(("n", "ratio"), [(12, 0.95), (16, 0.95), (12, 0.8), (24, 1.0)])
def test_coarse_saddles_are_smooth(n, ratio):
    """Tube on tube, at 12 nodes and nearly equal diameters: below the threshold by little."""
    alone, step = turned_from_neighbours(saddle(n, ratio))
    assert alone.max() < TURNED_ALONE
    assert step.max() < TURNED_STEP
    assert "normal_turned" not in {problem.code for problem in line_warnings(saddle(n, ratio), WHERE)}


@given(lines(least=3), rotations(), st.floats(25.0, 85.0), st.sampled_from([-1.0, 1.0]), st.data())
@settings(deadline=None, max_examples=40)
def test_one_turned_node_is_found_and_named(line, rotation, degrees, sign, data):
    """At any place of an open or closed line in any attitude; its angle is told and no other node is named."""
    at = data.draw(st.integers(0, line.node.size - 1))
    wrong = moved(turned(line, at, sign * degrees), rotation, np.zeros(3))
    alone, _ = turned_from_neighbours(wrong)
    assert alone[at] == pytest.approx(degrees, abs=1e-6)
    assert np.delete(alone, at).max() < 1e-6
    (warning,) = [problem for problem in line_warnings(wrong, WHERE) if problem.code == "normal_turned"]
    assert warning.where == f"{WHERE}, node {line.node[at]} (order {line.order[at]})"
    assert f"up to {degrees:.0f} degrees against the nodes beside it (more than 20)" in warning.what


def test_a_stretch_that_is_turned_is_found_where_it_begins():
    """Half of a line is no outlier: the step between the halves is told."""
    (warning,) = line_warnings(turned(straight([10.0] * 11), range(6, 12), 56.0), WHERE)
    assert warning.code == "normal_turned"
    assert "node 106 (order 6)" in warning.where
    assert "up to 56 degrees against the nodes beside it (more than 30)" in warning.what


def test_lines_of_two_nodes_are_compared_with_each_other():
    """Neither is the right one, and nothing is told below 30 degrees."""
    assert [p.code for p in line_warnings(turned(straight([10.0]), 1, 56.0), WHERE)] == ["normal_turned"]
    assert line_warnings(turned(straight([10.0]), 1, 25.0), WHERE) == []


def test_an_even_twist_is_no_turned_normal():
    """A twisted plate turns by 18 degrees from node to node, all along."""
    line = straight([10.0] * 9)
    angle = np.radians(18.0 * np.arange(10))
    normal = np.column_stack([np.zeros(10), np.sin(angle), np.cos(angle)])
    outward = np.column_stack([np.zeros(10), np.cos(angle), -np.sin(angle)])
    alone, step = turned_from_neighbours(replace(line, normal=normal, outward=outward))
    assert max(alone.max(), step.max()) < 1e-9


def test_a_stack_has_the_turns_of_each_line():
    """Lines are judged together as they are alone."""
    some = [turned(straight([10.0] * 5), 2, 50.0), tube(12), turned(ring(9), [0, 8], 40.0), straight([10.0])]
    stack = stacked(some)
    one_by_one = zip(*map(turned_from_neighbours, some), strict=True)
    for together, alone in zip(turned_from_neighbours(stack), one_by_one, strict=True):
        np.testing.assert_allclose(together, np.concatenate(alone), atol=1e-9)
    assert warned_lines(stack).tolist() == [0, 2]
