"""Consistent mass: of a rigid motion it is that of the surface exactly."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.flexbody.elements.bilinear import jacobians
from fatigue.flexbody.elements.quad_mass import quad_mass
from fatigue.flexbody.mass import centre_of_mass, rigid_mass, rigid_motions
from fatigue.flexbody.shell import structure
from tests.flexbody.shells import plate, section, shell_mesh

QUAD = np.array([[0.0, 0, 0], [10, 1, 0], [12, 9, 0], [-1, 8, 0]])


def test_inertia_of_a_plate():
    """Mass, centre and inertia of a plate with additional mass: a b (rho t + nsm), (a^2 + t_b^2)/12 and so on."""
    a, b, t, t_b = 400.0, 300.0, 4.0, 30.0
    mesh = plate(5, 3, a, b, t, nsm=2e-8, bending_thickness=t_b)
    body = structure(mesh)
    mass = a * b * (7.85e-9 * t + 2e-8)
    about_origin = rigid_mass(body.M, rigid_motions(body.xyz, body.direction))
    np.testing.assert_allclose(centre_of_mass(about_origin), [a / 2, b / 2, 0], atol=1e-9)
    found = rigid_mass(body.M, rigid_motions(body.xyz, body.direction, [a / 2, b / 2, 0]))
    rotary = mass * t_b**2 / 12
    exact = [mass] * 3 + [mass * b**2 / 12 + rotary, mass * a**2 / 12 + rotary, mass * (a**2 + b**2) / 12 + rotary]
    np.testing.assert_allclose(found, np.diag(exact), atol=1e-12 * max(exact))


@settings(max_examples=40, deadline=None)
@given(st.lists(st.floats(-2.0, 2.0), min_size=8, max_size=8))
def test_inertia_of_any_quad_is_that_of_its_two_triangles(moved):
    """Any convex quad has the inertia of the triangles that make it, within rounding, and a positive mass matrix."""
    corners = QUAD.copy()
    corners[:, :2] += np.reshape(moved, (4, 2))
    if jacobians(corners[None]).min() < 1.0:
        return
    one = structure(shell_mesh(corners, [[0, 1, 2, 3]]))
    two = structure(shell_mesh(corners, [[0, 1, 2], [0, 2, 3]]))
    R = rigid_motions(one.xyz, one.direction)
    np.testing.assert_allclose(rigid_mass(one.M, R), rigid_mass(two.M, R), rtol=1e-11, atol=1e-17)
    assert np.linalg.eigvalsh(quad_mass(corners[None], section(1))[0]).min() > 0.0
