"""Bounds of the events of a block: they only fall, stand for counts, and say which stations they leave unsettled."""

from dataclasses import fields

import numpy as np
import pytest

from fatigue.life.mission import Pass, Plan
from fatigue.pipeline.count.bounds import Bound, Bounds, Screening

PLAN = Plan((Pass("a", 100, 1.0, 0.5, None), Pass("b", 100, 1.0, 0.5, None)), 1.0, 1.0, 1.0)


def bound(*damage):
    """A bound of the same damage on both faces of each station; the ranges are the damage as well."""
    array = np.repeat(np.array(damage, dtype=float)[:, None], 2, axis=1)
    return Bound(array, array.copy(), array.copy())


def bounds(first, second, proves_worst=True):
    """Bounds of two events at three stations; the share that is enough is 0.1."""
    screening = Screening(0.1, proves_worst, (), ())
    return Bounds([first, second], PLAN, np.ones((3, 2), dtype=bool), np.zeros((3, 1)), screening)


def test_a_bound_is_only_ever_lowered():
    """At the stations asked for, each array for itself."""
    found = bound(1.0, 2.0, 3.0).tightened(bound(0.5, 5.0), np.array([0, 2]))
    for field in fields(Bound):
        assert getattr(found, field.name)[:, 0].tolist() == [0.5, 2.0, 3.0]


def test_a_bound_stands_for_a_count_in_which_nothing_was_counted():
    """Damage and largest ranges are there, all else is NaN; a count is a bound that lies a millionth above it."""
    one = bound(1.0, 2.0)
    counted = one.as_count()
    known = {field.name for field in fields(Bound)}
    for field in fields(counted):
        if field.name in known:
            assert np.array_equal(getattr(counted, field.name), getattr(one, field.name))
        else:
            assert np.isnan(getattr(counted, field.name)).all()
    assert counted.histogram.shape == (2, 2, 0, 2)
    assert Bound.of_count(counted).damage == pytest.approx(1.000001 * one.damage, rel=1e-12)


def test_a_station_is_settled_below_the_share_and_below_the_worst_point():
    """Half of each event's damage counts; the second condition is dropped where the worst point need not be proven."""
    rows = np.arange(3)
    found = bounds(bound(0.3, 0.1, 0.02), bound(0.1, 0.06, 0.02))
    assert found.utilisation()[:, 0] == pytest.approx([0.2, 0.08, 0.02])
    assert found.unsettled(rows).tolist() == [0, 1, 2]  # no worst point is known yet
    found.worst[:] = 0.05
    assert found.unsettled(rows).tolist() == [0, 1]
    assert bounds(*found.of_events, proves_worst=False).unsettled(rows).tolist() == [0]


def test_the_event_with_the_largest_share_comes_first_and_who_is_settled_leaves():
    """Tightened in between, a station is not asked for again; the last event may find all of them settled."""
    found = bounds(bound(0.04, 0.04, 0.04), bound(0.3, 0.3, 0.3), proves_worst=False)
    asked = []
    for event, rows in found.event_by_event(np.arange(3)):
        asked.append((event, rows.tolist()))
        if event == 1:
            found.tighten(1, rows[:2], bound(0.0, 0.0))
    assert asked == [(1, [0, 1, 2]), (0, [2])]
