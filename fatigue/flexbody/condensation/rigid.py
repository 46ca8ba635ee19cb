"""Rigid motions of a free body, mass-normalised, and a support that just holds it."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr

from fatigue.flexbody.mass import centre_of_mass, rigid_mass, rigid_motions
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]

NOTHING = 1e-10  # of the largest: what rounding leaves of a motion that a body cannot make


def rigid_modes(structure: Structure) -> Floats:
    """Rigid motions X_r (n, r) with ``X_r' M X_r = I``; r is 6, and less for a body in a plane or on a line."""
    M = structure.M
    centre = centre_of_mass(rigid_mass(M, rigid_motions(structure.xyz, structure.direction)))
    R = rigid_motions(structure.xyz, structure.direction, centre)
    size = np.sqrt(np.diag(rigid_mass(M, R)))
    R = R[:, size > 0.0] / size[size > 0.0]
    value, vector = np.linalg.eigh(rigid_mass(M, R))
    able = value > NOTHING * value[-1]
    return np.asarray(R @ (vector[:, able] / np.sqrt(value[able])))


def determinate_support(structure: Structure, rigid: Floats) -> NDArray[np.int64]:
    """Rows (r,) that hold a body against its rigid motions (n, r) and against nothing else.

    Pivots of a QR decomposition: each row is the one that the motions left over move most. A rotation counts as what it
    moves at a thousandth of the size of the body, so that it is held only where displacements do not suffice.
    """
    extent = float(np.ptp(structure.xyz, axis=0).max())
    lever = np.where(structure.direction < 3, 1.0, 1e-3 * extent if extent > 0.0 else 1.0)
    _, _, order = qr((lever[:, None] * rigid).T, mode="economic", pivoting=True)
    return np.asarray(order[: rigid.shape[1]], dtype=np.int64)


def without_rigid(structure: Structure, rigid: Floats, shapes: Floats) -> Floats:
    """Shapes (n, k) less their rigid motion, ``P' X = X - X_r X_r' M X``: orthogonal to it by mass."""
    return np.asarray(shapes - rigid @ (rigid.T @ (structure.M @ shapes)))
