"""Unit loads on the instants of an event, against closed forms."""

import numpy as np
import pytest
from scipy.signal import resample

from fatigue.verify.recount.anew.unit_load import between, factor_for, on_grid
from fatigue.verify.recount.inputs.loads import RecountLoad


def load(samples, *, start=0.0, step=1.0, linear=False):
    """A load with a file of its own."""
    return RecountLoad(
        samples=np.asarray(samples, float), times=start + step * np.arange(len(samples)), is_linear=linear
    )


def test_the_smallest_power_of_two_that_is_no_longer_than_the_step_of_any_load():
    """Within a thousandth; loads on the grid of the event and constants ask for nothing."""
    own = RecountLoad(samples=np.ones(3))
    assert factor_for([], 0.01) == factor_for([own, RecountLoad(1.0)], 0.01) == 1
    assert factor_for([load(np.ones(9), step=0.01), own], 0.01) == 1
    assert factor_for([load(np.ones(9), step=0.004), load(np.ones(9), step=0.02)], 0.01) == 4
    assert factor_for([load(np.ones(9), step=0.005 / 1.0005)], 0.01) == 2


def test_samples_at_the_kept_instants_are_taken_as_they_are():
    """Also some from the middle of a longer file; not those half a step away, or of too short a file."""
    x = np.arange(20.0)
    assert on_grid(load(x, step=0.1), 0.5, 0.1, 8).tolist() == x[5:13].tolist()
    assert on_grid(RecountLoad(samples=x), 0.5, 0.1, 8).tolist() == x[12:].tolist()
    assert on_grid(load(x, start=0.05, step=0.1), 0.5, 0.1, 8) is None
    assert on_grid(load(x, step=0.1), 0.5, 0.1, 17) is None
    assert on_grid(load(x, step=0.11), 0.5, 0.1, 8) is None


def test_one_period_of_an_event_that_recurs_goes_round():
    """The very interpolation of scipy.signal.resample; any other load is mirrored about its ends."""
    x = np.random.default_rng(1).standard_normal(12)
    found = between(load(x, step=0.25), 0.0, 0.125, 24, period=3.0)
    np.testing.assert_allclose(found, resample(x, 24), atol=1e-12)
    mirrored = between(load(x, step=0.25), 0.0, 0.125, 23, period=None)
    np.testing.assert_allclose(mirrored[::2], x, atol=1e-12)
    np.testing.assert_allclose(
        between(load(x[::-1], step=0.25), 0.0, 0.125, 23, period=None), mirrored[::-1], atol=1e-12
    )
    np.testing.assert_allclose(between(load(x, step=0.25), 0.0, 0.125, 23, period=5.0), mirrored, atol=1e-12)


def test_straight_lines_of_one_period_go_round_as_well():
    """From the last sample to the first; of a longer file they go on to its next sample."""
    x = [0.0, 1.0, 4.0]
    assert between(load(x, linear=True), 0.0, 0.5, 6, period=3.0).tolist() == pytest.approx([0, 0.5, 1, 2.5, 4, 2])
    assert between(load([*x, 10.0], linear=True), 0.0, 0.5, 6, period=3.0).tolist() == pytest.approx(
        [0, 0.5, 1, 2.5, 4, 7]
    )
