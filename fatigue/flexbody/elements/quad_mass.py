"""Consistent mass of a four-node shell: the bilinear field of the stiffness moves the mass too."""

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.elements.bilinear import GAUSS, jacobians, shape
from fatigue.flexbody.elements.section import Section

Floats = NDArray[np.float64]


def quad_mass(corners: Floats, section: Section) -> Floats:
    """Mass m_e (e, 4, 4) [t] between the nodes of elements with corners (e, 4, 3): integral of N' (rho t + nsm) N.

    It acts alike in all three displacements, and times t_b^2/12 on the rotations. Total mass, centre and inertia of a
    rigid motion are those of the surface exactly.
    """
    j = jacobians(corners)
    N = np.stack([shape(*at)[0] for at in GAUSS])
    return np.asarray(section.area_mass[:, None, None] * np.einsum("eg,gi,gj->eij", j, N, N))
