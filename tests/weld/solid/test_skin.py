"""The skin of solid meshes."""

import numpy as np
import pytest

from fatigue.weld.detection import topology
from fatigue.weld.mesh import centroids, normals
from fatigue.weld.solid.skin import BRANCHES, FREE, skin_of
from tests.solid_meshes import Solids, tee


def areas(mesh):
    """Area vectors of triangles and quadrangles."""
    a, b, c, d = (mesh.xyz[mesh.corner[:, k]] for k in range(4))
    triangle = (mesh.corner[:, 3] < 0)[:, None]
    return 0.5 * np.where(triangle, np.cross(b - a, c - a), np.cross(c - a, d - b))


@pytest.mark.parametrize("wedge", [0.0, 4.0])
@pytest.mark.parametrize("parabolic", [False, True])
def test_the_skin_is_closed_and_bounds_the_volume(wedge, parabolic):
    """Area vectors add up to nothing, the divergence theorem gives the volume, and every edge has two faces."""
    mesh = skin_of(tee(wedge=wedge).mesh(parabolic)).mesh
    area = areas(mesh)
    assert area.sum(axis=0) == pytest.approx(0.0, abs=1e-9)
    volume = np.einsum("ij,ij->", area, centroids(mesh)) / 3
    assert volume == pytest.approx(40 * (60 * 10 + 6 * 24 + wedge**2), rel=1e-12)
    assert (np.diff(topology(mesh).first) == 2).all()


def test_mid_nodes_lie_between_their_corners():
    """Of a face turned round as well."""
    mesh = skin_of(tee(wedge=4.0).mesh(parabolic=True)).mesh
    ends = mesh.side_ends()
    has = mesh.mid >= 0
    middle = (mesh.xyz[ends[has][:, 0]] + mesh.xyz[ends[has][:, 1]]) / 2
    assert has.sum() == (mesh.corner >= 0).sum()
    assert mesh.xyz[mesh.mid[has]] == pytest.approx(middle)


def test_a_solid_turned_inside_out_has_the_same_skin():
    """Normals point out of the material, whichever way the nodes run."""
    solids = Solids().block([0, 1], [0, 1], [0, 1])
    pid, nodes = solids.elements[0]
    solids.elements[0] = pid, nodes[4:] + nodes[:4]
    mesh = skin_of(solids.mesh()).mesh
    out = centroids(mesh) - 0.5
    assert (np.einsum("ij,ij->i", normals(mesh), out) > 0.4).all()


def test_what_lies_beyond_a_face():
    """A neighbour, nothing, or several solids."""
    solids = Solids().block([0, 1, 2], [0, 1], [0, 1])
    skin = skin_of(solids.mesh())
    assert (skin.beyond >= 0).sum() == 2
    assert (skin.beyond == FREE).sum() == 10 == skin.mesh.element.size
    face = int(np.flatnonzero(skin.beyond >= 0)[0])
    assert skin.beyond[skin.beyond[face]] == face
    solids.elements.append(solids.elements[0])
    solids.elements[-1] = (
        1,
        [*solids.elements[0][1][:4], *(solids.node((x, y, 5)) for x, y in [(0, 0), (1, 0), (1, 1), (0, 1)])],
    )
    solids.elements.append(
        (1, [*solids.elements[0][1][:4], *(solids.node((x, y, 7)) for x, y in [(0, 0), (1, 0), (1, 1), (0, 1)])])
    )
    assert (skin_of(solids.mesh()).beyond == BRANCHES).sum() == 3
