"""What is asked of an analysis graph: over which speeds and conicities, and along which lines roots are followed."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.vehicle.critical import CONICITIES, SPEEDS_KM_H
from fatigue.vehicle.definition import Vehicle

Floats = NDArray[np.float64]

POINTS = 60  # of a range without step: conicities at even ratios
SPEED_STEPS = 40  # between the ends of the speeds
ALSO_CONICITIES = (0.03, 0.06, 0.1, 0.3, 0.5, 0.7)  # beside that of the contact
ALSO_SPEEDS = (350.0, 380.0, 420.0)  # km/h, beside that of the run


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """Grid of the stability map: ``speeds`` (k,) [km/h] and ``conicities`` (m,), both ascending.

    Roots are followed over conicity at each speed of ``at_speeds`` and over speed at each of ``at_conicities``, beside
    those of the vehicle itself.
    """

    speeds: Floats
    conicities: Floats
    at_speeds: tuple[float, ...] = ALSO_SPEEDS
    at_conicities: tuple[float, ...] = ALSO_CONICITIES

    def lines_over_conicity(self, vehicle: Vehicle) -> tuple[float, ...]:
        """Speeds [km/h] at which roots are followed over conicity: that of the run, then the others."""
        return _first(vehicle.run.speed_km_h, self.at_speeds)

    def lines_over_speed(self, vehicle: Vehicle) -> tuple[float, ...]:
        """Conicities at which roots are followed over speed: that of the contact, then the others."""
        return _first(vehicle.contact.conicity, self.at_conicities)


def default_speeds() -> Floats:
    """Speeds (41,) [km/h] of the map where none are asked for."""
    return np.linspace(*SPEEDS_KM_H, SPEED_STEPS + 1)


def default_conicities() -> Floats:
    """Conicities (60,) of the map where none are asked for."""
    return np.geomspace(*CONICITIES, POINTS)


def _first(own: float, others: tuple[float, ...]) -> tuple[float, ...]:
    return (own, *sorted({other for other in others if other != own}))
