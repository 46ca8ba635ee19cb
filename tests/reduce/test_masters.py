"""Masters that are the mean of several nodes, and the bases that stand on them."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.flexbody.condensation.guyan import guyan
from fatigue.flexbody.factor import free_body
from fatigue.flexbody.shell import structure
from fatigue.readers.model.read import read_model
from fatigue.reduce.bases import Recipe, reduce_to
from fatigue.reduce.interface import InterfacePoint, motion_of, read_interface
from fatigue.reduce.masters import masters


@pytest.fixture(scope="module")
def small(model):
    """Structure and points of the small body."""
    return structure(read_model(model).body), read_interface(model / "interface.csv", strict=True)[0]


def test_each_column_moves_one_mean_by_one(small):
    """``C T`` is 1: a constraint mode moves the mean of its own point by 1 and holds that of the others."""
    body, points = small
    C = motion_of([point for point in points if point.is_loaded], body)
    given = masters(body, C, "loaded")
    T = given.B @ guyan(given.structure, given.rows)
    moved = C @ T
    order = np.abs(moved).argmax(axis=0)
    np.testing.assert_allclose(moved[order], np.eye(len(C)), atol=1e-9)


def test_what_is_left_on_a_pattern_is_shared_evenly(small):
    """``K T`` is a load of unit patterns: within a pattern every node bears the same, elsewhere there is none."""
    body, points = small
    C = motion_of([point for point in points if point.is_loaded], body)
    given = masters(body, C, "loaded")
    left = body.K @ (given.B @ guyan(given.structure, given.rows))
    strength = np.linalg.lstsq(C.T, left, rcond=None)[0]
    np.testing.assert_allclose(C.T @ strength, left, atol=1e-7 * np.abs(left).max())


@pytest.mark.parametrize(
    ("recipe", "least", "most"),
    [
        (Recipe("residual", 300.0), 1.0 - 1e-8, 1.0),
        (Recipe("strong", 300.0), 0.98, 1.0),
        (Recipe("guyan"), 0.98, 1.0),
        (Recipe("kuhar", kuhar_hz=50.0), 0.98, 1.0),
        (Recipe("weak", 300.0), 0.0, 0.9),
    ],
    ids=lambda value: value.name if isinstance(value, Recipe) else None,
)
def test_local_flexibility_of_each_basis(small, recipe, least, most):
    """Bases with all points as masters keep the local flexibility, a weak one loses that of the hanger."""
    body, points = small
    found = reduce_to(body, points, recipe)
    shapes, w2 = found.basis.shapes, (2.0 * np.pi * found.basis.frequency) ** 2
    np.testing.assert_allclose(shapes.T @ (body.M @ shapes), np.eye(len(w2)), atol=1e-8)
    np.testing.assert_allclose(shapes.T @ (body.K @ shapes), np.diag(w2), atol=1e-7 * w2.max())
    assert np.abs(shapes.T @ (body.M @ free_body(body).rigid)).max() < 1e-8
    at_hanger = found.kept[-3:]
    assert least <= at_hanger.min()
    assert at_hanger.max() <= most + 1e-8
    assert found.kept.max() <= 1.0 + 1e-8


def test_points_that_follow_from_others(small):
    """A pattern and its nodes, each by itself, have one motion too many."""
    body, points = small
    hanger = next(point for point in points if len(point.nodes) > 1)
    single = [InterfacePoint(f"n{n}", n, (n,), "internal", hanger.directions) for n in hanger.nodes]
    loaded = [point for point in points if point.is_loaded]
    with pytest.raises(DataError, match=r"are 24, and only 21 of them are independent"):
        masters(body, motion_of([*loaded, *single], body), "loaded")
