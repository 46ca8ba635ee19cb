"""The most damaging cycles of an event: by the damage of a whole one."""

import pandas as pd

from fatigue.report.sections.point.worst_cycles import most_damaging

CYCLES = pd.DataFrame(
    {
        "event": ["a", "a", "b", "a"],
        "start_s": [1.0, 2.0, 3.0, 4.0],
        "end_s": [1.5, 2.5, 3.5, 0.5],
        "count": [1.0, 0.5, 1.0, 1.0],
        "damage": [3e-9, 2e-9, 9e-9, 3e-9],
    }
)


def test_half_cycles_count_whole_and_the_first_of_equals_leads():
    """Half a cycle of 2e-9 is one of 4e-9."""
    assert most_damaging(CYCLES, "a", 2) == [(2.0, 2.5), (1.0, 1.5)]
    assert most_damaging(CYCLES, "a", 9) == [(2.0, 2.5), (1.0, 1.5), (4.0, 0.5)]


def test_an_event_without_cycles():
    """None of an event that is not there, or not known."""
    assert most_damaging(CYCLES, "c", 2) == []
    assert most_damaging(CYCLES, None, 2) == []
