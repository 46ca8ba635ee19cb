"""What a ratio of lives is worth where one of them is infinite or a bound."""

import math

import numpy as np
import pytest

from fatigue.decide.compare.ratios import life_ratio

INF = math.inf
CASES = {  # life in A, in B, bound in A, in B -> log ratio, basis
    "counted": (1e6, 2e6, False, False, math.log(2.0), "exact"),
    "A is a bound": (1e6, 2e6, True, False, math.log(2.0), "at_most"),
    "B is a bound": (1e6, 2e6, False, True, math.log(2.0), "at_least"),
    "both are": (1e6, 2e6, True, True, math.nan, "unknown"),
    "both endless": (INF, INF, False, False, 0.0, "exact"),
    "a bound of nothing is exact": (INF, INF, True, True, 0.0, "exact"),
    "B endless": (1e6, INF, False, False, INF, "exact"),
    "A endless": (INF, 1e6, False, False, -INF, "exact"),
    "A at least so much, B endless": (1e6, INF, True, False, math.nan, "unknown"),
    "A endless, B at least so much": (INF, 1e6, False, True, math.nan, "unknown"),
    "no life at all in B": (1e6, 0.0, False, False, math.nan, "unknown"),
    "A endless by its bound": (INF, 1e6, True, False, -INF, "exact"),
}


@pytest.mark.parametrize("name", CASES)
def test_ratio_and_basis(name):
    """A lower bound of B's life gives a lower bound of the ratio, one of A's an upper; what says nothing is unknown."""
    life_a, life_b, bound_a, bound_b, log, basis = CASES[name]
    found, told = life_ratio(*(np.array([one]) for one in (life_a, life_b, bound_a, bound_b)))
    assert found[0] == pytest.approx(log, rel=1e-15, nan_ok=True)
    assert told[0] == basis


def test_the_side_of_a_bound_is_the_right_one():
    """Whatever the true life behind a bound is, the ratio lies on the side that the basis says."""
    rng = np.random.default_rng(3)
    life_a, life_b = rng.uniform(1e5, 1e7, (2, 200))
    bound_a = rng.uniform(size=200) < 0.5
    log, basis = life_ratio(life_a, life_b, bound_a, ~bound_a)
    true_a, true_b = (
        np.where(bound, life * rng.uniform(1, 5, 200), life) for bound, life in ((bound_a, life_a), (~bound_a, life_b))
    )
    truth = np.log(true_b / true_a)
    assert (truth[basis == "at_most"] <= log[basis == "at_most"]).all()
    assert (truth[basis == "at_least"] >= log[basis == "at_least"]).all()
    assert set(basis) == {"at_most", "at_least"}
