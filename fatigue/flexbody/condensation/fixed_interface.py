"""Modes of a body whose masters are held: what Craig-Bampton adds to constraint modes, what effective mass is of."""

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.condensation.factored import factored
from fatigue.flexbody.condensation.lowest import DENSE, all_modes, lowest, wanted_of
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]


def fixed_interface_modes(
    structure: Structure, masters: NDArray[np.bool_], upto_hz: float | None = None, count: int | None = None
) -> tuple[Floats, Floats]:
    """Frequencies (k,) [Hz], ascending, and shapes (n, k) with unit modal mass, the ``masters`` (n,) held.

    ``K_ss phi = w^2 M_ss phi``; shapes are 0 on masters. All modes up to a frequency, or so many; with neither, all
    there are, which takes a dense matrix.
    """
    slaves = ~masters
    K, M = structure.K[slaves][:, slaves], structure.M[slaves][:, slaves]
    if K.shape[0] <= DENSE or (upto_hz is None and (count is None or 2 * count > K.shape[0])):
        frequency, modes = wanted_of(*all_modes(K.toarray(), M.toarray()), upto_hz, count)
    else:
        frequency, modes = lowest(K, M, factored(K).solve, upto_hz, count)
    shapes = np.zeros((len(masters), len(frequency)))
    shapes[slaves] = modes
    return frequency, shapes
