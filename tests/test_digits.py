"""Numbers down a column: one unit, one notation, three digits of what was computed."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.digits import LARGEST, as_given, in_millions, lives, results

sizes = st.floats(min_value=1e-9, max_value=1e12)
numbers = st.one_of(sizes, sizes.map(lambda x: -x), st.just(0.0), st.just(math.inf), st.just(math.nan))


def value_of(text):
    """Number that a text says."""
    return float(text.replace("\u202f", "").replace("−", "-").replace("< ", "").replace("> ", ""))


@given(st.lists(numbers, min_size=1, max_size=8))
def test_a_column_is_written_out_or_in_powers_never_both(values):
    """But for what is beyond all measure, zero, and what is missing."""
    texts = [text for text in results(values) if text not in ("0", "–") and not text.startswith(("> 1e12", "< −1e12"))]
    assert len({bool(re.search(r"\de", text)) for text in texts}) <= 1


@given(st.lists(sizes, min_size=1, max_size=8))
def test_results_are_right_to_three_digits(values):
    """Half a unit of the third digit, or said to be small."""
    for value, text in zip(values, results(values), strict=True):
        if text.startswith("< "):
            assert value < value_of(text)
        else:
            assert value_of(text) == pytest.approx(value, rel=5.001e-3)
            assert len(re.sub(r"e.*|[^0-9]", "", text).lstrip("0")) >= 3 or value_of(text) == value


@given(st.lists(st.floats(min_value=1e-4, max_value=1e6), min_size=1, max_size=8))
def test_given_quantities_have_the_same_decimals(values):
    """The largest right to four digits, the smallest to two."""
    texts = as_given(values)
    assert len({len(text.partition(".")[2]) for text in texts}) == 1
    assert value_of(texts[values.index(max(values))]) == pytest.approx(max(values), rel=5.001e-4)
    assert value_of(texts[values.index(min(values))]) == pytest.approx(min(values), rel=5.001e-2)


@given(st.lists(st.floats(min_value=1.0, max_value=1e12), min_size=1, max_size=8))
def test_lives_are_those_lives(values):
    """In the unit that is told, and in millions only where the shortest has a tenth of one."""
    texts, unit = lives(values)
    scale = {"km": 1.0, "million km": 1e6}[unit]
    assert (unit == "million km") == (min(values) >= 1e5) == in_millions(values)
    assert [value_of(text) * scale for text in texts] == pytest.approx(values, rel=5.001e-3)


def test_what_has_no_number():
    """Missing, infinite and zero; an empty column."""
    assert results([math.nan, math.inf, -math.inf, 0.0]) == ["–", "> 1e12", "< −1e12", "0"]
    assert lives([math.inf, math.nan]) == (["> 1e12", "–"], "km")
    assert lives([3e5, math.inf, 2 * LARGEST])[0] == ["0.300", "> 1\u202f000\u202f000", "> 1\u202f000\u202f000"]
    assert results([]) == as_given([]) == lives([])[0] == []


@pytest.mark.parametrize(
    ("values", "texts"),
    [
        ([979_812_345.0, 1.252e9], ["980 000 000", "1 250 000 000"]),
        ([0.9996, 9996.0, 99_960.0], ["1.00", "10 000", "100 000"]),
        ([24.41, 4.56e-5, -4.56e-5], ["24.4", "< 0.001", "> −0.001"]),
        ([0.00099996, 1.0], ["0.00100", "1.00"]),
        ([2.11e-10, 4e-3], ["2.11e−10", "4.00e−3"]),
    ],
)
def test_known_columns(values, texts):
    """Rounded first: 9996 is grouped as 10 000, 0.9996 has two decimals."""
    assert results(values, group=" ") == texts


@pytest.mark.parametrize(
    ("values", "texts"),
    [
        ([350.0, 300.0, 0.0, 50.0], ["350", "300", "0", "50"]),
        ([212.5, 0.0], ["212.5", "0.0"]),
        ([0.004, 30.0], ["0.004", "30.000"]),
        ([12_000_000.0], ["12 000 000"]),
        ([24.0], ["24"]),
        ([1e-9, 1.0], ["< 0.001", "1.00"]),
    ],
)
def test_known_given_quantities(values, texts):
    """A time step beside a duration keeps its digits."""
    assert as_given(values, group=" ") == texts
