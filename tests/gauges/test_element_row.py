"""Mean stress of an element from its corner forces: closed forms, patch tests, and the element's own field."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.flexbody.elements.quad import quad_stiffness
from fatigue.flexbody.elements.section import Section
from fatigue.flexbody.elements.triangle import triangle_stiffness
from fatigue.gauges.element_row import BOTTOM, TOP, element_frames, element_stress
from fatigue.gauges.instrument import strain_reading
from tests.carbody_stresses import SIDES, plates, turned
from tests.gauge_case import displaced

E, NU, T = 70000.0, 0.3, 2.0
STRIP = np.array([[0.0, 0.0, 0.0], [20.0, 0.0, 0.0], [20.0, 10.0, 0.0], [0.0, 10.0, 0.0]])  # measured_oracles.json
SMALL = st.floats(-1.0, 1.0)
ANGLES = st.floats(-180.0, 180.0)


def forces(**components):
    """Forces (4, 1, 6) at four corners, by component."""
    found = np.zeros((4, 1, 6))
    for name, values in components.items():
        found[:, 0, ("fx", "fy", "fz", "mx", "my", "mz").index(name)] = values
    return found


def reading(stress, angle):
    """Strain [1e-6] of one coordinate in a direction."""
    return float(strain_reading(stress, angle, E, NU, 0.0)[0])


def section(of=T):
    """Section of one plate."""
    one = np.ones(1)
    return Section(of * one, of * one, E * one, NU * one, 0 * one, 0 * one)


def plane_stress(strain):
    """Stress [MPa] of plane strains e_xx, e_yy, g_xy."""
    exx, eyy, gxy = strain
    return E / (1 - NU**2) * np.array([exx + NU * eyy, eyy + NU * exx, (1 - NU) / 2 * gxy])


def test_the_small_element_of_the_oracles_in_tension_and_bending():
    """measured_oracles.json, small_element: tension in three directions, bending on the top face."""
    tension = element_stress(STRIP, T, forces(fx=[-50, 50, 50, -50]))
    for angle, expected in ((0, 71.428571), (90, -21.428571), (45, 25.0)):
        assert reading(tension[TOP], angle) == pytest.approx(expected, rel=1e-7)
        assert reading(tension[BOTTOM], angle) == pytest.approx(expected, rel=1e-7)
    bending = element_stress(STRIP, T, forces(my=[-100, 100, 100, -100]))
    for angle, expected in ((0, 428.571429), (90, -128.571429)):
        assert reading(bending[TOP], angle) == pytest.approx(expected, rel=1e-8)
        assert reading(bending[BOTTOM], angle) == pytest.approx(-expected, rel=1e-8)


def test_shear_and_twist_by_hand():
    """Edge shear flow q gives q/t and tension at 45 degrees; a twisting moment 6 M/t2 of either sign on the faces."""
    q = 3.0  # N/mm
    shear = element_stress(STRIP, T, forces(fy=[-5 * q, 5 * q, 5 * q, -5 * q], fx=[-10 * q, -10 * q, 10 * q, 10 * q]))
    assert shear[TOP, :, 0] == pytest.approx([0.0, 0.0, q / T], abs=1e-12)
    assert reading(shear[TOP], 45) == pytest.approx(1e6 * (1 + NU) * q / T / E)
    M = 4.0  # N mm/mm: M_xy on the edges
    twist = element_stress(STRIP, T, forces(mx=[5 * M, -5 * M, -5 * M, 5 * M], my=[-10 * M, -10 * M, 10 * M, 10 * M]))
    assert twist[TOP, :, 0] == pytest.approx([0.0, 0.0, 6 * M / T**2], abs=1e-12)
    assert twist[BOTTOM, 2, 0] == pytest.approx(-6 * M / T**2)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(SMALL, SMALL), min_size=4, max_size=4),
    st.tuples(SMALL, SMALL, SMALL),
    st.tuples(SMALL, SMALL, SMALL),
    st.tuples(SMALL, SMALL, SMALL, SMALL).filter(lambda q: np.linalg.norm(q) > 0.3),
)
def test_any_linear_field_on_any_quad_and_triangle_is_exact(moved, strain, curvature, quaternion):
    """Patch test: forces K u of the shell elements, in any place in space, give back the field's own stress."""
    axes = rotation(quaternion)
    square = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 20.0], [0.0, 20.0]])
    flat = square + 5.0 * np.array(moved)
    for xy, stiffness in ((flat, quad_stiffness), (flat[:3], triangle_stiffness)):
        nodes = np.column_stack([xy, np.full(len(xy), 7.0)]) @ axes
        field = 1e-4 * np.array(strain), 1e-5 * np.array(curvature)
        own = element_frames(nodes).axes
        u = displaced(nodes, *field, own)
        force = (stiffness(nodes[None], section())[0] @ u).reshape(len(nodes), 1, 6)
        found = element_stress(nodes, T, force)[:, :, 0]
        for face, z in ((TOP, T / 2), (BOTTOM, -T / 2)):
            expected = plane_stress(field[0] + z * field[1])
            assert found[face] == pytest.approx(expected, abs=1e-6 * max(1.0, np.abs(expected).max()))


def rotation(quaternion):
    """Rotation matrix of a quaternion of any length."""
    w, x, y, z = np.array(quaternion) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@given(ANGLES, st.tuples(SMALL, SMALL, SMALL))
def test_readings_lie_on_mohrs_circle(angle, stress):
    """The sum of two readings at right angles, and the radius from a rosette, do not depend on its direction."""
    s = 10.0 * np.array(stress)[:, None]
    a, b, c, d = (reading(s, angle + turn) for turn in (0.0, 45.0, 90.0, 60.0))
    assert a + c == pytest.approx(reading(s, 0.0) + reading(s, 90.0), abs=1e-6)
    radius = np.hypot((a - c) / 2, b - (a + c) / 2)
    exx, eyy = reading(s, 0.0), reading(s, 90.0)
    gxy = 1e6 * 2 * (1 + NU) * s[2, 0] / E
    assert radius == pytest.approx(np.hypot((exx - eyy) / 2, gxy / 2), abs=1e-6)
    e = reading(s, angle + 120.0)
    assert a + d + e == pytest.approx(1.5 * (a + c), abs=1e-6)  # 0/60/120


def test_moments_about_the_normal_do_not_enter():
    """Drilling does no work in a symmetric strain field: any mz leaves the stress as it is."""
    force = forces(fx=[-50, 50, 50, -50], my=[-100, 100, 100, -100])
    drilled = force + forces(mz=[7.0, -30.0, 11.0, 900.0])
    assert np.array_equal(element_stress(STRIP, T, drilled), element_stress(STRIP, T, force))


def test_it_agrees_with_the_elements_own_field_in_its_middle():
    """A second route: displacements from the forces by the stiffness, and the strain of the QM6 and MITC4 field."""
    found, _ = plates()
    checked = 0
    for (weld, y), plate in found.items():
        if weld not in SIDES or y > 400.0:
            continue
        force = (plate_stiffness(plate) @ plate.u).reshape(4, 6, -1).swapaxes(1, 2)
        own = element_stress(plate.corners, 12.0, force)
        axes = element_frames(plate.corners).axes
        for face, surface in ((TOP, "top"), (BOTTOM, "bottom")):
            field = plate.stress(plate.corners.mean(axis=0), surface)  # in global x and y
            mean = turned(own[face if axes[2, 2] > 0 else 1 - face], axes[:2, :2])
            assert np.abs(mean - field).max() < 1e-6 * np.abs(field).max()
            checked += 1
    assert checked >= 8


def plate_stiffness(plate):
    """Stiffness of the element of a plate of the pad."""
    one = np.ones(1)
    return quad_stiffness(
        plate.corners[None], Section(12.0 * one, 12.0 * one, plate.E * one, plate.nu * one, 0 * one, 0 * one)
    )[0]


def test_a_tapered_element_keeps_the_mean_of_its_stress():
    """A linear pull on a trapezoid: the mean of N is the work of the forces, whatever the shape."""
    nodes = np.array([[0.0, 0.0, 0.0], [40.0, 5.0, 0.0], [40.0, 15.0, 0.0], [0.0, 20.0, 0.0]])
    K = quad_stiffness(nodes[None], section())[0]
    rng = np.random.default_rng(3)
    u = 1e-3 * rng.standard_normal((24, 5))
    force = (K @ u).reshape(4, 6, 5).swapaxes(1, 2)
    stress = element_stress(nodes, T, force)
    frame = element_frames(nodes)
    for k, name in enumerate(np.eye(3)):
        virtual = displaced(nodes, name, np.zeros(3), frame.axes)  # work of the forces in a field of one strain
        work = virtual @ (K @ u)
        mean = 0.5 * (stress[TOP, k] + stress[BOTTOM, k])
        assert mean * T * frame.area == pytest.approx(work, rel=1e-9)


def test_a_warped_quad_has_its_mean_plane():
    """The normal is that of the diagonals, x runs from corner 1 to 2, and tension along x is what it is."""
    h = 0.4
    nodes = STRIP + np.array([[0, 0, h], [0, 0, -h], [0, 0, h], [0, 0, -h]])
    frame = element_frames(nodes)
    assert frame.axes[2] == pytest.approx([0.0, 0.0, 1.0])
    assert frame.axes[0] == pytest.approx([1.0, 0.0, 0.0])
    assert float(frame.area) == pytest.approx(200.0)
    force = forces(fx=[-50, 50, 50, -50])
    assert element_stress(nodes, T, force)[:, 0, 0] == pytest.approx([5.0, 5.0])


def test_the_frame_follows_the_order_of_the_corners():
    """Corners listed the other way round turn the normal, and top becomes bottom."""
    turned_round = STRIP[[0, 3, 2, 1]]
    assert element_frames(turned_round).axes[2] == pytest.approx([0.0, 0.0, -1.0])
    bending = forces(my=[-100, 100, 100, -100])
    one, other = element_stress(STRIP, T, bending), element_stress(turned_round, T, bending[[0, 3, 2, 1]])
    assert other[TOP, 1, 0] == pytest.approx(one[BOTTOM, 0, 0])  # x of the other runs along y
    assert np.isnan(element_frames(np.zeros((4, 3))).axes).all()


def test_parabolic_elements_read_all_their_nodes():
    """Tension on the consistent forces of parabolic edges, 1/6, 4/6, 1/6 of the edge's; triangle and quadrilateral."""
    mid = (STRIP + np.roll(STRIP, -1, axis=0)) / 2.0
    nodes = np.concatenate([STRIP, mid])
    force = np.zeros((8, 1, 6))
    for at, share in ((0, 1), (7, 4), (3, 1)):  # the edge at x = 0, and the one at x = 20
        force[at, 0, 0] = -100.0 * share / 6.0
    for at, share in ((1, 1), (5, 4), (2, 1)):
        force[at, 0, 0] = 100.0 * share / 6.0
    assert element_stress(nodes, T, force, 4)[TOP, :, 0] == pytest.approx([5.0, 0.0, 0.0], abs=1e-12)
    corners = np.array([[0.0, 0.0, 0.0], [12.0, 0.0, 0.0], [0.0, 12.0, 0.0]])
    triangle = np.concatenate([corners, (corners + np.roll(corners, -1, axis=0)) / 2.0])
    force = np.zeros((6, 1, 6))
    for at, share in ((0, 1), (5, 4), (2, 1)):  # the edge at x = 0 under -N, the slanted one under N cos 45
        force[at, 0, 0] -= 12.0 * 10.0 * share / 6.0
    for at, share in ((1, 1), (4, 4), (2, 1)):
        force[at, 0, 0] += 12.0 * 10.0 * share / 6.0
    assert element_stress(triangle, T, force, 3)[BOTTOM, :, 0] == pytest.approx([5.0, 0.0, 0.0], abs=1e-12)
