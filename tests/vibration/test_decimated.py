"""A record at a lower sampling rate: what stays, what goes, and where the first sample is."""

import numpy as np
import pytest

from fatigue.vibration.decimated import decimated


@pytest.mark.parametrize(
    ("rate", "slow"), [(200, 200), (250, 250), (399, 399), (400, 200), (1000, 200), (4096, 4096 / 20)]
)
def test_rate(rate, slow):
    """No record becomes slower than 200 Hz, and none stays at twice that."""
    values, step = decimated(np.zeros(10 * rate), 1 / rate, 12.0)
    assert 1 / step == pytest.approx(slow)
    assert values.size == pytest.approx(10 * slow, abs=1)


def test_wide_band_keeps_ten_samples_per_period():
    """A band up to 50 Hz asks for 500 Hz."""
    assert 1 / decimated(np.zeros(10_000), 1e-3, 50.0)[1] == pytest.approx(500)


def test_nothing_is_delayed_and_nothing_folds_back():
    """A sine of 12 Hz stays as it is, sample for sample; one of 195 Hz, which would fold back to 5 Hz, goes."""
    t = np.arange(20_000) / 1000
    slow, step = decimated(np.sin(2 * np.pi * 12 * t) + np.sin(2 * np.pi * 195 * t), 1e-3, 12.0)
    inner = slice(50, -50)
    assert slow[inner] == pytest.approx(np.sin(2 * np.pi * 12 * np.arange(slow.size) * step)[inner], abs=0.003)


def test_a_constant_and_a_drift_leave_no_transient():
    """A straight line stays one up to its ends."""
    line = 9.81 + 0.3 * np.arange(5000) / 1000
    slow, step = decimated(line, 1e-3, 12.0)
    assert slow == pytest.approx(9.81 + 0.3 * np.arange(slow.size) * step, abs=0.01)
