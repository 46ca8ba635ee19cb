"""Spans of shares, and which of their ends answers."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.decide.backsolve.by_mission import _answers
from fatigue.decide.backsolve.closed import Span


@pytest.mark.parametrize(
    ("low", "high", "now", "answer", "is_upper"),
    [
        (0.0, 0.4, 0.7, 0.4, True),  # passed now
        (0.0, 0.4, 0.2, 0.4, True),  # room to grow
        (0.3, 1.0, 0.1, 0.3, False),
        (0.3, 1.0, 0.8, 0.3, False),
        (0.2, 0.6, 0.3, 0.2, False),  # the nearer end
        (0.2, 0.6, 0.5, 0.6, True),
        (0.2, 0.6, 0.1, 0.2, False),  # the end that is passed
        (0.2, 0.6, 0.9, 0.6, True),
    ],
)
def test_end_that_answers(low, high, now, answer, is_upper):
    """The end that is passed now, else the nearer one of those that are no end of 0 to 1."""
    at, upper = _answers(Span(np.array([low]), np.array([high])), now)
    assert (float(at[0]), bool(upper[0])) == (answer, is_upper)


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_answers_are_ends(low, high, now):
    """NaN where any share or none will do, else an end of the span inside 0 to 1."""
    (at,), _ = _answers(Span(np.array([low]), np.array([high])), now)
    if low > high or (low == 0.0 and high == 1.0):
        assert np.isnan(at)
    else:
        assert at in (low, high)
        assert 0.0 <= at <= 1.0
