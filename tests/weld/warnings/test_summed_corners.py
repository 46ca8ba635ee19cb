"""What is read at a corner whose nodal forces are summed over both legs, and what is said about it."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.weld.line import stacked
from fatigue.weld.line_geometry import split_at_kinks
from fatigue.weld.line_load import line_load_matrix
from fatigue.weld.structural_stress import assess_line
from fatigue.weld.warnings.summed_corners import corner_share, summed_corners
from tests.weld_lines import ring, straight, weld_line

T = 10.0  # mm


def bent(turn, before=(10.0,) * 8, after=(10.0,) * 8):
    """A line of two straight legs, the plate on its right side, and the position of the corner."""
    ahead = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn)), 0.0])
    first = np.outer(np.concatenate([[0.0], np.cumsum(before)]) - sum(before), [1.0, 0.0, 0.0])
    xyz = np.vstack([first, np.outer(np.cumsum(after), ahead)])
    left = np.array([[0.0, 1.0, 0.0], [-ahead[1], ahead[0], 0.0]])
    corner = len(before)
    outward = np.repeat([left[0], left.sum(axis=0), left[1]], [corner, 1, len(after)], axis=0)
    return weld_line(xyz, outward=outward, thickness=T, end_length=0.0), corner


def leg_forces(line, stress):
    """Nodal forces of each leg under this stress across it, (n, 1, 6) each [N]: as element forces give them."""
    found = []
    for leg, value in zip(split_at_kinks(line), stress, strict=True):
        tangent = (leg.xyz[-1] - leg.xyz[0]) / np.linalg.norm(leg.xyz[-1] - leg.xyz[0])
        load = np.zeros((leg.node.size, 1, 6))
        load[:, 0, :3] = value * T * np.cross([0.0, 0.0, 1.0], tangent)
        found.append((line_load_matrix(leg) @ load.reshape(leg.node.size, 6)).reshape(load.shape))
    return found


def summed(line, corner, stress):
    """The same forces as one sum at the corner."""
    before, after = leg_forces(line, stress)
    nodal = np.zeros((line.node.size, 1, 6))
    nodal[: corner + 1] += before
    nodal[corner:] += after
    return nodal


@pytest.mark.parametrize(("turn", "read"), [(45, 83.149), (90, 63.640), (135, 34.442)])
def test_the_corner_reads_a_share_of_a_stress_on_both_legs(turn, read):
    """90 MPa on both legs; summed leg by leg it is read as 90 at every node."""
    line, corner = bent(turn)
    found = assess_line(line, summed(line, corner, (90.0, 90.0)))
    assert found.raw.membrane[corner, 0] == pytest.approx(read, abs=1e-3)
    assert read == pytest.approx(90.0 * corner_share(turn), abs=1e-3)
    assert found.summed_corner.nonzero()[0].tolist() == [corner]
    for leg, forces in zip(split_at_kinks(line), leg_forces(line, (90.0, 90.0)), strict=True):
        of_leg = assess_line(leg, forces)
        np.testing.assert_allclose(of_leg.raw.membrane, 90.0, rtol=1e-12)
        assert of_leg.at_corner.any()
        assert not of_leg.summed_corner.any()


def test_uneven_edges_read_the_same_share_and_neighbours_too_much():
    """The share needs no even mesh; beside the corner of an even one 0.134 (1 - cos turn) is read too much."""
    line, corner = bent(90, before=(7.0, 3.0, 12.0, 5.0), after=(20.0, 9.0, 9.0))
    found = assess_line(line, summed(line, corner, (90.0, 90.0)))
    assert found.raw.membrane[corner, 0] == pytest.approx(90.0 * corner_share(90), rel=1e-12)
    for turn in (60, 90, 135):
        line, corner = bent(turn)
        found = assess_line(line, summed(line, corner, (1.0, 1.0)))
        over = (2 - np.sqrt(3)) / 2 * (1 - np.cos(np.radians(turn)))
        np.testing.assert_allclose(found.raw.membrane[[corner - 1, corner + 1], 0], 1.0 + over, rtol=1e-3)


def test_the_sum_bounds_nothing():
    """Legs under loads that differ without limit at the corner have the same nodal forces in sum."""
    before, after = split_at_kinks(bent(90)[0])
    free = {}
    for name, leg, at in (("before", before, -1), ("after", after, 0)):
        inner = np.delete(np.arange(leg.node.size), at)
        matrix = line_load_matrix(leg).toarray()
        load = np.ones(leg.node.size)
        load[inner] = -np.linalg.solve(matrix[np.ix_(inner, inner)], matrix[inner, at])
        free[name] = load, matrix @ load, at
    (load, forces, at), (other, others, end) = free["before"], free["after"]
    for leg_forces_ in (np.delete(forces, at), np.delete(others, end)):
        np.testing.assert_allclose(leg_forces_, 0.0, atol=1e-12)  # no inner node feels the free load
    factor = -forces[at] / others[end]
    assert forces[at] + factor * others[end] == pytest.approx(0.0, abs=1e-12)  # nor does the sum at the corner
    assert forces[at] == pytest.approx(10.0 / (2 * np.sqrt(3)), rel=1e-6)
    assert load[at] == 1.0  # and it may be as large as one likes
    assert factor * other[end] == pytest.approx(-1.0)
    assert load[at - 1] == pytest.approx(-0.268, abs=1e-3)


def test_each_line_with_corners_is_told_the_sharpest_first():
    """Angles, share, life by the slope of the curve of the weld, and the way out."""
    some = [
        replace(bent(91)[0], weld="right"),
        replace(straight([10.0] * 4), weld="straight"),
        replace(bent(135)[0], weld="sharp"),
        replace(ring(4), weld="square"),
        replace(bent(30)[0], weld="smooth"),
        replace(ring(12), weld="ring"),
    ]
    found = summed_corners(stacked(some), [3.60855] * 6, "weld_nodes.csv")
    assert {problem.code for problem in found} == {"summed_corner"}
    assert [problem.where for problem in found] == [
        "weld_nodes.csv: weld sharp, node 109 (135 degrees)",
        "weld_nodes.csv: weld right, node 109 (91 degrees)",
        "weld_nodes.csv: weld square, node 101 (90 degrees), 102 (90 degrees), 103 (90 degrees) and 1 more",
    ]
    assert "more than 30 degrees" in found[0].what
    assert "is read as 0.38 of it (life x 32)" in found[0].what
    assert "is read as 0.71 of it (life x 3.49)" in found[2].what
    assert found[0].remedy.startswith("Give element_forces with weld_elements")
    assert summed_corners(stacked(some[4:]), [3.0, 3.0], "weld_nodes.csv") == []
