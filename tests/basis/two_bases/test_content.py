"""The part of a signal above a frequency: closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.basis.two_bases.content import rms_above

STEP = 1.0 / 200.0


@given(st.floats(0.5, 15.0), st.floats(25.0, 90.0), st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(-50.0, 50.0))
@settings(deadline=None, max_examples=30)
def test_a_slow_and_a_fast_sine(slow, fast, a, b, mean):
    """The fast sine is what lies above, whatever the mean, and however the record ends."""
    t = STEP * np.arange(6000)
    signal = a * np.sin(2 * np.pi * slow * t) + b * np.sin(2 * np.pi * fast * t + 0.3) + mean
    whole, above = rms_above(signal[None], STEP)
    assert whole[0] == pytest.approx(np.hypot(a, b) / np.sqrt(2), rel=0.02)
    assert above[0] == pytest.approx(b / np.sqrt(2), rel=0.02, abs=2e-3 * a)


def test_a_drift_is_nothing_fast_and_a_constant_is_nothing():
    """The ends of a record, far from each other, make no fast motion."""
    whole, above = rms_above(np.stack([np.linspace(0.0, 100.0, 2000), np.full(2000, 7.0)]), STEP)
    assert whole[0] > 25.0
    assert above[0] < 0.01 * whole[0]
    assert (whole[1], above[1]) == (0.0, 0.0)
