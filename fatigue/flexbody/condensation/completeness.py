"""What a reduced body carries of the full one: flexibility where loads enter, mass that a moving interface feels."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fatigue.flexbody.factor import FreeBody
from fatigue.flexbody.flexibility import flexibility_index
from fatigue.flexbody.mass import boundary_mass, effective_mass, participation, rigid_mass, rigid_motions, summed_up_to
from fatigue.flexbody.structure import Basis, Structure

Floats = NDArray[np.float64]


def flexibility_ratio(body: FreeBody, basis: Basis, loads: Floats) -> Floats:
    """Flexibility that the basis has under each load over that of the body (c,): 1 is complete, 0 is blind.

    ``sum_i (F_j' phi_i)^2 / w_i^2`` over ``F_j' X_a``, X_a the inertia-relief answer to the columns F (n, c). By
    Rayleigh and Ritz it never exceeds 1, and grows with the basis.

    Source: Craig and Chang 1977.
    """
    of_body = np.einsum("ij,ij->j", loads, body.elastic(loads))
    of_basis = flexibility_index(loads.T @ basis.shapes, np.ones(len(basis.frequency)), basis.frequency)
    return np.asarray(of_basis / of_body)


@dataclass(frozen=True, slots=True, eq=False)
class EffectiveMass:
    """How the mass of a body is carried when its interface is held: by modes, and by what sits on the interface.

    ``frequency`` (k,) [Hz] and ``effective`` (k, 6) of the fixed-interface modes, ``boundary`` (6,), ``total`` (6,): of
    rigid motions of the interface, translations along x, y, z and rotations about them.
    """

    frequency: Floats
    effective: Floats
    boundary: Floats
    total: Floats

    def share(self, upto_hz: float) -> Floats:
        """Share (6,) of the body that modes up to a frequency carry; with the boundary, 90 % is a rule of thumb."""
        return summed_up_to(self.frequency, self.effective, upto_hz) / self.total


def effective_masses(
    structure: Structure, masters: NDArray[np.bool_], fixed: Basis, about: ArrayLike = (0.0, 0.0, 0.0)
) -> EffectiveMass:
    """Effective masses of the modes ``fixed`` that a body has with its ``masters`` (n,) held.

    All modes and the boundary together are the body: ``sum_i L_i^2 / m_i + R_m' (M_mm - M_ms M_ss^-1 M_sm) R_m`` is
    ``R' M R``. ``about`` is the point of the rotations.

    Source: Girard and Roy, effective modal parameters; ECSS-E-HB-32-26.
    """
    R = rigid_motions(structure.xyz, structure.direction, about)
    effective = effective_mass(participation(structure.M, fixed.shapes, R), np.ones(len(fixed.frequency)))
    on_boundary = boundary_mass(structure.M, R, masters)
    return EffectiveMass(fixed.frequency, effective, on_boundary, np.diag(rigid_mass(structure.M, R)).copy())
