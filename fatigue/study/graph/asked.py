"""What is asked of an analysis graph: over which speeds and conicities, and along which lines roots are followed."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.vehicle.critical import CONICITIES, SPEEDS_KM_H
from fatigue.vehicle.definition import Vehicle

Floats = NDArray[np.float64]

POINTS = 60  # of a range without step: conicities at even ratios
STEP_KM_H = 10.0
ALSO_CONICITIES = (0.03, 0.06, 0.1, 0.3, 0.5, 0.7)  # beside that of the contact
ALSO_SPEEDS = (350.0, 380.0, 420.0)  # km/h, beside that of the run


def speeds_of(given: Sequence[float] = SPEEDS_KM_H) -> Floats:
    """Speeds [km/h] as given; of two ends a step of 10 km/h or somewhat less.

    >>> speeds_of((60.0, 85.0)).tolist()
    [60.0, 68.33333333333333, 76.66666666666667, 85.0]
    """
    if len(given) != 2:
        return np.array(given, dtype=np.float64)
    return np.linspace(given[0], given[1], max(2, math.ceil((given[1] - given[0]) / STEP_KM_H) + 1))


def conicities_of(given: Sequence[float] = CONICITIES) -> Floats:
    """Conicities as given; of two ends 60 at even ratios.

    >>> conicities_of((0.01, 1.2)).shape
    (60,)
    """
    if len(given) != 2:
        return np.array(given, dtype=np.float64)
    return np.asarray(np.geomspace(given[0], given[1], POINTS))


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """Grid of the stability map: ``speeds`` (k,) [km/h] and ``conicities`` (m,), both ascending.

    Roots are followed over conicity at each speed of ``at_speeds`` and over speed at each of ``at_conicities``, beside
    those of the vehicle itself.
    """

    speeds: Floats = field(default_factory=speeds_of)
    conicities: Floats = field(default_factory=conicities_of)
    at_speeds: tuple[float, ...] = ALSO_SPEEDS
    at_conicities: tuple[float, ...] = ALSO_CONICITIES

    def problems(self) -> Iterator[Problem]:
        """Refusals of speeds and conicities that make no grid."""
        for where, values, highest in (("speeds", self.speeds, 1000.0), ("conicities", self.conicities, 2.0)):
            if values.size < 2 or not (np.diff(values) > 0.0).all():
                what = f"{values.size} value{'s' * (values.size != 1)} that ascend are no range"
                yield Problem("argument", where, what, "Give two or more, the smallest first")
            elif not (values[0] > 0.0 and values[-1] <= highest):
                what = f"{values[0]:g} to {values[-1]:g} is not above 0 and up to {highest:g}"
                yield Problem("argument", where, what, "Give values within")

    def lines_over_conicity(self, vehicle: Vehicle) -> tuple[float, ...]:
        """Speeds [km/h] at which roots are followed over conicity: that of the run, then the others."""
        return _first(vehicle.run.speed_km_h, self.at_speeds)

    def lines_over_speed(self, vehicle: Vehicle) -> tuple[float, ...]:
        """Conicities at which roots are followed over speed: that of the contact, then the others."""
        return _first(vehicle.contact.conicity, self.at_conicities)


def _first(own: float, others: tuple[float, ...]) -> tuple[float, ...]:
    return (own, *sorted({other for other in others if other != own}))
