"""Which station is which: by part, order and place, else the nearest; kinks keep their legs apart."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.decide.compare.finished import Points
from fatigue.decide.compare.matched.stations import match_stations, spacing


def points(xyz, part=None, order=None, weld=None) -> Points:
    """Points of stations, two faces each."""
    n = len(xyz)
    weld = np.zeros(n, np.int64) if weld is None else np.asarray(weld)
    part = np.ones(n, np.int64) if part is None else np.asarray(part)
    order = np.arange(1, n + 1) if order is None else np.asarray(order)
    columns = {name: np.repeat(value, 2) for name, value in (("weld", weld), ("part", part), ("order", order))}
    ones = np.ones(2 * n)
    names = tuple(f"w{i}" for i in range(int(weld.max(initial=0)) + 1))
    return Points(
        names,
        **columns,
        node=np.arange(2 * n),
        xyz=np.asarray(xyz, float),
        toe=ones > 0,
        damage=ones,
        life=ones,
        screened=ones < 0,
    )


def line(count=11, length=100.0):
    """A straight line."""
    return np.column_stack([np.linspace(0.0, length, count), np.zeros((count, 2))])


ONE = np.array([0])


def test_the_same_line_matches_itself():
    """Station by station, at no distance."""
    found = match_stations(points(line()), points(line()), ONE)
    assert found.second.tolist() == list(range(11))
    assert found.distance.max() == 0.0
    assert found.comparable.all()


def test_a_reversed_line_matches_by_place():
    """Orders that are equal at another place are none: the nearest station counts."""
    found = match_stations(points(line()), points(line()[::-1]), ONE)
    assert found.second.tolist() == list(range(11))[::-1]
    assert found.distance.max() == 0.0


def test_a_finer_line_gives_its_nearest_stations():
    """Between stations of the finer line nothing is interpolated: beyond half its spacing they stand for two places."""
    coarse, fine = line(6), line(41) + np.array([1.2, 0.0, 0.0])
    found = match_stations(points(coarse), points(fine), ONE)
    assert found.second.tolist() == [0, 8, 16, 24, 32, 40]
    assert found.distance == pytest.approx(np.full(6, 1.2))
    assert found.comparable.all()
    apart = match_stations(points(coarse), points(fine + np.array([0.0, 1.25, 0.0])), ONE)
    assert not apart.comparable.any()
    assert match_stations(points(fine), points(coarse), ONE).comparable.sum() < 41


def test_welds_without_partner_have_no_stations():
    """Only matched welds take part, and a nearer station of another weld does not count."""
    a = points(np.concatenate([line(3), line(3) + 50.0]), weld=[0, 0, 0, 1, 1, 1], order=[1, 2, 3] * 2)
    b = points(np.concatenate([line(3) + 50.5, line(3) + 900.0]), weld=[0, 0, 0, 1, 1, 1], order=[1, 2, 3] * 2)
    found = match_stations(a, b, np.array([-1, 1]))
    assert found.first.tolist() == [3, 4, 5]
    assert set(found.second.tolist()) <= {3, 4, 5}
    assert not found.comparable.any()


def test_legs_of_a_kink_stay_apart():
    """Both parts end in the same node; a reversed line has its parts the other way round."""
    legs = np.array([[0, 0, 0], [10, 0, 0], [20, 0, 0], [20, 0, 0], [20, 10, 0], [20, 20, 0]], float)
    a = points(legs, part=[1, 1, 1, 2, 2, 2], order=[1, 2, 3, 3, 4, 5])
    b = points(legs[::-1], part=[1, 1, 1, 2, 2, 2], order=[1, 2, 3, 3, 4, 5])
    found = match_stations(a, b, ONE)
    assert found.second.tolist() == [5, 4, 3, 2, 1, 0]
    assert found.distance.max() == 0.0


@given(st.integers(0, 2**32 - 1))
def test_renumbered_stations_find_their_places(seed):
    """Orders dealt anew change nothing about which place is which."""
    rng = np.random.default_rng(seed)
    xyz = rng.uniform(-1e4, 1e4, (12, 3))
    shuffled = rng.permutation(12)
    found = match_stations(points(xyz), points(xyz[shuffled], order=rng.permutation(12) + 1), ONE)
    assert shuffled[found.second].tolist() == list(range(12))


def test_spacing_is_that_of_the_shorter_edge_within_the_part():
    """Over a kink and to another weld there is no edge; a single station has none."""
    xyz = np.array([[0, 0, 0], [10, 0, 0], [14, 0, 0], [14, 0, 0], [14, 50, 0], [99, 0, 0]], float)
    one = points(xyz, part=[1, 1, 1, 2, 2, 1], weld=[0, 0, 0, 0, 0, 1], order=[1, 2, 3, 3, 4, 1])
    assert spacing(one).tolist()[:5] == [10.0, 4.0, 4.0, 50.0, 50.0]
    assert np.isnan(spacing(one)[5])
    alone = replace(one, weld=one.weld + 0)
    found = match_stations(alone, one, np.array([0, 1]))
    assert found.comparable.all()


@pytest.mark.parametrize(("away", "is_comparable"), [(1.249, True), (1.251, False)])
def test_half_the_finer_spacing_is_the_limit(away, is_comparable):
    """Spacing 2.5 mm on one side, 20 mm on the other: 1.25 mm, whichever of them is the reference."""
    coarse, fine = points(line(6)), points(line(41) + np.array([0.0, away, 0.0]))
    assert match_stations(coarse, fine, ONE).comparable.all() == is_comparable
    back = match_stations(fine, coarse, ONE)
    assert back.comparable[::8].all() == is_comparable
    assert not back.comparable[4]
