"""Nodal forces of parabolic elements on a line without mid-side nodes are recognised, and nothing else is."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.weld.edge_type import edge_type_warnings
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
        replace(straight([10.0] * 8), edge_mid=np.array([0, 1, 0, 0, 0, 0, 0, 1, 0], dtype=bool)),
    ],
)
def test_lines_that_cannot_be_parabolic_or_say_so_are_left_alone(line):
    """Too short, an odd number of edges, nodes far from any middle, or mid-side nodes already marked."""
    zigzag = line_load_matrix(replace(line, edge_mid=np.zeros_like(line.edge_mid))) @ (np.arange(line.node.size) % 2)
    assert edge_type_warnings(line, zigzag, WHERE) == []
