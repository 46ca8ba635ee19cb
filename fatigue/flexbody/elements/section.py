"""What a shell is made of: thickness, elasticity, mass."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

DRILLING = 1e-3  # penalty stiffness per area, in units of G t
SHEAR = 5.0 / 6.0  # share of the thickness that carries transverse shear, Reissner


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """Section of each of some elements, arrays (e,), in N, mm, t.

    ``thickness`` carries membrane and drilling, ``bending_thickness`` bending and transverse shear; ``rho`` is mass per
    volume, ``nsm`` further mass per area.
    """

    thickness: Floats
    bending_thickness: Floats
    E: Floats
    nu: Floats
    rho: Floats
    nsm: Floats

    @property
    def t(self) -> Floats:
        """Thickness of the membrane (e, 1, 1)."""
        return self.thickness[:, None, None]

    @property
    def shear_modulus(self) -> Floats:
        """Shear modulus G (e,)."""
        return np.asarray(self.E / (2 * (1 + self.nu)))

    @property
    def plane_stress(self) -> Floats:
        """Elasticity of plane stress D (e, 3, 3)."""
        one, none = np.ones_like(self.nu), np.zeros_like(self.nu)
        rows = [[one, self.nu, none], [self.nu, one, none], [none, none, (1 - self.nu) / 2]]
        return np.asarray((self.E / (1 - self.nu**2))[:, None, None] * np.moveaxis(np.array(rows), 2, 0))

    @property
    def bending(self) -> Floats:
        """Second moment per width, t_b^3/12 (e, 1, 1)."""
        return np.asarray(self.bending_thickness**3 / 12)[:, None, None]

    @property
    def transverse_shear(self) -> Floats:
        """Stiffness against transverse shear per width, 5/6 G t_b (e, 1, 1)."""
        return np.asarray(SHEAR * self.shear_modulus * self.bending_thickness)[:, None, None]

    @property
    def drilling(self) -> Floats:
        """Penalty on the drilling rotation per area (e, 1, 1)."""
        return np.asarray(DRILLING * self.shear_modulus * self.thickness)[:, None, None]

    @property
    def area_mass(self) -> Floats:
        """Mass per area, rho t + nsm (e,)."""
        return np.asarray(self.rho * self.thickness + self.nsm)

    @property
    def rotary(self) -> Floats:
        """Rotary inertia per mass, t_b^2/12 (e,) [mm2]."""
        return np.asarray(self.bending_thickness**2 / 12)

    def of(self, which: NDArray[np.integer] | NDArray[np.bool_] | slice) -> "Section":
        """Section of some of the elements."""
        return Section(*(getattr(self, name)[which] for name in self.__slots__))
