"""Mean stress of a shell element from the forces at its corners, by virtual work.

A field of constant strain does the same work on the corner forces as on the stress resultants. So the means of N and M
over the element follow from the forces alone, exactly for every element that passes the patch test, whatever its shape.
Moments about the normal do no work in a symmetric strain field. They do not enter, and without them fx and fy need not
be in balance of moments.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

TOP, BOTTOM = 0, 1
FLAT = 1e-12  # of the square of its size: an element of less area has none


@dataclass(frozen=True, slots=True, eq=False)
class ElementFrames:
    """The mean planes of elements as FE programs orient them; any leading axes, one element each.

    Attributes
    ----------
    axes : (..., 3, 3) unit vectors x, y, z as rows: x from corner 1 to 2, z by the right hand over the corners; NaN of
        an element without area
    centre : (..., 3) mean of the corners [mm]
    xy : (..., n, 2) nodes in the plane, about the centre [mm]
    area : (...) in the plane [mm2]
    """

    axes: Floats
    centre: Floats
    xy: Floats
    area: Floats


def element_frames(nodes: Floats, corners: int | None = None) -> ElementFrames:
    """Frames of elements with nodes (..., n, 3) [mm], the first 3 or 4 of which are ``corners``; by default all.

    Behind the corners stand mid-side nodes. A warped quadrilateral has its mean plane, that of its two diagonals.

    >>> float(element_frames(np.array([[0.0, 0.0, 0.0], [20.0, 0.0, 0.0], [20.0, 10.0, 0.0], [0.0, 10.0, 0.0]])).area)
    200.0
    """
    around = nodes[..., :corners, :]
    first, second, third, last = (around[..., i, :] for i in (0, 1, 2, -1))
    twice = np.cross(third - first, last - second)  # of a triangle, where third is last, too
    size = np.linalg.norm(twice, axis=-1, keepdims=True)
    extent = np.ptp(around, axis=-2).max(axis=-1, keepdims=True)
    z = _unit(np.where(size > FLAT * extent**2, twice, np.nan))
    along = second - first
    x = _unit(along - (along * z).sum(axis=-1, keepdims=True) * z)
    axes = np.stack([x, np.cross(z, x), z], axis=-2)
    centre = around.mean(axis=-2)
    xy = (nodes - centre[..., None, :]) @ np.swapaxes(axes[..., :2, :], -1, -2)
    return ElementFrames(axes, centre, xy, size[..., 0] / 2.0)


def element_stress(nodes: Floats, thickness: float, force: Floats, corners: int | None = None) -> Floats:
    """Mean stress of one element on its faces from the forces and moments at its nodes (measured_data.md 1.2).

    Parameters
    ----------
    nodes : (n, 3) of the element [mm], in its order, mid-side nodes behind the corners
    thickness : of the plate [mm]
    force : (n, c, 6) forces and moments on the element [N, N mm], global axes, of each of c coordinates
    corners : how many of the nodes are corners, by default all

    Returns
    -------
    (2, 3, c) s_xx, s_yy, s_xy in the axes of the element [MPa], on top (+z) and bottom

    Examples
    --------
    100 N along a strip of 10 mm x 2 mm are 5 MPa:

    >>> nodes = np.array([[0.0, 0.0, 0.0], [20.0, 0.0, 0.0], [20.0, 10.0, 0.0], [0.0, 10.0, 0.0]])
    >>> force = np.zeros((4, 1, 6))
    >>> force[:, 0, 0] = [-50.0, 50.0, 50.0, -50.0]
    >>> element_stress(nodes, 2.0, force)[:, :, 0].tolist()
    [[5.0, 0.0, 0.0], [5.0, 0.0, 0.0]]
    """
    frame, t = element_frames(nodes, corners), thickness
    x, y = frame.xy.T[:, :, None]
    fx, fy, fz = np.moveaxis(force[..., :3].astype(np.float64) @ frame.axes.T, -1, 0)
    mx, my = np.moveaxis(force[..., 3:].astype(np.float64) @ frame.axes[:2].T, -1, 0)
    N_xx = (fx * x).sum(axis=0)
    N_yy = (fy * y).sum(axis=0)
    N_xy = (fx * y + fy * x).sum(axis=0) / 2.0
    M_xx = (my * x - fz * x**2 / 2.0).sum(axis=0)
    M_yy = (-mx * y - fz * y**2 / 2.0).sum(axis=0)
    M_xy = (my * y - mx * x - fz * x * y).sum(axis=0) / 2.0
    N, M = np.stack([N_xx, N_yy, N_xy]) / frame.area, np.stack([M_xx, M_yy, M_xy]) / frame.area
    return np.stack([N / t + 6.0 * M / t**2, N / t - 6.0 * M / t**2])


def _unit(vectors: Floats) -> Floats:
    """Vectors (..., 3) of length 1; NaN of a zero one."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(np.divide(vectors, length, out=np.full_like(vectors, np.nan), where=length > 0.0))
