"""Static condensation: slaves follow the masters as if nothing had mass."""

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.factor import Factor, factored
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]


def guyan(structure: Structure, masters: NDArray[np.bool_], factor: Factor | None = None) -> Floats:
    """Constraint modes T (n, m), ``x = T x_m`` with ``T = [I; -K_ss^-1 K_sm]``; columns in the order of the rows.

    Each column moves one of the ``masters`` (n,) by 1 and holds the others. Exact for static loads on masters; rigid
    motions and the rigid mass of the body are kept. ``T' K T = K_mm - K_ms K_ss^-1 K_sm`` is what masters feel of the
    whole body, less than K_mm by a positive semi-definite part: a "weakened" stiffness is no more than that.

    ``factor`` is that of the stiffness with the masters held, where the caller has it.

    Raises
    ------
    DataError : the masters do not hold the body; K not symmetric

    Source: Guyan, AIAA Journal 3 (1965) 380.
    """
    to_masters = structure.K[:, np.flatnonzero(masters)].toarray()
    T = -(factored(structure, masters) if factor is None else factor).solve(to_masters)
    T[masters] = np.eye(T.shape[1])
    return T
