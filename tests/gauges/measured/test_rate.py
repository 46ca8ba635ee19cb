"""Rates are brought together by their exact ratio, or not at all."""

from fractions import Fraction

import numpy as np
import pytest

from fatigue.gauges.measured.rate import at_ratio, exact_ratio


@pytest.mark.parametrize(
    ("rate", "wanted", "ratio"),
    [
        (250.0, 200.0, Fraction(4, 5)),
        (2048.0, 200.0, Fraction(25, 256)),
        (200.0, 200.0, 1),
        (1 / 0.003, 250, Fraction(3, 4)),
    ],
)
def test_rates_of_whole_numbers_have_a_ratio(rate, wanted, ratio):
    """Also where a step is no finite decimal."""
    assert exact_ratio(rate, wanted, 100_000) == ratio


@pytest.mark.parametrize(("rate", "wanted"), [(250.0, 200.01), (250.0, 250.001), (1e6, 200.0), (200.0, 1e6)])
def test_other_rates_have_none(rate, wanted):
    """A record of a minute would slip by more than a hundredth of a sample, or the factor is beyond any filter."""
    assert exact_ratio(rate, wanted, 15_000) is None


def test_a_short_record_slips_less():
    """What a minute shows is nothing within a few samples."""
    assert exact_ratio(250.0, 250.0001, 100) == 1
    assert exact_ratio(250.0, 250.0001, 1_000_000) is None


def test_resampled_tones_are_the_tones():
    """Below the new half rate they keep size and phase to the 0.4 % of the filter, away from the ends."""
    t = np.arange(5000) / 250.0
    x = 3.0 + 0.2 * t + np.sin(2 * np.pi * 7.0 * t + 0.3)
    y = at_ratio(x, Fraction(4, 5))
    new = np.arange(len(y)) / 200.0
    assert len(y) == 4000
    np.testing.assert_allclose(
        y[100:-100], (3.0 + 0.2 * new + np.sin(2 * np.pi * 7.0 * new + 0.3))[100:-100], atol=5e-3
    )


def test_the_same_rate_changes_nothing():
    """Not a single bit."""
    x = np.random.default_rng(0).standard_normal(50)
    np.testing.assert_array_equal(at_ratio(x, Fraction(1)), x)
