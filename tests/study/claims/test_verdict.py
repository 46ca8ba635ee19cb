"""Verdicts: seed by seed, and all of them together."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.study.claims import CONTRADICTED, REPRODUCED, UNDECIDED, Claim, read_claims, verdicts
from fatigue.study.claims.verdict import OfSeed, compared, judged, scatter
from fatigue.study.quantities import Number
from tests.study.claims.studied import SEEDS, VARIANTS, numbers

FINITE = st.floats(-1e6, 1e6)
SIDE = FINITE | st.sampled_from([math.inf, -math.inf, math.nan, 0.0])
SAYS = st.sampled_from(["holds", "reverse", "same", "unknown"])
MIRRORED = {"holds": "reverse", "reverse": "holds"}


def told(rows=None, **table):
    """Verdict about one claim of the small study."""
    claims = read_claims([{"text": "x", **table}], SEEDS)
    return verdicts(claims, VARIANTS, numbers() if rows is None else rows, SEEDS)[0]


def test_reproduced_contradicted_and_neither():
    """The converter shakes twice as much at 9.2 Hz on worn wheels: more than 1.5 times, not three times."""
    worn = {"left": "conv_y_rms[contact=worn]", "right": "conv_y_rms[fe=14,contact=worn]", "operator": ">"}
    assert told(**worn, factor=1.5).verdict == REPRODUCED
    assert told(**worn, factor=3.0).verdict == CONTRADICTED
    split = told(**worn, factor=2.09)  # ratios 2.09, 2.4, 2.08, 2.0
    assert split.verdict == UNDECIDED
    assert "2 of 4 seeds hold the sentence, 2 of 4 seeds hold its reverse; 3 have to agree" in split.reason


def test_the_numbers_of_the_sides():
    """Means, scatter and ratios are those of the sides, seed by seed, the factor in the right one."""
    one = told(left="conv_y_rms[contact=worn]", right="conv_y_rms", operator=">", factor=3)
    assert one.left.mean == pytest.approx(2.35)
    assert one.right.mean == pytest.approx(3 * 0.28)
    assert one.ratio.low == pytest.approx(2.2 / 0.84)
    assert one.unit == "m/s2"
    assert one.count("holds") == 4


def test_seeds_of_a_claim():
    """Only the seeds that a claim names are compared."""
    one = told(left="conv_y_rms[contact=worn]", right=2.35, operator="<", seeds=[1, 4], agree=2)
    assert one.verdict == REPRODUCED
    assert [of.seed for of in one.of_seeds] == [1, 4]


def test_between():
    """An end belongs to what lies between; the reverse lies outside; the nearer end is the one shown."""
    one = told(left="conv_y_rms[contact=worn]", right=[2.2, 2.5], operator="between")
    assert one.verdict == REPRODUCED
    assert told(left="conv_y_rms[contact=worn]", right=[3.0, 4.0], operator="between").verdict == CONTRADICTED
    assert [of.right for of in one.of_seeds] == [2.2, 2.5, 2.5, 2.2]
    ends = told(left="conv_y_rms", right=["conv_y_rms[fe=14]", "conv_y_rms[contact=worn]"], operator="between")
    assert ends.verdict == REPRODUCED


def test_no_number_never_holds_and_says_why():
    """A run that failed holds nothing; enough others still decide."""
    rows = [
        replace(row, value=math.nan, reason="the run failed") if (row.variant, row.seed) == ("base", 1) else row
        for row in numbers()
    ]
    one = told(rows, left="conv_y_rms[contact=worn]", right="conv_y_rms", operator=">")
    assert one.verdict == REPRODUCED
    assert one.of_seeds[0].says == "unknown"
    assert one.of_seeds[0].reason == "the run failed"
    strict = told(rows, left="conv_y_rms[contact=worn]", right="conv_y_rms", operator=">", agree=4)
    assert strict.verdict == UNDECIDED
    assert "the run failed" in strict.reason


def test_unlike_units_are_not_compared():
    """Metres per second squared and kilometres are not compared."""
    one = told(left="conv_y_rms", right="life_km", operator="<")
    assert one.verdict == UNDECIDED
    assert "left is in m/s2, right in km" in one.reason


def test_infinite_lives():
    """A life without end is longer than any other and as long as another one."""
    rows = [
        Number(v.name, s, "life_km", "A", math.inf if v.name == "fe=14" else 1e6, "km") for v in VARIANTS for s in SEEDS
    ]
    longer = told(rows, left="life_km:A[fe=14]", right="life_km:A", operator=">", tolerance=0.1)
    assert longer.verdict == REPRODUCED
    assert math.isnan(longer.ratio.mean)
    same = told(rows, left="life_km:A[fe=14]", right="life_km:*[fe=14]", operator=">")
    assert {of.says for of in same.of_seeds} == {"same"}


def test_a_sentence_without_data_is_not_decidable():
    """The reason stated is the reason given."""
    one = told(undecidable="the paper gives no data")
    assert (one.verdict, one.reason, one.of_seeds) == (UNDECIDED, "the paper gives no data", ())


def test_lives_scatter_by_their_logarithm():
    """The mean of lives is geometric, their standard deviation that of log10."""
    found = scatter([1e6, 1e8], logarithmic=True)
    assert found.mean == pytest.approx(1e7)
    assert found.sd == pytest.approx(math.sqrt(2.0))
    one = told(left="life_km:W2_hanger1[fe=14]", right="life_km:W2_hanger1", operator=">")
    assert one.left.mean == pytest.approx(2e6 * 24**0.25)
    assert one.ratio.mean == pytest.approx(2.0)


def test_scatter_of_one_and_of_nothing():
    """One value has no standard deviation, none has nothing."""
    assert math.isnan(scatter([2.0]).sd)
    assert math.isnan(scatter([math.nan]).mean)
    assert scatter([math.nan, 3.0]).known == 1


@given(SIDE, SIDE, st.floats(0.0, 0.5))
def test_swapped_sides_mirror_the_sentence(left, right, tolerance):
    """``left > right`` and ``right < left`` say the same; ``left < right`` says the reverse."""
    says = compared(left, ">", [right], tolerance)
    assert compared(right, "<", [left], tolerance) == says
    assert compared(left, "<", [right], tolerance) == MIRRORED.get(says, says)


@given(FINITE, FINITE, FINITE)
def test_between_is_both_comparisons(left, one, other):
    """A value lies between two ends if it is not outside either of them."""
    low, high = sorted((one, other))
    outside = compared(left, "<", [low]) == "holds" or compared(left, ">", [high]) == "holds"
    assert compared(left, "between", [low, high]) == ("reverse" if outside else "holds")


@given(SIDE, st.floats(0.0, 0.5), st.floats(0.0, 0.5))
def test_a_larger_tolerance_decides_no_more(left, one, other):
    """What a tolerance leaves open, a larger one leaves open, too; nothing turns into its reverse."""
    small, large = sorted((one, other))
    for operator, right in ((">", [1.0]), ("between", [1.0, 2.0])):
        a, b = (compared(left, operator, right, t) for t in (small, large))
        assert b in (a, "same") or (operator, small) == ("between", 0.0)


@given(st.lists(SAYS, min_size=1, max_size=9), st.integers(1, 9), st.integers(1, 9))
def test_more_that_have_to_agree_decide_no_more(says, one, other):
    """Above half of the seeds, a larger ``agree`` only turns verdicts into not decidable."""
    few, many = sorted((one, other))
    of_seeds = [OfSeed(i, 1.0, 1.0, 1.0, word) for i, word in enumerate(says)]
    if 2 * few > len(says):
        assert judged(of_seeds, many)[0] in (judged(of_seeds, few)[0], UNDECIDED)


@given(st.lists(SAYS, min_size=1, max_size=9), st.integers(1, 9))
def test_mirrored_seeds_mirror_the_verdict(says, needed):
    """If every seed says the reverse, the verdict is reversed, too."""
    word, reason = judged([OfSeed(i, 1.0, 1.0, 1.0, said) for i, said in enumerate(says)], needed)
    mirrored, _ = judged([OfSeed(i, 1.0, 1.0, 1.0, MIRRORED.get(said, said)) for i, said in enumerate(says)], needed)
    assert mirrored == {REPRODUCED: CONTRADICTED, CONTRADICTED: REPRODUCED}.get(word, word)
    assert bool(reason) == (word == UNDECIDED)


@given(st.floats(0.01, 100.0))
def test_a_factor_on_the_right_is_one_on_the_number(factor):
    """``right`` times ``factor`` is compared, whatever the right side is."""
    with_factor = told(left="conv_y_rms", operator=">", right=0.27, factor=factor)
    without = told(left="conv_y_rms", operator=">", right=0.27 * factor)
    assert (with_factor.verdict, with_factor.of_seeds) == (without.verdict, without.of_seeds)


def test_both_reach_agree():
    """Where few seeds are enough for sentence and reverse alike, nothing is decided."""
    word, reason = judged([OfSeed(1, 1, 1, 1, "holds"), OfSeed(2, 1, 1, 1, "reverse")], 1)
    assert word == UNDECIDED
    assert "1 of 2 seeds hold the sentence" in reason


def test_claims_read_from_toml_hold_whole_numbers():
    """A whole number of the file is a number of a side."""
    assert Claim.model_validate({"text": "x", "left": "a", "operator": "<", "right": 3}).right_sides == (3.0,)
