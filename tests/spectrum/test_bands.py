"""Frequency bands: what adds up, what keeps its products, and where a tone, a ramp and a third octave belong."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.fft import idct

from fatigue.spectrum.bands import (
    band_products,
    band_slices,
    coefficient_frequencies,
    coefficients,
    third_octaves,
)

STEP = 0.01
RESIDUES = pytest.mark.parametrize("residue", ["repeat", "half"])


def band_split(x, step, edges, residue):
    """Split records (..., t) into bands (b, ..., t), which add up to the records.

    What lies below the first edge [Hz] is the first band, what lies from the last one on the last.
    """
    X = coefficients(x, residue)
    parts = np.zeros((len(edges) + 1, *X.shape))
    for part, band in zip(parts, band_slices(coefficient_frequencies(x.shape[-1], step, residue), edges), strict=True):
        part[..., band] = X[..., band]
        part[:] = records(part, residue)
    return parts


def records(coefficients, residue):
    """Turn coefficients (..., t) back into records."""
    if residue == "half":
        return np.asarray(idct(coefficients, type=2, norm="ortho"))
    samples = coefficients.shape[-1]
    packed = np.zeros((*coefficients.shape[:-1], 2 * (samples // 2 + 1)))
    packed[..., 0] = coefficients[..., 0]
    packed[..., 2 : samples + 1] = coefficients[..., 1:] / np.sqrt(2.0)
    if samples % 2 == 0:
        packed[..., samples] *= np.sqrt(2.0)
    return np.asarray(np.fft.irfft(packed.view(np.complex128), n=samples, norm="ortho"))


@given(
    samples=st.integers(1, 80),
    seed=st.integers(0, 2**32 - 1),
    edges=st.lists(st.floats(0.0, 60.0), max_size=5).map(sorted),
    residue=st.sampled_from(["repeat", "half"]),
)
@settings(deadline=None, max_examples=80)
def test_bands_add_up_to_the_record(samples, seed, edges, residue):
    """Any record, any edges, even beyond Nyquist or equal: the bands sum to the record."""
    x = np.random.default_rng(seed).standard_normal((2, samples))
    parts = band_split(x, STEP, edges, residue)
    assert parts.shape == (len(edges) + 1, 2, samples)
    assert parts.sum(axis=0) == pytest.approx(x, abs=1e-13)


@RESIDUES
@pytest.mark.parametrize("samples", [1, 2, 9, 200])
def test_products_are_kept(samples, residue):
    """The basis is orthonormal: products of coefficients are products of records, whole and band by band."""
    rng = np.random.default_rng(1)
    x, y = rng.standard_normal((3, samples)), rng.standard_normal((4, samples))
    edges = [5.0, 20.0]
    bands = band_slices(coefficient_frequencies(samples, STEP, residue), edges)
    products = band_products(coefficients(x, residue), coefficients(y, residue), bands)
    assert products.sum(axis=-1) == pytest.approx(x @ y.T, abs=1e-12)
    parts = band_split(y, STEP, edges, residue)
    assert np.moveaxis(products, -1, 0) == pytest.approx(np.stack([x @ part.T for part in parts]), abs=1e-12)


@RESIDUES
def test_a_tone_lies_in_its_band(residue):
    """A tone of 7 Hz over whole periods is in the band from 5 to 8 Hz and in no other."""
    t = STEP * np.arange(1000)
    tone = np.cos(2 * np.pi * 7.0 * (t + STEP / 2))  # even about both ends of the record, as a single pass is continued
    energy = (band_split(tone, STEP, [3.0, 5.0, 8.0, 11.0], residue) ** 2).sum(axis=-1)
    assert energy == pytest.approx([0.0, 0.0, 500.0, 0.0, 0.0], abs=1e-9)


@RESIDUES
def test_frequencies_name_their_coefficients(residue):
    """The coefficient a tone has is the one at its frequency, and frequencies ascend to at most Nyquist."""
    frequency = coefficient_frequencies(1000, STEP, residue)
    t = STEP * (np.arange(1000) + 0.5)
    largest = np.abs(coefficients(np.cos(2 * np.pi * 12.5 * t), residue)).argmax()
    assert frequency[largest] == pytest.approx(12.5)
    assert (np.diff(frequency) >= 0.0).all()
    assert frequency[-1] <= 0.5 / STEP


def test_a_single_pass_that_ends_elsewhere_does_not_leak():
    """A loading ramp is slow: as a single pass it leaves the upper bands empty, as a recurring block it jumps."""
    ramp = np.linspace(0.0, 1.0, 1000)
    high = {residue: (band_split(ramp, STEP, [5.0], residue)[1] ** 2).sum() for residue in ("half", "repeat")}
    assert high["half"] < 1e-3 * high["repeat"]


def test_third_octaves_are_those_of_the_standard():
    """Edges around the nominal centres 8, 10 and 12.5 Hz by IEC 61260-1, base ten."""
    assert third_octaves(8.0, 12.5) == pytest.approx([7.0795, 8.9125, 11.2202, 14.1254], rel=1e-5)
    assert len(third_octaves()) == 21


def test_slices_cover_everything_once():
    """Bands are neighbours; the lower edge belongs to the band; one between two coefficients is empty."""
    frequency = np.array([0.0, 1.0, 1.0, 2.0, 2.0, 3.0])
    assert band_slices(frequency, [1.0, 1.2, 1.5, 9.0]) == [
        slice(0, 1),
        slice(1, 3),
        slice(3, 3),
        slice(3, 6),
        slice(6, 6),
    ]
