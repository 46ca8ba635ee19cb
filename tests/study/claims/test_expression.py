"""The grammar of a claim's sides."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.study.claims.expression import Expression, ExpressionError, Term, parsed


def test_a_number_of_a_run():
    """Numbers, truth values and texts are told apart, blanks do not matter."""
    assert parsed("conv_y_rms").above == Term("conv_y_rms")
    assert parsed(" conv_y_rms [ fe = 9.2 , contact=worn, doubled=true ] ").above == Term(
        "conv_y_rms", "", (("fe", 9.2), ("contact", "worn"), ("doubled", True))
    )
    assert parsed("x[]").above == Term("x")


def test_a_number_of_a_weld():
    """A weld or a pattern stands behind a colon; quotation marks hold signs that mean something."""
    assert parsed("life_km:W2_hanger*[fe=14]").above == Term("life_km", "W2_hanger*", (("fe", 14),))
    assert parsed('life_km:"seam [1], front: a / b"[fe=14]').above.weld == "seam [1], front: a / b"
    assert parsed("life_km:W 7 left").above.weld == "W 7 left"


def test_events_and_channels():
    """The event behind @ and the channel behind a stroke belong to the quantity."""
    assert parsed("alarms/bogie@worn 350[fe=9.2]").above.quantity == "alarms/bogie@worn 350"


def test_one_over_another():
    """A stroke between blanks makes a ratio of two terms, once."""
    both = parsed("conv_y_rms[fe=9.2] / conv_y_rms[fe=14]")
    assert both == Expression(Term("conv_y_rms", "", (("fe", 9.2),)), Term("conv_y_rms", "", (("fe", 14),)))
    with pytest.raises(ExpressionError, match="a third term"):
        parsed("a / b / c")


def test_quoted_value_is_a_text():
    """A value in quotation marks stays a text, whatever it reads like."""
    assert parsed("x[body='2']").above.settings == (("body", "2"),)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("", "a quantity is missing"),
        ("[fe=9.2]", "a quantity is missing"),
        ("x[fe]", "no = follows the name 'fe'"),
        ("x[fe=]", "a value of 'fe' is missing"),
        ("x[fe=9.2", "the bracket is not closed"),
        ("x[fe=9.2,]", "a name is missing"),
        ("x[fe=9.2]y", "'y' follows where the expression is complete"),
        ("x[fe=1][v=2]", "follows where the expression is complete"),
        ("x:", "a weld or pattern is missing"),
        ("x[fe=1,fe=2]", "'fe' stands twice"),
        ("x]", "']' stands in 'x]'"),
    ],
)
def test_mistakes_are_named(text, what):
    """A mistake says what is wrong and what to write."""
    with pytest.raises(ExpressionError, match=what.replace("[", r"\[")) as refused:
        parsed(text)
    assert refused.value.remedy


NAMES = st.text(
    st.characters(blacklist_categories=("Cs", "Cc", "Zs", "Zl", "Zp"), blacklist_characters="'\""), min_size=1
)
VALUES = st.one_of(st.integers(-999, 999), st.floats(allow_nan=False, allow_infinity=False), st.booleans(), NAMES)


@given(
    st.lists(st.tuples(NAMES, NAMES | st.just(""), st.dictionaries(NAMES, VALUES, max_size=3)), min_size=1, max_size=2)
)
def test_what_is_written_reads_as_it_was(terms):
    """Whatever names and values an expression has, its text is read as the same expression."""
    both = [Term(quantity, weld, tuple(settings.items())) for quantity, weld, settings in terms]
    expression = Expression(*both)
    assert parsed(str(expression)) == expression
