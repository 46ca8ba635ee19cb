"""Distance of the samples of a record: no way is lost, none is counted twice, backwards is none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.gauges.measured.distance import filled, of_odometer, of_speed


@given(st.lists(st.floats(0.0, 5.0), min_size=1, max_size=50))
def test_an_odometer_gives_back_its_way(steps):
    """Half of each step on either side of it; the first and the last sample stand for a whole step."""
    reading = np.cumsum([0.0, *steps])
    ways, backwards = of_odometer(reading)
    assert backwards == 0
    assert (ways >= 0.0).all()
    assert ways.sum() == pytest.approx(reading[-1] + 0.5 * (steps[0] + steps[-1]))


def test_an_odometer_that_is_reset_loses_no_way():
    """A step backwards is counted as none, and told."""
    ways, backwards = of_odometer(np.array([100.0, 101.0, 0.0, 1.0]))
    assert backwards == 1
    assert ways.tolist() == [1.0, 0.5, 0.5, 1.0]


def test_speed_times_step_is_distance():
    """A train at 360 km/h runs 0.1 km in a second, whichever way."""
    assert of_speed(np.full(100, 360.0), 0.01).sum() == pytest.approx(0.1)
    assert of_speed(np.full(100, -360.0), 0.01).sum() == pytest.approx(0.1)
    assert of_speed(np.zeros(100), 0.01).sum() == 0.0


def test_missing_speeds_are_on_a_line():
    """Inside between their neighbours, at the ends held; a channel of nothing stays that."""
    x, missing = filled(np.array([np.nan, 2.0, np.inf, 4.0, np.nan]))
    assert (x.tolist(), missing) == ([2.0, 2.0, 3.0, 4.0, 4.0], 3)
    assert filled(np.full(3, np.nan))[1] == 3
