"""Craig-Bampton: constraint modes of the masters and modes of the body between them."""

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.condensation.fixed_interface import fixed_interface_modes
from fatigue.flexbody.condensation.guyan import guyan
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]


def craig_bampton(
    structure: Structure, masters: NDArray[np.bool_], upto_hz: float | None = None, count: int | None = None
) -> Floats:
    """T (n, m + k), ``x = [I 0; Psi Phi_s] [x_m; eta]``: constraint modes Psi first, then fixed-interface modes Phi_s.

    Parameters
    ----------
    masters : (n,) the rows that meet the surroundings; a *strong* interface node is a master, a *weak* one is none
    upto_hz, count : fixed-interface modes up to a frequency, 1.5 to 2 times the highest that is wanted, or so many;
        with neither all of them, and the reduced body is the full one

    Exact for static loads on masters, whatever the cut.

    Source: Craig and Bampton, AIAA Journal 6 (1968) 1313.
    """
    _, Phi = fixed_interface_modes(structure, masters, upto_hz, count)
    return np.hstack([guyan(structure, masters), Phi])
