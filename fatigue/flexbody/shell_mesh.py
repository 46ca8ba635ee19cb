"""The shell mesh of a body: nodes, three- and four-node elements, what they are made of."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

NONE = -1
"""Fourth corner of a triangle."""


@dataclass(frozen=True, slots=True, eq=False)
class ShellMesh:
    """Nodes and elements of a shell body in N, mm, t; every node belongs to an element.

    ``node`` (n,) and ``element`` (e,) are ids, ascending, ``xyz`` (n, 3) places [mm]. ``corners`` (e, 4) are indices of
    nodes around the element, ``NONE`` in the last place of a triangle. Arrays (e,): ``thickness`` carries membrane
    and drilling, ``bending_thickness`` bending and transverse shear [mm]; ``E`` [MPa], ``nu``, ``rho`` [t/mm3], and
    ``nsm``, further mass per area [t/mm2].
    """

    node: Integers
    xyz: Floats
    element: Integers
    corners: Integers
    thickness: Floats
    bending_thickness: Floats
    E: Floats
    nu: Floats
    rho: Floats
    nsm: Floats

    @property
    def is_triangle(self) -> NDArray[np.bool_]:
        """Which elements have three corners (e,)."""
        return np.asarray(self.corners[:, 3] == NONE)
