"""What names of channels state."""

import math

import pytest

from fatigue.readers.units.channel_names import channel, stated_frequency, time_unit_in, without_unit_one, written


@pytest.mark.parametrize(
    ("name", "mode", "unit"),
    [
        ("q_12", 12, ""),
        (".FLEX.Q12", 12, ""),
        ("$B_Car.q(12)", 12, ""),
        ("mode 7 [m]", 7, "m"),
        ("q 3 (12.5 Hz)", 3, ""),
        ("12", 12, ""),
        ("q", 0, ""),
    ],
)
def test_number_and_unit(name, mode, unit):
    """The last whole number that belongs neither to the unit nor to the frequency."""
    found = channel(name)
    assert (found.is_time, found.mode, found.unit) == (False, mode, unit)


@pytest.mark.parametrize(
    ("name", "unit"),
    [("time_s", "s"), ("Zeit [ms]", "ms"), ("t", ""), ("time (-)", ""), ("timer", None), ("t_1", None), ("q_1", None)],
)
def test_time(name, unit):
    """Names of time in several languages, and what only looks like one."""
    assert time_unit_in(name) == unit


def test_frequency_and_its_resolution():
    """Half a unit of the last digit that is written."""
    assert stated_frequency("q_3, f = 12,50 Hz") == pytest.approx((12.5, 0.005))
    assert stated_frequency("1.2 kHz") == pytest.approx((1200.0, 50.0))
    assert all(math.isnan(value) for value in stated_frequency("q_3"))
    assert written("1.25D+01") == pytest.approx((12.5, 0.05))


def test_one_in_brackets():
    """A unit where all coordinates have it, else the number of a mode."""
    assert without_unit_one(["time", "q_1 [1]", "q_2 [1]"]) == ["time", "q_1", "q_2"]
    assert without_unit_one(["time", "q [1]", "q [2]"]) == ["time", "q [1]", "q [2]"]
