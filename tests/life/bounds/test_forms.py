"""Two quadratic forms from one product, against the plain sums."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fatigue.life.bounds import forms
from fatigue.life.bounds.forms import face_forms, form_pair, part_forms

Floats = NDArray[np.float64]


def gram(rng: np.random.Generator, modes: int, rank: int) -> Floats:
    """Draw a symmetric matrix without negative eigenvalues, of coordinates of very different sizes."""
    rows = rng.normal(size=(rank, modes)) * np.exp(3.0 * rng.normal(size=modes))
    return rows.T @ rows


def plain(S_m: Floats, S_b: Floats, A: Floats) -> Floats:
    """Evaluate w'A w of both faces, (n, 2), as it is written."""
    return np.stack([np.einsum("ni,ij,nj->n", w, A, w) for w in (S_m + S_b, S_m - S_b)], axis=1)


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10**6), st.integers(1, 30), st.integers(0, 40), st.integers(0, 40), st.floats(-6, 6))
def test_the_forms_are_those_of_the_two_matrices(seed: int, modes: int, a: int, b: int, scale: float) -> None:
    """Whatever their ranks, and however much larger one of them is; the error stays below the one that is stated."""
    rng = np.random.default_rng(seed)
    A, B = gram(rng, modes, a), 10.0**scale * gram(rng, modes, b)
    S_m, S_b = rng.normal(size=(2, 7, modes))
    S_b[0] = S_m[0]
    pair = form_pair(A, B)
    found = face_forms(S_m, S_b, pair)
    sizes = (np.abs(S_m) + np.abs(S_b)) @ pair.size
    for form, matrix, rounding in zip(found, (A, B), pair.rounding, strict=True):
        assert (np.abs(form - plain(S_m, S_b, matrix)) <= rounding * sizes[:, None] ** 2).all()
        assert (form >= 0.0).all()
        assert form[0, 1] == 0.0  # of a stress that is exactly zero


def test_forms_of_usual_spectra_keep_their_digits() -> None:
    """Moments of orders 2 and 4 of resonances from 1 to 100 Hz: twelve digits at every point."""
    rng = np.random.default_rng(3)
    f = np.geomspace(1.0, 100.0, 60)
    mix = np.eye(60) + 0.3 * rng.normal(size=(60, 60))
    A, B = mix @ np.diag(f**2.0) @ mix.T, mix @ np.diag(f**4.0) @ mix.T
    S_m, S_b = rng.normal(size=(2, 300, 60))
    for form, matrix in zip(face_forms(S_m, S_b, form_pair(A, B)), (A, B), strict=True):
        assert form == pytest.approx(plain(S_m, S_b, matrix), rel=1e-12)


def test_forms_of_members_and_faces_come_from_the_same_product() -> None:
    """Membrane and bending stress beside the faces."""
    rng = np.random.default_rng(5)
    A, B = (mix @ mix.T for mix in np.eye(9) + 0.3 * rng.normal(size=(2, 9, 9)))
    S_m, S_b = rng.normal(size=(2, 150, 9))
    pair = form_pair(A, B)
    parts = part_forms(S_m, S_b, pair)
    np.testing.assert_array_equal(parts[..., 2:], face_forms(S_m, S_b, pair))
    for form, matrix in zip(parts, (A, B), strict=True):
        members = plain(S_m + S_b, S_m - S_b, matrix) / 4.0  # the faces of the faces are twice the members
        assert form[:, :2] == pytest.approx(members, rel=1e-12)


def test_where_the_stations_are_cut_does_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks that stay in the cache leave no seam."""
    rng = np.random.default_rng(4)
    pair = form_pair(gram(rng, 12, 20), gram(rng, 12, 20))
    S_m, S_b = rng.normal(size=(2, 50, 12))
    whole = face_forms(S_m, S_b, pair)
    monkeypatch.setattr(forms, "AT_ONCE", 7)
    assert face_forms(S_m, S_b, pair) == pytest.approx(whole, rel=1e-13)


def test_a_record_at_rest_has_no_forms() -> None:
    """All matrices zero: all forms zero."""
    pair = form_pair(np.zeros((5, 5)), np.zeros((5, 5)))
    assert (face_forms(np.ones((3, 5)), np.ones((3, 5)), pair) == 0.0).all()
    assert pair.directions.shape == (5, 0)
