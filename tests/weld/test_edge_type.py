"""Nodal forces that fit other mid-side nodes than a line marks are recognised, and nothing else is."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.weld.edge_type import edge_type_warnings, jumpy_lines
from fatigue.weld.line import stacked
from fatigue.weld.line_geometry import arc_length
from fatigue.weld.line_load import line_load, line_load_matrix
from tests.weld_lines import ring, shifted, straight

WHERE = "nodal_forces.csv, weld W1"


def parabolic(line, first=1):
    """Mark every other node as a mid-side node."""
    return replace(line, edge_mid=np.arange(line.node.size) % 2 == first)


def smooth_load(line, columns=6, seed=0):
    """A line load of two waves and a rise towards the first node, (n, columns)."""
    rng = np.random.default_rng(seed)
    s = arc_length(line)[:, np.newaxis] / (arc_length(line)[-1])
    waves = sum(rng.normal(size=columns) / k * np.cos(k * np.pi * s + rng.uniform(0, 6, columns)) for k in (1, 2))
    return waves + rng.normal(size=columns) / np.sqrt(s + 0.1)


def test_the_trap():
    """A constant parabolic load solved on linear edges is 0, 2, 0, 2, ...: twice the stress at every other node."""
    line = straight([10.0] * 8)
    nodal = line_load_matrix(parabolic(line)) @ np.ones(9)
    np.testing.assert_allclose(line_load(line, nodal), [0, 2, 0, 2, 0, 2, 0, 2, 0], atol=1e-12)


@pytest.mark.parametrize("line", [straight([10.0] * 8), straight(np.repeat([5.0, 8, 12, 6], 2)), ring(24)])
def test_a_constant_parabolic_load_is_recognised(line):
    """On even, uneven and closed lines the warning names the place and the column to fill."""
    nodal = line_load_matrix(parabolic(line)) @ np.ones((line.node.size, 6))
    (warning,) = edge_type_warnings(line, nodal, WHERE)
    assert warning.code == "edge_type"
    assert str(warning) == (
        "nodal_forces.csv, weld W1: the line load jumps up and down from node to node, and would not if every other "
        "node were the mid-side node of a parabolic edge. "
        "Mark the mid-side nodes in edge_mid if the elements have them."
    )


@pytest.mark.parametrize("seed", range(20))
def test_smooth_parabolic_loads_are_recognised(seed):
    """So are loads that vary along the line and rise towards its end."""
    line = straight(np.repeat(np.random.default_rng(seed).uniform(5, 15, 6), 2))
    nodal = line_load_matrix(parabolic(line)) @ smooth_load(line, seed=seed)
    assert len(edge_type_warnings(line, nodal, WHERE)) == 1


def test_a_ring_may_begin_at_a_mid_node():
    """On closed lines both phases are tried."""
    line = parabolic(shifted(ring(24), 1), first=0)
    nodal = line_load_matrix(line) @ smooth_load(line)
    assert len(edge_type_warnings(replace(line, edge_mid=np.zeros(24, dtype=bool)), nodal, WHERE)) == 1


@pytest.mark.parametrize("seed", range(20))
def test_rough_linear_lines_are_not_accused(seed):
    """Neither random line loads, nor random nodal forces, nor smooth loads on linear edges raise the warning."""
    rng = np.random.default_rng(seed)
    n = int(rng.choice([5, 7, 9, 21]))
    line = straight(np.repeat(rng.uniform(5, 15, n // 2), 2))
    rough = rng.normal(size=(n, 6))
    for nodal in (rough, line_load_matrix(line) @ rough, line_load_matrix(line) @ smooth_load(line, seed=seed)):
        assert edge_type_warnings(line, nodal, WHERE) == []


@pytest.mark.parametrize(
    "line",
    [
        straight([10.0] * 2),
        straight([10.0] * 7),
        straight([10.0, 2, 10, 2, 10, 2]),
        parabolic(straight([10.0] * 8)),
    ],
)
def test_lines_that_cannot_be_parabolic_or_say_so_are_left_alone(line):
    """Too short, an odd number of edges, nodes far from any middle, or all mid-side nodes marked already."""
    zigzag = line_load_matrix(replace(line, edge_mid=np.zeros_like(line.edge_mid))) @ (np.arange(line.node.size) % 2)
    assert edge_type_warnings(line, zigzag, WHERE) == []


def marked(line, *at):
    """Mark these nodes, and no others, as mid-side nodes."""
    return replace(line, edge_mid=np.isin(np.arange(line.node.size), at))


def test_the_opposite_trap():
    """A constant load of linear edges solved on parabolic ones is 2.25, 0.375, 2.25, ... inside a line."""
    line = straight([10.0] * 40)
    load = line_load(parabolic(line), line_load_matrix(line) @ np.ones(41))
    np.testing.assert_allclose(load, np.where(np.arange(41) % 2, 0.375, 2.25), rtol=1e-12)


@pytest.mark.parametrize(
    ("line", "at"),
    [
        (straight([10.0] * 8), (1, 3, 5, 7)),
        (straight([10.0] * 20), (9,)),
        (straight([10.0] * 20), (1,)),
        (straight([10.0] * 20), (19,)),
        (straight([10.0] * 20), (1, 3, 5, 17)),
        (straight([10.0] * 7), (1, 3)),
        (straight([10.0] * 2), (1,)),
        (straight([10.0, 10, 8, 9, 12, 12, 9, 8]), (1, 5)),
        (ring(24), tuple(range(0, 24, 2))),
        (ring(24), (0, 13)),
    ],
)
def test_marks_on_linear_edges_are_recognised(line, at):
    """All nodes, one, the first, the last, a few, of a ring: the marks that are wrong are counted."""
    nodal = line_load_matrix(line) @ np.ones((line.node.size, 6))
    (warning,) = edge_type_warnings(marked(line, *at), nodal, WHERE)
    more = f" and {len(at) - 1} more" if len(at) > 1 else ""
    assert f"if node {101 + at[0]}{more} marked in edge_mid" in warning.what
    assert warning.remedy.startswith("Take the marks in edge_mid away")


@pytest.mark.parametrize("forgotten", [(9,), (1,), (19,), (5, 7), (1, 3, 5, 7, 9), (3, 13)])
@pytest.mark.parametrize("line", [straight([10.0] * 20), straight(np.repeat([8.0, 12, 10, 9, 11] * 2, 2))])
def test_mid_side_nodes_that_are_not_marked_beside_others_are_recognised(line, forgotten):
    """One, the first, the last, neighbours, half of a line, two apart."""
    nodal = line_load_matrix(parabolic(line)) @ np.ones((line.node.size, 6))
    (warning,) = edge_type_warnings(marked(line, *(set(range(1, 20, 2)) - set(forgotten))), nodal, WHERE)
    more = f" and {len(forgotten) - 1} more" if len(forgotten) > 1 else ""
    assert f"if node {101 + forgotten[0]}{more} were also a mid-side node" in warning.what
    assert warning.remedy.startswith("Mark the mid-side nodes")


def test_parabolic_edges_of_half_a_line_are_recognised():
    """Where none is marked, and the other half is linear."""
    line = straight([10.0] * 20)
    nodal = line_load_matrix(marked(line, 1, 3, 5, 7, 9)) @ np.ones((21, 6))
    (warning,) = edge_type_warnings(line, nodal, WHERE)
    assert "if node 102 and 4 more were also a mid-side node" in warning.what


@pytest.mark.parametrize("seed", range(20))
def test_marked_lines_that_are_right_are_not_accused(seed):
    """Mixed, linear and parabolic ones, under smooth loads, random loads and random forces."""
    rng = np.random.default_rng(seed)
    is_parabolic = rng.random(8) < rng.choice([0.0, 0.5, 1.0])
    edge = rng.uniform(8, 16, 8)
    steps = np.concatenate([[a / 2, a / 2] if p else [a / 2] for a, p in zip(edge, is_parabolic, strict=True)])
    mid = np.concatenate([[False], *([True, False] if p else [False] for p in is_parabolic)])
    line = replace(straight(steps), edge_mid=mid)
    rough = rng.normal(size=(line.node.size, 6))
    for nodal in (rough, line_load_matrix(line) @ rough, line_load_matrix(line) @ smooth_load(line, seed=seed)):
        assert edge_type_warnings(line, nodal, WHERE) == []


def test_a_stack_finds_the_jumpy_lines():
    """Marked wrongly, unmarked and right ones, together."""
    line = straight([10.0] * 20)
    right, wrong = line_load_matrix(line) @ np.ones((21, 6)), line_load_matrix(parabolic(line)) @ np.ones((21, 6))
    stack = stacked([line, marked(line, 9), line, parabolic(line)])
    nodal = np.concatenate([right, right, wrong, wrong])
    assert jumpy_lines(stack, line_load(stack, nodal)).tolist() == [1, 2]
