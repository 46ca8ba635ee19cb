"""The worst point of every weld: at a toe, counted, and the first of equals."""

import pytest

from fatigue.case import load_case
from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.count.worst import ABOVE, EQUAL, WorstPoint, histogram_points, worst_points
from fatigue.pipeline.solve.model import read_model
from tests.small_case import small_case


@pytest.fixture(scope="module")
def stations(tmp_path_factory):
    """The small case: welds of seven stations each, the second with a toe on top only."""
    return read_model(load_case(small_case().write(tmp_path_factory.mktemp("case")))).stations


def used_up(stations, **points):
    """A result in which a hundredth of the limit is used up at every point but those given as ``s<station>f<face>``."""
    result = GroupResult.empty(1, len(stations))
    utilisation = result.mission.utilisation
    utilisation[...], result.tier[...] = 0.01, 0
    for name, value in points.items():
        station, face = name[1:].split("f")
        utilisation[int(station), int(face)] = value
    return result


def test_the_toe_with_the_highest_utilisation_is_the_worst_point(stations):
    """A face without a toe is never it."""
    result = used_up(stations, s2f1=0.7, s9f1=0.9, s10f0=0.5)
    assert worst_points(stations, result) == (WorstPoint(0, 2, 1), WorstPoint(1, 10, 0))


def test_of_points_that_differ_by_rounding_the_first_is_the_worst(stations):
    """Only the order of sums differs."""
    result = used_up(stations, s2f0=0.5 * EQUAL, s5f0=0.5, s8f0=0.3)
    assert worst_points(stations, result)[0] == WorstPoint(0, 2, 0)


def test_a_point_that_a_bound_has_settled_is_not_the_worst(stations):
    """Its bound may be above what was counted elsewhere."""
    result = used_up(stations, s2f0=0.9, s5f0=0.5, s8f0=0.3)
    result.tier[2] = 1
    assert worst_points(stations, result)[0] == WorstPoint(0, 5, 0)


@pytest.mark.parametrize("used", [ABOVE, 0.7])
def test_histograms_are_kept_of_worst_points_and_of_those_above_a_share(stations, used):
    """A tenth of the limit is enough, a little less is not; neither a bound nor a face without a toe has any."""
    result = used_up(stations, s2f1=0.9, s4f0=used, s4f1=0.0999, s5f0=0.8, s9f0=0.02, s9f1=0.9, s13f0=used)
    result.tier[5] = 1
    worst = worst_points(stations, result)
    found = histogram_points(stations, result, worst, everything=False)
    expected = {WorstPoint(0, 2, 1), WorstPoint(0, 4, 0), WorstPoint(1, 13, 0), *worst}
    assert found == sorted(expected, key=lambda point: (point.station, point.face))


def test_histograms_of_everything_are_those_of_all_counted_points(stations):
    """Both faces, toe or not."""
    result = used_up(stations)
    result.tier[[3, 9]] = 1, 2
    found = histogram_points(stations, result, worst_points(stations, result), everything=True)
    assert {(point.station, point.face) for point in found} == {
        (s, f) for s in range(14) if s not in (3, 9) for f in (0, 1)
    }
    assert all(point.weld == stations.weld[point.station] for point in found)
