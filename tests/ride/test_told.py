"""Whether an alarm tells of the damage: every outcome, and none where no alarm can be had."""

import pytest

from fatigue.ride.alarm import AlarmRow
from fatigue.ride.hot_damage import HotDamageRow, told

NAN = float("nan")


def outcome(alarms, share, length):
    """What is told of a channel with so many alarms, whose hot stretches hold so much of damage and length."""
    alarm = AlarmRow("worn", "bogie", alarms, NAN, NAN, NAN, 8.0, 6, length, NAN, None, None)
    dense = NAN if length in (0.0, NAN) else share / length
    worst = HotDamageRow("A", 0, 1, 1, "top", "worn", "bogie", 1.0, share, share, length, dense)
    return told(alarm, worst).told


@pytest.mark.parametrize(
    ("alarms", "share", "length", "expected"),
    [
        (2, 0.9, 0.2, "yes"),
        (0, 0.9, 0.2, "missed"),
        (2, 0.1, 0.2, "nothing_to_tell"),
        (0, 0.0, 0.0, "no_hot_stretch"),
        (None, 0.9, 0.2, None),
        (None, 0.0, 0.0, None),
        (0, NAN, NAN, None),
    ],
)
def test_outcomes(alarms, share, length, expected):
    """The table of the documentation, row by row."""
    assert outcome(alarms, share, length) == expected
