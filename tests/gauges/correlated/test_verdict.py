"""Verdicts by the equivalent range ratio, and what goes before it; the line of all gauges."""

import math

import pytest

from fatigue.gauges.correlated.verdict import case_line, verdict


@pytest.mark.parametrize(
    ("ratio", "kept", "correlation", "word"),
    [
        (0.9, 1.0, None, "good"),
        (1.1, 0.9, None, "good"),
        (0.899, 1.0, None, "fair"),
        (1.25, 1.0, None, "fair"),
        (0.8, 1.0, None, "fair"),
        (0.799, 1.0, None, "poor"),
        (1.251, 1.0, None, "poor"),
        (math.inf, 1.0, None, "poor"),
        (1.0, 0.899, None, "data"),
        (math.nan, 1.0, None, "data"),
        (1.0, 1.0, 0.7, "good"),
        (1.0, 1.0, 0.69, "not_alignable"),
        (1.0, 1.0, -0.5, "not_alignable"),
        (1.0, 1.0, -0.51, "sign"),
        (2.0, 1.0, -0.99, "sign"),
        (1.0, 1.0, math.nan, "not_alignable"),
        (1.0, 0.5, -0.99, "data"),
    ],
)
def test_verdicts(ratio, kept, correlation, word):
    """measured_data 2.5, with the ends of every range; too little data goes before all."""
    assert verdict(ratio, kept, correlation) == word


def test_the_case_line():
    """Geometric mean, and sd of the natural logarithm with n - 1; one gauge has no scatter, none no mean."""
    found = case_line([1.0, math.e, math.e**2])
    assert (found.gauges, found.damage_ratio, found.log_sd) == (3, pytest.approx(math.e), pytest.approx(1.0))
    assert math.isnan(case_line([1.3]).log_sd)
    assert case_line([1.3]).damage_ratio == pytest.approx(1.3)
    assert math.isnan(case_line([]).damage_ratio)
    assert case_line([0.0, math.inf, 2.0]).gauges == 1
