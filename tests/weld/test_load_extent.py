"""How large the forces of weld lines are."""

from dataclasses import replace

import numpy as np

from fatigue.weld.line import stacked
from fatigue.weld.load_extent import load_extent, of_welds
from tests.weld_lines import straight

LINE = straight([10.0] * 4, thickness=5.0)  # 5 nodes, 40 mm


def test_line_force_by_hand():
    """3, 4 and 0 N at every node and 10 N mm over 5 mm: 5 x (7 + 2) N on 40 mm."""
    forces = np.zeros((5, 2, 6))
    forces[:, 0, :4] = 3.0, 4.0, 0.0, 10.0
    found = load_extent(LINE, forces)
    assert found.line_force.tolist() == [[45.0 / 40.0, 0.0]]
    assert found.largest.tolist() == [[3.0, 4.0, 0.0, 10.0, 0.0, 0.0]]
    assert not found.across_plate[0]
    assert found.flat_axis == 2


def test_bare_nodes_are_counted():
    """Nodes without any force in any mode, with one of them by name."""
    forces = np.ones((5, 2, 6))
    forces[1:3] = 0.0
    forces[4, 0] = 0.0  # not in the other mode
    found = load_extent(LINE, forces)
    assert (found.bare.tolist(), found.first_bare.tolist()) == ([2], [102])


def test_forces_across_the_plate():
    """In the plane of an oblique plate nothing acts across it but rounding."""
    normal = np.array([1.0, 2.0, -2.0]) / 3.0
    oblique = replace(LINE, normal=np.tile(7.0 * normal, (5, 1)))
    in_plane = np.cross(normal, [0.3, 0.5, 0.1])
    forces = np.zeros((5, 1, 6))
    forces[..., :3] = in_plane
    assert not load_extent(oblique, forces).across_plate[0]
    assert load_extent(oblique, forces + 1e-5 * np.array([*normal, 0, 0, 0])).across_plate[0]
    assert load_extent(oblique, forces).flat_axis is None


def test_parts_of_a_weld_are_taken_together():
    """The largest of all parts is that of the weld; bare nodes add up; welds keep their order."""
    other = replace(LINE, weld="W2")
    parts = stacked([LINE, replace(LINE, part=2), other])
    forces = np.concatenate([np.full((5, 1, 6), 1.0), np.full((5, 1, 6), 2.0), np.zeros((5, 1, 6))])
    forces[[0, 7]] = 0.0
    found = of_welds([load_extent(parts, forces), load_extent(other, np.full((5, 1, 6), 3.0))])
    assert found.weld == ("W1", "W2")
    assert found.largest[:, 0].tolist() == [2.0, 3.0]
    assert found.bare.tolist() == [2, 5]


def test_no_force_is_too_large_or_too_small():
    """Squares that overflow or vanish do not matter."""
    for size in (1e300, 1e-300):
        found = load_extent(LINE, np.full((5, 1, 6), size))
        assert found.line_force[0, 0] > 0.1 * size
