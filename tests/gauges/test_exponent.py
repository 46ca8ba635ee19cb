"""The exponent of pseudo-damage, and where it is from."""

import math

import pytest

from fatigue.case import load_case
from fatigue.gauges.exponent import exponent_of, exponent_problems
from tests.small_case import small_case


def test_the_exponent_is_that_of_the_curve_of_the_case(tmp_path):
    """1/h of a master curve, the first slope of another one, or whatever is asked for."""
    case = small_case()
    assert exponent_of(load_case(case.write(tmp_path / "master"))) == (
        pytest.approx(1 / 0.27712),
        "1/h of curve 'master-aluminium'",
    )
    case.curve = {"name": "mine", "survival": "mean"}
    case.extra = "[curves.mine]\nslopes = [4.0, 6.0]\nknees_cycles = [1e7]\nrange_at_2e6_MPa = 40.0\n"
    case.extra += 'applies = "structural"\nsource = "mine"'
    own = load_case(case.write(tmp_path / "own"))
    assert exponent_of(own) == (4.0, "first slope of curve 'mine'")
    assert exponent_of(own, 3.0) == (3.0, "as asked")


@pytest.mark.parametrize("asked", [0.0, -1.0, math.inf, math.nan, 300.0, "3"])
def test_what_is_no_exponent_is_told(asked):
    """Nothing below 0, no text, and nothing to whose power ranges are no numbers any more."""
    (problem,) = exponent_problems(asked)
    assert str(problem).startswith(f"exponent: {asked!r} is no exponent of an S-N curve. Give a number above 0")


def test_what_is_an_exponent_is_not():
    """Up to the steepest; none asked for."""
    assert not [*exponent_problems(None), *exponent_problems(3.6), *exponent_problems(50), *exponent_problems(50.0)]
