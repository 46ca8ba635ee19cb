"""Root loci: one unbroken line per root, whatever it meets."""

import numpy as np
import pytest

from fatigue.vehicle.roots import roots
from fatigue.vehicle.stability.loci import distance, followed, loci_over_conicity, loci_over_speed
from tests.vehicle_oracles import trailer

CONICITIES = np.geomspace(0.03, 1.0, 15)


@pytest.fixture(scope="module")
def over_conicity():
    """Loci of the reference at 350 km/h."""
    return loci_over_conicity(trailer(), 350.0, CONICITIES)


def test_loci_hold_every_root_once(over_conicity):
    """At each point of the grid the loci have just the roots of the vehicle there."""
    for k, conicity in enumerate(CONICITIES):
        there = sorted(abs(locus.s[k]) for locus in over_conicity if np.isfinite(locus.s[k]))
        assert there == pytest.approx([abs(root.s) for root in roots(trailer().at(350.0, conicity))], rel=1e-9)


def test_a_locus_is_the_same_on_a_finer_grid(over_conicity):
    """Every third point of a grid three times as fine: the same loci."""
    fine = loci_over_conicity(trailer(), 350.0, np.geomspace(0.03, 1.0, 43))
    ends = {(round(abs(locus.s[0]), 6), round(abs(locus.s[-1]), 6)) for locus in fine if np.isfinite(locus.s).all()}
    coarse = {(round(abs(locus.s[0]), 6), round(abs(locus.s[-1]), 6)) for locus in over_conicity}
    assert len(coarse & ends) >= 30


def test_hunting_grows_out_of_the_sway_of_the_car_body(over_conicity):
    """The root that is unstable at 0.03 is the one that hunts at 1.0: one locus, stable in between."""
    unstable = [locus for locus in over_conicity if locus.damping[0] < 0.0]
    assert len(unstable) == 1
    (locus,) = unstable
    assert locus.roots[0].of.group == "car"
    assert locus.roots[-1].of.name.startswith("bogie hunting")
    assert locus.damping[-1] < 0.0 < locus.damping[len(CONICITIES) // 2]
    assert locus.frequency_hz[-1] > 8.0


def test_loci_over_speed_begin_and_end():
    """A root that is overdamped for a while, or too fast, is not shown there; the others run through."""
    loci = loci_over_speed(trailer("soft"), 0.3, np.linspace(100.0, 500.0, 12))
    whole = [locus for locus in loci if np.isfinite(locus.s).all()]
    assert len(whole) >= 28
    assert any(locus.name.startswith("bogie hunting") for locus in whole)
    for locus in loci:
        assert all((root is None) == bool(np.isnan(s)) for root, s in zip(locus.roots, locus.s, strict=True))
        assert np.nanmax(locus.frequency_hz) < 25.0


def test_one_point_and_no_point():
    """A grid of one point has its roots as loci of one point."""
    of = trailer()
    loci = followed(lambda conicity: of.at(350.0, conicity), np.array([0.1]))
    assert len(loci) == len(roots(of.at(350.0, 0.1)))


def test_distance_of_a_root_from_itself_is_nothing():
    """Zero on the diagonal, and larger beside it."""
    of = trailer().at(350.0, 0.3)
    found = roots(of)
    apart = distance(found, found, of.M)
    assert np.abs(np.diag(apart)).max() < 1e-9
    assert (apart + 10.0 * np.eye(len(found))).min() > 1e-3
