"""Classes of modes under single sines, and the thresholds that columns tell."""

import numpy as np
import pytest

from fatigue.results.dictionary.resonance import RESONANCE
from fatigue.vibration.resonance import AMPLIFIED, DYNAMIC, FAR_ABOVE, HALF_POWER, Indicators, mode_classes


def of_sine(r, response_share=0.0):
    """Indicators of an undamped mode of 10 Hz under a sine at r times its frequency."""
    values = 10.0, 10.0 * r, r * r, 1.0 / abs(1.0 - r * r), response_share
    return Indicators(*(np.array([value]) for value in values))


@pytest.mark.parametrize(
    ("r", "expected"),
    [
        (0.05, "quasi_static"),
        (0.70, "quasi_static"),
        (0.71, "resonant"),
        (1.01, "resonant"),
        (1.41, "resonant"),
        (1.42, "inertial"),
        (3.0, "inertial"),
    ],
)
def test_a_sine_below_in_and_above_resonance(r, expected):
    """It follows up to r = 0.7, swings up to r = sqrt(2), and is held back by inertia above."""
    assert mode_classes(of_sine(r)).tolist() == [expected]


def test_what_swings_in_its_half_power_band_is_resonant():
    """Even where faster loads make its quasi-static part larger than the coordinate."""
    assert mode_classes(of_sine(3.0, response_share=0.6)).tolist() == ["resonant"]


def test_without_a_dynamic_share_only_a_boundary_mode_has_a_class():
    """A mode above twice the highest frequency of its motion follows; a nearer one is not assessed."""
    nothing = np.full(2, np.nan)
    of = Indicators(np.array([330.0, 330.0]), np.array([164.0, 166.0]), nothing, nothing, nothing)
    assert mode_classes(of).tolist() == ["quasi_static", "not_assessed"]


def test_the_column_tells_the_thresholds():
    """The meaning of the class names the numbers that the code uses."""
    meaning = next(column.meaning for column in RESONANCE if column.name == "class")
    assert f"dynamic_share below {DYNAMIC:g}" in meaning
    assert f"above {FAR_ABOVE:g} times" in meaning
    assert f"amplification from {AMPLIFIED:g} or response_share from {HALF_POWER:g}" in meaning
