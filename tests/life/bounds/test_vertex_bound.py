"""Bounds where reversals are read at their vertices: never below what is counted there."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.life.bounds.vertex_bound import growth, vertex_bound
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.counting.vertex import vertex_history
from tests.awkward_records import KINDS, modal_coordinates

POWERS = (1, 2, 3, 4)


def variation(s, q, *, recurs):
    """Total variation of s |s|^(q-1)."""
    f = s * np.abs(s) ** (q - 1)
    return float(np.abs(np.diff(np.append(f, f[:1]) if recurs else f)).sum())


@settings(deadline=None, max_examples=200)
@given(st.lists(st.floats(-100.0, 100.0), min_size=2, max_size=30), st.booleans(), st.sampled_from(POWERS))
def test_the_variation_grows_no_more_than_that(values, recurs, q):
    """Of any history, about any level."""
    s = np.array(values)
    moved = vertex_history(s, np.zeros(len(s)), 1.0, recurs=recurs).membrane
    assert variation(moved, q, recurs=recurs) <= growth(q) * variation(s, q, recurs=recurs) * (1 + 1e-9) + 1e-9
    assert np.ptp(moved) <= 1.25 * np.ptp(s) * (1 + 1e-12)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("residue", ["half", "repeat"])
def test_cycles_at_vertices_stay_below(kind, residue):
    """Range and sums n S^q by the variation of the samples, of records of every kind."""
    rng = np.random.default_rng(KINDS.index(kind))
    for _ in range(20):
        s = modal_coordinates(rng, kind)[0].astype(np.float64)
        s = s - s.mean()
        recurs = residue == "repeat"
        sums = {q: 2.0 ** (q - 2) * variation(s, q, recurs=recurs) for q in POWERS}
        largest, bounds = vertex_bound(np.ptp(s), sums)
        cycles = rainflow(vertex_history(s, np.zeros(len(s)), 1.0, recurs=recurs).membrane, residue)
        assert cycles.range.max(initial=0.0) <= largest * (1 + 1e-9) + 1e-12 * np.abs(s).max()
        for q, bound in bounds.items():
            assert (cycles.count * cycles.range**q).sum() <= bound * (1 + 1e-9) + 1e-300


def test_one_peak_of_three_samples():
    """0, 1, 0 and a touch below, repeated: the largest growth of a range, one eighth, is nearly reached."""
    s = np.array([0.0, 1.0, 1.0 - 1e-9, 0.0])
    moved = vertex_history(s, np.zeros(4), 1.0, recurs=False).membrane
    assert np.ptp(moved) == pytest.approx(1.125, rel=1e-6)
