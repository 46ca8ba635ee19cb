"""Consistent unit systems of foreign files, and the factors that turn their numbers into N, mm, t, s."""

from dataclasses import dataclass
from typing import Literal

from fatigue.errors import CaseError, Problem

Normalisation = Literal["mass", "length"]
"""What a modal coordinate of 1 means: modes of unit generalised mass, or modes of unit displacement."""


@dataclass(frozen=True, slots=True)
class UnitSystem:
    """A consistent unit system with seconds: its units of length and mass in mm and t."""

    length: float
    mass: float

    @property
    def force(self) -> float:
        """Unit of force in N (t mm/s^2)."""
        return self.mass * self.length

    def modal_coordinate(self, normalisation: Normalisation) -> float:
        """Unit of the modal coordinate: in sqrt(t) mm for modes of unit mass, in mm for modes of unit displacement.

        A displacement is mode shape times coordinate, so mode shapes of unit generalised mass are in 1/sqrt(mass).
        """
        return self.length * (self.mass**0.5 if normalisation == "mass" else 1.0)


SYSTEMS = {
    "mm-t-s": UnitSystem(1.0, 1.0),
    "m-kg-s": UnitSystem(1000.0, 1e-3),
    "in-lbf-s": UnitSystem(25.4, 0.45359237e-3 * 9.80665 / 0.0254),
}


def unit_system(name: str, where: str) -> UnitSystem:
    """Unit system of this name.

    Raises
    ------
    CaseError : unknown name
    """
    if name not in SYSTEMS:
        raise CaseError(
            Problem("unknown_units", where, f"unknown unit system {name!r}", f"Name one of {', '.join(SYSTEMS)}")
        )
    return SYSTEMS[name]
