"""Which edges of a shell mesh are welds.

Every edge is judged by the number of shells that meet there, by their properties and by the angle between them:

========  ==========================================================  ============
tee       three or more shells meet (T, cross and lap joints)         weld
corner    two shells with different properties, turned by > 30 deg    weld
flat      two shells with different properties in one plane           candidate
fold      two shells with one property, turned by > 30 deg            candidate
========  ==========================================================  ============

A change of property in a plane is often a mere change of thickness or colour, and a fold is often bent sheet: these are
listed, and assessed only on request.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.mesh import NONE, ShellMesh, centroids, inward, normals

SMOOTH_DEG = 30.0
"""Shells that meet at a smaller angle are one plate."""

_OPPOSITE = -np.cos(np.radians(SMOOTH_DEG))

WELDS = ("tee", "corner")
CANDIDATES = ("flat", "fold")

Key = tuple[str, tuple[int, ...]]
"""Kind of an edge and the sorted properties that meet there: a weld line keeps both."""


@dataclass(frozen=True, slots=True, eq=False)
class Topology:
    """Edges of a mesh and the sides of elements that meet there; a *side* is 4 x element + its number in the element.

    Attributes
    ----------
    ends : (k, 2) node indices of every edge, ascending
    edge : (4 e,) edge of every side, -1 for the fourth side of a triangle
    sides : (s,) sides sorted by edge
    first : (k + 1,) where the sides of each edge begin in ``sides``
    inward : (4 e, 3) unit vector from a side into its element
    normal, centroid : (e, 3) of the elements
    """

    mesh: ShellMesh
    ends: NDArray[np.int64]
    edge: NDArray[np.int64]
    sides: NDArray[np.int64]
    first: NDArray[np.int64]
    inward: NDArray[np.float64]
    normal: NDArray[np.float64]
    centroid: NDArray[np.float64]

    def sides_of(self, edge: int) -> list[int]:
        """Sides that meet at an edge."""
        sides: list[int] = self.sides[self.first.item(edge) : self.first.item(edge + 1)].tolist()
        return sides

    def is_smooth(self, a: int, b: int) -> bool:
        """Whether the elements of two sides of one edge continue each other as one plate."""
        return bool(self.inward[a] @ self.inward[b] < _OPPOSITE)


def topology(mesh: ShellMesh) -> Topology:
    """Edges of a mesh and the sides of elements that meet there."""
    ends, nodes = mesh.side_ends().reshape(-1, 2), len(mesh.node)
    both = ends.min(axis=1) * nodes + ends.max(axis=1)  # one number for two nodes: faster to sort
    sides = np.flatnonzero(ends[:, 0] != NONE)
    sides = sides[np.argsort(both[sides], kind="stable")]
    both = both[sides]
    begins = np.diff(both, prepend=-1) != 0
    edge = np.full(len(ends), NONE, np.int64)
    edge[sides] = np.cumsum(begins) - 1
    first = np.flatnonzero(np.append(begins, True))
    both = both[begins]
    return Topology(
        mesh=mesh,
        ends=np.stack([both // nodes, both % nodes], axis=1),
        edge=edge,
        sides=sides,
        first=first,
        inward=inward(mesh).reshape(-1, 3),
        normal=normals(mesh),
        centroid=centroids(mesh),
    )


def classify(topo: Topology) -> dict[int, Key]:
    """Kind and properties of every edge that may be a weld; free edges and edges inside a plate are left out."""
    count = np.diff(topo.first)
    pid = np.repeat(topo.mesh.pid, 4)
    found: dict[int, Key] = {}
    for edge in np.flatnonzero(count >= 3).tolist():
        found[edge] = ("tee", tuple(sorted(int(pid[s]) for s in topo.sides_of(edge))))
    pair = np.flatnonzero(count == 2)
    a, b = topo.sides[topo.first[pair]], topo.sides[topo.first[pair] + 1]
    is_turned = np.einsum("ij,ij->i", topo.inward[a], topo.inward[b]) >= _OPPOSITE
    changes = pid[a] != pid[b]
    for kind, where in (
        ("corner", is_turned & changes),
        ("flat", ~is_turned & changes),
        ("fold", is_turned & ~changes),
    ):
        for edge, p, q in zip(pair[where], pid[a[where]], pid[b[where]], strict=True):
            found[int(edge)] = (kind, (int(min(p, q)), int(max(p, q))))
    return found


def stacked_elements(mesh: ShellMesh) -> NDArray[np.int64]:
    """Ids of elements that share all their corners with another one; such doubled shells look like welds all round."""
    corners = np.sort(mesh.corner, axis=1)
    _, which, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    return mesh.element[count[which.ravel()] > 1]
