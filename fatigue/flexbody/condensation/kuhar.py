"""Dynamic condensation: slaves follow the masters as they do at one frequency."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from fatigue.errors import NumericalError, Problem
from fatigue.flexbody.factor import refuse_unsymmetric
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]

TOO_NEAR = 1e-6  # relative distance to a fixed-interface mode: shapes grow by its inverse and lose as many digits
STEPS = 6  # of inverse iteration: a mode as near as that stands out of all others after two or three
INEXACT = 1e-12  # of |D_ss| |T_s|, what may be left of D_sm + D_ss T_s: ten thousand times rounding


def kuhar(structure: Structure, masters: NDArray[np.bool_], at_hz: float) -> Floats:
    """T (n, m), ``x = T x_m`` with ``T = [I; -D_ss^-1 D_sm]``, ``D = K - p^2 M`` at the frequency p.

    Exact for harmonic loads on the ``masters`` (n,) at ``at_hz``, and for a mode there; at 0 it is that of Guyan. Rigid
    motions of masters move the slaves as p says, not rigidly: the columns alone do not contain them.

    Raises
    ------
    DataError : K or M not symmetric
    NumericalError : the body has a mode at p while its masters are held, ``det D_ss = 0``

    Source: Kuhar and Stahle, AIAA Journal 12 (1974) 672.
    """
    for name, matrix in (("K", structure.K), ("M", structure.M)):
        refuse_unsymmetric(name, matrix, structure)
    p2 = (2.0 * np.pi * at_hz) ** 2
    m, s = np.flatnonzero(masters), np.flatnonzero(~masters)
    D = sparse.csc_array(structure.K - p2 * structure.M)
    T = np.zeros((len(masters), len(m)))
    T[m] = np.eye(len(m))
    if not s.size:
        return T
    D_ss, D_sm, M_ss = sparse.csc_array(D[s][:, s]), D[s][:, m].toarray(), sparse.csc_array(structure.M[s][:, s])
    for pivot_threshold in (0.0, 1.0):  # pivots on the diagonal save fill; D is indefinite and may need others
        try:
            factors = splu(
                D_ss,
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=pivot_threshold,
                options={"SymmetricMode": pivot_threshold == 0.0},
            )
        except RuntimeError as error:  # exactly singular
            raise _at_a_mode(at_hz) from error
        if _to_nearest(factors, M_ss) < 2.0 * TOO_NEAR * p2:  # w^2 - p^2 is about 2 p (w - p)
            raise _at_a_mode(at_hz)
        T_s = -factors.solve(D_sm)
        T_s -= factors.solve(D_sm + D_ss @ T_s)
        if np.abs(D_sm + D_ss @ T_s).max() <= INEXACT * np.abs(D_ss.data).max() * np.abs(T_s).max():
            T[s] = T_s
            return T
    raise _at_a_mode(at_hz)


def _to_nearest(factors: SuperLU, M_ss: sparse.csc_array) -> float:
    """Distance ``|w_s^2 - p^2|`` [1/s^2] of the fixed-interface mode nearest to p, from above, by inverse iteration."""
    x, distance = np.random.default_rng(0).standard_normal(M_ss.shape[0]), np.inf
    for _ in range(STEPS):
        answer = factors.solve(M_ss @ x)
        mass = float(answer @ (M_ss @ answer))
        if not mass > 0.0:  # slaves without mass
            break
        distance = float(np.sqrt(x @ (M_ss @ x) / mass))
        x = answer / np.sqrt(mass)
    return distance


def _at_a_mode(at_hz: float) -> NumericalError:
    what = f"with its interface held, the body has a mode at {at_hz:.6g} Hz: there no motion of the interface is finite"
    remedy = "Take another frequency for the condensation, some per cent away"
    return NumericalError(Problem("at_fixed_interface_mode", "dynamic condensation", what, remedy))
