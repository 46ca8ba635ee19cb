"""Straight Euler-Bernoulli beams in space with the same bending stiffness in both planes, without transverse shear.

With equal bending stiffness no plane of a beam stands out, so that its direction e alone says where it lies.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def beam_stiffness(start: Floats, end: Floats, EA: ArrayLike, EI: ArrayLike, GJ: ArrayLike) -> Floats:
    """Stiffness (b, 12, 12) of beams in global axes: displacement and rotation of the start, then of the end.

    A beam along e of length L has, with E = e e' and I - E across it, S = [e]_x the matrix of the cross product::

        A = EA/L E + 12 EI/L^3 (I - E)      force of a displacement at one end
        C = -6 EI/L^2 S                     force of a rotation
        D = GJ/L E + 4 EI/L (I - E)         moment of a rotation at the same end
        H = -GJ/L E + 2 EI/L (I - E)        and at the other end

    Parameters
    ----------
    start, end : (b, 3) places of the two nodes, apart
    EA, EI, GJ : (b,) axial stiffness, bending stiffness in both planes, torsional stiffness; consistent units

    Source: Przemieniecki, Theory of Matrix Structural Analysis, 5.6, without shear and with I_y = I_z.
    """
    start, end = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    L = np.linalg.norm(end - start, axis=1)
    e = (end - start) / L[:, None]
    along = e[:, :, None] * e[:, None, :]
    across = np.eye(3) - along
    S = np.cross(e[:, None, :], np.eye(3)[None], axis=2).swapaxes(1, 2)  # column j: e x unit vector j

    def times(factor: ArrayLike, matrix: Floats) -> Floats:
        return np.broadcast_to(factor, L.shape)[:, None, None] * matrix

    EA, EI, GJ = np.asarray(EA), np.asarray(EI), np.asarray(GJ)
    A = times(EA / L, along) + times(12.0 * EI / L**3, across)
    C = times(-6.0 * EI / L**2, S)
    D = times(GJ / L, along) + times(4.0 * EI / L, across)
    H = times(-GJ / L, along) + times(2.0 * EI / L, across)
    Ct = C.swapaxes(1, 2)
    return np.asarray(np.block([[A, C, -A, C], [Ct, D, -Ct, H], [-A, -C, A, -C], [Ct, H, -Ct, D]]))
