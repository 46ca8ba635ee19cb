"""The three-node shell against what every shell element must satisfy, and how it converges."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fatigue.flexbody.elements.triangle import triangle_mass, triangle_stiffness
from fatigue.flexbody.factor import factored
from fatigue.flexbody.modes import held_modes
from fatigue.flexbody.shell import structure
from tests.flexbody.shells import halved, plate, section, shell_mesh
from tests.shell_fe import grid

CORNERS = np.array([[0.0, 0, 0], [10, 1, 0], [3, 7, 0]])


@pytest.mark.parametrize("angles", [(0, 0, 0), (0.3, -1.1, 2.0)])
def test_rigid_motions_are_free_and_nothing_else(angles):
    """Six zero eigenvalues, and nodal forces in balance, in any attitude."""
    corners = CORNERS @ Rotation.from_euler("xyz", angles).as_matrix().T
    K = triangle_stiffness(corners[None], section(1))[0]
    values = np.linalg.eigvalsh(K)
    assert np.abs(values[:6]).max() < 1e-12 * values[-1]
    assert values[6] > 1e-6 * values[-1]
    force = (K @ np.random.default_rng(0).normal(size=18)).reshape(3, 6)
    moment = force[:, 3:] + np.cross(corners, force[:, :3])
    np.testing.assert_allclose(force[:, :3].sum(axis=0), 0, atol=1e-11 * np.abs(force).max())
    np.testing.assert_allclose(moment.sum(axis=0), 0, atol=1e-10 * np.abs(force).max())


def test_first_corner_does_not_matter():
    """The same triangle from another corner has the same stiffness and mass."""
    turned = [1, 2, 0]
    rows = (6 * np.array(turned)[:, None] + np.arange(6)).ravel()
    K = triangle_stiffness(CORNERS[None], section(1))[0]
    other = triangle_stiffness(CORNERS[turned][None], section(1))[0]
    np.testing.assert_allclose(other, K[np.ix_(rows, rows)], atol=1e-10 * np.abs(K).max())
    m = triangle_mass(CORNERS[None], section(1))[0]
    assert m.sum() == pytest.approx(7.85e-9 * 2.0 * 33.5)


def test_patch_of_membrane_and_bending():
    """Constant strain and curvature, prescribed at the outline, are reproduced inside an irregular patch."""
    xyz, quads = grid([0, 3, 7, 10], [0, 4, 6, 10])
    inside = np.flatnonzero(np.all((xyz[:, :2] > 0) & (xyz[:, :2] < 10), axis=1))
    xyz[inside, :2] += np.random.default_rng(1).uniform(-1, 1, (inside.size, 2))
    body = structure(shell_mesh(xyz, halved(quads), 1.0))
    x, y = xyz[:, 0], xyz[:, 1]
    exact = np.zeros((len(xyz), 6))
    exact[:, 0], exact[:, 1] = 1e-3 * x + 4e-4 * y, 4e-4 * x - 2e-3 * y
    exact[:, 2] = 1e-4 * (x**2 / 2 - y**2 + x * y)
    exact[:, 3], exact[:, 4] = 1e-4 * (x - 2 * y), -1e-4 * (x + y)
    held = np.ones((len(xyz), 6), dtype=bool)
    held[inside] = False
    loads = -(body.K @ (exact * held).ravel())
    u = factored(body, held.ravel()).solve(loads[:, None]).reshape(-1, 6)
    np.testing.assert_allclose(u[inside], exact[inside], atol=1e-9 * np.abs(exact).max())


@pytest.mark.parametrize("triangles", [False, True], ids=["quads", "triangles"])
def test_frequencies_of_a_plate_converge(triangles):
    """A simply supported plate: with half the size of elements a quarter of the error, and 1 % at 16 by 12."""
    D = 210000.0 * 4.0**3 / 12 / (1 - 0.3**2)
    exact = np.pi / 2 * (1 / 400**2 + 1 / 300**2) * np.sqrt(D / (7.85e-9 * 4.0))
    error = []
    for n in (1, 2, 4):
        mesh = plate(4 * n, 3 * n, triangles=triangles)
        outline = np.isclose(mesh.xyz[:, :2], 0) | np.isclose(mesh.xyz[:, :2], [400, 300])
        held = np.zeros((len(mesh.xyz), 6), dtype=bool)
        held[:, [0, 1, 5]] = True
        held[outline.any(axis=1), 2] = True
        error.append(held_modes(structure(mesh), held.ravel(), count=1).frequency[0] / exact - 1.0)
    assert 0.0 < error[2] < 0.01
    assert error[1] < 0.3 * error[0]
    assert error[2] < 0.3 * error[1]
