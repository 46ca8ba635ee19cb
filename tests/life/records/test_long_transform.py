"""Transforms in scratch files against those in memory, for lengths with factors and without."""

import tracemalloc

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.life.records import history, long_transform
from fatigue.life.records.history import ModalHistory, upsampled
from fatigue.life.records.long_transform import factor_of
from fatigue.life.records.long_transform import long_transform as transform


@pytest.mark.parametrize("length", [4096, 5000, 12_288, 4999, 2 * 2503])
@pytest.mark.parametrize("at_once", [1000, 1 << 20])
def test_transform(tmp_path, monkeypatch, length, at_once):
    """All bins and some of them, whatever is in memory at a time; no file is left."""
    monkeypatch.setattr(long_transform, "AT_ONCE", at_once)
    x = 3.0 + np.random.default_rng(0).normal(size=length)
    expected = np.fft.fft(x)
    with transform(lambda a, b: x[a:b], length, tmp_path / "scratch") as bins:
        np.testing.assert_allclose(bins(0, length), expected, atol=1e-12 * np.abs(expected).max())
        np.testing.assert_array_equal(bins(77, 1234), bins(0, length)[77:1234])
    assert list(tmp_path.iterdir()) == []


def test_factors():
    """Near 256, of rows that are not too long; none of a prime number."""
    assert factor_of(256 * 1001) == 256
    assert factor_of(5_000_000) == 250
    assert factor_of(5_000_011) == 0
    assert factor_of(1 << 34) == 1 << 12


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("samples", [600, 601, 997])
@pytest.mark.parametrize("factor", [2, 8])
def test_a_long_record_is_interpolated_as_a_short_one(tmp_path, monkeypatch, residue, samples, factor):
    """To rounding; the samples of the record stay."""
    q = np.random.default_rng(samples).normal(size=(2, samples)).astype(np.float32)
    event = ModalHistory("e", np.arange(2), q, 0.01, 0.0)
    expected = upsampled(event, factor, residue)
    monkeypatch.setattr(history, "LONGEST_TRANSFORM", 0)
    found = upsampled(event, factor, residue, tmp_path / "fine")
    assert found.step == expected.step
    np.testing.assert_allclose(np.asarray(found.q), expected.q, atol=1e-13)
    np.testing.assert_array_equal(np.asarray(found.q)[:, ::factor], q)
    assert [path.name for path in tmp_path.iterdir()] == ["fine"]


def test_no_place_for_scratch_files(tmp_path):
    """A clear line."""
    (tmp_path / "file").touch()
    with (
        pytest.raises(DataError, match="cannot be written"),
        transform(lambda a, b: np.zeros(b - a), 4096, tmp_path / "file" / "x"),
    ):
        pass


@pytest.mark.parametrize("length", [1_000_000, 100_003])
def test_memory_does_not_grow_with_the_length(tmp_path, monkeypatch, length):
    """Less than a copy of the numbers, with factors or without."""
    monkeypatch.setattr(long_transform, "AT_ONCE", 1 << 13)
    tracemalloc.start()
    try:
        with transform(lambda a, b: np.arange(a, b) % 17.0, length, tmp_path / "scratch") as bins:
            bins(0, 1000)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 3e6
