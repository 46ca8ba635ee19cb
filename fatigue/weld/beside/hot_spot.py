"""Structural stress at a hot spot: surface stress read at some distances from the toe, extrapolated to it.

Type a is a toe on the face of a plate, its read-outs are at multiples of the plate thickness; type b is a toe on the
edge of a plate, its read-outs are at fixed distances. Extrapolation is linear in the stress, so that it is done once
for each mode. Source: IIW recommendations, structural hot spot stress; the weights are used as they are printed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

OF_THICKNESS = 0.01  # how far a read-out of type a may be off, of the plate thickness,
OF_EDGE_MM = 0.1  # and one of type b [mm]
ROUNDING = 1e-9  # distances in tables have decimals
FACE, EDGE = "hot_spot_a", "hot_spot_b"


@dataclass(frozen=True, slots=True)
class ReadOuts:
    """A set of read-outs that a rule gives, and the weight of each.

    ``distances`` from the toe ascend, in plate thicknesses for type a and in mm for type b.
    """

    name: str
    kind: str
    distances: tuple[float, ...]
    weights: tuple[float, ...]

    @property
    def unit(self) -> str:
        """What the distances are multiples of."""
        return "t" if self.kind == FACE else "mm"

    def __str__(self) -> str:
        """Name and distances: ``a fine (0.4 t, 1 t)``."""
        return f"{self.name} ({', '.join(f'{d:g} {self.unit}' for d in self.distances)})"


SETS = (
    ReadOuts("a fine", FACE, (0.4, 1.0), (1.67, -0.67)),
    ReadOuts("a quadratic", FACE, (0.4, 0.9, 1.4), (2.52, -2.24, 0.72)),
    ReadOuts("a coarse", FACE, (0.5, 1.5), (1.5, -0.5)),
    ReadOuts("b fine", EDGE, (4.0, 8.0, 12.0), (3.0, -3.0, 1.0)),
    ReadOuts("b coarse", EDGE, (5.0, 15.0), (1.5, -0.5)),
)


def sets_of(kind: str) -> tuple[ReadOuts, ...]:
    """The sets of read-outs of type a or b, by the name of the kind."""
    return tuple(one for one in SETS if one.kind == kind)


def matching_set(kind: str, distances: NDArray[np.float64], thickness: float) -> ReadOuts | None:
    """The set whose read-outs are at these ascending distances (r,) [mm] of a plate [mm]; None if there is none.

    >>> str(matching_set("hot_spot_a", np.array([4.0, 10.0]), 10.0))
    'a fine (0.4 t, 1 t)'
    """
    unit, tolerance = (thickness, OF_THICKNESS * thickness) if kind == FACE else (1.0, OF_EDGE_MM)
    for one in sets_of(kind):
        wanted = unit * np.array(one.distances)
        if wanted.size == distances.size and np.all(np.abs(distances - wanted) <= (1.0 + ROUNDING) * tolerance):
            return one
    return None
