"""Records: the start-up cut, the duration of a pass, upsampling, stresses and statistics; in memory and on disk."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.life.records import spool
from fatigue.life.records.history import ModalHistory, kept, mean_and_covariance, stress_history, upsampled
from fatigue.life.records.spool import Spool, create_spool


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


def on_disk(history, path):
    """Move a record to a file."""
    made = create_spool(path, history.q.shape, history.q.dtype)
    made[:, :] = history.q
    return replace(history, q=made)


def noise(modes, samples):
    """A record of noise in single precision, far from zero."""
    q = np.random.default_rng(0).normal(size=(modes, samples)) + 50.0
    return ModalHistory("e", np.arange(modes), q.astype(np.float32), 0.01, 5.0)


@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_a_record_on_disk_is_cut_and_upsampled_like_one_in_memory(tmp_path, residue):
    """The same numbers, and they stay on disk."""
    whole = noise(3, 9001)
    expected = upsampled(kept(whole, 0.3), 2, residue)
    cut = kept(on_disk(whole, tmp_path / "q"), 0.3)
    found = upsampled(cut, 2, residue, tmp_path / "fine")
    assert isinstance(cut.q, Spool)
    assert isinstance(found.q, Spool)
    assert found.start == expected.start
    np.testing.assert_array_equal(np.asarray(found.q), expected.q)


@pytest.mark.parametrize("samples", [1, 2, 300, 10_000])
def test_mean_and_covariance_do_not_depend_on_the_pieces(tmp_path, monkeypatch, samples):
    """Against numpy, in memory and on disk."""
    whole = noise(4, samples)
    wide = whole.q.astype(np.float64)
    monkeypatch.setattr(spool, "CHUNK", 64)
    monkeypatch.setattr(spool, "AT_ONCE", 64)
    for q in (whole.q, on_disk(whole, tmp_path / "q").q):
        mean, covariance = mean_and_covariance(q)
        np.testing.assert_allclose(mean, wide.mean(axis=1), rtol=1e-13)
        np.testing.assert_allclose(covariance, np.cov(wide, bias=True), rtol=1e-11, atol=1e-14)


def test_a_record_at_rest_has_exactly_no_variance():
    """Not even rounding."""
    mean, covariance = mean_and_covariance(np.full((3, 1000), 0.1))
    np.testing.assert_array_equal(mean, np.full(3, 0.1))
    np.testing.assert_array_equal(covariance, np.zeros((3, 3)))


def test_stress_histories_of_one_shape_and_of_many(tmp_path, monkeypatch):
    """Double precision whatever that of the record, piece by piece."""
    whole = noise(5, 9000)
    shapes = np.random.default_rng(1).normal(size=(7, 5))
    expected = shapes @ whole.q.astype(np.float64)
    monkeypatch.setattr(spool, "AT_ONCE", 5)
    for q in (whole.q, on_disk(whole, tmp_path / "q").q):
        np.testing.assert_allclose(stress_history(shapes, q), expected, rtol=1e-12)
        np.testing.assert_allclose(stress_history(shapes[2], q), expected[2], rtol=1e-12)
