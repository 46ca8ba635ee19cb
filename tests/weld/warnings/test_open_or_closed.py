"""Rings that are given as open, and open lines that are given as closed, are told."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from fatigue.weld.line import stacked
from fatigue.weld.line_check import line_warnings
from fatigue.weld.warnings.open_or_closed import seems_closed, seems_open
from tests.weld_lines import lines, reversed_line, ring, shifted, straight, weld_line

WHERE = "nodes.csv, weld W1"


def part_of_ring(n, nodes, **given):
    """The first nodes of a ring of n."""
    columns = ("order", "node", "xyz", "thickness", "normal", "outward", "edge_mid")
    whole = ring(n, **given)
    return replace(whole, **{name: getattr(whole, name)[:nodes] for name in columns}, closed=False)


def square(edges):
    """A closed square with so many edges of 10 mm on each side."""
    at = np.arange(edges)
    sides = [(at, 0 * at), (edges + 0 * at, at), (edges - at, edges + 0 * at), (0 * at, edges - at)]
    xy = np.concatenate([np.column_stack(side) for side in sides])
    return weld_line(10.0 * np.column_stack([xy, 0 * xy[:, 0]]), outward=[0.3, 1.0, 0.0], closed=True)


def codes(line):
    """Codes of the warnings about a line."""
    return [problem.code for problem in line_warnings(line, WHERE)]


@pytest.mark.parametrize("n", [4, 6, 12, 48])
def test_a_ring_that_is_not_closed(n):
    """Its ends lie one edge apart."""
    open_ring = part_of_ring(n, n)
    assert codes(open_ring) == ["not_closed"]
    assert codes(replace(open_ring, closed=True)) == []
    (warning,) = line_warnings(open_ring, WHERE)
    assert f"node {100 + n} (order {n})" in warning.where
    gap = 200 * np.sin(np.pi / n)
    assert f"the ends of the line lie {gap:.3g} mm apart, less than 1.5 edges of {gap:.3g} mm" in warning.what


def test_a_square_that_is_not_closed_wherever_it_begins():
    """At a corner or amid a side, forwards and backwards, of one edge a side or several."""
    for edges in (1, 2, 5):
        for by in range(edges):
            line = replace(shifted(square(edges), by), closed=False)
            assert seems_closed(line).all()
            assert seems_closed(reversed_line(line)).all()


def test_ends_at_one_place():
    """Two nodes that were never merged: the line runs round."""
    line = part_of_ring(12, 12)
    xyz = np.vstack([line.xyz, line.xyz[:1]])
    assert codes(weld_line(xyz, outward=xyz)) == ["not_closed"]


@pytest.mark.parametrize(
    "line",
    [
        part_of_ring(12, 10),
        part_of_ring(24, 12),
        straight([10.0] * 3),
        straight([10.0, 0.9, 0.9, 0.9], thickness=1.0),
        weld_line([[0, 0, 0], [10, 0, 0], [10, 10, 0]], outward=[-1.0, 1, 0]),
        weld_line([[0, 0, 0], [10, 0, 0], [20, 0, 0], [20, 20, 0], [10, 20, 0], [0, 20, 0]], outward=[1.0, 1, 0]),
    ],
)
def test_open_lines(line):
    """Two edges missing, half a ring, straight ones with long and short edges, a corner, a wide U."""
    assert not seems_closed(line).any()


@given(lines(closed=True))
@settings(deadline=None, max_examples=40)
def test_closed_lines_are_closed(line):
    """With linear and parabolic edges, unless the last edge is more than twice as long as every other."""
    corners = line.xyz[~line.edge_mid]
    *others, last = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    assert seems_open(line).any() == (last > 2.0 * max(others))


def test_a_closed_line_with_a_gap():
    """Half a ring is closed by its diameter."""
    half = replace(part_of_ring(24, 12), closed=True)
    assert codes(half) == ["far_closing_edge"]
    (warning,) = line_warnings(half, WHERE)
    assert "the line is closed by an edge of 198 mm, more than 2 times the longest other edge, 26.1 mm" in warning.what


def test_a_stack_of_both():
    """Each line is judged by its own edges."""
    some = [ring(12), part_of_ring(12, 12), straight([10.0] * 4), replace(part_of_ring(24, 12), closed=True), square(3)]
    assert seems_closed(stacked(some)).tolist() == [False, True, False, False, False]
    assert seems_open(stacked(some)).tolist() == [False, False, False, True, False]
