"""Craig-Bampton: constraint modes of the masters and modes of the body between them."""

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.condensation.guyan import guyan
from fatigue.flexbody.factor import factored
from fatigue.flexbody.modes import held_modes
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]


def craig_bampton(
    structure: Structure, masters: NDArray[np.bool_], *, upto_hz: float | None = None, count: int | None = None
) -> Floats:
    """T (n, m + k), ``x = [I 0; Psi Phi_s] [x_m; eta]``: constraint modes Psi first, then fixed-interface modes Phi_s.

    Exact for static loads on masters, whatever the cut; with all modes the reduced body is the full one.

    Parameters
    ----------
    masters : (n,) the rows that meet the surroundings: six of a *strong* interface node, none of a *weak* one
    upto_hz, count : one of both; fixed-interface modes up to a frequency, 1.5 to 2 times the highest that is wanted,
        or so many

    Raises
    ------
    DataError : the masters do not hold the body; K not symmetric

    Source: Craig and Bampton, AIAA Journal 6 (1968) 1313.
    """
    factor = factored(structure, masters)
    fixed = held_modes(structure, masters, upto_hz=upto_hz, count=count, factor=factor)
    return np.hstack([guyan(structure, masters, factor), fixed.shapes])
