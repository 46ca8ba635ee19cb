"""Uneven steps, instants written twice and gaps."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.foreign.histories.time_grid import uniform


def history(time):
    """One coordinate, a sine of 1 rad/s."""
    time = np.asarray(time, float)
    return ForeignHistory("q", np.array([1]), np.array([np.nan]), ("q_1",), time, np.sin(time)[None])


def test_uneven_steps_are_resampled_on_request():
    """An event with smaller steps is refused, and interpolated by cubic splines if a step is given."""
    uneven = history(np.concatenate([np.arange(0, 1, 0.1), np.arange(1, 2, 0.05)]))
    with pytest.raises(DataError, match=r"resample, for instance with a step of 0\.05 s"):
        uniform(uneven, None)
    even = uniform(uneven, 0.02)
    assert np.allclose(np.diff(even.time), 0.02)
    assert np.allclose(even.q[0], np.sin(even.time), atol=2e-5)
    assert [warning.code for warning in even.warnings] == ["resampled"]
    assert [warning.code for warning in uniform(uneven, 0.2).warnings] == ["resampled", "coarser"]
    assert uniform(history([0, 1, 2]), None).time.size == 3
    for step in (0.0, -1.0, 1e-12, 99.0):
        with pytest.raises(DataError, match="is impossible"):
            uniform(uneven, step)


def test_an_instant_written_twice():
    """Solvers write an event twice: with a step the later sample is kept, without one the place is named."""
    time = np.array([0.0, 0.1, 0.2, 0.2, 0.2, 0.3, 0.3, 0.4])
    twice = replace(history(time), q=np.arange(8.0)[None], lines=np.arange(2, 10))
    with pytest.raises(
        DataError, match=r"^q, line 5, sample 4: time goes from 0\.2 to 0\.2 s, it stands still \(and at 2"
    ):
        uniform(twice, None)
    even = uniform(twice, 0.1)
    assert even.time == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])
    assert even.q[0] == pytest.approx([0.0, 1.0, 4.0, 6.0, 7.0])
    assert [(warning.code, warning.count) for warning in even.warnings] == [("instant_twice", 3), ("resampled", 1)]
    with pytest.raises(DataError, match="time stands still"):
        uniform(history([1.0, 1.0]), 0.1)


def test_a_gap_is_told():
    """An interpolation over lost samples is a doubt that names the place."""
    gap = history([*np.arange(0, 1, 0.01), *np.arange(3, 4, 0.01)])
    assert [warning.code for warning in uniform(gap, 0.01).warnings] == ["resampled", "gap"]
    assert "from 0.99 s" in uniform(gap, 0.01).warnings[1].what
