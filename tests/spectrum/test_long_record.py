"""A long record on disk has the slow part and the tones of the same record in memory."""

import numpy as np
import pytest

from fatigue.life.records.history import ModalHistory
from fatigue.life.records.spool import create_spool
from fatigue.spectrum import long_record, whole_record
from fatigue.spectrum.whole_record import record_matrices
from tests.synthetic_records import RATE, seconds


@pytest.mark.parametrize("blocks", [40, 1 << 14])
@pytest.mark.parametrize("upper_hz", [80.0, 1e9])
def test_parts_of_a_long_record(tmp_path, monkeypatch, blocks, upper_hz):
    """Drift, a tone and noise in two modes; pieces of bins, and all of them up to the last one."""
    samples = 100 * 256
    t = seconds(samples)
    noise = np.random.default_rng(0).normal(size=(2, samples))
    q = noise + np.stack([3 * np.sin(2 * np.pi * 0.1 * t), 0.5 * np.sin(2 * np.pi * 9.3 * t)])
    expected = record_matrices(ModalHistory("e", np.arange(2), q, 1 / RATE, 0.0), upper_hz)
    spool = create_spool(tmp_path / "q", q.shape, q.dtype)
    spool[:, :] = q
    monkeypatch.setattr(whole_record, "LONGEST_TRANSFORM", 0)
    monkeypatch.setattr(long_record, "BLOCKS_AT_ONCE", blocks)
    monkeypatch.setattr(long_record, "CHOSEN_AT_ONCE", 40)
    found = record_matrices(ModalHistory("e", np.arange(2), spool, 1 / RATE, 0.0), upper_hz)
    assert found.slow_hz == expected.slow_hz
    np.testing.assert_allclose(found.slow, expected.slow, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(found.lines, expected.lines, rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(found.covariance, expected.covariance)
    assert expected.lines[1, 1] > 0.1


def test_the_last_samples_matter_little(tmp_path, monkeypatch):
    """A length without the factor loses fewer than 256 samples."""
    samples = 400 * 256 + 17
    q = np.random.default_rng(0).normal(size=(1, samples)) + np.sin(2 * np.pi * 0.02 * seconds(samples))
    expected = record_matrices(ModalHistory("e", np.arange(1), q, 1 / RATE, 0.0), 80.0)
    spool = create_spool(tmp_path / "q", q.shape, q.dtype)
    spool[:, :] = q
    monkeypatch.setattr(whole_record, "LONGEST_TRANSFORM", 0)
    found = record_matrices(ModalHistory("e", np.arange(1), spool, 1 / RATE, 0.0), 80.0)
    assert found.slow[0, 0] == pytest.approx(expected.slow[0, 0], rel=2e-3)
