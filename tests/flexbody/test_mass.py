"""Modal mass against a frame whose matrices are known, against closed forms, and against a full harmonic solution."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import sparse

from fatigue.flexbody.mass import (
    boundary_mass,
    centre_of_mass,
    dynamic_mass,
    effective_mass,
    elastic_mass,
    frequencies_to_look_at,
    modal_mass_matrix,
    participation,
    rigid_mass,
    rigid_motions,
    summed_up_to,
)
from tests.beam_frame import RHO, frame, lumped

Z = 0.015


def about_centre(model):
    """Rigid motions of a frame about its centre of mass."""
    centre = centre_of_mass(rigid_mass(model.mass, rigid_motions(model.place, model.direction)))
    return rigid_motions(model.place, model.direction, centre)


def carried(model):
    """Frequencies, effective masses and rigid masses of a frame held at its feet."""
    R = about_centre(model)
    f, shapes = model.fixed_modes()
    L, mass = participation(model.mass, shapes, R), np.diag(modal_mass_matrix(model.mass, shapes))
    return f, effective_mass(L, mass), np.diag(rigid_mass(model.mass, R))


def test_rigid_motions_are_strainless():
    """A rigid motion costs a frame no force, translations and rotations about any point alike."""
    model = frame()
    R = rigid_motions(model.place, model.direction, (300.0, -70.0, 1100.0))
    assert abs(model.K @ R).max() < 1e-10 * abs(model.K).max() * abs(R).max()


def test_mass_of_a_frame_is_that_of_its_beams():
    """R' M R holds the mass of the beams in every direction, and no coupling about the centre of mass."""
    model = frame()
    lengths = sum(np.linalg.norm(model.xyz[a] - model.xyz[b]) for a, b in [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5)])
    lengths += np.linalg.norm(model.xyz[5] - model.xyz[6]) + np.linalg.norm(model.xyz[3] - model.xyz[7])
    whole = rigid_mass(model.mass, about_centre(model))
    assert np.diag(whole)[:3] == pytest.approx(RHO * 2000.0 * lengths, rel=1e-12)
    assert abs(whole[:3, 3:]).max() < 1e-9 * abs(whole).max()


@pytest.mark.parametrize("foot_mass", [0.0, 3.0])
def test_effective_masses_and_boundary_sum_up_to_the_body(foot_mass):
    """All fixed-interface modes and what is on the boundary are the whole body, in all six directions."""
    model = frame(foot_mass)
    _, effective, whole = carried(model)
    on_boundary = boundary_mass(model.mass, about_centre(model), model.held)
    assert effective.sum(axis=0) + on_boundary == pytest.approx(whole, rel=1e-10)
    assert (effective.sum(axis=0) <= whole * (1 + 1e-12)).all()


def test_boundary_of_a_lumped_mass_is_the_mass_on_it():
    """With a diagonal mass matrix the boundary has exactly what is lumped there: the sum check of the textbooks."""
    model = lumped(frame())
    R = about_centre(model)
    on_boundary = boundary_mass(model.mass, R, model.held)
    held = np.where(model.held, np.diag(model.M), 0.0)
    assert on_boundary == pytest.approx(np.diag(R.T @ (held[:, None] * R)), rel=1e-12)
    _, effective, whole = carried(model)
    assert effective.sum(axis=0) == pytest.approx(whole - on_boundary, rel=1e-10)


def test_boundary_passes_over_massless_degrees_of_freedom():
    """Degrees of freedom without mass do not stop the sum."""
    M = sparse.csc_array(np.diag([1.0, 0.0, 2.0, 0.0]))
    R = rigid_motions(np.zeros((4, 3)), np.array([0, 3, 0, 3]))
    assert boundary_mass(M, R, np.array([True, True, False, False])).tolist() == [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]


def test_rigid_motion_is_the_static_answer_to_a_moving_boundary():
    """L by Craig and Bampton's constraint modes, Psi_r = T R_m, is L by the rigid motion itself."""
    model = frame(0.5)
    R, m, s = about_centre(model), model.held, ~model.held
    psi = R.copy()
    psi[s] = -np.linalg.solve(model.K[s][:, s], model.K[s][:, m] @ R[m])
    _, shapes = model.fixed_modes()
    by_constraint_modes = shapes.T @ model.M @ psi
    L = participation(model.mass, shapes, R)
    assert by_constraint_modes == pytest.approx(L, abs=1e-8 * abs(L).max())


def test_free_modes_take_no_part():
    """Elastic modes of a free frame are orthogonal to rigid motions: an effective mass is undefined there."""
    model = frame(0.2)
    R = about_centre(model)
    _, shapes = model.free_modes()
    share = effective_mass(participation(model.mass, shapes, R), np.ones(shapes.shape[1])) / np.diag(
        rigid_mass(model.mass, R)
    )
    assert share.max() < 1e-12


@given(scale=st.floats(1e-3, 1e3), sign=st.sampled_from([-1.0, 1.0]), mode=st.integers(0, 20))
def test_scale_and_sign_of_a_shape_do_not_count(scale, sign, mode):
    """Effective mass is that of the mode, not of its normalisation."""
    L, mass = np.arange(1.0, 22.0)[:, None] * [1.0, -2.0], np.linspace(0.5, 2.0, 21)
    factor = np.ones(21)
    factor[mode] = scale * sign
    scaled = effective_mass(factor[:, None] * L, factor**2 * mass)
    assert scaled == pytest.approx(effective_mass(L, mass), rel=1e-12)


def test_summed_up_to_a_frequency():
    """The band ends with the mode that lies on its edge."""
    effective = np.array([[3.0], [2.0], [1.0]])
    assert [float(summed_up_to(np.array([5.0, 9.0, 20.0]), effective, band)[0]) for band in (4.9, 9.0, 99.0)] == [
        0,
        5,
        6,
    ]


def test_dynamic_mass_is_that_of_the_full_model():
    """Force at a base that shakes the whole frame, by solving all its equations at each frequency."""
    model = frame(0.1)
    R, s = about_centre(model), ~model.held
    f, effective, whole = carried(model)
    _, shapes = model.fixed_modes()
    M, K, phi = model.M[s][:, s], model.K[s][:, s], shapes[s]
    w = 2 * np.pi * f
    C = M @ phi @ np.diag(2 * Z * w) @ phi.T @ M
    at = np.array([0.3 * f[0], f[0], 1.1 * f[1], 2.5 * f[3]])
    found = dynamic_mass(at, f, np.full(len(f), Z), effective, whole)
    for row, hz in zip(found, at, strict=True):
        W = 2 * np.pi * hz
        forced = model.M[s] @ R
        relative = np.linalg.solve(K - W**2 * M + 1j * W * C, -forced)
        force = np.diag(R.T @ model.M @ R) - W**2 * np.einsum("ij,ij->j", forced, relative)
        assert row == pytest.approx(force, rel=1e-8)


def test_dynamic_mass_at_resonance():
    """The numbers of a car body of 30 t: 17 974 kg at 11.66 Hz and 1.5 % are 599 133 kg at resonance."""
    f, z, m_eff = np.array([11.66]), np.array([0.015]), np.array([[17974.0]])
    assert abs(elastic_mass(f, f, z, m_eff))[0, 0] == pytest.approx(599133.0, abs=1.0)
    assert abs(dynamic_mass(f, f, z, m_eff, np.array([30000.0])))[0, 0] == pytest.approx(599958.0, rel=2e-3)


def test_dynamic_mass_near_a_mode_among_others():
    """m_eff / (2 zeta) within 0.2 % where a mode stands alone, though others are there."""
    f, effective = np.array([4.0, 40.0, 90.0]), np.array([[12.0], [5.0], [3.0]])
    peak = abs(elastic_mass(f[:1], f, np.full(3, Z), effective))[0, 0]
    assert peak == pytest.approx(12.0 / (2 * Z), rel=2e-3)


@given(
    st.lists(st.tuples(st.floats(1.0, 200.0), st.floats(1e-3, 0.3), st.floats(0.0, 30.0)), min_size=1, max_size=12),
    st.floats(0.0, 500.0),
)
def test_both_forms_of_the_dynamic_mass_are_one(modes, hz):
    """Rigid mass with the elastic part, and residual mass with what the modes carry, are the same."""
    f, z, m_eff = np.array(modes).T
    residual, r = 2.0, hz / f
    first = dynamic_mass(np.array([hz]), f, z, m_eff[:, None], np.array([m_eff.sum() + residual]))[0, 0]
    second = residual + np.sum(m_eff * (1 + 2j * z * r) / (1 - r**2 + 2j * z * r))
    assert abs(first - second) <= 1e-12 * (abs(first) + abs(m_eff / z).sum())


def test_limits_of_the_dynamic_mass():
    """The whole body at rest, the residual mass far above the modes, m_eff r^2 far below one of them."""
    f, z, m_eff, rigid = np.array([8.0, 12.0]), np.array([Z, Z]), np.array([[18.0], [7.0]]), np.array([30.0])
    low, high = dynamic_mass(np.array([0.0, 1e7]), f, z, m_eff, rigid)[:, 0]
    assert low == rigid[0]
    assert high == pytest.approx(30.0 - 25.0, rel=1e-5)
    far_above = np.array([500.0])
    static = elastic_mass(np.array([5.0]), far_above, z[:1], m_eff[:1])[0, 0]
    assert static.real == pytest.approx(18.0 * (5.0 / 500.0) ** 2, rel=1e-3)


def test_frequencies_meet_every_mode():
    """The frequencies that are looked at have every natural one among them, ascend, and end where asked."""
    f = np.array([7.31, 11.66, 55.5, 130.0])
    at = frequencies_to_look_at(f, np.array([0.0, 0.015, 0.02, 0.02]), 120.0)
    assert np.isin(f[:3], at).all()
    assert (np.diff(at) > 0).all()
    assert (at[0], at[-1]) == (0.0, 120.0)
