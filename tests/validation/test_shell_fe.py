"""The shell finite element program of the tests against what every shell element must satisfy."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.shell_fe import ShellModel, element_stiffness, grid

QUAD = np.array([[0.0, 0, 0], [10, 1, 0], [12, 9, 0], [-1, 8, 0]])


@pytest.mark.parametrize("angles", [(0, 0, 0), (0.3, -1.1, 2.0)])
def test_rigid_motions_are_free_and_nothing_else(angles):
    """A distorted element has six zero eigenvalues, and its nodal forces are in balance, in any attitude."""
    corners = QUAD @ Rotation.from_euler("xyz", angles).as_matrix().T
    K = element_stiffness(corners[np.newaxis], np.array([2.0]), 210000.0, 0.3)[0]
    eigenvalues = np.linalg.eigvalsh(K)
    assert np.abs(eigenvalues[:6]).max() < 1e-12 * eigenvalues[-1]
    assert eigenvalues[6] > 1e-6 * eigenvalues[-1]
    force = (K @ np.random.default_rng(0).normal(size=24)).reshape(4, 6)
    moment = force[:, 3:] + np.cross(corners, force[:, :3])
    np.testing.assert_allclose(force[:, :3].sum(axis=0), 0, atol=1e-9 * np.abs(force).max())
    np.testing.assert_allclose(moment.sum(axis=0), 0, atol=1e-9 * np.abs(moment).max())


def test_patch_of_membrane_bending_and_shear():
    """Constant membrane strain and curvature, prescribed at the outline, are reproduced inside a distorted patch."""
    xyz, quads = grid([0, 3, 7, 10], [0, 4, 6, 10])
    inside = np.flatnonzero(np.all((xyz[:, :2] > 0) & (xyz[:, :2] < 10), axis=1))
    xyz[inside, :2] += np.random.default_rng(1).uniform(-1, 1, (inside.size, 2))
    model = ShellModel(xyz, quads, 1.0)
    x, y = xyz[:, 0], xyz[:, 1]
    exact = np.zeros((len(xyz), 6))
    exact[:, 0], exact[:, 1] = 1e-3 * x + 4e-4 * y, 4e-4 * x - 2e-3 * y
    exact[:, 2] = 1e-4 * (x**2 / 2 - y**2 + x * y)
    exact[:, 3], exact[:, 4] = 1e-4 * (x - 2 * y), -1e-4 * (x + y)
    residual = (model.assembled() @ exact.ravel()).reshape(-1, 6)[inside]
    assert np.abs(residual).max() < 1e-9 * np.abs(model.element_forces(exact)).max()


def test_natural_frequency_of_a_plate():
    """A simply supported 400 x 300 x 4 mm plate: Kirchhoff's first frequency within 1 %."""
    model = ShellModel(*grid(np.linspace(0, 400, 17), np.linspace(0, 300, 13)), 4.0)
    outline = np.isclose(model.xyz[:, :2], 0) | np.isclose(model.xyz[:, :2], [400, 300])
    fixed = np.zeros((len(model.xyz), 6), dtype=bool)
    fixed[:, [0, 1, 5]] = True
    fixed[outline.any(axis=1), 2] = True
    frequency, mode = model.modes(2, fixed)
    D = 210000.0 * 4**3 / 12 / (1 - 0.3**2)
    exact = np.pi / 2 * (1 / 400**2 + 1 / 300**2) * np.sqrt(D / (7.85e-9 * 4))
    assert frequency[0] == pytest.approx(exact, rel=0.01)
    np.testing.assert_allclose(np.sum(model.mass() * mode[0].ravel() ** 2), 1, rtol=1e-9)
