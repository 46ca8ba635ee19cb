"""Local flexibility of a modal basis at loaded points, and how many independent directions its interface modes span.

A basis of few modes is stiffer than the body by what it leaves out, and most so close to a load. The flexibility
index of a direction is what the modes alone give under a unit force there, held against a static solution. Each mode
adds something, so the index only grows with the basis; with residual (attachment) modes it is that of the body.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

NOT_MOVED = 1e-6  # of the motion of a direction by all modes: round-off of a file with six digits
INDEPENDENT = 1e-4  # of the largest singular value: hundred times that round-off


def flexibility_of_modes(shape: Floats, modal_mass: Floats, frequency: Floats) -> Floats:
    """What each mode adds to the flexibility index of each direction, c_ji = phi_ji^2 / (m_i w_i^2).

    Parameters
    ----------
    shape : (d, m) displacement [mm] or rotation [rad] of each direction per unit modal coordinate
    modal_mass : (m,) modal mass, in t mm2 per unit modal coordinate squared
    frequency : (m,) natural frequency [Hz], above 0: a rigid mode has no flexibility

    Returns
    -------
    (d, m) [mm/N] of a displacement under a force, [1/(N mm)] of a rotation under a moment
    """
    w = 2.0 * np.pi * frequency
    return np.asarray(shape**2 / (modal_mass * w**2))


def flexibility_index(shape: Floats, modal_mass: Floats, frequency: Floats) -> Floats:
    """Flexibility index of each direction (d,), c_j = sum_i phi_ji^2 / (m_i w_i^2), as of ``flexibility_of_modes``.

    It is the static displacement under a unit force, less the rigid motion. By Rayleigh and Ritz it never exceeds the
    inertia-relief solution of the body (Craig and Chang 1977).

    >>> float(flexibility_index(np.array([[2.0]]), np.array([1.0]), np.array([1.0 / np.pi])).round(6)[0])
    1.0
    """
    return np.asarray(flexibility_of_modes(shape, modal_mass, frequency).sum(axis=1))


@dataclass(frozen=True, slots=True, eq=False)
class Spanned:
    """How many independent directions some modes span.

    ``rank`` is their number, ``not_moved`` (d,) marks directions that no mode moves, ``lost`` (l, d) are unit vectors,
    one for each combination of the moved directions that the modes cannot follow.
    """

    rank: int
    not_moved: NDArray[np.bool_]
    lost: Floats


def spanned(shape: Floats, of_all: Floats) -> Spanned:
    """Independent directions that some modes span.

    Parameters
    ----------
    shape : (d, k) each direction per unit coordinate of these modes, each over w_i sqrt(m_i), so that its square is
        flexibility and the normalisation of a mode says nothing
    of_all : (d,) the root of the sum of squares of the same over all modes, which makes directions of displacement and
        rotation comparable
    """
    size = np.linalg.norm(shape, axis=1)
    not_moved = size <= NOT_MOVED * of_all
    moved = np.flatnonzero(~not_moved)
    if not moved.size:
        return Spanned(0, not_moved, np.zeros((0, len(shape))))
    left, value, _ = np.linalg.svd(shape[moved] / size[moved, None], full_matrices=True)
    rank = int(np.count_nonzero(value > INDEPENDENT * value[0]))
    lost = np.zeros((len(moved) - rank, len(shape)))
    lost[:, moved] = left[:, rank:].T
    return Spanned(rank, not_moved, lost)
