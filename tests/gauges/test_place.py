"""Where a gauge sits: nearest element of a like normal that contains the point; elements under a long grid."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.gauges.element_row import BOTTOM, TOP
from fatigue.gauges.place import contains, crossed, located, shells_of
from fatigue.readers.neutral.body.mesh import Mesh
from tests.gauge_case import ELEMENTS, NODES, T

UP = np.array([0.0, 0.0, 1.0])


def mesh():
    """The plate of the small case with gauges."""
    node = np.array(sorted(NODES))
    corners = np.zeros((len(ELEMENTS), 8), dtype=np.int64)
    for row, (ids, _) in enumerate(ELEMENTS.values()):
        corners[row, : len(ids)] = ids
    xyz = np.array([NODES[n] for n in node])
    pid = np.array([pid for _, pid in ELEMENTS.values()])
    return Mesh(node, xyz, np.array(list(ELEMENTS)), corners, pid, np.full(len(corners), T))


@pytest.fixture(scope="module")
def shells():
    """Its shells."""
    return shells_of(mesh())


def test_the_sign_of_the_normal_picks_the_face(shells):
    """Seen from above it is the top of element 102, from below its bottom; the distance is from the mid-surface."""
    above = located(shells, np.array([30.0, 1005.0, 1.0]), UP, "here")
    assert (shells.element[above.index], above.face, above.distance) == (102, TOP, 1.0)
    below = located(shells, np.array([30.0, 1005.0, -1.5]), -UP, "here")
    assert (shells.element[below.index], below.face, below.distance) == (102, BOTTOM, 1.5)


def test_of_two_plates_at_one_place_the_alike_and_nearest_counts(shells):
    """Two elements lie on each other: the first by id; the upright flange is found by its own normal."""
    spot = located(shells, np.array([10.0, 1005.0, 1.0]), UP, "here")
    assert shells.element[spot.index] == 101
    flange = located(shells, np.array([5.0, 999.0, 4.0]), np.array([0.0, -1.0, 0.1]), "here")
    assert (shells.element[flange.index], flange.face) == (106, TOP)


@pytest.mark.parametrize(("degrees", "is_found"), [(19.9, True), (20.1, False)])
def test_the_normal_may_be_20_degrees_off(shells, degrees, is_found):
    """And no more."""
    tilt = np.deg2rad(degrees)
    normal, at = np.array([np.sin(tilt), 0.0, np.cos(tilt)]), np.array([30.0, 1005.0, 1.0])
    if is_found:
        assert shells.element[located(shells, at, normal, "here").index] == 102
    else:
        with pytest.raises(DataError, match="no element whose normal is within 20 degrees"):
            located(shells, at, normal, "here")


def test_a_point_beside_all_elements_is_refused_with_the_nearest(shells):
    """The message names the nearest of those that look the same way."""
    with pytest.raises(DataError, match=r"the middle of the nearest such element, 101, is 55.9 mm away"):
        located(shells, np.array([-40.0, 1030.0, 0.0]), UP, "here")


def test_edges_and_corners_belong_to_the_elements():
    """A point on an edge is contained; one a little outside is not."""
    square = np.array([[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]])
    for at, inside in (((10.0, 5.0), True), ((0.0, 0.0), True), ((10.01, 5.0), False), ((5.0, -0.01), False)):
        assert bool(contains(square, np.array([at]))[0]) is inside
    triangle = np.array([[[0.0, 0.0], [10.0, 0.0], [0.0, 10.0], [0.0, 10.0]]])
    assert bool(contains(triangle, np.array([[4.0, 4.0]]))[0])
    assert not bool(contains(triangle, np.array([[6.0, 6.0]]))[0])


def test_a_long_grid_is_shared_by_length(shells):
    """Of 20 to 50 mm along x, element 102 has 20 mm and element 103 the rest; 101, where it begins, has nothing."""
    centre = np.array([35.0, 1005.0, 0.0])
    spot = located(shells, centre, UP, "here")
    found = dict(crossed(shells, spot, centre, np.array([1.0, 0.0, 0.0]), 30.0, "here"))
    by_id = {int(shells.element[index]): share for index, share in found.items()}
    assert by_id == pytest.approx({102: 2 / 3, 103: 1 / 3})


def test_a_grid_at_an_angle_and_along_an_edge(shells):
    """Across the corner of an element, and along the common edge of two: each length counts once."""
    centre = np.array([20.0, 1005.0, 0.0])
    spot = located(shells, centre, UP, "here")
    slanted = np.array([1.0, 0.5, 0.0]) / np.sqrt(1.25)
    shares = dict(crossed(shells, spot, centre, slanted, 8.0, "here"))
    assert sorted(shares.values()) == pytest.approx([0.5, 0.5])
    along = dict(crossed(shells, spot, centre, np.array([0.0, 1.0, 0.0]), 8.0, "here"))
    assert sum(along.values()) == pytest.approx(1.0)


def test_a_grid_that_leaves_the_plate_is_refused(shells):
    """The message says how far from its middle."""
    centre = np.array([30.0, 1005.0, 0.0])
    spot = located(shells, centre, UP, "here")
    with pytest.raises(DataError, match="its grid of 16 mm leaves the plate 5 mm from its middle"):
        crossed(shells, spot, centre, np.array([0.0, 1.0, 0.0]), 16.0, "here")
