"""The geometry of weld lines: edges, arc length, local axes, kinks and parts."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.weld.line import stacked
from fatigue.weld.line_geometry import (
    arc_length,
    corners,
    edge_nodes,
    edges,
    kink_angles,
    length,
    local_axes,
    split_at_kinks,
    unit,
)
from tests import naive_weld
from tests.weld_lines import lines, moved, reversed_line, ring, rotations, shifted, straight, weld_line

SQUARE = [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]]
MIDDLE = [5.0, 5.0, 0.0]


def square(per_side=2, **given):
    """Build a closed square of side 10 with ``per_side`` edges each, the plate outside."""
    corner = np.array(SQUARE, dtype=float)
    steps = np.arange(per_side)[:, np.newaxis] / per_side
    xyz = np.concatenate([a + steps * (b - a) for a, b in zip(corner, np.roll(corner, -1, axis=0), strict=True)])
    return weld_line(xyz, outward=MIDDLE - xyz, closed=True, **given)


def test_edges_of_an_open_mixed_line():
    """A mid-side node joins its two neighbours to one parabolic edge."""
    line = straight([1, 1, 2, 3, 3], edge_mid=[0, 1, 0, 0, 1, 0])
    assert edges(line) == [(0, 1, 2), (2, 3), (3, 4, 5)]


def test_edges_of_a_closed_line_that_begins_at_a_mid_node():
    """The edges of a ring wrap, and its first node may be a mid-side node."""
    assert edges(ring(4, edge_mid=[1, 0, 1, 0])) == [(1, 2, 3), (3, 0, 1)]
    assert edges(ring(3)) == [(0, 1), (1, 2), (2, 0)]


def test_arc_length_of_straight_lines():
    """Off-centre mid nodes keep their true distance."""
    line = straight([1, 3, 2.5], edge_mid=[0, 1, 0, 0])
    np.testing.assert_allclose(arc_length(line), [0, 1, 4, 6.5], rtol=1e-14)
    assert length(line) == pytest.approx(6.5, rel=1e-14)


def test_length_of_a_ring():
    """A ring of chords counts the way back to its first node; parabolic edges follow the circle to fourth order."""
    assert length(ring(12)) == pytest.approx(12 * 200 * np.sin(np.pi / 12), rel=1e-14)
    assert length(ring(24, edge_mid=np.arange(24) % 2)) == pytest.approx(200 * np.pi, rel=1e-4)
    assert arc_length(ring(12))[-1] == pytest.approx(11 * 200 * np.sin(np.pi / 12), rel=1e-14)


@given(lines())
@settings(deadline=None, max_examples=20)
def test_arc_length_against_quadrature(line):
    """Arc lengths agree with adaptive quadrature along every edge."""
    s, total = naive_weld.arc_length(line)
    np.testing.assert_allclose(arc_length(line), s, atol=1e-9 * total)
    assert length(line) == pytest.approx(total, rel=1e-9)


def test_axes_of_a_straight_line():
    """On a line along x with the plate at negative y: y' = y, z' = z, x' = y' x z' = x."""
    np.testing.assert_array_equal(local_axes(straight([1, 2]))[1], np.eye(3))
    np.testing.assert_array_equal(
        local_axes(straight([1, 2], outward=(0, -1, 0)))[1], [[-1, 0, 0], [0, -1, 0], [0, 0, 1]]
    )


def test_tangent_is_not_length_weighted():
    """At a kink between a long and a short edge the tangent halves the angle."""
    line = weld_line([[0, 0, 0], [100, 0, 0], [100, 1, 0]], outward=(-1, 1, 0))
    np.testing.assert_allclose(local_axes(line)[1, 0], [np.sqrt(0.5), np.sqrt(0.5), 0], atol=1e-15)


def test_plate_normal_is_kept():
    """A normal that is tilted along the line stays; x' and y' give way."""
    line = straight([1, 1], normal=(0.1, 0.0, 2.0))
    axes = local_axes(line)
    np.testing.assert_allclose(axes[:, 2], np.broadcast_to(np.array([0.1, 0, 2]) / np.hypot(0.1, 2), (3, 3)))
    np.testing.assert_allclose(axes[:, 1], np.broadcast_to([0, 1, 0], (3, 3)), atol=1e-15)


def test_axes_of_a_parabolic_arc():
    """On parabolic edges the tangent is dx/dxi: true to the circle at its mid nodes."""
    line = ring(8, edge_mid=np.arange(8) % 2)
    radial = line.xyz / 100
    np.testing.assert_allclose(local_axes(line)[:, 1], radial, atol=1e-14)


def test_outward_needs_a_part_across_the_line_only_once():
    """Beside a corner the outward vector of one leg may lie along the other."""
    parts = split_at_kinks(weld_line([[0, 0, 0], [10, 0, 0], [10, 10, 0]], outward=[[0, 1, 0], [0, 1, 0], [-1, 0, 0]]))
    np.testing.assert_allclose(local_axes(parts[1])[:, 1], [[-1, 0, 0], [-1, 0, 0]], atol=1e-15)


@given(lines(), rotations())
@settings(deadline=None, max_examples=25)
def test_axes_against_the_words_of_the_convention(line, rotation):
    """Vectorised axes agree with a loop over nodes, in any attitude, and are right-handed and orthonormal."""
    line = moved(line, rotation, np.array([1.0, -2.0, 3.0]))
    axes = local_axes(line)
    np.testing.assert_allclose(axes, naive_weld.local_axes(line), atol=1e-9)
    np.testing.assert_allclose(axes @ axes.swapaxes(1, 2), np.broadcast_to(np.eye(3), axes.shape), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(axes), 1, rtol=1e-12)


@given(lines())
@settings(deadline=None, max_examples=25)
def test_axes_do_not_depend_on_the_direction_of_the_line(line):
    """Numbered the other way round, a line has the same axes: y' follows outward and x' = y' x z'."""
    np.testing.assert_allclose(local_axes(reversed_line(line))[::-1], local_axes(line), atol=1e-12)


@given(lines(closed=True), st.integers(1, 7))
@settings(deadline=None, max_examples=25)
def test_axes_do_not_depend_on_the_start_of_a_ring(line, by):
    """A ring that begins elsewhere has the same axes and kinks."""
    np.testing.assert_allclose(local_axes(shifted(line, by)), np.roll(local_axes(line), -by, axis=0), atol=1e-12)
    np.testing.assert_allclose(kink_angles(shifted(line, by)), np.roll(kink_angles(line), -by), atol=1e-6)


def test_kink_angles():
    """A kink is the angle between the edges at a node; open ends and mid nodes have none."""
    line = weld_line([[0, 0, 0], [5, 0, 0], [10, 0, 0], [10, 10, 0]], outward=(-1, 1, 0), edge_mid=[0, 1, 0, 0])
    np.testing.assert_allclose(kink_angles(line), [0, 0, 90, 0], atol=1e-12)
    np.testing.assert_allclose(kink_angles(ring(8)), 45, rtol=1e-12)


def test_a_regular_12_gon_is_smooth_and_an_11_gon_is_not():
    """The limit is above 30 degrees, and the round-off of coordinates does not cross it."""
    assert not corners(ring(12)).any()
    assert corners(ring(11)).all()


def test_a_smooth_line_is_not_split():
    """Without corners the only part is the line itself."""
    line = ring(24)
    assert split_at_kinks(line) == (line,)


def test_an_open_line_is_split_at_its_corner():
    """Both parts keep the corner node and know at which end it is."""
    line = weld_line([[0, 0, 0], [5, 0, 0], [10, 0, 0], [10, 10, 0]], outward=(-1, 1, 0), edge_mid=[0, 1, 0, 0])
    first, second = split_at_kinks(line)
    assert (first.part, first.node.tolist(), first.corner_start, first.corner_end) == (1, [101, 102, 103], False, True)
    assert (second.part, second.node.tolist(), second.corner_start, second.corner_end) == (2, [103, 104], True, False)
    assert first.edge_mid.tolist() == [False, True, False]
    assert second.order.tolist() == [3, 4]


def test_a_loop_is_split_into_its_sides():
    """A square loop becomes four open parts that begin at its first corner, wherever its numbering begins."""
    parts = split_at_kinks(shifted(square(), 1))
    assert [part.node.tolist() for part in parts] == [
        [103, 104, 105],
        [105, 106, 107],
        [107, 108, 101],
        [101, 102, 103],
    ]
    assert all(part.corner_start and part.corner_end and not part.closed for part in parts)
    assert sum(length(part) for part in parts) == pytest.approx(length(square()), rel=1e-14)


def test_a_drop_becomes_one_open_part():
    """A loop with a single corner is cut open there: its corner node is both first and last."""
    angle = np.linspace(-0.75 * np.pi, 0.75 * np.pi, 11)
    arc = 10 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    tip = np.array([[-10 * np.sqrt(2), 0.0, 0.0]])
    drop = np.concatenate([arc, tip])
    (part,) = split_at_kinks(weld_line(drop, outward=drop, closed=True))
    assert part.node.tolist() == [112, *range(101, 112), 112]


def test_a_part_that_is_split_keeps_its_own_ends():
    """A part that begins at a corner still does after a further split."""
    line = replace(
        weld_line([[0, 0, 0], [10, 0, 0], [10, 10, 0]], outward=(-1, 1, 0)), corner_start=True, corner_end=True
    )
    assert [(part.corner_start, part.corner_end) for part in split_at_kinks(line)] == [(True, True), (True, True)]


@given(st.lists(lines(), min_size=1, max_size=4))
@settings(deadline=None, max_examples=20)
def test_geometry_of_a_stack(some):
    """Edges, arc lengths, axes and kinks are those of each line alone."""
    stack = stacked(some)
    nodes = [edge_nodes(line) for line in some]
    at = [np.where(e < 0, e, e + first) for e, first in zip(nodes, stack.begin, strict=False)]
    np.testing.assert_array_equal(edge_nodes(stack), np.concatenate(at))
    for of, tolerance in ((arc_length, 1e-12), (local_axes, 1e-13), (kink_angles, 1e-10)):
        np.testing.assert_allclose(of(stack), np.concatenate([of(line) for line in some]), atol=tolerance)


@given(st.lists(st.floats(-1.0, 1.0).filter(lambda x: abs(x) > 1e-3), min_size=3, max_size=3), st.integers(-900, 900))
def test_a_direction_does_not_depend_on_the_length_of_the_vector(vector, exponent):
    """Squares that overflow or vanish do no harm: the direction is the same to the last bit."""
    given_vector = np.array([vector, [0.0, 0.0, 0.0]])
    np.testing.assert_array_equal(unit(np.ldexp(given_vector, exponent)), unit(given_vector))


def test_directions_at_the_ends_of_double_precision():
    """The largest and the smallest number, and nothing at all."""
    vectors = np.array([[1.7e308, 0.0, 1.7e308], [0.0, 5e-324, 0.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(unit(vectors), [[0.5**0.5, 0.0, 0.5**0.5], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]], rtol=1e-15)
