"""Coefficients of long records on disk: those of records in memory, whatever their length and basis."""

import numpy as np
import pytest

from fatigue.spectrum import long_bands
from fatigue.spectrum.bands import band_slices, coefficient_frequencies, coefficients
from fatigue.spectrum.long_bands import long_band_slices, long_coefficients


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("samples", [4096, 17 * 51, 1009, 1021 * 2])
@pytest.mark.parametrize("records", [1, 2])
def test_coefficients_are_those_of_records_in_memory(samples, residue, records, tmp_path, monkeypatch):
    """Even and odd lengths, with and without factors, one record and two, all of them and some."""
    monkeypatch.setattr(long_bands, "LONGEST_TRANSFORM", 100)
    x = np.random.default_rng(samples).standard_normal((records, samples)).cumsum(axis=1) + 50.0
    expected = coefficients(x, residue)
    scale = np.abs(expected).max()
    with long_coefficients(lambda a, b: x[:, a:b], samples, residue, tmp_path / "t") as found:
        for first, end in [(0, samples), (0, 1), (1, 2), (2, 5), (7, 400), (samples - 3, samples)]:
            part = found(first, end)
            assert part.shape == (records, end - first)
            np.testing.assert_allclose(part, expected[:, first:end], rtol=0.0, atol=1e-12 * scale)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_slices_are_those_of_all_frequencies(residue):
    """Edges on frequencies, between them, below and above all of them."""
    samples, step = 999, 0.01
    frequency = coefficient_frequencies(samples, step, residue)
    edges = np.sort([0.001, *frequency[[3, 4, 500]], 7.7, 20.1, 1e3])
    assert long_band_slices(samples, step, residue, edges) == band_slices(frequency, edges)
