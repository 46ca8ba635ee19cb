"""The consistent line load and the treatment of weld ends."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.weld.line_geometry import arc_length, edges, length
from fatigue.weld.line_load import line_load, line_load_matrix, treat_ends
from tests import naive_weld
from tests.weld_lines import fields, lines, reversed_line, ring, shifted, straight, weld_line


def test_matrix_of_a_linear_edge():
    """A linear edge has l/6 [[2, 1], [1, 2]]."""
    np.testing.assert_allclose(line_load_matrix(straight([12.0])).toarray(), [[4, 2], [2, 4]], rtol=1e-14)


def test_matrix_of_a_parabolic_edge():
    """A straight parabolic edge with a central mid node has l/30 [[4, 2, -1], [2, 16, 2], [-1, 2, 4]]."""
    line = straight([15.0, 15.0], edge_mid=[0, 1, 0])
    np.testing.assert_allclose(line_load_matrix(line).toarray(), [[4, 2, -1], [2, 16, 2], [-1, 2, 4]], atol=1e-13)


def test_matrix_of_a_ring_wraps():
    """A closed line has no end rows: every row sums to its node's two half edges."""
    np.testing.assert_allclose(line_load_matrix(ring(12)).sum(axis=1), length(ring(12)) / 12, rtol=1e-13)


@given(lines())
@settings(deadline=None, max_examples=8)
def test_matrix_against_quadrature(line):
    """Linear, parabolic, mixed, straight, curved, open and closed lines agree with adaptive quadrature."""
    expected = naive_weld.line_load_matrix(line)
    np.testing.assert_allclose(line_load_matrix(line).toarray(), expected, atol=1e-8 * expected.max())


@given(lines(least=2))
@settings(deadline=None, max_examples=25)
def test_solution_against_a_dense_solver(line):
    """The banded factorisation, folded for closed lines, solves what a dense solver solves, for all columns."""
    nodal = fields(line, 3, 2)
    load = line_load(line, nodal)
    dense = np.linalg.solve(line_load_matrix(line).toarray(), nodal.reshape(line.node.size, -1))
    assert load.shape == nodal.shape
    np.testing.assert_allclose(load.reshape(dense.shape), dense, rtol=1e-10, atol=1e-12 * np.abs(dense).max())


@given(lines())
@settings(deadline=None, max_examples=25)
def test_line_load_keeps_force_and_first_moment(line):
    """Line load and nodal forces have the same resultant force and moment about the origin, on any line."""
    force = fields(line, 3)
    load = line_load(line, force)
    total, moment = np.zeros(3), np.zeros(3)
    gauss, weight = np.polynomial.legendre.leggauss(12)
    for edge in edges(line):
        shape, _, speed = naive_weld.edge_functions(line, edge)
        for xi, w in zip(gauss, weight, strict=True):
            N = [function(xi) for function in shape]
            f, at = N @ load[list(edge)], N @ line.xyz[list(edge)]
            total += w * speed(xi) * f
            moment += w * speed(xi) * np.cross(at, f)
    scale = np.abs(force).sum()
    np.testing.assert_allclose(total, force.sum(axis=0), atol=1e-9 * scale)
    np.testing.assert_allclose(moment, np.cross(line.xyz, force).sum(axis=0), atol=1e-9 * scale * 200)


@given(lines(closed=True), st.integers(1, 7))
@settings(deadline=None, max_examples=20)
def test_line_load_does_not_depend_on_the_start_of_a_ring(line, by):
    """A ring that begins elsewhere has the same line load."""
    nodal = fields(line, 2)
    expected = np.roll(line_load(line, nodal), -by, axis=0)
    np.testing.assert_allclose(line_load(shifted(line, by), np.roll(nodal, -by, axis=0)), expected, rtol=1e-9)


def test_single_precision_forces_are_solved_in_double():
    """Forces stored in single precision lose nothing more in the solution."""
    line, nodal = straight([1, 2, 3]), np.array([1, 2, 3, 4], dtype=np.float32)
    np.testing.assert_array_equal(line_load(line, nodal), line_load(line, nodal.astype(np.float64)))


def test_zone_of_one_thickness():
    """Without an end length the mean is taken over one plate thickness; nodes beyond keep their value."""
    line = straight([4, 4, 4, 4, 4, 4], thickness=[8, 8, 8, 8, 8, 4, 4])
    ends = treat_ends(line, np.array([6.0, 2, 1, 1, 1, 3, 7]))
    np.testing.assert_allclose(ends.value, [2.75, 2.75, 2.75, 1, 1, 5, 5], rtol=1e-14)
    assert ends.at_end.tolist() == [True, True, True, False, False, True, True]
    assert not ends.unresolved.any()


def test_zone_that_ends_within_an_edge():
    """The mean over [0, a] weighs the part of the edge it covers: over 2 mm of a 4 mm edge, 5.0 of 6 falling to 2."""
    ends = treat_ends(straight([4, 4, 4], end_length=2.0), np.array([6.0, 2, 2, 2]))
    np.testing.assert_allclose(ends.value, [5, 2, 2, 2], rtol=1e-14)
    assert ends.unresolved.tolist() == [True, False, False, True]


def test_zone_is_at_most_half_the_line():
    """On a short line both zones meet at the middle node, which takes the mean of both."""
    ends = treat_ends(straight([5, 5], end_length=100.0), np.array([4.0, 2, 8]))
    np.testing.assert_allclose(ends.value, [3, 4, 5], rtol=1e-14)
    assert ends.at_end.all()


def test_an_end_length_of_zero_treats_nothing():
    """Without treatment the values stay; the end nodes are marked all the same."""
    load = np.array([6.0, 2, 1])
    ends = treat_ends(straight([4, 4], end_length=0.0), load)
    np.testing.assert_array_equal(ends.value, load)
    assert ends.at_end.tolist() == [True, False, True]
    assert not ends.unresolved.any()


def test_corner_ends_are_treated_but_are_no_weld_ends():
    """The solution is singular at a corner too, but a corner is no end of the weld."""
    line = replace(straight([4, 4, 4, 4], end_length=4.0), corner_start=True)
    ends = treat_ends(line, np.array([6.0, 2, 1, 1, 3]))
    np.testing.assert_allclose(ends.value, [4, 4, 1, 2, 2], rtol=1e-14)
    assert ends.at_end.tolist() == [False, False, False, True, True]


def test_closed_lines_have_no_ends():
    """A ring is not treated."""
    line = ring(12)
    ends = treat_ends(line, fields(line, 2))
    np.testing.assert_array_equal(ends.value, fields(line, 2))
    assert not (ends.at_end | ends.unresolved).any()


def test_zone_on_an_edge_with_an_off_centre_mid_node():
    """Arc length, not the local coordinate, bounds the zone: the mean of f = s over [0, 3] is 1.5."""
    line = straight([3, 6, 20], edge_mid=[0, 1, 0, 0], end_length=3.0)
    ends = treat_ends(line, arc_length(line))
    np.testing.assert_allclose(ends.value[:2], 1.5, rtol=1e-12)


@given(lines(closed=False))
@settings(deadline=None, max_examples=10)
def test_end_values_against_quadrature(line):
    """On any line the treated end value is the mean of the interpolated line load over the zone."""
    load = fields(line)
    a = min(line.thickness[0] if line.end_length is None else line.end_length, length(line) / 2)
    value = treat_ends(line, load).value
    if a > 0:
        first, last = naive_weld.mean_load(line, load, a), naive_weld.mean_load(reversed_line(line), load[::-1], a)
    else:
        first, last = load[0], load[-1]
    assert value[0] == pytest.approx(first, rel=1e-8, abs=1e-9)
    assert value[-1] == pytest.approx(last, rel=1e-8, abs=1e-9)


@given(lines(closed=False))
@settings(deadline=None, max_examples=30)
def test_end_treatment_is_symmetric(line):
    """Numbered the other way round, a line has the same treated values and marks."""
    load = fields(line, 2)
    forward, backward = treat_ends(line, load), treat_ends(reversed_line(line), load[::-1])
    np.testing.assert_allclose(backward.value[::-1], forward.value, atol=1e-9)
    np.testing.assert_array_equal(backward.at_end[::-1], forward.at_end)
    np.testing.assert_array_equal(backward.unresolved[::-1], forward.unresolved)


@given(lines(closed=False), st.floats(-5, 5))
@settings(deadline=None, max_examples=20)
def test_a_constant_load_has_no_ends(line, value):
    """The mean of a constant is the constant."""
    load = np.full(line.node.size, value)
    np.testing.assert_allclose(treat_ends(line, load).value, load, rtol=1e-12, atol=1e-15)


def test_zones_meet_on_a_curved_line():
    """On a parabolic arc with zones of half the line, both means together are the mean of the whole."""
    angle = np.linspace(0, np.pi / 2, 7)
    line = weld_line(
        100 * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]),
        outward=(1, 1, 0),
        edge_mid=[0, 1, 0, 1, 0, 1, 0],
        end_length=1000.0,
    )
    load = fields(line)
    value = treat_ends(line, load).value
    weights = line_load_matrix(line).sum(axis=0)
    assert (value[0] + value[-1]) / 2 == pytest.approx(weights @ load / length(line), rel=1e-9)
