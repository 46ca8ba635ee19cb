"""Rows of the tables of modal mass; their fields are the columns of ``fatigue.results.dictionary.basis``."""

from dataclasses import dataclass

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")


def unit_of(direction: str) -> str:
    """Unit of a mass: ``t``, or ``t mm2`` about an axis."""
    return "t mm2" if direction.startswith("r") else "t"


@dataclass(frozen=True, slots=True)
class MassSum:
    """What the modes carry in one direction; see the columns of ``mass_sum``."""

    direction: str
    unit: str
    body_mass: float
    boundary_mass: float
    summed_mass: float
    band_hz: float
    mass_in_band: float
    share_in_band: float
    missing_share: float
    enough: bool | None
    carried_by: str
    reason: str


@dataclass(frozen=True, slots=True)
class ModalMass:
    """Effective mass of one mode in one direction; see the columns of ``modal_mass``."""

    mode: int
    frequency_hz: float
    kind: str
    direction: str
    participation: float
    effective_mass: float
    share: float
    summed_share: float


@dataclass(frozen=True, slots=True)
class DynamicMass:
    """Dynamic mass at one frequency in one direction; see the columns of ``dynamic_mass``."""

    frequency_hz: float
    direction: str
    dynamic_mass: float
    phase_deg: float
    elastic_mass: float
