"""A ride at a lower rate: what is slow stays, what is fast does not fold back, modes far above it stay right."""

import numpy as np
import pytest

from fatigue.errors import CaseError
from fatigue.vehicle.in_time.recorded import Ride
from fatigue.vehicle.in_time.thinned import thinned

TIME = 3.0 + 1e-3 * np.arange(20_001)


def of_signal(signal):
    """A ride in which everything does the same."""
    rows = np.stack([signal, 2 * signal])
    return Ride(1e-3, 97.0, TIME, rows, {"bog_y": signal}, {"mount_mx": signal}, rows[:1], np.abs(np.sign(rows[:1])))


def test_a_slow_sine_stays_what_it_is():
    """8 Hz at 250 Hz: every fourth sample, unchanged to 0.2 %, in every part of the ride."""
    ride = of_signal(np.sin(2 * np.pi * 8.0 * TIME))
    found = thinned(ride, 250.0)
    assert found.step_s == pytest.approx(4e-3)
    np.testing.assert_allclose(found.time_s, TIME[::4], rtol=1e-12)
    expected = np.sin(2 * np.pi * 8.0 * found.time_s)
    for values in (found.q[0], found.q[1] / 2, found.channels["bog_y"], found.recovered["mount_mx"]):
        np.testing.assert_allclose(values[50:-50], expected[50:-50], atol=2e-3)
    np.testing.assert_allclose(found.wheelsets_m[0], found.q[0], rtol=1e-12)
    assert found.worn.shape == found.wheelsets_m.shape
    assert found.speed_m_s == ride.speed_m_s


def test_what_is_fast_does_not_fold_back():
    """242 Hz read every 4 ms would be 8 Hz; less than 0.3 % of it is left."""
    found = thinned(of_signal(np.sin(2 * np.pi * 242.0 * TIME)), 250.0)
    assert np.abs(found.q[0, 50:-50]).max() < 3e-3


def test_a_ride_that_does_not_begin_at_zero_has_no_transient():
    """The line through the ends of a record stays as it is."""
    found = thinned(of_signal(5.0 + 0.1 * TIME), 200.0)
    np.testing.assert_allclose(found.q[0], 5.0 + 0.1 * found.time_s, rtol=1e-6)


def test_rates_are_whole_parts_of_the_rate_of_the_ride():
    """300 Hz of 1000 Hz is every third sample; the rate of the ride itself changes nothing; more there is not."""
    ride = of_signal(np.sin(TIME))
    assert thinned(ride, 300.0).step_s == pytest.approx(3e-3)
    assert thinned(ride, 1000.0) is ride
    for rate in (1001.0, 0.0, float("nan")):
        with pytest.raises(CaseError, match=r"a ride in steps of 0\.001 s holds no .* samples per second"):
            thinned(ride, rate)
