"""Modal mass: participation factors, effective modal masses, and the dynamic mass that a moving base feels.

A body is held at its boundary and the boundary moves as a rigid body. What its masses then do is carried by the
fixed-interface modes, each with its effective mass; what moves with the boundary alone is left. Free-free elastic modes
are orthogonal to rigid motions: their participation is 0, and an effective mass is not defined for them.

Directions are translations along x, y, z and rotations about them through a point, in this order. Units are consistent:
mass in t and lengths in mm give effective masses in t and t mm2.

Sources: Craig and Bampton 1968; Girard and Roy, effective modal parameters; ECSS-E-HB-32-26, definitions.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

EVENLY = 400  # steps of a frequency axis
FREE = 1e-6  # of the mass of the body: what rounding leaves of the participation of free-free modes


def rigid_motions(xyz: Floats, direction: NDArray[np.integer], about: ArrayLike = (0.0, 0.0, 0.0)) -> Floats:
    """Motion (n, 6) of degrees of freedom under unit rigid motions, R.

    ``u = t + theta x (r - r0)``: columns are t_x, t_y, t_z [mm/mm] and theta_x, theta_y, theta_z [mm/rad], about r0.

    Parameters
    ----------
    xyz : (n, 3) place of each degree of freedom [mm]
    direction : (n,) 0, 1, 2: displacement along x, y, z; 3, 4, 5: rotation about them
    about : the point r0 [mm]

    >>> rigid_motions(np.array([[0.0, 2.0, 0.0]]), np.array([0]))
    array([[ 1.,  0.,  0.,  0.,  0., -2.]])
    """
    x, y, z = (np.asarray(xyz, dtype=np.float64) - np.asarray(about, dtype=np.float64)).T
    zero = np.zeros_like(x)
    turned = np.array([[zero, z, -y], [-z, zero, x], [y, -x, zero]])  # turned[i, j]: along i for a rotation about j
    R = np.zeros((len(x), 6))
    row = np.arange(len(x))
    R[row, direction] = 1.0
    for axis in range(3):
        along = direction == axis
        R[along, 3:] = turned[axis][:, along].T
    return R


def participation(M: sparse.sparray, Phi: Floats, R: Floats) -> Floats:
    """Participation factors L (m, 6) of mode shapes Phi (n, m) for rigid motions R (n, 6) of the boundary.

    ``L = Phi' M Psi_r``. Psi_r is the static answer to a rigid motion of the boundary, which is the rigid motion R.
    """
    return np.asarray(Phi.T @ (M @ R))


def modal_mass_matrix(M: sparse.sparray, Phi: Floats) -> Floats:
    """Mass matrix (m, m) of the modes, ``Phi' M Phi``: modal masses on its diagonal, 0 beside it."""
    return np.asarray(Phi.T @ (M @ Phi))


def rigid_mass(M: sparse.sparray, R: Floats) -> Floats:
    """Mass matrix (6, 6) of the body as a rigid one, ``R' M R``: masses [t], static moments [t mm], inertia [t mm2]."""
    return np.asarray(R.T @ (M @ R))


def centre_of_mass(about_origin: Floats) -> Floats:
    """Centre of mass (3,) [mm] of a body with this rigid mass matrix (6, 6) about the origin.

    >>> M, R = sparse.eye_array(3) * 2.0, rigid_motions(np.tile([1.0, 2.0, 3.0], (3, 1)), np.arange(3))
    >>> centre_of_mass(rigid_mass(M, R)).tolist()
    [1.0, 2.0, 3.0]

    A matrix with mass along one axis alone tells two of the three; the third is 0 then.
    """
    S, mass = about_origin[:3, 3:], np.diag(about_origin)[:3]  # of a point mass m at r: S = m [[0, z, -y], [-z, ...
    moment = np.array([S[1, 2] - S[2, 1], S[2, 0] - S[0, 2], S[0, 1] - S[1, 0]])
    of_both = mass[[1, 2, 0]] + mass[[2, 0, 1]]
    return np.asarray(np.divide(moment, of_both, out=np.zeros(3), where=of_both > 0.0))


def boundary_mass(M: sparse.sparray, R: Floats, held: NDArray[np.bool_]) -> Floats:
    """What of the rigid masses (6,) no fixed-interface mode can carry: ``diag R_m' (M_mm - M_ms M_ss^-1 M_sm) R_m``.

    With a lumped mass matrix this is the mass on the boundary, m the degrees of freedom that are ``held`` (n,).
    Degrees of freedom without mass carry nothing.
    """
    M = sparse.csc_array(M)
    free = ~held & (abs(M).sum(axis=0) > 0.0)
    of_boundary = M[held][:, held] @ R[held]
    M_sm_R = M[free][:, held] @ R[held]
    if free.any() and np.any(M_sm_R):
        of_boundary = of_boundary - M[held][:, free] @ splu(sparse.csc_array(M[free][:, free])).solve(M_sm_R)
    return np.asarray(np.einsum("ij,ij->j", R[held], of_boundary))


def effective_mass(L: Floats, modal_mass: Floats) -> Floats:
    """Effective modal masses (m, d), ``L_ij^2 / m_i``, of participation factors (m, d) and modal masses (m,).

    L and the modal mass have to belong to the same shape of a mode; then neither its scale nor its sign counts.

    >>> effective_mass(np.array([[3.0]]), np.array([0.5])).tolist()
    [[18.0]]
    """
    return np.asarray(L**2 / modal_mass[:, None])


def summed_up_to(frequency: Floats, effective: Floats, band_hz: float) -> Floats:
    """Effective masses (d,) of the modes up to a frequency, summed; ``frequency`` (m,) [Hz], ``effective`` (m, d)."""
    return np.asarray(effective[frequency <= band_hz].sum(axis=0))


def elastic_mass(f: Floats, frequency: Floats, damping_ratio: Floats, effective: Floats) -> Complex:
    """Elastic dynamic mass m_e (n, d) at the frequencies f (n,) [Hz] of a moving base.

    ``m_e = sum_i m_eff,i r^2 / (1 - r^2 + 2 i z r)``, r = f / f_i. Near a mode that stands alone ``|m_e|`` is
    ``m_eff / (2 z)``; far below it m_eff r^2.

    Parameters
    ----------
    frequency, damping_ratio : (m,) natural frequency [Hz], above 0, and damping ratio [-]
    effective : (m, d) effective masses

    >>> at_resonance = elastic_mass(np.array([11.66]), np.array([11.66]), np.array([0.015]), np.array([[17.974]]))
    >>> round(float(abs(at_resonance[0, 0])), 3)  # t
    599.133
    """
    r = f[:, None] / frequency
    return np.asarray((r**2 / (1.0 - r**2 + 2j * damping_ratio * r)) @ effective)


def dynamic_mass(f: Floats, frequency: Floats, damping_ratio: Floats, effective: Floats, rigid: Floats) -> Complex:
    """Force over acceleration of a moving base (n, d): ``M_rigid + m_e``; arguments as of ``elastic_mass``.

    ``rigid`` (d,) is the mass of the whole body: what the base feels at 0 Hz.
    """
    return rigid + elastic_mass(f, frequency, damping_ratio, effective)


def frequencies_to_look_at(frequency: Floats, damping_ratio: Floats, upto_hz: float) -> Floats:
    """Frequencies [Hz] from 0 to ``upto_hz``, evenly, and around each mode within its width."""
    across = np.array([-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0])  # of the half width z f
    around = frequency[:, None] * (1.0 + np.maximum(damping_ratio, 1e-4)[:, None] * across)
    near = around[(around > 0.0) & (around <= upto_hz)]
    return np.unique(np.concatenate([np.linspace(0.0, upto_hz, EVENLY + 1), near]))
