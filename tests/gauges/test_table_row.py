"""Gauges at stress points: the frame of the point, its surfaces, edges, and points that nothing can be mounted on."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.gauges.gauge_file import Gauge
from fatigue.gauges.grid import grid_at_point
from fatigue.gauges.material import Material, Properties, Section
from fatigue.gauges.table_row import at_point
from fatigue.readers.neutral.points.modal_stresses import PointStress
from fatigue.readers.neutral.points.stress_points import StressPoints

E, NU = 70000.0, 0.3
STEEL = Properties("properties.csv", {1: Section(Material(E, NU), np.nan, np.nan)})
KINDS = ("parent", "hot_spot_b", "hot_spot_a", "haz")
POINTS = StressPoints(
    file="points.csv",
    name=("P", "edge", "toe", "turned"),
    kind=KINDS,
    weld=("", "W", "W", ""),
    xyz=np.arange(12.0).reshape(4, 3),
    thickness=np.full(4, 8.0),
    e1=np.array([[1.0, 0, 0], [1.0, 0, 0], [1.0, 0, 0], [0, 1.0, 0]]),
    normal=np.array([[0, 0, 1.0]] * 4),
    curve=("c",) * 4,
    curve_shear=("",) * 4,
    planes=("planes_60",) * 4,
)
TENSOR = np.zeros((4, 2, 3, 1))
TENSOR[:, 0, :, 0] = [10.0, 4.0, 3.0]
TENSOR[:, 1, :, 0] = [-10.0, 4.0, 3.0]
TENSOR[1, :, 1:] = 0.0
STRESS = PointStress(
    tensor=TENSOR,
    given=np.array([[True, True], [True, False], [True, False], [True, True]]),
    surface=(("top", "bottom"), ("edge", ""), ("top", "bottom"), ("top", "bottom")),
    read_outs=("",) * 4,
)


def grid(name, surface, **more):
    """Grid of a gauge at a point."""
    gauge = Gauge(name, "table", "gauges.csv: here", surface=surface, **more)
    return grid_at_point(gauge, at_point(gauge, POINTS, STRESS, "case.toml"), STEEL)


def test_the_angle_is_that_from_e1_and_the_point_that_of_the_gauges_name():
    """Stress sx at 0, sy at 90 degrees; where e1 runs along y, a vector along y is 0 degrees."""
    for angle, expected in ((0.0, (10 - NU * 4) / E), (90.0, (4 - NU * 10) / E)):
        assert float(grid("P", "top", angle_deg=angle).strain()[0]) == pytest.approx(1e6 * expected)
    turned = grid("g", "top", point="turned", direction=(0.0, 2.0, 0.0))
    assert turned.angle_deg == pytest.approx(0.0)
    assert float(turned.strain()[0]) == pytest.approx(1e6 * (10 - NU * 4) / E)
    assert float(grid("P", "top", angle_deg=45.0).strain()[0]) == pytest.approx(
        1e6 * (0.7 * 7.0 / E + (1 + NU) * 3.0 / E)
    )


def test_the_surface_picks_the_face():
    """Top and bottom have stresses of their own, and normals that look away from each other."""
    top, bottom = grid("P", "top", angle_deg=0.0), grid("P", "bottom", angle_deg=0.0)
    assert float(bottom.along()[0]) == -float(top.along()[0])
    assert bottom.normal == pytest.approx(-top.normal)


def test_along_an_edge_there_is_stress_along_it_alone():
    """At 0 degrees s/E; at right angles, through the plate, the contraction."""
    assert float(grid("edge", "edge", angle_deg=0.0).strain()[0]) == pytest.approx(1e6 * 10.0 / E)
    through = grid("edge", "edge", direction=(0.0, 0.0, 1.0))
    assert float(through.strain()[0]) == pytest.approx(-1e6 * NU * 10.0 / E)


def test_stress_extrapolated_to_a_toe_is_a_stand_in():
    """Points in parent metal and heat-affected zones are places; toes are not."""
    assert not grid("P", "top", angle_deg=0.0).stand_in
    assert not grid("turned", "top", angle_deg=0.0).stand_in
    assert grid("toe", "top", angle_deg=0.0).stand_in
    assert grid("edge", "edge", angle_deg=0.0).stand_in


@pytest.mark.parametrize(
    ("name", "surface", "message"),
    [
        ("nowhere", "top", "there is no stress point 'nowhere' in points.csv"),
        ("toe", "bottom", "stress point 'toe' has no stress on surface bottom, but on top"),
        ("P", "edge", "stress point 'P' has no stress on surface edge, but on top and bottom"),
    ],
)
def test_points_and_surfaces_that_there_are_not(name, surface, message):
    """With what there is."""
    with pytest.raises(DataError, match=message):
        grid(name, surface, angle_deg=0.0)
