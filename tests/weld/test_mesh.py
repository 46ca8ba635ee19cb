"""Sides, centroids, normals and inward directions of quads and triangles, by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.weld.mesh import NONE, ShellMesh, centroids, inward, normals

XYZ = np.array([[0.0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [1, 3, 0], [7, 7, 7]])
CORNERS = np.array([[0, 1, 2, 3], [3, 2, 4, NONE]])  # a quad and a triangle on its third side


def mesh(xyz=XYZ, corner=CORNERS):
    """A mesh of some elements; what does not matter here is plain."""
    count = len(corner)
    none = np.full((count, 4), NONE)
    ids = np.arange(1, count + 1)
    return ShellMesh(np.arange(1, len(xyz) + 1), xyz, ids, corner, none, ids, np.ones(count), np.zeros(count))


def test_a_triangle_closes_with_its_third_side():
    """Side k runs from corner k to the next one round the element; a triangle has no fourth."""
    assert mesh().side_ends().tolist() == [
        [[0, 1], [1, 2], [2, 3], [3, 0]],
        [[3, 2], [2, 4], [4, 3], [NONE, NONE]],
    ]


def test_centroids_are_means_of_the_corners_there_are():
    """Of four corners, or of three; a fourth that is missing is not the last node of the mesh."""
    np.testing.assert_allclose(centroids(mesh()), [[1.0, 0.5, 0.0], [1.0, 5.0 / 3.0, 0.0]], rtol=1e-15)


def test_normals_by_the_right_hand_rule():
    """Up where the corners run counter-clockwise, down where they run back, zero without area."""
    back = np.array([[3, 2, 1, 0], [4, 2, 3, NONE], [0, 1, 1, NONE]])
    assert normals(mesh()).tolist() == [[0, 0, 1], [0, 0, 1]]
    np.testing.assert_array_equal(normals(mesh(corner=back)), [[0, 0, -1], [0, 0, -1], [0, 0, 0]])


def test_inward_is_normal_to_each_side_and_points_into_the_element():
    """Unit vectors in the plane; zero on the side that a triangle does not have."""
    found = inward(mesh())
    assert found[0].tolist() == [[0, 1, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]]
    slant = np.array([-2.0, -1.0, 0.0]) / np.sqrt(5.0)
    expected = [[0, 1, 0], slant, slant * [-1, 1, 1], [0, 0, 0]]
    np.testing.assert_allclose(found[1], expected, atol=1e-15)


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10**6), st.booleans())
def test_inward_of_any_element_in_space(seed, triangle):
    """Turned, sheared and moved: normal to side and normal, of length 1, and towards the centroid."""
    rng = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    xyz = (XYZ + 0.2 * rng.normal(size=XYZ.shape) * [1, 1, 0]) @ turn + rng.normal(size=3)
    one = mesh(xyz, CORNERS[[int(triangle)]])
    sides = 3 if triangle else 4
    ends, found = one.side_ends()[0, :sides], inward(one)[0]
    along = xyz[ends[:, 1]] - xyz[ends[:, 0]]
    np.testing.assert_allclose(np.linalg.norm(found[:sides], axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(np.einsum("kx,kx->k", found[:sides], along), 0.0, atol=1e-12)
    np.testing.assert_allclose(found[:sides] @ normals(one)[0], 0.0, atol=1e-12)
    assert (np.einsum("kx,kx->k", centroids(one) - xyz[ends[:, 0]], found[:sides]) > 0.0).all()


@pytest.mark.parametrize("corner", [[0, 1, 2, 3], [3, 2, 4, NONE]])
def test_renumbering_the_corners_renumbers_the_sides(corner):
    """A corner further round the element: the same sides, one place further."""
    count = 3 if NONE in corner else 4
    turned = [*corner[1:count], corner[0], *corner[count:]]
    first, second = (inward(mesh(corner=np.array([c])))[0, :count] for c in (corner, turned))
    np.testing.assert_allclose(second, np.roll(first, -1, axis=0), atol=1e-15)


def test_sides_of_many_elements_are_those_of_each_alone(monkeypatch):
    """However many are worked out together."""
    rng = np.random.default_rng(3)
    corner = np.array([rng.permutation(len(XYZ))[:4] for _ in range(11)])
    corner[::3, 3] = NONE
    whole = inward(mesh(corner=corner))
    monkeypatch.setattr("fatigue.weld.mesh.AT_ONCE", 4)
    assert inward(mesh(corner=corner)).tobytes() == whole.tobytes()
