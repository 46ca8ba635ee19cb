"""Reversals at the vertices of parabolas, against parabolas that are known."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.verify.recount.anew.vertex import vertices


def record(q, *, recurs, vertex=True):
    """The part of a record that is looked at."""
    return SimpleNamespace(counted=q, recurs=recurs, vertex=vertex)


def test_the_vertex_of_a_sampled_parabola_is_met():
    """Membrane and bending are read on their own parabolas at the instant at which their sum turns."""
    i = np.arange(-3.0, 4.0)
    m, b = 5.0 - 0.7 * (i - 0.3) ** 2, 1.0 + 0.2 * i - 0.3 * (i + 0.1) ** 2
    s, q = m + b, np.stack([m, b])
    found = vertices(s, record(q, recurs=False), 0.0)
    assert found.at.tolist() == [3]
    top = (2 * 0.7 * 0.3 + 0.2 - 2 * 0.3 * 0.1) / 2.0  # where the derivative of the sum is 0
    assert found.shift[0] == pytest.approx(top, rel=1e-12)
    parts = found.parts(np.eye(2), q, np.array([0, 3]))
    assert parts[:, 0].tolist() == [m[0], b[0]]
    expected = [5.0 - 0.7 * (top - 0.3) ** 2, 1.0 + 0.2 * top - 0.3 * (top + 0.1) ** 2]
    assert parts[:, 1] == pytest.approx(expected, rel=1e-12)
    assert found.moved(s)[3] == pytest.approx(parts[:, 1].sum(), rel=1e-12)
    assert found.shift_of(np.array([2, 3, 6])).tolist() == [0.0, found.shift[0], 0.0]


def test_ends_and_plateaus_stay_and_a_block_that_recurs_has_no_ends():
    """The first and the last sample of a block are neighbours."""
    s = np.array([3.0, 0.0, 0.0, 2.0, 1.0])
    assert vertices(s, record(s[None], recurs=False), 0.0).at.tolist() == [3]
    found = vertices(s, record(s[None], recurs=True), 0.0)
    assert found.at.tolist() == [0, 3, 4]
    assert found.shift[0] == pytest.approx((2.0 - 3.0) / (2.0 * (2.0 + 3.0)))
    at_samples = vertices(s, record(s[None], recurs=True, vertex=False), 0.0)
    assert not len(at_samples.at)
    assert at_samples.moved(s) is s


def test_which_of_two_samples_is_larger_may_be_a_matter_of_rounding():
    """Then the vertex is one of two, an eighth of the step apart at most; equal coordinates are equal for all."""
    s, q = np.array([0.0, 4.0, 4.0, 0.0]), np.array([[0.0, 1.0, 2.0, 0.0]])
    assert vertices(s, record(q, recurs=False), 1e-9).doubt == 0.5
    assert vertices(s, record(s[None], recurs=False), 1e-9).doubt == 0.0


@given(st.lists(st.floats(-100, 100), min_size=3, max_size=30), st.booleans())
def test_an_overshoot_is_at_most_an_eighth_of_the_larger_step(values, recurs):
    """Peaks rise, valleys fall, and nothing else moves."""
    s = np.array(values)
    found = vertices(s, record(s[None], recurs=recurs), 0.0)
    moved = found.moved(s) - s
    step = np.maximum(np.abs(s - np.roll(s, 1)), np.abs(s - np.roll(s, -1)))
    is_peak = s > np.roll(s, 1)
    assert (np.abs(moved) <= step / 8.0 * (1 + 1e-9) + 1e-12).all()
    assert (np.where(is_peak, moved, -moved)[found.at] >= -1e-12).all()
    assert (np.abs(found.shift) < 0.5 + 1e-12).all()
    assert not np.delete(moved, found.at).any()
