"""Stress recovered from modal coordinates for the points in detail."""

import numpy as np
import pytest
from scipy.signal import welch

from fatigue.life.records.history import ModalHistory
from fatigue.report import stress

STEP = 0.004


@pytest.fixture
def history():
    """Two modes at 9 and 14 Hz and one that stands still, 20 s."""
    t = STEP * np.arange(5000)
    q = np.stack([np.sin(2 * np.pi * 9.0 * t), 0.5 * np.sin(2 * np.pi * 14.0 * t + 1.0), np.full_like(t, 3.0)])
    return ModalHistory("run", np.array([3, 5, 8]), q, STEP, 10.0)


MODAL_STRESS = np.array([2.0, 4.0, 1.0])


def test_the_spectrum_is_that_of_the_stress(history):
    """Welch's method on the recovered stress gives the same density."""
    found = stress.spectrum(stress.event_record(history, 1.5), MODAL_STRESS, 2.0, 100.0)
    frequency, density = welch(1.5 * MODAL_STRESS @ history.q, 1 / STEP, nperseg=500, detrend="constant")
    kept = frequency <= 100.0
    np.testing.assert_allclose(found.frequency, frequency[kept])
    np.testing.assert_allclose(found.density, density[kept], rtol=1e-9, atol=1e-12)


def test_a_short_record_has_no_spectrum(history):
    """Shorter than one segment: none, and no error."""
    assert stress.spectrum(stress.event_record(history, 1.0), MODAL_STRESS, 30.0, 100.0) is None


def test_shares_of_the_variance_sum_to_one(history):
    """Two sines share as their squares; what stands still has no share."""
    shares = stress.variance_shares(stress.event_record(history, 2.0), MODAL_STRESS)
    assert shares.sum() == pytest.approx(1.0)
    np.testing.assert_allclose(shares, [0.5, 0.5, 0.0], atol=2e-3)


def test_shares_of_nothing_are_not_numbers(history):
    """A point whose stress does not vary has no shares."""
    assert np.isnan(stress.variance_shares(stress.event_record(history, 1.0), np.array([0.0, 0.0, 1.0]))).all()


def test_deviations_are_those_of_the_stress(history):
    """Standard deviation along the line from the covariance of the modes."""
    modal_stress = np.array([MODAL_STRESS, 0.5 * MODAL_STRESS, [0.0, 0.0, 1.0]])
    found = stress.deviations(stress.event_record(history, 1.0), modal_stress)
    np.testing.assert_allclose(found, (modal_stress @ history.q).std(axis=1), atol=1e-12)


def test_a_short_cycle_has_one_close_up(history):
    """Both instants in one window, at their file times, with the stress there."""
    record = stress.event_record(history, 1.0)
    (found,) = stress.excerpts(record, MODAL_STRESS, 12.0, 12.2, [0, 1])
    np.testing.assert_allclose(found.instants, [12.0, 12.2])
    np.testing.assert_allclose(found.stress, (MODAL_STRESS @ history.q)[425:626])
    np.testing.assert_allclose(found.time[[0, -1]], [11.7, 12.5])
    assert list(found.parts) == [3, 5]


def test_a_long_or_wrapped_cycle_has_two_close_ups(history):
    """One around each instant, the earlier first, cut at the ends of the record."""
    found = stress.excerpts(stress.event_record(history, 1.0), MODAL_STRESS, 29.99, 10.0, [0])
    assert [round(e.instants[0], 3) for e in found] == [10.0, 29.988]
    assert [len(e.time) for e in found] == [76, 78]


def test_the_envelope_holds_every_extreme(history):
    """The largest and smallest stress of the record are in it."""
    found = stress.envelope(stress.event_record(history, 1.0), MODAL_STRESS)
    whole = MODAL_STRESS @ history.q
    assert len(found.time) == 600
    assert (found.low.min(), found.high.max()) == (whole.min(), whole.max())


def test_constants_move_the_level_and_nothing_else(history):
    """What is given and means that are removed are in history and envelope, never in parts or spectra."""
    plain, constants = stress.event_record(history, 1.5), np.array([0.0, 4.0, -1.0])
    removed = np.array([True, True, False])
    record = stress.event_record(history, 1.5, constants, removed)
    level = 1.5 * MODAL_STRESS @ (constants - np.where(removed, history.q.mean(axis=1), 0.0))
    (found,), (expected,) = (stress.excerpts(one, MODAL_STRESS, 12.0, 12.2, [0, 1]) for one in (record, plain))
    np.testing.assert_allclose(found.stress, expected.stress + level)
    assert [found.parts[mode].tolist() for mode in (3, 5)] == [expected.parts[mode].tolist() for mode in (3, 5)]
    low, high = stress.envelope(record, MODAL_STRESS), stress.envelope(plain, MODAL_STRESS)
    np.testing.assert_allclose(low.low, high.low + level)
    np.testing.assert_allclose(low.high, high.high + level)
    of_both = [stress.spectrum(one, MODAL_STRESS, 2.0, 100.0) for one in (record, plain)]
    np.testing.assert_array_equal(of_both[0].density, of_both[1].density)
