"""How sure a reading is of its place: distance to a weld, a crooked grid, the elements beside it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.gauges.gauge_file import Gauge
from fatigue.gauges.grid import Grid, Piece
from fatigue.gauges.material import Material
from fatigue.gauges.near import angle_sensitivity, beside, distances, neighbours, rms
from fatigue.gauges.place import shells_of
from tests.gauge_case import NU, E, gauge_case
from tests.gauges.test_place import mesh
from tests.gauges.test_rows import rows_of, table


def grid(stress, angle, *, stand_in=False):
    """A grid at an angle under a stress (3, c)."""
    zero = np.zeros(3)
    return Grid(
        (Piece(1.0, np.asarray(stress, float), angle, Material(E, NU)),),
        angle,
        Material(E, NU),
        0.0,
        zero,
        zero,
        zero,
        2.0,
        "top",
        stand_in,
    )


def test_five_degrees_off_a_principal_direction_are_of_second_order():
    """Uniaxial tension: along it 1 - (1 + nu) sin^2 5, at 45 degrees the circle is steepest."""
    uniaxial, one = [[10.0], [0.0], [0.0]], np.eye(1)
    along = angle_sensitivity(grid(uniaxial, 0.0), one)
    assert along == pytest.approx((1 + NU) * np.sin(np.deg2rad(5.0)) ** 2)
    slanted = angle_sensitivity(grid(uniaxial, 45.0), one)
    mean, radius = (1 - NU) / 2, (1 + NU) / 2
    assert slanted == pytest.approx(radius * np.sin(np.deg2rad(10.0)) / mean)
    assert slanted > 20.0 * along


def test_the_larger_of_both_turns_counts_however_small_the_strain():
    """At 70 degrees to the tension 5 degrees on lose more than 5 degrees back gain, relative to what is read."""
    for size in (10.0, 1e-4):
        changes = []
        for turn in (-5.0, 5.0):
            e = [(1 - NU) / 2 + (1 + NU) / 2 * np.cos(2 * np.deg2rad(70.0 + t)) for t in (0.0, turn)]
            changes.append(abs(abs(e[1]) / abs(e[0]) - 1.0))
        assert abs(changes[0] - changes[1]) > 0.1
        found = angle_sensitivity(grid([[size], [0.0], [0.0]], 70.0), np.eye(1))
        assert found == pytest.approx(max(changes))


def test_a_stand_in_and_a_grid_at_rest_have_no_sensitivity():
    """There is nothing to turn."""
    assert np.isnan(angle_sensitivity(grid([[1.0], [0.3], [0.0]], 0.0, stand_in=True), np.eye(1)))
    assert np.isnan(angle_sensitivity(grid(np.zeros((3, 1)), 0.0), np.eye(1)))


@given(st.integers(0, 10_000))
def test_rms_is_that_of_the_history(seed):
    """From the covariance of the coordinates and from the reading itself."""
    rng = np.random.default_rng(seed)
    rows, q = rng.standard_normal((2, 3)), rng.standard_normal((3, 40)) + 5.0
    assert rms(rows, np.cov(q, bias=True)) == pytest.approx((rows @ q).std(axis=1))


def test_distance_from_an_edge_and_from_its_ends():
    """Beside the edge, beyond it, and from an edge without length."""
    begin, end = np.array([[0.0, 0, 0], [9.0, 9, 9]]), np.array([[4.0, 0, 0], [9.0, 9, 9]])
    at = np.array([[2.0, 3.0, 0.0], [7.0, 0.0, 4.0], [9.0, 9.0, 10.0]])
    assert distances(at, begin, end) == pytest.approx([3.0, 5.0, 1.0])


def test_elements_beside_share_an_edge_and_look_alike():
    """The upright flange shares an edge with element 101 and does not count, nor does one that shares a corner."""
    shells = shells_of(mesh())
    ids = [int(shells.element[i]) for i in beside(shells, shells.index(102))]
    assert ids == [101, 103, 107]
    assert [int(shells.element[i]) for i in beside(shells, shells.index(105))] == [104]


def test_neighbours_read_what_the_gradient_says(tmp_path):
    """Tension grows from element to element as 1, 2, 3: on 102 a neighbour reads half as much or half again."""
    rows, _ = rows_of(*gauge_case(table("g,element,102,,,,,,,0,,,,top,,,,,,,,")).write(tmp_path))
    only_tension = np.diag([1.0, 0.0, 0.0])
    found = neighbours(rows.gauges[0], rows.grids[0], rows.plates, only_tension)
    assert (found.count, found.largest) == (2, pytest.approx(0.5))
    assert neighbours(Gauge("t", "toe", "here"), grid(np.zeros((3, 1)), 0.0), None, np.eye(1)).count == 0
