"""Cycles of the strain of gauges: closed forms on a sine, residue, events weighted into the mission."""

import numpy as np
import pytest

from fatigue.gauges.histories.counts import Counted, counted_cycles, gauge_spectra
from fatigue.gauges.simulated import Reading

STEP = 0.01


def sine(amplitude, cycles, residue="repeat"):
    """Reading of one gauge: whole cycles of a sine with its peaks on samples."""
    t = STEP * np.arange(20 * cycles)
    strain = amplitude * np.sin(2 * np.pi * t / (20 * STEP))[None]
    return Reading("sine", 0.0, STEP, strain, 0.07 * strain, residue)


def test_a_sine_has_its_cycles_of_twice_its_amplitude():
    """Sum n r^k, and the range that does the same at one cycle a second."""
    reading = sine(50.0, 30)
    counted = Counted("sine", counted_cycles(reading, vertex=False), 6.0, 2.0)
    found = gauge_spectra([counted], 0, 3.6)
    assert found.cycles == pytest.approx([30.0])
    assert found.largest == pytest.approx([100.0])
    assert found.power_sum == pytest.approx([30 * 100.0**3.6])
    assert found.equivalent == pytest.approx([100.0 * (30 / 6.0) ** (1 / 3.6)])
    assert found.mission.count.sum() == pytest.approx(60.0)  # two passes a km


def test_events_add_up_with_their_passes():
    """The mission is the weighted sum; classes are common to all events."""
    events = [
        Counted("small", counted_cycles(sine(10.0, 8), vertex=False), 1.6, 5.0),
        Counted("large", counted_cycles(sine(40.0, 3), vertex=True), 0.6, 0.25),
    ]
    found = gauge_spectra(events, 0, 3.0)
    assert found.edges[-1] == pytest.approx(80.0, rel=0.02)
    total = found.mission
    assert total.count.sum() == pytest.approx(5 * 8 + 0.25 * 3)
    assert total.power_sum.sum() == pytest.approx(5 * 8 * 20.0**3 + 0.25 * found.power_sum[1])
    assert total.reached[0] == pytest.approx(total.count.sum())


def test_the_residue_is_that_of_the_event():
    """One step up and back is one cycle where it recurs, and up alone is half a cycle where it does not."""
    up = np.array([[0.0, 30.0]])
    for residue, cycles in (("repeat", 1.0), ("half", 0.5)):
        (found,) = counted_cycles(Reading("e", 0.0, 1.0, up, up, residue), vertex=False)
        assert found.count.sum() == pytest.approx(cycles)
        assert found.range == pytest.approx([30.0] * found.range.size)


def test_a_gauge_at_rest_has_no_cycles():
    """And no damage, and no division by nothing."""
    still = Reading("e", 0.0, 1.0, np.zeros((1, 50)), np.zeros((1, 50)), "repeat")
    found = gauge_spectra([Counted("e", counted_cycles(still, vertex=False), 50.0, 1.0)], 0, 3.6)
    assert (found.cycles[0], found.largest[0], found.power_sum[0], found.equivalent[0]) == (0.0, 0.0, 0.0, 0.0)
