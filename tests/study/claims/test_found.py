"""Values of the sides of a claim."""

import math

import pytest

from fatigue.study.claims.expression import parsed
from fatigue.study.claims.found import Numbers
from fatigue.study.quantities import Number
from tests.study.claims.studied import BASE, VARIANTS, numbers


def side(text, seed=1, rows=None):
    """Value of an expression."""
    return Numbers(VARIANTS, numbers() if rows is None else rows).side(parsed(text), seed)


def test_a_pattern_takes_the_worst():
    """Of several welds the shortest life counts, of anything else the largest value."""
    assert side("life_km:W2_hanger2").value == 3e6
    assert (side("life_km:W2_*").value, side("life_km:W2_*").weld) == (1e6, "W2_hanger1")
    assert side("life_km:W2_*", seed=4).weld == "W2_hanger2"
    damage = [Number("base", 1, "damage_per_km", weld, value, "1/km") for weld, value in (("A", 1e-7), ("B", 3e-7))]
    assert side("damage_per_km:?", rows=damage).value == 3e-7


def test_without_a_weld_the_worst_of_all():
    """A quantity of welds without a weld means the number of the whole run, else the worst weld."""
    assert side("life_km").value == 1e6
    whole = [*numbers(), Number("base", 1, "life_km", "", 7.0, "km")]
    assert side("life_km", rows=whole).value == 7.0


def test_brackets_of_a_weld_are_letters():
    """Only * and ? of a pattern stand for others."""
    rows = [Number("base", 1, "life_km", weld, value, "km") for weld, value in (("s[1]", 2.0), ("s1", 1.0))]
    assert side('life_km:"s[?]"', rows=rows).value == 2.0


def test_a_missing_weld_makes_nothing_worse_and_all_missing_tell_why():
    """A weld without a number is passed over, unless no other has one."""
    lost = Number("base", 1, "life_km", "A", math.nan, "km", "not assessed")
    assert side("life_km:*", rows=[lost, Number("base", 1, "life_km", "B", 2.0, "km")]).value == 2.0
    assert side("life_km:*", rows=[lost]).reason == "not assessed"


def test_what_is_not_there_says_why():
    """A seed, quantity or weld that is not there is NaN with a reason."""
    assert side("life_km:W3").reason == "no weld is named 'W3'; there are W2_hanger1, W2_hanger2"
    assert side("conv_y_rms", seed=9).reason == "seed 9 of 'base' has no conv_y_rms"
    assert math.isnan(side("conv_y_rms", seed=9).value)
    assert side("conv_yy_rms").reason == "no run has a conv_yy_rms, the nearest is conv_y_rms"
    assert side("weight").reason == "no run has a weight"


def test_ratios():
    """A ratio has no unit where both have the same; 0 over 0 and unlike units are none."""
    assert side("conv_y_rms[contact=worn] / conv_y_rms[fe=14,contact=worn]").value == pytest.approx(2.3 / 1.1)
    assert side("conv_y_rms[contact=worn] / conv_y_rms[fe=14,contact=worn]").unit == ""
    unlike = side("conv_y_rms / life_km")
    assert math.isnan(unlike.value)
    assert "is in m/s2" in unlike.reason
    assert side("alarms/bogie[contact=worn] / alarms/bogie").value == math.inf
    assert "0 over 0" in side("alarms/bogie / alarms/bogie").reason


def test_the_reason_of_a_part_is_that_of_the_ratio():
    """A ratio of a number that cannot be had says why."""
    rows = [Number(BASE.name, 1, "a", "", math.nan, "", "failed"), Number(BASE.name, 1, "b", "", 1.0, "")]
    assert side("a / b", rows=rows).reason == "failed"
