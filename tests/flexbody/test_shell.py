"""K and M of shell meshes, forces of their elements, and meshes that are none."""

import dataclasses

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.flexbody import shell
from fatigue.flexbody.factor import factored
from fatigue.flexbody.mass import rigid_motions
from fatigue.flexbody.modes import held_modes
from fatigue.flexbody.shell import element_forces, side_forces, structure
from tests.flexbody.shells import halved, plate, shell_mesh, together, tube
from tests.shell_fe import ShellModel, grid


@pytest.fixture(params=["quads", "triangles", "warped", "both"])
def mesh(request):
    """A mesh of each kind, and one of quads and triangles together."""
    if request.param == "both":
        return together(tube(4, 3, twist=0.3), plate(3, 2, triangles=True), [0, 0, 500.0])
    if request.param == "warped":
        return tube(6, 5, twist=0.4)
    return plate(4, 3, triangles=request.param == "triangles")


def test_rigid_motions_are_free_of_force(mesh):
    """K is symmetric and resists no rigid motion; its rows are six of each node."""
    body = structure(mesh)
    R = rigid_motions(body.xyz, body.direction, [100.0, -50.0, 20.0])
    assert (np.abs(body.K @ R) <= 1e-11 * (abs(body.K) @ np.abs(R)).max(axis=0)).all()
    assert abs(body.K - body.K.T).max() < 1e-12 * abs(body.K).max()
    assert body.node.tolist() == np.repeat(mesh.node, 6).tolist()
    assert body.direction.tolist() == list(range(6)) * len(mesh.node)


def test_chunks_make_no_difference(mesh, monkeypatch):
    """K, M and forces are the same, whether elements are taken at once or in small portions."""
    shapes = np.random.default_rng(0).normal(size=(6 * len(mesh.node), 2))
    at_once, forces = structure(mesh), element_forces(mesh, shapes, mesh.element)
    monkeypatch.setattr(shell, "CHUNK", 3)
    by_parts = structure(mesh)
    assert abs(at_once.K - by_parts.K).max() < 1e-12 * abs(at_once.K).max()
    assert abs(at_once.M - by_parts.M).max() < 1e-12 * abs(at_once.M).max()
    np.testing.assert_allclose(element_forces(mesh, shapes, mesh.element), forces, atol=1e-12 * np.abs(forces).max())


def test_forces_of_all_elements_are_those_of_the_body(mesh):
    """Forces on elements sum to K u at each node, and each element is in balance."""
    u = np.random.default_rng(1).normal(size=(6 * len(mesh.node), 3))
    body = structure(mesh)
    of_all = side_forces(mesh, u, mesh.element, mesh.node)
    np.testing.assert_allclose(of_all.reshape(-1, 3), body.K @ u, atol=1e-11 * np.abs(of_all).max())
    forces = element_forces(mesh, u, mesh.element[::-1])[::-1]
    total = np.zeros((len(mesh.node) + 1, 6, 3))
    np.add.at(total, mesh.corners, forces)
    np.testing.assert_allclose(total[:-1], of_all, atol=1e-11 * np.abs(of_all).max())
    arm = mesh.xyz[mesh.corners] - mesh.xyz[mesh.corners].mean(axis=1, keepdims=True)
    moment = forces[:, :, 3:] + np.cross(arm[..., None], forces[:, :, :3], axis=2)
    assert np.abs(forces[:, :, :3].sum(axis=1)).max() < 1e-10 * np.abs(forces[:, :, :3]).max()
    assert np.abs(moment.sum(axis=1)).max() < 1e-9 * np.abs(moment).max()


def test_forces_of_a_side():
    """Nodes and elements are given by id in any order; the elements of one side carry what those of the other do."""
    mesh = plate(6, 4)
    mesh = dataclasses.replace(mesh, node=mesh.node * 10, element=mesh.element + 500)
    u = np.random.default_rng(2).normal(size=(6 * len(mesh.node), 2))
    line = mesh.node[np.isclose(mesh.xyz[:, 0], 200.0)][::-1]
    left = mesh.xyz[mesh.corners].mean(axis=1)[:, 0] < 200.0
    one, other = (side_forces(mesh, u, mesh.element[side], line) for side in (left, ~left))
    of_body = (structure(mesh).K @ u).reshape(-1, 6, 2)[np.searchsorted(mesh.node, line)]
    np.testing.assert_allclose(one + other, of_body, atol=1e-11 * np.abs(of_body).max())
    model = ShellModel(mesh.xyz, mesh.corners, 4.0)
    known = model.side_forces(u[:, 0].reshape(-1, 6), np.flatnonzero(left), np.searchsorted(mesh.node, line))
    np.testing.assert_allclose(one[:, :, 0], known, atol=1e-12 * np.abs(known).max())


def test_forces_of_unknown_elements_are_refused():
    """And at unknown nodes, by their id."""
    mesh = plate(2, 2)
    u = np.zeros((6 * len(mesh.node), 1))
    for elements, nodes, said in (([1, 9], [1], "element 9"), ([0], [1], "element 0"), ([1], [1, 44], "node 44")):
        with pytest.raises(DataError, match=f"{said}: the mesh does not have it"):
            side_forces(mesh, u, np.array(elements), np.array(nodes))


@pytest.mark.parametrize("triangles", [False, True], ids=["quads", "triangles"])
def test_cantilever(triangles):
    """A slender strip bends across its plane with the frequencies of a beam, 1.875^2 and 4.694^2, within 1 %.

    Its tip load F L^3/3EI; nu = 0, so that the strip is a beam.
    """
    mesh = plate(20, 2, 400.0, 20.0, 4.0, triangles=triangles, nu=0.0)
    body = structure(mesh)
    root = np.isclose(body.xyz[:, 0], 0.0)
    sideways = np.isin(body.direction, [0, 1, 5])
    found = held_modes(body, root | sideways, count=3).frequency
    EI, mass = 210000.0 * 20.0 * 4.0**3 / 12, 7.85e-9 * 20.0 * 4.0
    exact = np.array([1.8751, 4.6941]) ** 2 / (2 * np.pi * 400.0**2) * np.sqrt(EI / mass)
    assert found[0] == pytest.approx(exact[0], rel=0.01)
    assert np.abs(found[1:] / exact[1] - 1.0).min() < 0.01  # the third may be torsion
    tip = np.isclose(body.xyz[:, 0], 400.0) & (body.direction == 2)
    load = np.where(tip, 1.0 / tip.sum(), 0.0)[:, None]
    u = factored(body, root | sideways).solve(load)
    assert u[tip].mean() == pytest.approx(400.0**3 / (3 * EI), rel=0.01)


def test_bending_thickness_bends_and_thickness_pulls():
    """With another bending thickness, stretching keeps its stiffness and bending takes that of the other."""
    thin, thick = plate(3, 3, thickness=4.0), plate(3, 3, thickness=30.0)
    skin = plate(3, 3, thickness=4.0, bending_thickness=30.0)
    K = {name: structure(mesh).K for name, mesh in {"thin": thin, "thick": thick, "skin": skin}.items()}
    bends = np.tile([False, False, True, True, True, False], len(thin.node))
    for rows, alike in ((bends, "thick"), (~bends, "thin")):
        np.testing.assert_allclose(K["skin"][rows][:, rows].toarray(), K[alike][rows][:, rows].toarray())


def quads_with(change):
    """A plate whose mesh is damaged."""
    xyz, quads = grid(np.linspace(0, 40, 5), np.linspace(0, 30, 4))
    change(xyz, quads)
    return shell_mesh(xyz, quads)


def repeated(_, quads):
    """A node is there twice."""
    quads[3, 2] = quads[3, 1]


def crossed(_, quads):
    """Corners go over the cross."""
    quads[3] = quads[3, [0, 2, 1, 3]]


def dented(xyz, quads):
    """A corner lies inside the triangle of the others."""
    xyz[quads[3, 0]] = xyz[quads[3, 2]] - [3.0, 3.0, 0.0]


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (repeated, "collapsed", "element 4: a node is there twice"),
        (crossed, "no_area", "element 4"),
        (dented, "folded", "element 4: its corners do not run around it, or one of them points inwards"),
    ],
)
def test_elements_without_stiffness_are_refused(change, code, said):
    """By their id, and why."""
    with pytest.raises(DataError) as error:
        structure(quads_with(change))
    assert error.value.problems[0].code == code
    assert said in str(error.value)


def test_a_flat_triangle_is_refused():
    """Three corners on a line have no area; only the first five are named."""
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]])
    with pytest.raises(DataError, match="element 1, 2, 3, 4, 5 and 2 more: its corners lie on a line"):
        structure(shell_mesh(xyz, [[0, 1, 2]] * 7 + [[0, 1, 3]]))


def test_halved_quads_cover_the_plate():
    """Triangles of a plate weigh what its quads do."""
    assert structure(plate(4, 3, triangles=True)).M.sum() == pytest.approx(structure(plate(4, 3)).M.sum())
    assert len(halved(plate(4, 3).corners)) == 24
