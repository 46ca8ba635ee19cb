"""The weakest link against the specification, its limits, and draws."""

import numpy as np
import pytest

from fatigue.life.band.line import (
    line_survival,
    median_life,
    straight_line_survival,
    strength_survival,
    tributary_lengths,
)

SIGMA = 0.3223058221131365 * np.log(10.0)
MEDIAN_OF_TEN = {0.0: 0.32880512727360517, 0.5: 0.4483439589598819, 1.0: 1.0}  # B5_band.weakest_link
UNEVEN = {0.0: 0.5156864441850151, 0.5: 0.6584407086791207, 1.0: 0.8248451389155093}  # its survival_at_5e6_km


def survival_of(log_median, lengths, rho, other=0.0):
    """Survival of."""
    return lambda x: straight_line_survival(x, log_median, SIGMA, lengths, rho, other)


@pytest.mark.parametrize("rho", MEDIAN_OF_TEN)
def test_lines_are_those_of_the_specification(rho):
    """Lines are those of the specification."""
    ten = survival_of(np.full(10, np.log(1e7)), np.ones(10), rho)
    assert median_life(ten, np.log(1e6), np.log(1e8)) / 1e7 == pytest.approx(MEDIAN_OF_TEN[rho], abs=1e-9)
    uneven = survival_of(np.log([1e7, 1.5e7, 4e7]), np.array([2.0, 3.5, 10.0]), rho)
    assert uneven(np.log(5e6)) == pytest.approx(UNEVEN[rho], abs=1e-9)


def test_all_one_strength_is_the_worst_point_and_nearly_so_is_nearly_that():
    """All one strength is the worst point and nearly so is nearly that."""
    uneven = np.log([1e7, 1.5e7, 4e7])
    exact = straight_line_survival(np.log(5e6), uneven, SIGMA, np.ones(3), 1.0)
    assert straight_line_survival(np.log(5e6), uneven, SIGMA, np.ones(3), 1.0 - 1e-5) == pytest.approx(exact, abs=3e-3)
    assert straight_line_survival(np.log(5e6), uneven, SIGMA, np.ones(3), 1.0 - 1e-7) == pytest.approx(exact, abs=3e-4)


@pytest.mark.parametrize("rho", [0.0, 0.3, 0.99, 1.0])
def test_a_finer_mesh_changes_nothing_where_lives_are_equal(rho):
    """A finer mesh changes nothing where lives are equal."""
    for nodes in (11, 101):
        lengths = tributary_lengths(np.linspace(0.0, 1000.0, nodes)) / 100.0
        assert lengths.sum() == pytest.approx(10.0)
        found = straight_line_survival(np.log(3e6), np.full(nodes, np.log(1e7)), SIGMA, lengths, rho)
        assert found == pytest.approx(
            straight_line_survival(np.log(3e6), np.full(10, np.log(1e7)), SIGMA, np.ones(10), rho), rel=1e-12
        )


def test_a_finer_mesh_changes_less_than_a_thousandth_where_lives_differ():
    """A finer mesh changes less than a thousandth where lives differ."""
    found = []
    for nodes in (41, 401):
        at = np.linspace(0.0, 1000.0, nodes)
        lengths = tributary_lengths(at) / 100.0
        found.append(straight_line_survival(np.log(3e6), np.log(1e7 * (1.0 + at / 300.0)), SIGMA, lengths, 0.4))
    assert found[0] == pytest.approx(found[1], abs=1e-3)


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.95])
@pytest.mark.parametrize("other", [0.0, 0.4])
def test_the_outer_integral_is_the_one_with_the_variances_together(rho, other):
    """The outer integral is the one with the variances together."""
    log_median, lengths = np.log([1e7, 1.5e7, 4e7]), np.array([2.0, 3.5, 10.0])
    general = line_survival(np.log(5e6), lambda x: (x - log_median) / SIGMA, lengths, rho, other)
    assert general == pytest.approx(survival_of(log_median, lengths, rho, other)(np.log(5e6)), abs=1e-6)


def test_a_line_is_what_draws_of_its_weakest_length_give():
    """A line is what draws of its weakest length give."""
    rng, rho, other, draws = np.random.default_rng(5), 0.5, 0.3, 200_000
    log_median = np.log([1e7, 1.5e7, 4e7])
    lengths = np.array([2, 3, 10])
    own = rng.standard_normal((draws, lengths.sum()))
    strength = np.sqrt(rho) * rng.standard_normal((draws, 1)) + np.sqrt(1.0 - rho) * own
    weakest = (np.repeat(log_median, lengths) + SIGMA * strength).min(axis=1) + other * rng.standard_normal(draws)
    found = straight_line_survival(np.log(4e6), log_median, SIGMA, lengths.astype(float), rho, other)
    assert found == pytest.approx((weakest > np.log(4e6)).mean(), abs=4e-3)


def test_a_length_of_nothing_is_no_link():
    """A length of nothing is no link."""
    strength = np.array([-1.0, 5.0])
    for rho in (0.0, 0.5, 1.0):
        both = strength_survival(strength, np.array([1.0, 0.0]), rho)
        assert both == pytest.approx(strength_survival(strength[:1], np.ones(1), rho), rel=1e-12)
    assert tributary_lengths(np.array([3.0])).tolist() == [0.0]
