"""Throats of fillet welds: statics by hand, equilibrium, and what must not change them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.weld.structural_stress import StructuralStress, structural_stress
from fatigue.weld.throat import (
    SIGN,
    LineForce,
    Throat,
    lap_throat,
    line_force,
    tee_throat,
    throat_stress,
    weld_forces,
)

T = np.array([8.0])
BOTH = ("top", "bottom")
numbers = st.floats(-500.0, 500.0, allow_nan=False, allow_subnormal=False)
loads = st.tuples(*[numbers] * 5)
throats = st.builds(
    lambda a, angle, y, z: Throat(a, angle, np.array([y]), np.array([z])),
    st.floats(1.0, 12.0),
    st.floats(-90.0, 90.0),
    st.floats(-10.0, 10.0),
    st.floats(0.5, 10.0),
)


def line(fx=0.0, fy=0.0, fz=0.0, mx=0.0, my=0.0):
    """A line force and moment at one station under one mode."""
    return LineForce(*(np.array([[float(value)]]) for value in (fx, fy, fz, mx, my)))


def stresses(load, throat, sides=BOTH, lever="throats"):
    """Throat stress on every side."""
    return {s: throat_stress(f, throat, s) for s, f in weld_forces(load, throat, sides, T, lever).items()}


def value(array):
    """The one number of a station and mode."""
    return float(array[0, 0])


def tractions(stress, throat, side, points=2001):
    """Resultant force and moment about the line of the stress over the throat, by the trapezium rule."""
    s, a, angle = SIGN[side], throat.throat, np.radians(throat.angle_deg)
    n, u = np.array([np.cos(angle), s * np.sin(angle)]), np.array([-np.sin(angle), s * np.cos(angle)])
    y_c, z_c = (float(part[0]) for part in throat.centroid)
    v = np.linspace(-0.5 * a, 0.5 * a, points)  # along u, from the root to the face
    normal = value(stress.sigma_perp) - 2.0 * v / a * value(stress.bending)
    traction = normal[:, None] * n + value(stress.tau_perp) * u
    y, z = y_c + v * u[0], s * z_c + v * u[1]
    along = np.full(points, value(stress.tau_par))
    moment_x, moment_y = y * traction[:, 1] - z * traction[:, 0], z * along
    return [float(np.trapezoid(q, v)) for q in (along, traction[:, 0], traction[:, 1], moment_x, moment_y)]


@given(loads, throats)
@settings(max_examples=80, deadline=None)
def test_two_welds_carry_the_whole_load(load, throat):
    """Tractions of both welds, integrated, give back the three forces and both moments about the line."""
    z_c = float(throat.centroid[1][0])
    if abs(z_c) < 0.1:
        return
    found = stresses(line(*load), throat)
    total = np.sum([tractions(stress, throat, side) for side, stress in found.items()], axis=0)
    np.testing.assert_allclose(
        total, load, rtol=1e-6, atol=1e-6 * max(1.0, np.abs(load).max()) * (1.0 + 10.0 / abs(z_c))
    )


@given(loads, throats, st.sampled_from(BOTH))
@settings(max_examples=80, deadline=None)
def test_one_weld_carries_forces_and_moment(load, throat, side):
    """A single weld gives back the forces and the moment about the line; its twist is neglected."""
    found = stresses(line(*load), throat, (side,))[side]
    total = np.array(tractions(found, throat, side))
    np.testing.assert_allclose(total[:4], load[:4], rtol=1e-6, atol=1e-5 * max(1.0, np.abs(load).max()))


@given(loads, throats)
@settings(max_examples=50, deadline=None)
def test_the_resultant_does_not_know_the_angle(load, throat):
    """sigma_perp^2 + tau_perp^2 is (F_y^2 + F_z^2) / a^2 at any angle of the section."""
    for side, force in weld_forces(line(*load), throat, ("top",), T).items():
        found = throat_stress(force, throat, side)
        squared = value(found.sigma_perp) ** 2 + value(found.tau_perp) ** 2
        assert squared == pytest.approx(
            (value(force.y) ** 2 + value(force.z) ** 2) / throat.throat**2, rel=1e-9, abs=1e-9
        )


@given(loads, throats)
@settings(max_examples=50, deadline=None)
def test_top_and_bottom_are_mirror_images(load, throat):
    """A load mirrored in the mid-surface does at the bottom weld what the load does at the top one."""
    fx, fy, fz, mx, my = load
    mirrored = line(fx, fy, -fz, -mx, -my)
    for sides in (("top",), BOTH):
        one = stresses(line(*load), throat, sides)["top"]
        other = stresses(mirrored, throat, ("bottom",) if sides == ("top",) else sides)["bottom"]
        for name in ("sigma_perp", "tau_perp", "tau_par", "root", "face"):
            assert value(getattr(one, name)) == pytest.approx(value(getattr(other, name)), rel=1e-9, abs=1e-9), name


def test_tension_of_a_tee():
    """Two sides: sigma_perp = |tau_perp| = N / (2 sqrt2 a); one: sigma_root = N / (sqrt2 a) + 6 z_c N / a^2."""
    N, a = 240.0, 4.0
    throat = tee_throat(T, a, 0.0, 0.0)
    for stress in stresses(line(fy=N), throat).values():
        assert value(stress.sigma_perp) == pytest.approx(N / (2.0 * np.sqrt(2.0) * a))
        assert value(stress.tau_perp) == pytest.approx(-N / (2.0 * np.sqrt(2.0) * a))
    z_c = float(throat.centroid[1][0])
    alone = stresses(line(fy=N), throat, ("top",))["top"]
    assert value(alone.root) == pytest.approx(N / (np.sqrt(2.0) * a) + 6.0 * z_c * N / a**2)


def test_lap_joint_of_full_legs():
    """A lap of leg = t without restraint: root -2 N/t, face +4 N/t."""
    N, t = 240.0, 8.0
    stress = stresses(line(fy=N), lap_throat(T, t / np.sqrt(2.0), 0.0, 0.0), ("top",))["top"]
    assert value(stress.root) == pytest.approx(-2.0 * N / t)
    assert value(stress.face) == pytest.approx(4.0 * N / t)


def test_lever_of_the_thickness_scales_the_couples():
    """With the lever t the couples of two welds are h/t times as large, and all else stays."""
    throat = tee_throat(T, 4.0, 0.0, 0.0)
    h = 2.0 * float(throat.centroid[1][0])
    for load in (line(mx=480.0), line(my=300.0)):
        own, other = stresses(load, throat)["top"], stresses(load, throat, lever="t")["top"]
        for name in ("sigma_perp", "tau_perp", "tau_par"):
            assert value(getattr(other, name)) == pytest.approx(value(getattr(own, name)) * h / 8.0)
    forces = line(fx=10.0, fy=20.0)
    assert value(stresses(forces, throat, lever="t")["top"].root) == value(stresses(forces, throat)["top"].root)


def test_the_line_at_the_mid_surface_of_the_base_has_a_lever():
    """f_z acts on an arm of half the base more: leaving the offset out loses most of the moment."""
    load = line(fz=60.0)
    right = stresses(load, tee_throat(T, 4.0, 0.0, -5.0))["top"]
    wrong = stresses(load, tee_throat(T, 4.0, 0.0, 0.0))["top"]
    assert value(right.tau_perp) > 1.7 * value(wrong.tau_perp)


@given(loads)
@settings(max_examples=30, deadline=None)
def test_line_force_is_the_inverse_of_structural_stress(load):
    """The five components of structural stress give back the line force and moment that they were made of."""
    fx, fy, fz, mx, my = load
    made = structural_stress(np.eye(3)[None], T, np.array([[[fx, fy, fz, mx, my, 7.0]]]))
    again = line_force(made, T)
    found = [value(getattr(again, name)) for name in ("x", "y", "z", "mx", "my")]
    np.testing.assert_allclose(found, load, rtol=1e-12, atol=1e-12)
    assert isinstance(made, StructuralStress)
