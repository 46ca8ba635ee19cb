"""Load factors of stored ranges: that of the specification, and the largest factor that meets the target."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.decide.whatif.margin import largest_factor
from fatigue.life.bounds.histogram import damage_of_classes
from fatigue.life.curves import catalogue, damage_law
from tests.life.bounds.test_histogram import ALUMINIUM, HAIBACH, classes_of, cycles, laws

LOAD_FACTOR = 1.4581586760163232  # loads_oracles.json, B2_whatif.haibach.load_factor


def solved(x, n, k, law, part):
    """Load factor of cycles from their histogram, with low (0), value (1) or high (2) of the damage."""
    classes = classes_of(x, n, k)

    def utilisation(log_factor, points):
        return np.where(points, damage_of_classes(classes, k, law, np.exp(log_factor[0]))[part], np.nan)

    return float(largest_factor(utilisation, 1)[0])


def test_load_factor_of_the_specification():
    """Five ranges on Haibach's law: the value is that of the cycles, between the two bounds."""
    x, n = np.array(HAIBACH["dS_n"]).T
    law = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "haibach", 1e7)
    low, value, high = (solved(x, n, ALUMINIUM, law, part) for part in (2, 1, 0))
    np.testing.assert_allclose(value, LOAD_FACTOR, rtol=1e-9)
    assert low <= value <= high


@settings(max_examples=100, deadline=None)
@given(cycles, laws(), st.floats(1.0, 1e9))
def test_a_factor_meets_the_target_and_a_larger_one_does_not(found, law, often):
    """At the factor the utilisation is at most 1, just above it is not; also where it jumps."""
    x, n = np.array(found).T
    n = often * n
    factor = solved(x, n, 3.0, law, 1)
    classes = classes_of(x, n, 3.0)
    assert 0.0 < factor < np.inf
    assert damage_of_classes(classes, 3.0, law, factor * (1 - 1e-10)).value <= 1.0 + 1e-9
    assert damage_of_classes(classes, 3.0, law, factor * (1 + 1e-8)).value >= 1.0 - 1e-9


def test_what_nothing_damages_has_no_factor():
    """No cycles: any load meets the target."""
    assert (
        solved(np.array([0.0]), np.array([1.0]), 3.0, damage_law(catalogue()["master-steel"], "mean", "none", 1e7), 1)
        == np.inf
    )
