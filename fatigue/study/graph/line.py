"""One line of an analysis graph: roots over conicity at a speed, or over speed at a conicity, and where it turns."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.vehicle.assembly import SuspendedVehicle
from fatigue.vehicle.critical import POINTS, Crossing, conicity_crossings, speed_crossings, stable_ranges
from fatigue.vehicle.roots import largest_real_part
from fatigue.vehicle.stability.loci import Locus, loci_over_conicity, loci_over_speed

Floats = NDArray[np.float64]
Along: TypeAlias = Literal["conicity", "speed"]

UPTO_HZ = 25.0  # roots above are not followed


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """Roots along conicity or speed.

    Attributes
    ----------
    along : what grows along the line
    at : what stays, the speed [km/h] or the conicity
    places : (n,) ascending
    loci : every root that was followed
    crossings : where the vehicle gains or loses stability, found to seven digits
    stable : ranges without an unstable root
    """

    along: Along
    at: float
    places: Floats
    loci: tuple[Locus, ...]
    crossings: tuple[Crossing, ...]
    stable: tuple[tuple[float, float], ...]

    def point(self, place: int) -> tuple[float, float]:
        """Speed [km/h] and conicity at a place of the line."""
        return self.point_at(float(self.places[place]))

    def point_at(self, value: float) -> tuple[float, float]:
        """Speed [km/h] and conicity where what grows has a value."""
        return (self.at, value) if self.along == "conicity" else (value, self.at)

    @property
    def ends(self) -> tuple[float, float]:
        """What was looked at, from and to."""
        return float(self.places[0]), float(self.places[-1])


def conicity_line(of: SuspendedVehicle, speed_km_h: float, conicities: Floats) -> Line:
    """Line over conicities (n,) at a speed [km/h]."""
    ends = (float(conicities[0]), float(conicities[-1]))
    crossed = conicity_crossings(of, speed_km_h, ends, max(POINTS, len(conicities)))
    first = largest_real_part(of.state_matrix(speed_km_h, ends[0])) < 0.0
    loci = loci_over_conicity(of, speed_km_h, conicities, UPTO_HZ)
    ranges = stable_ranges(crossed, ends, stable_at_first=first)
    return Line("conicity", speed_km_h, conicities, tuple(loci), tuple(crossed), tuple(ranges))


def speed_line(of: SuspendedVehicle, conicity: float, speeds: Floats) -> Line:
    """Line over speeds (n,) [km/h] at a conicity."""
    ends = (float(speeds[0]), float(speeds[-1]))
    crossed = speed_crossings(of, conicity, ends, max(POINTS, len(speeds)))
    first = largest_real_part(of.state_matrix(ends[0], conicity)) < 0.0
    loci = loci_over_speed(of, conicity, speeds, UPTO_HZ)
    ranges = stable_ranges(crossed, ends, stable_at_first=first)
    return Line("speed", conicity, speeds, tuple(loci), tuple(crossed), tuple(ranges))
