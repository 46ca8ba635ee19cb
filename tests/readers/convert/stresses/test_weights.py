"""Whatever way elements and points are turned, the stress at a point is that of the field."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.readers.convert.stresses.evaluate import at_read_outs, available
from fatigue.readers.convert.stresses.points import StressPoint
from fatigue.readers.convert.stresses.read_outs import place_read_outs
from fatigue.readers.convert.stresses.surface import plates_of
from fatigue.readers.convert.stresses.weights import elements_needed, skewed, terms_of
from fatigue.readers.foreign.fe.model import FeModel, Section, Shell, shell_mesh
from tests.readers.convert.stresses.plate_fields import T, blocks, field, in_frame, plate


def point(x, y, e1=(1.0, 0.0), up=True, kind="nominal", name="p", z=0.0):
    """A stress point on the plate."""
    along = np.array([*e1, 0.0]) / np.hypot(*e1)
    return StressPoint(name, kind, np.array([x, y, z]), T, along, np.array([0.0, 0.0, 1.0 if up else -1.0]), 0)


def stress_at(shells, points, own, density="fine"):
    """Stress (r, 2, 3) at the read-outs of points, and the read-outs."""
    plates = plates_of(shells.model.mesh)
    read_outs, problems = place_read_outs(plates, points, density, "points.csv")
    assert not problems
    terms = terms_of(plates, read_outs, available(own))
    return at_read_outs(terms, own, shells.model, len(read_outs)), read_outs


@settings(max_examples=40, deadline=None)
@given(
    st.integers(0, 10_000), st.floats(2.0, 78.0), st.floats(2.0, 58.0), st.floats(-np.pi, np.pi), st.booleans(),
    st.sampled_from([0.0, 0.3, 1.0]), st.booleans(), st.floats(-T / 2, T / 2),
)  # fmt: skip
def test_a_linear_field_is_exact(seed, x, y, angle, up, triangles, corners, z):
    """From corners or centres, at any place through the thickness, in any frame; top and bottom change with it."""
    shells, own = plate(seed, triangles=triangles), field(seed)
    e1 = np.array([np.cos(angle), np.sin(angle)])
    stress, _ = stress_at(shells, [point(x, y, e1, up, z=z)], blocks(shells, lambda _: own, corners=corners))
    for face, top in enumerate((1, -1) if up else (-1, 1)):
        assert np.allclose(stress[0, face], in_frame(own.at((x, y), top), e1, up), atol=1e-8)


def test_one_tensor_in_every_frame():
    """A uniform field: every point of one frame has one tensor, whatever the element; pure bending changes its sign."""
    shells, own = plate(3, triangles=0.4), field(3, linear=False)
    points = [point(x, y, name=f"{x} {y}") for x in (5, 22, 41, 77) for y in (3, 29, 55)]
    stress, _ = stress_at(shells, points, blocks(shells, lambda _: own))
    assert np.allclose(stress, stress[:1], atol=1e-9)
    mean, bending = stress.mean(axis=1), (stress[:, 0] - stress[:, 1]) / 2
    assert np.allclose(mean, own.membrane[:, 0])
    assert np.allclose(bending, own.bending[:, 0])


def test_turning_a_point_over():
    """With the normal the faces change and txy its sign; with e1 nothing does."""
    shells, own = plate(1), field(1)
    there = blocks(shells, lambda _: own)
    first, back, over = (
        stress_at(shells, [point(40, 31, e1, up)], there)[0][0]
        for e1, up in (((1, 0), True), ((-1, 0), True), ((1, 0), False))
    )
    assert np.allclose(first, back)
    assert np.allclose(first, over[::-1] * np.array([1, 1, -1]))


@pytest.mark.parametrize("fibres", [(-T / 2, T / 2), (T / 2, -T / 2), (0.0, T / 2), (-1.0, 2.0)])
def test_fibres_anywhere(fibres):
    """Z1 and Z2 of a property may be anything but equal: stress is linear through the thickness."""
    shells, own = plate(2), field(2)
    stress, _ = stress_at(shells, [point(33, 20)], blocks(shells, lambda _: own, fibres=fibres))
    assert np.allclose(stress[0], [own.at((33, 20), top) for top in (1, -1)], atol=1e-8)


def test_a_mean_and_a_curvature_are_refused():
    """Fibres at one distance are no two faces."""
    shells, own = plate(2), field(2)
    there = blocks(shells, lambda _: own, fibres=(0.0, 1.0))
    for block in there:
        block.fibre[..., 1] = 0.0
    with pytest.raises(DataError, match="a mean and a curvature are no stresses of faces"):
        stress_at(shells, [point(33, 20)], there)


def test_an_average_stays_within_a_property():
    """Two properties meet at x = 40: each side has the stress of its own elements right up to the line."""
    shells = plate(4, pid=lambda x, _: 1 if x < 40 else 2)
    fields = {1: field(1, linear=False), 2: field(2, linear=False)}
    there = blocks(shells, lambda e: fields[shells.pid[e]])
    edge = min(g[0] for g in shells.grids.values() if g[0] > 36)  # distorted: some place left of the line
    stress, _ = stress_at(shells, [point(edge - 4.0, 30), point(48, 30, name="q")], there)
    assert np.allclose(stress[0].mean(axis=0), fields[1].membrane[:, 0])
    assert np.allclose(stress[1].mean(axis=0), fields[2].membrane[:, 0])


def tee_of_plates():
    """Two plates in one plane and an upright on the line where they meet: one property, and a branch."""
    places = [(0, 0, 0), (10, 0, 0), (20, 0, 0), (0, 10, 0), (10, 10, 0), (20, 10, 0), (10, 0, 10), (10, 10, 10)]
    grids = {k: np.array(p, float) for k, p in enumerate(places, 1)}
    shells = {1: (1, 2, 5, 4), 2: (2, 3, 6, 5), 3: (2, 5, 8, 7)}
    mesh = shell_mesh("tee", grids, [Shell(e, 1, c) for e, c in shells.items()], {1: Section(T)})
    model = FeModel("tee", mesh, np.empty(0, np.int64), np.empty((0, 3, 3)))
    return type("Tee", (), {"grids": grids, "shells": shells, "pid": dict.fromkeys(shells, 1), "model": model})


def test_an_average_ends_where_plates_meet():
    """On the line of an upright each side keeps its own stress; e1 chooses the side."""
    shells = tee_of_plates()
    flat = type("Flat", (), {"shells": {e: shells.shells[e] for e in (1, 2)}, "grids": shells.grids})
    fields = {1: field(1, linear=False), 2: field(2, linear=False)}
    there = blocks(flat, lambda e: fields[e])
    for e1, element in (((1, 0), 2), ((-1, 0), 1)):
        stress, _ = stress_at(shells, [point(10, 5, e1, kind="hot_spot_a")], there)
        wanted = [in_frame(fields[element].at((0, 0), top), e1, True) for top in (1, -1)]
        assert np.allclose(stress, [wanted, wanted])


def test_hot_spots_and_edges():
    """Type a at its multiples of the thickness, type b along the edge: the stress along it, mean of the faces."""
    shells, own = plate(5), field(5)
    there = blocks(shells, lambda _: own)
    stress, read_outs = stress_at(shells, [point(20, 30, (0, 1), kind="hot_spot_a")], there, "quadratic")
    assert [one.distance for one in read_outs] == pytest.approx([2.4, 5.4, 8.4])
    for k, one in enumerate(read_outs):
        assert np.allclose(stress[k, 0], in_frame(own.at((20, 30 + one.distance), 1), (0, 1), True), atol=1e-8)
    for e1, sign in (((1, 0), 1), ((-1, 0), -1)):
        edge = point(30, 60.5, e1, kind="hot_spot_b")  # half a millimetre off, as drawings are
        stress, read_outs = stress_at(shells, [edge], there, "coarse")
        assert [one.distance for one in read_outs] == [5.0, 15.0]
        for k, one in enumerate(read_outs):
            sx = own.at((30 + sign * one.distance, 60), 0)[0]
            assert stress[k].mean(axis=0)[0] == pytest.approx(sx, abs=1e-8)


def test_corners_are_asked_for_only_where_the_plate_is_one():
    """The elements needed are the holder and those that touch it without a branch."""
    shells = tee_of_plates()
    plates = plates_of(shells.model.mesh)
    read_outs, _ = place_read_outs(plates, [point(5, 5)], "fine", "")
    assert elements_needed(plates, read_outs).tolist() == [1]


def test_an_element_without_stress_is_named():
    """A block that lacks an element is no zero."""
    shells, own = plate(6, turned=False), field(6)
    (only,) = blocks(shells, lambda _: own)
    plates = plates_of(shells.model.mesh)
    read_outs, _ = place_read_outs(plates, [point(33, 20)], "fine", "")
    terms = terms_of(plates, read_outs, available([only]))
    with pytest.raises(DataError, match=r"element \d+ has no stress at node \d+"):
        at_read_outs(terms, [only.__class__(only.where, 1, 1, np.nan, "QUAD4", only.element[:1], only.node[:1],
                                            only.fibre[:1], only.stress[:1])], shells.model, 1)  # fmt: skip


def test_skewed_parabolic_quadrangles_are_refused():
    """How their solver lays axes at a corner of 60 degrees is not known; at right angles it does not matter."""
    for lean, refused in ((0.0, False), (1.0, False), (6.0, True)):
        corners = [(0, 0, 0), (10, 0, 0), (10 + lean, 10, 0), (lean, 10, 0)]
        middle = [np.mean([corners[k], corners[(k + 1) % 4]], axis=0) for k in range(4)]
        grids = {k: np.array(p, float) for k, p in enumerate([*corners, *middle], 1)}
        mesh = shell_mesh("q8", grids, [Shell(1, 1, (1, 2, 3, 4), (5, 6, 7, 8))], {1: Section(T)})
        plates = plates_of(mesh)
        read_outs, _ = place_read_outs(plates, [point(5, 5)], "fine", "")
        found = list(skewed(plates, terms_of(plates, read_outs, available([])._replace(corners={1})), "p.csv"))
        assert [problem.code for problem in found] == ["skewed_element"] * refused
        if refused:
            assert "4 corners of parabolic quadrangles are more than 10 degrees" in found[0].what
