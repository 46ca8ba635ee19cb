"""Which shell holds a place, which shells go on from it as one plate, and where the plate has its free edges."""

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line_geometry import KINK_LIMIT
from fatigue.weld.mesh import NONE, ShellMesh, centroids, normals

Floats = NDArray[np.float64]
INSIDE = 1e-3  # of half the size of an element: how far outside a place may lie
PARALLEL = float(np.cos(np.radians(KINK_LIMIT)))
_SAME_THICKNESS = 0.01


@dataclass(frozen=True, slots=True)
class Held:
    """A place in an element: its natural coordinates, ``xi, eta`` from -1 to 1 or the first two areas of a triangle.

    ``excess`` is how far outside it lies, in natural coordinates (0: inside), ``height`` its distance from the
    mid-surface [mm].
    """

    element: int
    natural: tuple[float, float]
    excess: float
    height: float


@dataclass(frozen=True, slots=True, eq=False)
class Plates:
    """A shell mesh [mm] with what is asked of it again and again.

    Attributes
    ----------
    normal, centre : (e, 3) of the elements
    reach : (e,) distance from the centre to the farthest corner
    smooth : elements beyond every side, (e, 4), where the plate goes on without kink, branch or change of section
    ends : (e, 4, 2) indices of the two nodes of every side
    free : (e, 4) sides that belong to one element only
    at_node : elements by the index of a corner
    """

    mesh: ShellMesh
    normal: Floats
    centre: Floats
    reach: Floats
    smooth: NDArray[np.int64]
    ends: NDArray[np.int64]
    free: NDArray[np.bool_]
    at_node: dict[int, list[int]]

    def corners(self, element: int) -> NDArray[np.int64]:
        """Indices of the three or four corners."""
        around = self.mesh.corner[element]
        return np.asarray(around[around != NONE])

    def size(self, element: int) -> float:
        """Length of the longest side [mm]."""
        xyz = self.mesh.xyz[self.corners(element)]
        return float(np.linalg.norm(np.roll(xyz, -1, axis=0) - xyz, axis=1).max())

    def fan(self, element: int, node: int) -> list[int]:
        """Elements round a node that are one plate with ``element``, itself first."""
        found, todo = [element], [element]
        while todo:
            own = todo.pop()
            for side in range(4):
                other = int(self.smooth[own, side])
                if other != NONE and node in self.ends[own, side] and other not in found:
                    found.append(other)
                    todo.append(other)
        return found

    def neighbours(self, element: int) -> list[int]:
        """Elements that touch ``element`` at a corner or side and are one plate with it, itself left out."""
        around = (other for node in self.corners(element).tolist() for other in self.fan(element, node))
        return [other for other in dict.fromkeys(around) if other != element]


def plates_of(mesh: ShellMesh) -> Plates:
    """Plates of a mesh in mm."""
    normal, centre = normals(mesh), centroids(mesh)
    ends = mesh.side_ends()
    is_side = ends[:, :, 1] != NONE
    rows, sides = np.nonzero(is_side)
    _, of_edge, count = np.unique(np.sort(ends[is_side], axis=1), axis=0, return_inverse=True, return_counts=True)
    of_edge = of_edge.ravel()
    order = np.argsort(of_edge, kind="stable")
    pair = order[np.flatnonzero(count[of_edge[order]] == 2)].reshape(-1, 2)
    a, b = rows[pair[:, 0]], rows[pair[:, 1]]
    thickness = np.nan_to_num(mesh.thickness)
    even = np.abs(thickness[a] - thickness[b]) <= _SAME_THICKNESS * np.maximum(thickness[a], thickness[b])
    flat = np.abs(np.sum(normal[a] * normal[b], axis=1)) >= PARALLEL
    pair = pair[even & flat & (mesh.pid[a] == mesh.pid[b])]
    smooth = np.full(mesh.corner.shape, NONE, np.int64)
    smooth[rows[pair[:, 0]], sides[pair[:, 0]]] = rows[pair[:, 1]]
    smooth[rows[pair[:, 1]], sides[pair[:, 1]]] = rows[pair[:, 0]]
    free = np.zeros(mesh.corner.shape, np.bool_)
    free[rows, sides] = count[of_edge] == 1
    at_node: dict[int, list[int]] = defaultdict(list)
    for element, around in enumerate(mesh.corner.tolist()):
        for node in around:
            at_node[node].append(element)
    far = np.where((mesh.corner != NONE)[:, :, None], mesh.xyz[mesh.corner] - centre[:, None], 0.0)
    return Plates(mesh, normal, centre, np.linalg.norm(far, axis=2).max(axis=1), smooth, ends, free, at_node)


def holding(plates: Plates, place: Floats, normal: Floats, thickness: float) -> list[Held]:
    """Elements parallel to a plate of ``normal`` that hold a place, or nearly so, the best one first.

    The place may lie anywhere through the thickness. An element that it lies beside is listed, too, with its excess.
    """
    mesh = plates.mesh
    reach = 1.5 * plates.reach + thickness
    near = np.flatnonzero(np.sum((plates.centre - place) ** 2, axis=1) <= reach**2)
    near = near[np.abs(plates.normal[near] @ normal) >= PARALLEL]
    found = []
    for element in near.tolist():
        height = float((place - plates.centre[element]) @ plates.normal[element]) - float(mesh.offset[element])
        own = float(np.nan_to_num(mesh.thickness[element]))
        if abs(height) <= 0.6 * max(own, thickness):
            natural, excess = _natural(mesh.xyz[plates.corners(element)], plates.normal[element], place)
            found.append(Held(element, natural, excess, height))
    return sorted(found, key=lambda held: (max(held.excess - INSIDE, 0.0), round(abs(held.height), 6)))


def _natural(xyz: Floats, normal: Floats, place: Floats) -> tuple[tuple[float, float], float]:
    """Natural coordinates of a place in the plane of an element, and how far outside it lies."""
    x = xyz[1] - xyz[0]
    x = x - (x @ normal) * normal
    x /= np.linalg.norm(x)
    flat = np.stack([(xyz - place) @ x, (xyz - place) @ np.cross(normal, x)], axis=1)
    if len(xyz) == 3:
        second, third = np.linalg.solve(np.stack([flat[1] - flat[0], flat[2] - flat[0]], axis=1), -flat[0])
        areas = (1.0 - second - third, second, third)
        return (float(areas[0]), float(second)), max(0.0, -2.0 * float(min(areas)))
    at, size = np.zeros(2), float(np.abs(flat - flat.mean(axis=0)).max())
    for _ in range(30):
        shape, slope = shape_functions(*at)
        step = np.linalg.lstsq((slope @ flat).T, shape @ flat, rcond=None)[0]
        at = np.clip(at - step, -4.0, 4.0)
        if np.abs(step).max() < 1e-12:
            break
    if np.abs(shape_functions(*at)[0] @ flat).max() > 1e-6 * size:  # far outside there may be no solution
        return (0.0, 0.0), np.inf
    return (float(at[0]), float(at[1])), max(0.0, float(np.abs(at).max()) - 1.0)


def shape_functions(xi: float, eta: float) -> tuple[Floats, Floats]:
    """Bilinear shape functions of the four corners, and their slopes along xi and eta, (2, 4).

    >>> shape_functions(0.0, 0.0)[0].tolist()
    [0.25, 0.25, 0.25, 0.25]
    """
    a, b = np.array([-1.0, 1.0, 1.0, -1.0]), np.array([-1.0, -1.0, 1.0, 1.0])
    shape = (1 + a * xi) * (1 + b * eta) / 4
    return shape, np.stack([a * (1 + b * eta), b * (1 + a * xi)]) / 4


def weights_of_corners(held: Held, corners: int) -> Floats:
    """Weights (3,) or (4,) of the corners of an element at a place, clipped to the element."""
    first, second = held.natural
    if corners == 3:
        areas = np.clip([first, second, 1.0 - first - second], 0.0, 1.0)
        return np.asarray(areas / areas.sum())
    return shape_functions(*np.clip(held.natural, -1.0, 1.0))[0]
