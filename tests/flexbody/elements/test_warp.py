"""Warped quads: free rigid motions and balanced forces, and the twisted beam of MacNeal and Harder."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy import sparse
from scipy.sparse.linalg import splu

from fatigue.flexbody.elements.bilinear import quad_axes
from fatigue.flexbody.elements.quad import quad_stiffness
from fatigue.flexbody.elements.warp import freed_from_warp, warp
from fatigue.flexbody.mass import rigid_motions
from fatigue.flexbody.shell import structure
from tests.flexbody.shells import section, shell_mesh
from tests.shell_fe import grid

QUAD = np.array([[0.0, 0, 0], [10, 1, 0], [12, 9, 0], [-1, 8, 0]])


@given(heights=st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4))
def test_forces_of_warped_elements_are_balanced(heights):
    """Six rigid motions are free of force, and no more, whatever the warp; forces and moments sum to 0."""
    corners = QUAD + np.array(heights)[:, None] * [0, 0, 1]
    K = quad_stiffness(corners[None], section(1))[0]
    R = rigid_motions(np.repeat(corners, 6, axis=0), np.tile(np.arange(6), 4))
    scale = np.abs(K) @ np.abs(R)
    assert (np.abs(K @ R) < 1e-11 * scale.max(axis=0)).all()
    values = np.linalg.eigvalsh(K)
    assert values[6] > 1e-7 * values[-1]
    force = (K @ np.random.default_rng(0).normal(size=24)).reshape(4, 6)
    moment = force[:, 3:] + np.cross(corners, force[:, :3])
    assert np.abs(force[:, :3].sum(axis=0)).max() < 1e-10 * np.abs(force).max()
    assert np.abs(moment.sum(axis=0)).max() < 1e-10 * np.abs(force).max()


def test_flat_elements_are_untouched():
    """Corners that lie off their plane by rounding make no warped element."""
    corners = QUAD + np.array([1e-12, 0, 0, 0])[:, None] * [0, 0, 1]
    K, axes = quad_stiffness(corners[None], section(1)), quad_axes(corners[None])
    assert warp(corners[None], axes)[0] > 0.0
    assert freed_from_warp(K, corners[None], axes) is K


def test_twisted_beam():
    """A thin strip twisted by 90 degrees bends as MacNeal and Harder (1985) give it, within 1 %.

    Length 12, width 1.1, thickness 0.0032, E = 29e6, nu = 0.22; unit load 1e-6 at the tip: 5.256e-3 along the width at
    the root, 1.294e-3 across it. Without the projection it would be 1000 times too stiff.
    """
    xyz, quads = grid(np.linspace(0, 12, 25), np.linspace(-0.55, 0.55, 5))
    x, s = xyz[:, 0], xyz[:, 1]
    places = np.column_stack([x, s * np.cos(np.pi * x / 24), s * np.sin(np.pi * x / 24)])
    body = structure(shell_mesh(places, quads, 0.0032, E=29e6, nu=0.22))
    tip = np.flatnonzero(np.isclose(x, 12.0))
    share = np.array([0.5, 1, 1, 1, 0.5]) / 4.0
    loads = np.zeros((len(body.node), 2))
    loads[6 * tip + 2, 0] = loads[6 * tip + 1, 1] = 1e-6 * share
    free = np.repeat(x > 0.0, 6)
    u = np.zeros_like(loads)
    u[free] = splu(sparse.csc_array(body.K[free][:, free])).solve(loads[free])
    np.testing.assert_allclose([u[6 * tip + 2, 0].mean(), u[6 * tip + 1, 1].mean()], [5.256e-3, 1.294e-3], rtol=0.01)
