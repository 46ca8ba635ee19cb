"""Records: the start-up cut, the duration of a pass, upsampling."""

import numpy as np
import pytest

from fatigue.life.history import ModalHistory, kept, upsampled


def record(q, step=0.01, start=5.0):
    """A one-mode history."""
    return ModalHistory("e", np.array([1]), np.atleast_2d(np.asarray(q, dtype=float)), step, start)


@pytest.mark.parametrize(("start_s", "first"), [(0.0, 0), (0.004, 0), (0.005, 0), (0.0051, 1), (0.02, 2), (0.0249, 2)])
def test_start_up_cut_is_by_half_steps(start_s, first):
    """Samples with time - time[0] >= start - step / 2 stay."""
    whole = record(np.arange(10.0))
    assert kept(whole, start_s).q[0, 0] == first
    assert kept(whole, start_s).start == pytest.approx(5.0 + first * 0.01)


def test_duration_is_samples_times_step():
    """A block that repeats lasts as long as its samples, not one step less."""
    assert record(np.zeros(100)).duration == pytest.approx(1.0)


@pytest.mark.parametrize("samples", [64, 65])
@pytest.mark.parametrize("factor", [2, 4])
def test_upsampling_a_block_that_repeats_is_exact_below_nyquist(samples, factor):
    """A periodic band-limited record is found again on the finer grid; its own samples are kept."""
    t = np.arange(samples) / samples

    def signal(t):
        return 2.0 + np.sin(2 * np.pi * 3 * t) + 0.3 * np.cos(2 * np.pi * 11 * t)

    fine = upsampled(record(signal(t)), factor, "repeat")
    assert fine.q[0] == pytest.approx(signal(np.arange(samples * factor) / (samples * factor)), abs=1e-12)
    assert fine.q[0, ::factor] == pytest.approx(signal(t), abs=1e-12)
    assert fine.step == pytest.approx(0.01 / factor)


def test_upsampling_a_single_pass_does_not_ring_at_a_jump():
    """Mirrored at its ends, a ramp stays near a ramp although its first and last sample differ."""
    ramp = np.linspace(0.0, 100.0, 50)
    fine = upsampled(record(ramp), 4, "half")
    assert fine.q.shape[1] == 49 * 4 + 1
    assert fine.q[0, ::4] == pytest.approx(ramp, abs=1e-9)
    assert np.all(fine.q[0] > -1.0)
    assert np.all(fine.q[0] < 101.0)


def test_factor_one_leaves_the_record_alone():
    """No upsampling, no copy."""
    whole = record(np.arange(5.0))
    assert upsampled(whole, 1, "repeat") is whole
