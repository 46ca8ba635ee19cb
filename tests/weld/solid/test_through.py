"""Cuts through the plate beneath a line on the skin of solids."""

from itertools import pairwise

import numpy as np
import pytest

from fatigue.weld.cuts import trace
from fatigue.weld.detection import topology
from fatigue.weld.solid.mesh import SolidMesh
from fatigue.weld.solid.skin import skin_of
from fatigue.weld.solid.through import cut_through
from fatigue.weld.solid.toes import toes
from tests.solid_meshes import Solids, tee


def cuts(mesh: SolidMesh):
    """Cuts of all toes with their faults, by name."""
    skin = skin_of(mesh)
    topo = topology(skin.mesh)
    return {cut.name: cut_through(skin, cut) for cut in trace(topo, toes(topo))}


def heights(mesh, column):
    """Places of the nodes of a column."""
    return mesh.xyz[np.searchsorted(mesh.node, column)]


@pytest.mark.parametrize("parabolic", [False, True])
@pytest.mark.parametrize("wedge", [0.0, 4.0])
def test_columns_through_uneven_layers(wedge, parabolic):
    """From the toe straight down to the other face; solids beyond the cut alone; x, y, z half way; y' to the weld."""
    mesh = tee(wedge=wedge).mesh(parabolic)
    base = [cut for cut, fault in cuts(mesh).values() if cut.pid == 1 and not fault]
    assert len(base) == 2
    for cut in base:
        line = cut.line
        side = -1.0 if line.xyz[0, 1] < 30 else 1.0
        y = 30 + side * (3 + wedge)
        assert line.edge_mid.tolist() == ([False, True] * 3 + [False] if parabolic else [False] * 4)
        assert line.xyz[:, 1:] == pytest.approx(np.tile([y, 5.0], (line.node.size, 1)))
        assert line.thickness == pytest.approx(10.0)
        assert line.normal == pytest.approx(np.tile([0, 0, 1], (line.node.size, 1)))
        assert line.outward == pytest.approx(np.tile([0, -side, 0], (line.node.size, 1)))
        for node, column, is_mid, xyz in zip(line.node, cut.columns, line.edge_mid, line.xyz, strict=True):
            z = [10.0, 6.5, 3.0, 1.5, 0.0] if parabolic and not is_mid else [10.0, 3.0, 0.0]
            assert column[0] == node
            assert heights(mesh, column) == pytest.approx(np.array([[xyz[0], y, h] for h in z]))
        touching = np.isin(mesh.corner, np.searchsorted(mesh.node, [n for c in cut.columns for n in c])).any(axis=1)
        centre = np.array([mesh.xyz[c[c >= 0]].mean(axis=0) for c in mesh.corner])
        beyond = touching & (side * (centre[:, 1] - y) > 0)
        assert cut.elements.tolist() == mesh.element[beyond].tolist()


def test_a_weld_of_wedges_is_no_plate():
    """The way through a wedge ends at its other flank."""
    found = [fault for cut, fault in cuts(tee(wedge=4.0).mesh()).values() if cut.pid == 3]
    assert len(found) == 4
    assert all("a pentahedron, has no face opposite" in fault for fault in found)


def test_any_direction_and_any_numbers():
    """A turned and renumbered mesh gives the same places, thickness and solids."""
    rng = np.random.default_rng(1)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    ids = rng.permutation(5000) + 1
    plain, other = tee(wedge=4.0).mesh(), tee(wedge=4.0).mesh(move=lambda x: turn @ x, renumber=lambda n: int(ids[n]))

    def lines(mesh, back):
        found = [cut for cut, fault in cuts(mesh).values() if not fault]
        return {(*c.elements, *np.round(c.line.normal[0] @ back).astype(int)): c.line for c in found}

    here, there = lines(plain, np.eye(3)), lines(other, turn)
    assert here.keys() == there.keys()
    assert len(here) == 4
    for elements, line in here.items():
        order = np.argsort(line.xyz[:, 0])
        turned = there[elements]
        again = np.argsort((turned.xyz @ turn)[:, 0])
        assert (turned.xyz @ turn)[again] == pytest.approx(line.xyz[order])
        assert (turned.normal @ turn)[again] == pytest.approx(line.normal[order])
        assert (turned.outward @ turn)[again] == pytest.approx(line.outward[order])
        assert turned.thickness[again] == pytest.approx(line.thickness[order])


def pipe(parabolic):
    """A pipe of 16 segments on a plate of 16 mm: rings of bricks, the pipe from radius 20 to 26 mm."""
    angle = np.radians(np.arange(0, 360, 22.5))
    solids = Solids()

    def ring(radii, z):
        for a, b in zip(angle, np.roll(angle, -1), strict=True):
            for r0, r1 in pairwise(radii):
                for z0, z1 in pairwise(z):
                    flat = [(r0, a), (r1, a), (r1, b), (r0, b)]
                    nodes = [(r * np.cos(t), r * np.sin(t), h) for h in (z0, z1) for r, t in flat]
                    solids.elements.append((1, [solids.node(n) for n in nodes]))

    ring([8.0, 14.0, 20.0, 26.0, 34.0, 44.0], [0.0, 8.0, 16.0])
    ring([20.0, 26.0], [16.0, 26.0, 40.0])
    return solids.mesh(parabolic)


@pytest.mark.parametrize("parabolic", [False, True])
def test_a_closed_line_round_a_pipe(parabolic):
    """Two rings of toes, each seen from the plate and from the pipe, all closed."""
    mesh = pipe(parabolic)
    found = cuts(mesh)
    assert len(found) == 4
    for cut, fault in found.values():
        assert not fault
        assert cut.line.closed
        assert cut.line.node.size == (32 if parabolic else 16)
        assert cut.elements.size == (32 if cut.line.thickness[0] > 10 else 16)
    thick = sorted(round(float(cut.line.thickness[0]), 3) for cut, _ in found.values())
    assert thick == pytest.approx([6.0, 6.0, 16.0, 16.0])


def changed(mesh: SolidMesh, **columns):
    """Solid mesh with other columns."""
    same = {name: getattr(mesh, name) for name in ("node", "xyz", "element", "corner", "mid", "pid")}
    return SolidMesh(**(same | columns))


def test_mid_side_nodes_of_one_face_only():
    """There is no column beneath a mid-side node of the toe where the other face has none."""
    mesh = tee(z=(0.0, 10.0)).mesh(parabolic=True)
    mid = mesh.mid.copy()
    bottom = mesh.xyz[mid][:, :, 2] == 0
    mid[bottom & (mid >= 0)] = -1
    faults = [fault for cut, fault in cuts(changed(mesh, mid=mid)).values() if cut.pid == 1]
    assert len(faults) == 2
    assert all("on one of two opposite edges only" in fault for fault in faults)


def test_mid_side_nodes_left_out_along_the_columns():
    """They need not be there: columns have what there is."""
    mesh = tee().mesh(parabolic=True)
    mid = mesh.mid.copy()
    mid[:48, 4:8] = -1  # the base plate, between bottom and top
    base = [cut for cut, fault in cuts(changed(mesh, mid=mid)).values() if cut.pid == 1 and not fault]
    assert [len(column) for column in base[0].columns] == [3] * 7


def test_tetrahedra_beneath():
    """They have no columns."""
    mesh = tee().mesh()
    corner = mesh.corner.copy()
    pid = mesh.pid
    corner[4] = [*corner[4, [0, 1, 3, 4]], -1, -1, -1, -1]
    faults = [fault for cut, fault in cuts(changed(mesh, corner=corner, pid=pid)).values() if fault]
    assert faults


def test_a_block_is_no_plate():
    """A short step on a long block: 100 mm to the other face beside a line of 10 mm."""
    solids = Solids().block([0, 10], [0, 20, 40], [0, 50, 100]).block([0, 10], [20, 40], [100, 120])
    faults = {cut.pid: fault for cut, fault in cuts(solids.mesh()).values() if "100 mm thick" in fault}
    assert faults == {1: "100 mm thick beside a line of 10 mm: no plate"}


def test_faces_that_are_not_parallel_and_columns_that_lean():
    """A wedge of a plate, and a plate whose nodes are shifted from layer to layer."""

    def leaning(x):
        return np.add(x, (0, 0.6 * min(x[2] - 10, 0), 0))

    faults = [fault for cut, fault in cuts(tee().mesh(move=leaning)).values() if cut.pid == 1]
    assert all("31 degrees off the normal of the surface" in fault for fault in faults)
    assert len(faults) == 2

    def tapered(x):  # the lower face falls by 0.75 in 1
        return np.add(x, (0, 0, -0.75 * max(40 - x[1], 0) * max(1 - x[2] / 10, 0)))

    faults = [fault for cut, fault in cuts(tee().mesh(move=tapered)).values() if cut.pid == 1 and fault]
    assert any("37 degrees from parallel" in fault for fault in faults)
