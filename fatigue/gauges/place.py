"""Where a gauge sits: the element under it, its face, and the elements that its grid crosses.

A place is given by an element, or by a point near the plate with the outward normal there. Of the elements whose normal
is within 20 degrees of it and which contain the projection of the point, the nearest one is meant; the sign of its
normal says which face that is (measured_data.md 1.5).
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.gauges.element_row import BOTTOM, TOP, element_frames
from fatigue.readers.neutral.body.mesh import Mesh

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

ALIKE = float(np.cos(np.deg2rad(20.0)))  # of two normals
MOST_DISTANCE = 2.0  # plate thicknesses from the mid-surface
ROUNDING = 1e-6  # of the size of an element: a point this far outside an edge is on it
CLIPPED = 1e-9  # likewise where a grid is cut: what it adds is left out again
CORNERS = 4


@dataclass(frozen=True, slots=True, eq=False)
class Shells:
    """The shell elements of a mesh in their mean planes; e elements by ascending id.

    Attributes
    ----------
    element : (e,) ids
    nodes : (e, 8) node ids, 0 where an element has fewer
    axes, centre : (e, 3, 3) and (e, 3), see ``ElementFrames``
    xy : (e, 4, 2) corners [mm], the third of a triangle twice
    thickness : (e,) NaN where it is not known [mm]
    pid : (e,) property
    """

    element: NDArray[np.int64]
    nodes: NDArray[np.int64]
    axes: Floats
    centre: Floats
    xy: Floats
    thickness: Floats
    pid: NDArray[np.int64]

    @property
    def normal(self) -> Floats:
        """Unit normals (e, 3) on the top side."""
        return self.axes[:, 2]

    def index(self, element: int) -> int | None:
        """Place of an element among all; None where there is none of this id."""
        at = int(np.searchsorted(self.element, element))
        return at if at < self.element.size and self.element[at] == element else None

    def of(self, some: NDArray[np.integer]) -> "Shells":
        """Some of the elements, ascending."""
        parts = (self.element, self.nodes, self.axes, self.centre, self.xy, self.thickness, self.pid)
        return Shells(*(part[some] for part in parts))


@dataclass(frozen=True, slots=True)
class Spot:
    """A point on a face of an element: its index, the face, and how far the given point is from the mid-surface."""

    index: int
    face: int
    distance: float


def shells_of(mesh: Mesh) -> Shells:
    """Elements of a mesh, their planes computed; mid-side nodes do not matter for these."""
    ids = mesh.corners[:, :CORNERS].copy()
    triangle = (ids[:, 3] == 0) | (ids[:, 3] == ids[:, 2])
    ids[triangle, 3] = ids[triangle, 2]
    xyz = mesh.xyz[np.searchsorted(mesh.node, ids)]
    axes, centre = np.empty((len(ids), 3, 3)), np.empty((len(ids), 3))
    for some, corners in ((triangle, 3), (~triangle, 4)):
        frames = element_frames(xyz[some, :corners])
        axes[some], centre[some] = frames.axes, frames.centre
    xy = (xyz - centre[:, None]) @ axes[:, :2].transpose(0, 2, 1)
    return Shells(mesh.element, mesh.corners, axes, centre, xy, mesh.thickness, mesh.pid)


def located(shells: Shells, xyz: Floats, normal: Floats, where: str) -> Spot:
    """The nearest element whose normal is alike and which contains the projection of a point; ``where`` for messages.

    Of elements that are as near the one of the lowest id is taken. How thick it is does not matter here.

    Raises
    ------
    DataError : there is none
    """
    toward = shells.normal @ (normal / np.linalg.norm(normal))
    local = np.einsum("eij,ej->ei", shells.axes, xyz - shells.centre)
    inside = contains(shells.xy, local[:, :2])
    found = np.flatnonzero(inside & (np.abs(toward) >= ALIKE))
    if found.size:
        index = int(found[np.argmin(np.round(np.abs(local[found, 2]), 9))])
        return Spot(index, TOP if toward[index] > 0.0 else BOTTOM, float(abs(local[index, 2])))
    what = "no element whose normal is within 20 degrees of the given one contains its projection"
    alike = np.flatnonzero(np.abs(toward) >= ALIKE)
    if alike.size:
        apart = np.linalg.norm(shells.centre[alike] - xyz, axis=1)
        nearest = shells.element[alike[np.argmin(apart)]]
        what += f"; the middle of the nearest such element, {nearest}, is {apart.min():.4g} mm away"
    remedy = "Correct the place [mm] or the normal, or give the element"
    raise DataError(Problem("not_on_plate", where, what, remedy))


def contains(xy: Floats, at: Floats) -> Flags:
    """Whether each polygon (e, n, 2), counter-clockwise and convex, holds its point (e, 2), its edges included."""
    edge = np.roll(xy, -1, axis=1) - xy
    to = at[:, None, :] - xy
    left = edge[..., 0] * to[..., 1] - edge[..., 1] * to[..., 0]
    size = np.ptp(xy, axis=1).max(axis=1)
    return np.asarray((left >= -ROUNDING * size[:, None] ** 2).all(axis=1))


def crossed(
    shells: Shells, spot: Spot, centre: Floats, direction: Floats, length: float, where: str
) -> list[tuple[int, float]]:
    """Elements under a straight grid and what part of its length lies on each, in their order along it.

    Parameters
    ----------
    spot : its middle
    centre, direction : (3,) the middle on the mid-surface [mm], and a unit vector in the plane there
    length : of the grid [mm]
    where : for messages

    Returns
    -------
    index of each element and its share of the length, 1 in all

    Raises
    ------
    DataError : a part of the grid is on no element
    """
    near = np.flatnonzero(
        (np.abs(shells.normal @ shells.normal[spot.index]) >= ALIKE)
        & (np.linalg.norm(shells.centre - centre, axis=1) <= length + np.linalg.norm(shells.xy, axis=2).max(axis=1))
    )
    some = shells.of(near)
    middle = np.einsum("eij,ej->ei", some.axes, centre - some.centre)
    along = some.axes @ direction
    ends = _clipped(some.xy, middle[:, :2], along[:, :2], length / 2.0)
    cuts = np.unique(np.concatenate([ends[np.isfinite(ends)], [-length / 2.0, length / 2.0]]))
    shares: dict[int, float] = {}
    for begin, end in pairwise(cuts.tolist()):
        if end - begin <= ROUNDING * length:
            continue
        s = (begin + end) / 2.0
        height = np.abs(middle[:, 2] + s * along[:, 2])
        there = (ends[:, 0] <= s) & (s <= ends[:, 1]) & (height <= MOST_DISTANCE * np.nan_to_num(some.thickness))
        if not there.any():
            what = f"its grid of {length:g} mm leaves the plate {min(abs(begin), abs(end)):.4g} mm from its middle"
            raise DataError(Problem("grid_off_plate", where, what, "Move it, or give a shorter grid_length_mm"))
        best = int(np.flatnonzero(there)[np.argmin(np.round(height[there], 9))])
        shares[int(near[best])] = shares.get(int(near[best]), 0.0) + float(end - begin)
    total = sum(shares.values())
    return [(index, share / total) for index, share in shares.items()]


def _clipped(xy: Floats, middle: Floats, along: Floats, half: float) -> Floats:
    """Where the line ``middle + s along`` (e, 2) enters and leaves each polygon (e, n, 2), (e, 2); NaN: nowhere.

    Clipped edge by edge (Cyrus and Beck, 1978), |s| at most ``half``.
    """
    edge = np.roll(xy, -1, axis=1) - xy
    to = middle[:, None, :] - xy
    size = np.ptp(xy, axis=1).max(axis=1)[:, None]
    inside = edge[..., 0] * to[..., 1] - edge[..., 1] * to[..., 0] + CLIPPED * size**2
    slope = edge[..., 0] * along[:, None, 1] - edge[..., 1] * along[:, None, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        at = -inside / slope
    low = np.where(slope > 0.0, at, -half).max(axis=1).clip(min=-half)
    high = np.where(slope < 0.0, at, half).min(axis=1).clip(max=half)
    outside = ((slope == 0.0) & (inside < 0.0)).any(axis=1) | (low > high)
    return np.where(outside[:, None], np.nan, np.stack([low, high], axis=1))
