"""Dynamic condensation: slaves follow the masters as they do at one frequency."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import SuperLU

from fatigue.errors import NumericalError, Problem
from fatigue.flexbody.condensation.factored import factored
from fatigue.flexbody.condensation.guyan import followed
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]

PIVOT = 0.1  # D is indefinite above the first fixed-interface mode
TOO_NEAR = 1e-6  # relative distance to a fixed-interface mode: shapes grow by its inverse and lose as many digits
STEPS = 30  # of inverse iteration: only a mode that is as near as that has to be found


def kuhar(structure: Structure, masters: NDArray[np.bool_], at_hz: float) -> Floats:
    """T (n, m), ``x = T x_m`` with ``T = [I; -D_ss^-1 D_sm]``, ``D = K - p^2 M`` at the frequency p.

    Exact for harmonic loads on the ``masters`` (n,) at ``at_hz``, and for modes near it; at 0 it is that of Guyan.
    Rigid motions are not kept: they follow p as well.

    Raises
    ------
    NumericalError : p is the frequency of a fixed-interface mode, where ``det D_ss = 0``

    Source: Kuhar and Stahle, AIAA Journal 12 (1974) 672.
    """
    w2 = (2.0 * np.pi * at_hz) ** 2
    D, slaves = sparse.csc_array(structure.K - w2 * structure.M), ~masters
    try:
        factors = factored(D[slaves][:, slaves], PIVOT)
    except NumericalError as error:
        raise _at_a_mode(at_hz) from error
    distance = _nearest(factors, structure.M[slaves][:, slaves])  # w_s^2 - p^2
    if abs(distance) < 2.0 * TOO_NEAR * w2:
        raise _at_a_mode(at_hz)
    return followed(factors, D, masters)


def _nearest(factors: SuperLU, M_ss: sparse.csc_array) -> float:
    """Distance ``w_s^2 - p^2`` [1/s^2] of the fixed-interface mode nearest to p, by inverse iteration."""
    x = np.random.default_rng(0).standard_normal(M_ss.shape[0])
    distance = np.inf
    for _ in range(STEPS):
        x = factors.solve(M_ss @ x)
        mass = float(x @ (M_ss @ x))
        if not mass > 0.0:
            break
        before = x / np.sqrt(mass)
        x = before
        distance = 1.0 / float(x @ (M_ss @ factors.solve(M_ss @ x)))
    return distance


def _at_a_mode(at_hz: float) -> NumericalError:
    return NumericalError(
        Problem(
            "at_a_fixed_interface_mode",
            "dynamic condensation",
            f"the body has a mode at {at_hz:.6g} Hz while its masters are held, and no master then moves the others",
            "take another frequency, or another choice of masters",
        )
    )
