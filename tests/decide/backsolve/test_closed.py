"""Closed forms against the oracles of the specification, key B3."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from fatigue.decide.backsolve.closed import km_per_year, share_that_meets, shares_that_meet, strength_factor

ALUMINIUM = 3.6085450346420327


def test_load_and_curve():
    """Oracles [B3 straight]: utilisation 2.5."""
    x = float(strength_factor(np.array([2.5]), ALUMINIUM)[0])
    assert 1.0 / x == pytest.approx(0.7757519300968568, rel=1e-12)
    assert x == pytest.approx(1.2890718813617963, rel=1e-12)


def test_mileage():
    """Oracle [B3 straight.km_per_year_for_30_years]; infinite lives bear any."""
    assert km_per_year(np.array([4.8e6, np.inf]), 30.0).tolist() == [160000.0, np.inf]


def test_share_of_an_event():
    """Oracle [B3 share]: events of 3e-7, 4e-8, 6e-8 per km with 0.1, 0.7, 0.2; the first one, at 1.2e7 km."""
    rest = np.array([(0.7 * 4e-8 + 0.2 * 6e-8) / 0.9])
    s = share_that_meets(np.zeros(1), np.array([3e-7]), rest, 1.0 / 1.2e7)
    assert float(s[0]) == pytest.approx(0.15217391304347827, rel=1e-12)


@given(st.floats(0.0, 2.0), st.floats(0.0, 3.0), st.floats(0.0, 3.0), st.floats(0.01, 3.0))
@example(0.0, 0.0, 2.2e-311, 1.0)  # the share overflows
def test_spans_hold_what_meets(held, own, rest, allowed):
    """Every share inside the span meets what is allowed, every one outside does not."""
    span = shares_that_meet(*(np.array([value]) for value in (held, own, rest)), allowed)
    for s in np.linspace(0.0, 1.0, 21):
        damage = held + s * own + (1.0 - s) * rest
        inside = span.low[0] <= s <= span.high[0]
        if abs(damage - allowed) > 1e-9:
            assert inside == (damage <= allowed)
