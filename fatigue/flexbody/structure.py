"""A finite element body as matrices, and a basis of few coordinates for it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Structure:
    """K and M (n, n) of a free body, symmetric, in consistent units, and what each row is.

    ``node`` (n,) is its node, ``direction`` (n,) 0, 1, 2 for a displacement along x, y, z and 3, 4, 5 for a rotation
    about them, ``xyz`` (n, 3) the place of the node.
    """

    K: sparse.csc_array
    M: sparse.csc_array
    node: NDArray[np.int64]
    direction: NDArray[np.int64]
    xyz: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Basis:
    """Shapes (n, k) of the rows of a structure with unit modal mass, without rigid motions, and their frequencies.

    ``frequency`` (k,) [Hz] is ascending. ``normal`` (k,) marks shapes that are modes of the body itself; the others
    are there for what enters at the interface and follow it quasi-statically.
    """

    shapes: Floats
    frequency: Floats
    normal: NDArray[np.bool_]
