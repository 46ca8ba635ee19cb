"""How sure a reading is of its place: how near a weld is, what a crooked grid shows, and what its neighbours would.

A grid is glued within a few degrees and millimetres. Where the strain changes much over these, the simulation and the
measurement may differ for no other reason. Along a principal direction a small angle does next to nothing.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.errors import DataError
from fatigue.gauges.gauge_file import Gauge
from fatigue.gauges.grid import Grid
from fatigue.gauges.instrument import Floats
from fatigue.gauges.on_element import Plates, piece_on
from fatigue.gauges.place import ALIKE, Shells
from fatigue.weld.line import WeldLine

TURNED_DEG = 5.0
COMMON_NODES = 2  # of elements that share an edge


@dataclass(frozen=True, slots=True)
class Nearest:
    """The weld line nearest to a gauge, "" without any, and its distance [mm]."""

    weld: str
    distance: float


@dataclass(frozen=True, slots=True)
class Neighbours:
    """What the elements beside that of a gauge would read.

    ``count`` of them have forces; ``largest`` is the largest change of the rms against that of the gauge, NaN without
    any.
    """

    count: int
    largest: float


def nearest_welds(lines: Iterable[WeldLine], places: Sequence[Floats]) -> list[Nearest]:
    """The nearest weld line of each place (3,) [mm]."""
    at = np.stack(places)
    best, names = np.full(len(at), np.inf), np.full(len(at), "", dtype=object)
    for line in lines:
        begin = line.xyz
        end = np.roll(begin, -1, axis=0)
        if not line.closed:
            begin, end = begin[:-1], end[:-1]
        apart = distances(at, begin, end)
        closer = apart < best
        best[closer], names[closer] = apart[closer], line.weld
    return [Nearest(str(name), float(far)) for name, far in zip(names, best, strict=True)]


def distances(at: Floats, begin: Floats, end: Floats) -> Floats:
    """Distance (g,) of places (g, 3) from the nearest of some straight edges (s, 3).

    >>> distances(np.array([[5.0, 3.0, 0.0]]), np.zeros((1, 3)), np.array([[4.0, 0.0, 0.0]])).round(6)
    array([3.162278])
    """
    along = end - begin
    to = at[:, None] - begin
    length2 = np.maximum((along**2).sum(axis=1), np.finfo(np.float64).tiny)
    where = np.clip((to * along).sum(axis=2) / length2, 0.0, 1.0)
    return np.asarray(np.linalg.norm(to - where[..., None] * along, axis=2).min(axis=1))


def rms(rows: Floats, covariance: Floats) -> Floats:
    """Rms about the mean of rows (..., c) times coordinates of this covariance (c, c)."""
    variance = np.einsum("...i,ij,...j->...", rows, covariance, rows)
    return np.asarray(np.sqrt(np.maximum(variance, 0.0)))


def angle_sensitivity(grid: Grid, covariance: Floats) -> float:
    """Largest change of the rms, relative to it, of a grid that is turned by 5 degrees; NaN of a grid at rest.

    A stand-in has no direction but that across the line: NaN, too.
    """
    if grid.stand_in:
        return float("nan")
    straight = rms(grid.strain(), covariance)
    turned = rms(np.stack([grid.strain(sign * TURNED_DEG) for sign in (-1.0, 1.0)]), covariance)
    return float(np.abs(turned / straight - 1.0).max()) if straight > 0.0 else float("nan")


def neighbours(gauge: Gauge, grid: Grid, plates: Plates | None, covariance: Floats) -> Neighbours:
    """What the elements that share an edge with that of a gauge would read in the same direction on the same face.

    Elements whose normal is more than 20 degrees off, and those without forces or with another section than a plate,
    are left out.
    """
    if plates is None or grid.element_index < 0:
        return Neighbours(0, float("nan"))
    own = rms(grid.strain(), covariance)
    found = []
    for index in beside(plates.shells, grid.element_index):
        try:
            piece = piece_on(gauge, plates, index, grid.normal, grid.direction, 1.0)
        except DataError:
            continue
        theirs = rms(piece.strain(gauge.transverse_sensitivity), covariance)
        found.append(abs(theirs / own - 1.0) if own > 0.0 else np.nan)
    return Neighbours(len(found), float(max(found, default=np.nan)))


def beside(shells: Shells, index: int) -> list[int]:
    """Elements that share an edge with one and look the same way, within 20 degrees."""
    corners = shells.nodes[index, :4]
    common = np.isin(shells.nodes[:, :4], corners[corners > 0]).sum(axis=1)
    alike = np.abs(shells.normal @ shells.normal[index]) >= ALIKE
    found = np.flatnonzero((common >= COMMON_NODES) & alike)
    return [int(i) for i in found if i != index]
