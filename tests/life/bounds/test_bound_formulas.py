"""The bounds from few histories, term by term: what the module derives, worked out from the histories in full."""

import numpy as np
import pytest

from fatigue.life.bounds import weld_basis
from fatigue.life.bounds.forms import face_forms, form_pair
from fatigue.life.bounds.screening import extent_bound, modal_extent, size_bound
from fatigue.life.bounds.weld_basis import reduced_bound, weld_bases
from fatigue.life.counting.single.prepare import single_record


def record(modes=8, samples=3000):
    """Modes of different sizes and rates, with means."""
    rng = np.random.default_rng(5)
    noise = rng.normal(size=(modes, samples + 8))
    smooth = np.stack([np.convolve(x, np.hanning(3 + k), mode="same") for k, x in enumerate(noise)])
    return smooth[:, :samples] * np.logspace(0, -1.5, modes)[:, None] + rng.normal(size=(modes, 1))


def about_mean(stress, residue):
    """A stress without its mean, and its steps, of which a record that recurs has one more."""
    stress = stress - stress.mean(axis=-1, keepdims=True)
    closed = np.concatenate([stress[..., -1:], stress], axis=-1) if residue == "repeat" else stress
    return stress, closed


def norm(x):
    """Root of the sum of squares over time."""
    return np.sqrt(np.sum(x**2, axis=-1))


@pytest.mark.parametrize("residue", ["half", "repeat"])
@pytest.mark.parametrize("tolerance", [0.6, 0.2, 1e-9])
def test_bounds_from_few_histories_term_by_term(monkeypatch, residue, tolerance):
    """Where the histories miss much, little and nothing: range, sum n S^3 and sum n S^4 are those of the derivation."""
    monkeypatch.setattr(weld_basis, "TOLERANCE", tolerance)
    rng = np.random.default_rng(6)
    q = record()
    S_m, S_b = rng.normal(size=(2, 12, len(q)))
    extent = modal_extent(q, residue)
    bases = weld_bases(S_m, S_b, np.repeat([0, 1], [7, 5]), [extent])
    largest, sums = reduced_bound(bases, np.arange(12), single_record(q), extent)

    faces = [np.stack([m + b, m - b], axis=1) for m, b in ((S_m, S_b), (bases.membrane_rest, bases.bending_rest))]
    (s, s_closed), (e, e_closed) = (about_mean(w @ q, residue) for w in faces)
    a, a_closed = s - e, s_closed - e_closed
    if tolerance < 1e-6:
        assert norm(e).max() < 1e-6 * norm(s).max()
    elif tolerance > 0.5:
        assert norm(e).max() > 0.3 * norm(s).max()
    peak = size_bound(bases.membrane_rest, bases.bending_rest, extent)[0]
    e_2, e_step = norm(e), norm(np.diff(e_closed))
    a_step = norm(np.diff(s_closed)) + e_step
    cubes = np.diff(a_closed**3)
    I_2 = norm(cubes) / 3
    I_1 = np.sqrt(a_step * I_2)
    s_6 = np.sum(a**6, axis=-1) ** (1 / 6) + (peak**4 * e_2**2) ** (1 / 6)
    s_4_squared = np.sqrt(norm(s) * s_6**3)
    ends = np.sqrt(2) * e_2
    third = np.abs(cubes).sum(axis=-1) + 3 * e_step * s_4_squared + 3 * 2 * ends * (I_1 + peak * a_step)
    fourth = np.abs(np.diff(a_closed**3 * np.abs(a_closed))).sum(axis=-1)
    fourth += 4 * e_step * s_6**3 + 4 * 3 * ends * (I_2 + 2 * peak * I_1 + peak**2 * a_step)
    np.testing.assert_allclose(largest, 2 * (np.sum(a**12, axis=-1) ** (1 / 12) + peak), rtol=2e-3)
    np.testing.assert_allclose(sums[3], 2 * third, rtol=2e-3)
    np.testing.assert_allclose(sums[4], 4 * fourth, rtol=2e-3)


@pytest.mark.parametrize("residue", ["half", "repeat"])
def test_bounds_without_a_loop_term_by_term(residue):
    """Range and sums by Cauchy-Schwarz and by the coordinates one by one, whichever is less."""
    rng = np.random.default_rng(7)
    q = record()
    S_m, S_b = rng.normal(size=(2, 40, len(q))) * np.logspace(0, 2, len(q))
    S_m[:8], S_b[:8] = np.eye(8), 0.0  # of one mode
    extent = modal_extent(q, residue)
    largest, sums = extent_bound(S_m, S_b, face_forms(S_m, S_b, extent.products), extent)
    w = np.stack([S_m + S_b, S_m - S_b], axis=1)
    _, closed = about_mean(q, residue)
    steps = np.diff(closed)
    s, s_closed = about_mean(w @ q, residue)
    ds = np.diff(s_closed)
    by_modes = np.abs(w) @ np.abs(steps).sum(axis=1)
    variation = np.minimum(np.sqrt(ds.shape[-1]) * norm(ds), by_modes)
    centred = q - q.mean(axis=1, keepdims=True)
    covariance = centred @ centred.T / q.shape[1]
    reach = np.sqrt(np.einsum("mt,mt->t", centred, np.linalg.solve(covariance, centred)).max())
    peak = reach * norm(s) / np.sqrt(q.shape[1])
    expected = np.minimum(np.minimum(2 * peak, np.abs(w) @ np.ptp(q, axis=1)), variation)
    np.testing.assert_allclose(largest, expected, rtol=1e-5)
    np.testing.assert_allclose(sums[1], variation / 2, rtol=1e-6)
    np.testing.assert_allclose(sums[2], 2 * norm(s) * norm(ds), rtol=1e-6)
    bounds = np.stack([2 * peak, np.abs(w) @ np.ptp(q, axis=1), variation])
    assert set(np.unique(bounds.argmin(axis=0))) >= {0, 1}  # no bound is idle


def test_the_rounding_of_a_form_is_told_and_small():
    """Both forms of many stresses: never below the truth by more than what is told, which is 1e-12 of their size."""
    rng = np.random.default_rng(8)
    A, B = (x @ x.T for x in rng.normal(size=(2, 30, 12)))
    S_m, S_b = rng.normal(size=(2, 200, 30))
    pair = form_pair(A, B)
    exact = np.stack([[np.einsum("nm,mk,nk->n", w, M, w) for w in (S_m + S_b, S_m - S_b)] for M in (A, B)])
    told = pair.rounding[:, None, None] * ((np.abs(S_m) + np.abs(S_b)) @ pair.size)[None, None] ** 2
    assert (np.abs(face_forms(S_m, S_b, pair) - exact.transpose(0, 2, 1)) <= told.transpose(0, 2, 1)).all()
    assert (told / exact).max() < 1e-9
    of_product = 4.0 * (30 + 4) * np.finfo(float).eps  # a sum of 30 products, a square of it, and what is beside it
    assert (pair.rounding >= of_product * np.array([1.0, np.mean(np.diag(B) / np.diag(A))])).all()
