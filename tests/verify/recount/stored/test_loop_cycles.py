"""Cycles of a loop have no first reversal: their instants are compared in the order of events and time."""

import numpy as np

from fatigue.verify.recount.stored.loop_cycles import _in_order


def test_instants_of_a_cycle_in_order():
    """Turned where the later event, or the later instant of one event, comes first."""
    columns = {
        "start_event": np.array([0.0, 1.0, 0.0]),
        "end_event": np.array([0.0, 0.0, 1.0]),
        "start_s": np.array([5.0, 2.0, 9.0]),
        "end_s": np.array([3.0, 7.0, 1.0]),
        "range_MPa": np.array([10.0, 20.0, 30.0]),
    }
    found = _in_order(columns)
    np.testing.assert_array_equal(found["start_event"], [0.0, 0.0, 0.0])
    np.testing.assert_array_equal(found["end_event"], [0.0, 1.0, 1.0])
    np.testing.assert_array_equal(found["start_s"], [3.0, 7.0, 9.0])
    np.testing.assert_array_equal(found["end_s"], [5.0, 2.0, 1.0])
    np.testing.assert_array_equal(found["range_MPa"], columns["range_MPa"])
