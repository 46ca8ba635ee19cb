"""Moment matrices against Welch's method on the recovered stress."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.life.records.history import ModalHistory
from fatigue.spectrum import moments
from fatigue.spectrum.moments import (
    cross_densities,
    has_spectrum,
    moment_matrices,
    moments_by_chunk,
    point_moments,
    quadratic_forms,
    segment_spectra,
)
from tests.naive_spectrum import welch_moments

ORDERS = (0, 0.75, 1, 1.5, 2, 4)


def history(q, step=0.004):
    """Make a record of some modes."""
    return ModalHistory("event", np.arange(len(q)) + 1, q, step, 0.0)


def coloured(rng, modes, samples):
    """Make modal coordinates whose spectra differ and correlate."""
    noise = rng.normal(size=(modes, samples))
    mixed = rng.normal(size=(modes, modes)) @ noise
    return np.cumsum(mixed, axis=1) * 0.1 + mixed


@pytest.mark.parametrize(
    ("samples", "step", "segment_s", "upper_hz"),
    [
        (3000, 0.004, 4.0, 60.0),
        (3001, 0.004, 3.996, 60.0),  # an odd segment
        (1000, 0.004, 4.0, 200.0),  # one segment, all bins
        (2999, 1 / 256, 2.0, 40.0),
        (2500, 0.01, 1.0, 47.0),  # upper limit on a bin
    ],
)
def test_equals_welch_of_the_recovered_stress(samples, step, segment_s, upper_hz):
    """All orders agree with the trapezoid rule on Welch's spectrum of each point, to rounding."""
    rng = np.random.default_rng(1)
    q = coloured(rng, 7, samples)
    modal_stress = rng.normal(size=(40, 7))
    spectra = segment_spectra(history(q, step), segment_s, upper_hz)
    ours = point_moments(modal_stress, moment_matrices(spectra, ORDERS))
    slow = welch_moments(modal_stress @ q, step, round(segment_s / step), upper_hz, ORDERS)
    np.testing.assert_allclose(ours, slow, rtol=1e-12)


def test_describes_its_spectrum():
    """Resolution, limits, number of segments and shapes are those of the segments."""
    spectra = segment_spectra(history(np.random.default_rng(0).normal(size=(3, 1250))), 2.0, 60.0)
    matrices = moment_matrices(spectra)
    assert spectra.resolution_hz == pytest.approx(0.5)
    assert spectra.segment_s == pytest.approx(2.0)
    assert spectra.frequency[-1] == pytest.approx(60.0)
    assert [parts.shape for parts in spectra.transforms()] == [(3, 242)] * 4
    assert (matrices.segments, matrices.upper_hz, matrices.resolution_hz) == (4, 60.0, pytest.approx(0.5))
    assert matrices.matrix.shape == (4, 3, 3)


@pytest.mark.parametrize("modes", [1, 7])
def test_densities_add_up_to_the_variance(modes, monkeypatch):
    """The cross-spectral densities are symmetric, and their integral is the moment of order 0; pieces do not matter."""
    record = history(coloured(np.random.default_rng(4), modes, 3000).astype(np.float32))
    spectra = segment_spectra(record, 2.0, 60.0)
    density, expected = cross_densities(spectra), moment_matrices(spectra, (0,)).matrix[0]
    np.testing.assert_allclose(np.tensordot(spectra.weight, density, axes=1), expected, rtol=1e-12)
    np.testing.assert_array_equal(density, density.transpose(0, 2, 1))
    monkeypatch.setattr(moments, "NUMBERS_AT_ONCE", 4000)
    monkeypatch.setattr(moments, "CACHED_NUMBERS", 100)
    np.testing.assert_allclose(cross_densities(spectra), density, rtol=1e-12)


@pytest.mark.parametrize("size", [1, 2, 3, 8])
def test_chunks_of_segments_make_up_the_record(size):
    """Each chunk is the mean over its segments; the last one holds what is left."""
    spectra = segment_spectra(history(coloured(np.random.default_rng(5), 3, 1250)), 1.0, 60.0)
    chunks = list(moments_by_chunk(spectra, ORDERS, size))
    assert sum(chunk.segments for chunk in chunks) == len(spectra.starts) == 9
    assert all(chunk.segments == size for chunk in chunks[:-1])
    together = sum(chunk.segments * chunk.matrix for chunk in chunks) / len(spectra.starts)
    np.testing.assert_allclose(together, moment_matrices(spectra, ORDERS).matrix, rtol=1e-12)


def test_a_large_constant_part_in_single_precision_leaves_no_trace():
    """Gravity a thousand times the vibration, stored as float32: only the storage itself costs digits."""
    rng = np.random.default_rng(2)
    q = (rng.normal(size=(4, 4000)) + 1000.0 * rng.normal(size=(4, 1))).astype(np.float32)
    modal_stress = rng.normal(size=(10, 4))
    ours = point_moments(modal_stress, moment_matrices(segment_spectra(history(q), 4.0, 60.0)))
    exact = q.astype(np.float64)
    exact -= exact.mean(axis=1, keepdims=True)
    slow = welch_moments(modal_stress @ exact, 0.004, 1000, 60.0, (0, 1, 2, 4))
    np.testing.assert_allclose(ours, slow, rtol=1e-10)


def test_a_constant_history_has_no_moments():
    """Nothing moves, nothing remains: all moments are 0 within the rounding of the mean."""
    matrices = moment_matrices(segment_spectra(history(np.full((2, 2000), 7.0)), 4.0, 60.0))
    assert np.all(point_moments(np.ones((1, 2)), matrices) == 0)


def test_cancelling_modes_never_give_a_negative_moment():
    """Two modes that move alike cancel in a point; rounding must not make its variance negative."""
    q = np.random.default_rng(3).normal(size=(1, 3000))
    matrices = moment_matrices(segment_spectra(history(np.vstack([q, q, 3 * q])), 4.0, 60.0))
    modal_stress = np.array([[1.0, -1.0, 0.0], [3.0, 0.0, -1.0], [1e3, -1e3 - 1e-6, 0.0], [1.0, 2.0, -1.0]])
    assert np.all(point_moments(modal_stress, matrices) >= 0)


@pytest.mark.parametrize(
    ("samples", "segment_s", "expected"), [(999, 4.0, False), (1000, 4.0, True), (1000, 0.008, False), (2, 4.0, False)]
)
def test_a_record_shorter_than_a_segment_has_no_spectrum(samples, segment_s, expected):
    """The record must hold one whole segment, and a segment at least four samples."""
    record = history(np.zeros((1, samples)))
    assert has_spectrum(record, segment_s) is expected
    if not expected:
        with pytest.raises(DataError, match=r"event 'event'.*no segment of .* s.*shorten segment_s"):
            segment_spectra(record, segment_s, 60.0)


@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 2**32 - 1), factor=st.floats(0.01, 100), order=st.floats(0, 4))
def test_moments_are_quadratic_in_stress_and_add_over_independent_segments(seed, factor, order):
    """m(c s) = c^2 m(s), and m(s + r) + m(s - r) = 2 m(s) + 2 m(r) (parallelogram law)."""
    rng = np.random.default_rng(seed)
    matrices = moment_matrices(segment_spectra(history(coloured(rng, 4, 600)), 1.0, 60.0), (order,))
    s, r = rng.normal(size=(2, 1, 4))
    m = {name: point_moments(v, matrices)[0, 0] for name, v in {"s": s, "r": r, "+": s + r, "-": s - r}.items()}
    assert point_moments(factor * s, matrices)[0, 0] == pytest.approx(factor**2 * m["s"], rel=1e-9)
    assert m["+"] + m["-"] == pytest.approx(2 * m["s"] + 2 * m["r"], rel=1e-9)


@settings(deadline=None, max_examples=10)
@given(points=st.integers(0, 2100), modes=st.integers(1, 5))
def test_quadratic_forms_do_not_depend_on_the_block(points, modes):
    """Blocks of points are cut for speed only; single-precision modal_stress are taken as they are."""
    rng = np.random.default_rng(points)
    half = rng.normal(size=(3, modes, modes))
    matrices = half @ half.transpose(0, 2, 1)
    modal_stress = rng.normal(size=(points, modes)).astype(np.float32)
    slow = np.einsum("ni,pij,nj->pn", *(x.astype(np.float64) for x in (modal_stress, matrices, modal_stress)))
    np.testing.assert_allclose(quadratic_forms(modal_stress, matrices), slow, rtol=1e-9)
