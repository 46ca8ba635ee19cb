"""Lengths along polylines and distances from them."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fatigue.weld.along.polyline import Polyline

CORNER = Polyline(np.array([[0.0, 0, 0], [10, 0, 0], [10, 5, 0]]))


def test_lengths_and_places():
    """Piece by piece; a closed polyline goes back to its first point."""
    assert CORNER.at.tolist() == [0.0, 10.0, 15.0]
    np.testing.assert_allclose(CORNER.point(12.0), [10, 2, 0])
    closed = Polyline(CORNER.points, closed=True)
    np.testing.assert_allclose(closed.at[-1], 15.0 + np.hypot(10, 5))


def test_distances():
    """From the nearest piece, and the length along it."""
    off, at = CORNER.nearest(np.array([[4.0, 3.0, 0.0], [13.0, 4.0, 0.0], [-3.0, 0.0, 4.0]]))
    np.testing.assert_allclose(off, [3.0, 3.0, 5.0])
    np.testing.assert_allclose(at, [4.0, 14.0, 0.0])


def test_corners():
    """By the angle; of a closed polyline its first point may be one."""
    assert CORNER.corners(20.0) == [1]
    assert Polyline(CORNER.points, closed=True).corners(20.0) == [0, 1, 2]


@given(st.floats(0.0, 15.0), st.floats(0.0, 15.0))
def test_a_stretch_has_the_length_it_is_asked_for(a, b):
    """Between two lengths along it, corners in between kept."""
    first, last = sorted((a, b))
    part = CORNER.between(first, last)
    np.testing.assert_allclose(part.at[-1], last - first, atol=1e-9)
    off, _ = CORNER.nearest(part.points)
    assert off.max() < 1e-9
