"""Mean stress of a shell element from the forces at its corners, by virtual work.

A field of constant strain does the same work on the corner forces as on the stress resultants: the mean of N and M over
the element follows from the forces alone, exactly for every element that passes the patch test, whatever its shape.
Moments about the normal do no work in a symmetric strain field. They do not enter, and fx, fy need not be in balance
of moments without them.

Sources: measured_data.md 1.2; Bergan and Hanssen (1976) for the individual element test.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

TOP, BOTTOM = 0, 1


@dataclass(frozen=True, slots=True, eq=False)
class ElementFrame:
    """The mean plane of an element, as an FE program orients it.

    Attributes
    ----------
    axes : (3, 3) unit vectors x, y, z as rows: x from corner 1 to 2, z by the right hand over the corners
    centre : (3,) mean of the corners [mm]
    xy : (n, 2) corners in the plane, about the centre [mm]
    area : in the plane [mm2]
    warp : largest distance of a corner from the plane [mm]
    """

    axes: Floats
    centre: Floats
    xy: Floats
    area: float
    warp: float


def element_frame(corners: Floats) -> ElementFrame | None:
    """Frame of an element with corners (n, 3) [mm], three or four; None of one without area.

    A warped quadrilateral has its mean plane: that of its two diagonals.

    >>> element_frame(np.array([[0.0, 0.0, 0.0], [20.0, 0.0, 0.0], [20.0, 10.0, 0.0], [0.0, 10.0, 0.0]])).area
    200.0
    """
    first, second, third, last = corners[0], corners[1], corners[2], corners[-1]
    z = np.cross(third - first, last - second) if len(corners) == 4 else np.cross(second - first, third - first)
    size = np.linalg.norm(z)
    along = second - first
    if not size > 1e-12 * np.ptp(corners, axis=0).max() ** 2:
        return None
    z = z / size
    x = along - (along @ z) * z
    if not np.linalg.norm(x) > 0.0:
        return None
    x /= np.linalg.norm(x)
    axes = np.stack([x, np.cross(z, x), z])
    centre = corners.mean(axis=0)
    local = (corners - centre) @ axes.T
    return ElementFrame(axes, centre, local[:, :2], float(size / 2.0), float(np.abs(local[:, 2]).max()))


def element_stress(frame: ElementFrame, thickness: float, force: Floats) -> Floats:
    """Mean stress of an element on its faces from the forces and moments on its corners.

    Parameters
    ----------
    frame : of the element, n corners
    thickness : of the plate [mm]
    force : (n, c, 6) forces and moments on the element at its corners, of each of c coordinates [N, N mm], global axes

    Returns
    -------
    (2, 3, c) s_xx, s_yy, s_xy in the axes of the element [MPa], on top (+z) and bottom

    Examples
    --------
    100 N along a strip of 10 mm x 2 mm are 5 MPa:

    >>> frame = element_frame(np.array([[0.0, 0, 0], [20, 0, 0], [20, 10, 0], [0, 10, 0]]))
    >>> force = np.zeros((4, 1, 6))
    >>> force[:, 0, 0] = [-50.0, 50.0, 50.0, -50.0]
    >>> element_stress(frame, 2.0, force)[:, :, 0].tolist()
    [[5.0, 0.0, 0.0], [5.0, 0.0, 0.0]]
    """
    x, y = frame.xy.T[:, :, None]
    fx, fy, fz = np.moveaxis(force[..., :3] @ frame.axes.T, -1, 0)
    mx, my = np.moveaxis(force[..., 3:] @ frame.axes[:2].T, -1, 0)
    N = np.stack([(fx * x).sum(axis=0), (fy * y).sum(axis=0), (fx * y + fy * x).sum(axis=0) / 2.0]) / frame.area
    M_xx = (my * x - fz * x**2 / 2.0).sum(axis=0)
    M_yy = (-mx * y - fz * y**2 / 2.0).sum(axis=0)
    M_xy = (my * y - mx * x - fz * x * y).sum(axis=0) / 2.0
    M = np.stack([M_xx, M_yy, M_xy]) / frame.area
    t = thickness
    return np.stack([N / t + 6.0 * M / t**2, N / t - 6.0 * M / t**2])
