"""Structural stress: worked values, signs and what must not change it."""

from dataclasses import fields as columns
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.weld.line_geometry import arc_length, local_axes
from fatigue.weld.line_load import line_load_matrix
from fatigue.weld.structural_stress import StructuralStress, assess_line, structural_stress
from tests.weld_lines import fields, lines, moved, reversed_line, ring, rotations, shifted, straight, weld_line

NAMES = [column.name for column in columns(StructuralStress)]


def assert_same_stress(actual, expected, at=slice(None), signs=None):
    """Compare all five components, raw and treated, at the nodes ``at`` of the second line."""
    for kind in ("raw", "treated"):
        for name in NAMES:
            want = getattr(getattr(expected, kind), name)[at] * (signs or {}).get(name, 1)
            got = getattr(getattr(actual, kind), name)
            np.testing.assert_allclose(got, want, rtol=1e-7, atol=1e-9 * max(1e-300, np.abs(want).max()))


@pytest.mark.parametrize(
    ("component", "name", "stress"),
    [
        (0, "in_plane_shear", 10.0),
        (1, "membrane", 10.0),
        (2, "transverse_shear", 10.0),
        (3, "bending", -6.0),
        (4, "twist_shear", 6.0),
        (5, None, 0.0),
    ],
)
def test_one_component_at_a_time(component, name, stress):
    """Thickness 10, local axes = global axes: f / t from 100 N/mm, 6 m / t^2 from 100 N; drilling is no stress."""
    load = np.zeros((2, 1, 6))
    load[..., component] = 100.0
    line = straight([10.0])
    found = structural_stress(local_axes(line), line.thickness, load)
    for other in NAMES:
        np.testing.assert_allclose(getattr(found, other), stress if other == name else 0.0, atol=1e-15)


def test_tension_is_positive_membrane():
    """A plate at negative y pulled in +y across the line: sigma_m > 0."""
    line = straight([10.0, 10])
    nodal = np.zeros((3, 1, 6))
    nodal[:, 0, 1] = [500, 1000, 500]
    np.testing.assert_allclose(assess_line(line, nodal).raw.membrane, 10.0, rtol=1e-14)


def test_a_tip_load_upwards_presses_the_top():
    """A cantilever, line along the clamped edge's opposite cut: m = r x F from 2 N/mm up at 60 mm: sigma_b = -7.2."""
    line = straight([10.0, 10])
    nodal = np.zeros((3, 1, 6))
    nodal[:, 0, 3] = 2.0 * 60.0 * np.array([5, 10, 5])  # y x z = x
    np.testing.assert_allclose(assess_line(line, nodal).raw.bending, -7.2, rtol=1e-14)


def test_each_node_has_its_own_thickness():
    """The line load does not depend on the thickness, the stress does."""
    load = np.zeros((2, 1, 6))
    load[..., 1] = 100.0
    line = straight([10.0], thickness=[10, 20])
    found = structural_stress(local_axes(line), line.thickness, load)
    np.testing.assert_allclose(found.membrane[:, 0], [10, 5], rtol=1e-14)


def test_solving_comes_before_rotating():
    """A uniform radial line load on a ring of 12 chords is recovered; rotated first it would be 0.955 of it."""
    line = ring(12, thickness=10.0)
    radial = line.xyz / 100
    nodal = np.zeros((12, 1, 6))
    nodal[:, 0, :3] = 50.0 * (line_load_matrix(line) @ radial)
    np.testing.assert_allclose(assess_line(line, nodal).raw.membrane, 5.0, rtol=1e-12)
    rotated_first = np.linalg.solve(line_load_matrix(line).toarray(), np.sum(nodal[:, 0, :3] * radial, axis=1))
    np.testing.assert_allclose(rotated_first / 50.0, 2 / 3 + np.cos(2 * np.pi / 12) / 3, rtol=1e-12)


@given(lines(), rotations(), st.tuples(*3 * [st.floats(-1e4, 1e4)]))
@settings(deadline=None, max_examples=25)
def test_stress_does_not_depend_on_the_frame(line, rotation, shift):
    """A model rotated and shifted with its forces has the same stress."""
    nodal = fields(line, 2, 6)
    turned = np.concatenate([nodal[..., :3] @ rotation.T, nodal[..., 3:] @ rotation.T], axis=-1)
    assert_same_stress(assess_line(moved(line, rotation, np.array(shift)), turned), assess_line(line, nodal))


@given(lines())
@settings(deadline=None, max_examples=25)
def test_stress_does_not_depend_on_the_direction_of_the_line(line):
    """Numbered the other way round, all five components stay: y' follows outward, hence x' stays too."""
    nodal = fields(line, 2, 6)
    assert_same_stress(
        assess_line(reversed_line(line), nodal[::-1]), assess_line(line, nodal), at=slice(None, None, -1)
    )


@given(lines(closed=True), st.integers(1, 7))
@settings(deadline=None, max_examples=20)
def test_stress_does_not_depend_on_the_start_of_a_ring(line, by):
    """A ring that begins elsewhere has the same stress."""
    nodal = fields(line, 2, 6)
    order = np.roll(np.arange(line.node.size), -by)
    assert_same_stress(assess_line(shifted(line, by), nodal[order]), assess_line(line, nodal), at=order)


@given(lines())
@settings(deadline=None, max_examples=20)
def test_the_other_side_of_an_unloaded_line_sees_the_same_stress(line):
    """Outward and forces reversed: only the transverse shear, whose face z' is kept, changes its sign."""
    nodal = fields(line, 2, 6)
    other = assess_line(replace(line, outward=-line.outward), -nodal)
    assert_same_stress(other, assess_line(line, nodal), signs={"transverse_shear": -1})


@given(lines())
@settings(deadline=None, max_examples=20)
def test_top_and_bottom(line):
    """With the normal reversed x' and z' turn: bending and both mean shears change sign, membrane and twist do not."""
    nodal = fields(line, 2, 6)
    below = assess_line(replace(line, normal=-line.normal), nodal)
    signs = {"bending": -1, "in_plane_shear": -1, "transverse_shear": -1}
    assert_same_stress(below, assess_line(line, nodal), signs=signs)


@given(lines(), st.floats(0.01, 100))
@settings(deadline=None, max_examples=20)
def test_scale_law(line, scale):
    """Lengths times k, forces times k^2 and moments times k^3 leave the stress."""
    nodal = fields(line, 2, 6)
    larger = replace(
        line,
        xyz=scale * line.xyz,
        thickness=scale * line.thickness,
        end_length=None if line.end_length is None else scale * line.end_length,
    )
    scaled = nodal * np.repeat([scale**2, scale**3], 3)
    assert_same_stress(assess_line(larger, scaled), assess_line(line, nodal))


@given(lines(), st.floats(-3, 3), st.floats(-3, 3))
@settings(deadline=None, max_examples=15)
def test_stress_is_linear_in_the_forces(line, a, b):
    """Modes superpose."""
    nodal = fields(line, 2, 6)
    combined = assess_line(line, a * nodal[:, :1] + b * nodal[:, 1:])
    parts = assess_line(line, nodal)
    for name in NAMES:
        of_modes = getattr(parts.treated, name)
        expected = a * of_modes[:, 0] + b * of_modes[:, 1]
        np.testing.assert_allclose(getattr(combined.treated, name)[:, 0], expected, atol=1e-9 * np.abs(of_modes).max())


def test_only_the_zone_of_a_weld_end_is_treated():
    """Raw and treated stress differ in the end zones and agree between them."""
    line = straight([5.0] * 8, thickness=10.0)
    nodal = np.zeros((9, 1, 6))
    nodal[:, 0, 1] = line_load_matrix(line) @ (1 / np.sqrt(arc_length(line) + 0.5))
    found = assess_line(line, nodal)
    assert found.at_end.tolist() == [True] * 3 + [False] * 3 + [True] * 3
    assert found.treated.membrane[0] < found.raw.membrane[0]
    np.testing.assert_array_equal(found.treated.membrane[3:6], found.raw.membrane[3:6])


def test_marks_of_corners_and_coarse_ends():
    """A kink inside the line, the corner ends of a part and end edges longer than the zone are marked."""
    bent = weld_line([[0, 0, 0], [20, 0, 0], [20, 5, 0], [20, 10, 0]], outward=(-1, 1, 0))
    found = assess_line(replace(bent, corner_end=True), np.zeros((4, 1, 6)))
    assert found.at_corner.tolist() == [False, True, False, True]
    assert found.unresolved.tolist() == [True, False, False, False]
