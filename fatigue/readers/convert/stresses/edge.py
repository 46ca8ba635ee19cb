"""Places on the free edge of a plate, at distances along it from a toe."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.convert.stresses.surface import PARALLEL, Plates
from fatigue.weld.mesh import NONE

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class OnEdge:
    """A place on a free edge: its element, the direction of the edge there, and what of the distance is missing.

    ``missing`` is how much farther the place should be where the edge ends before it [mm].
    """

    element: int
    place: Floats
    along: Floats
    missing: float


@dataclass(frozen=True, slots=True, eq=False)
class Foot:
    """The point of a free edge nearest to a toe: element, side, place, distance from the toe [mm]."""

    element: int
    side: int
    place: Floats
    distance: float


def foot(plates: Plates, toe: Floats, along: Floats) -> Foot | None:
    """Nearest point of the free edges that run with ``along``; None if there are none."""
    elements, sides = np.nonzero(plates.free)
    first, last = (plates.mesh.xyz[plates.ends[elements, sides, k]] for k in (0, 1))
    chord = last - first
    length = np.linalg.norm(chord, axis=1)
    keep = np.abs(chord @ along) >= PARALLEL * length
    if not keep.any():
        return None
    elements, sides, first, chord, length = (v[keep] for v in (elements, sides, first, chord, length))
    at = np.clip(np.sum((toe - first) * chord, axis=1) / length**2, 0.0, 1.0)
    place = first + at[:, None] * chord
    distance = np.linalg.norm(place - toe, axis=1)
    ahead = chord @ along * np.where(chord @ along > 0, 1 - at, at)  # of edges that meet at the toe, the one before it
    k = int(np.lexsort((-np.abs(ahead), np.round(distance, 6)))[0])
    return Foot(int(elements[k]), int(sides[k]), place[k], float(distance[k]))


def along_edge(plates: Plates, start: Foot, along: Floats, distance: float) -> OnEdge:
    """Place at a distance from the foot along the edge, in the sense of ``along``; kinks above 30 degrees end it."""
    element, side, place, left = start.element, start.side, start.place, distance
    while True:
        ends = plates.ends[element, side]
        xyz = plates.mesh.xyz[ends]
        to = 1 if (xyz[1] - xyz[0]) @ along > 0 else 0
        direction = xyz[to] - xyz[1 - to]
        direction /= np.linalg.norm(direction)
        room = float(np.linalg.norm(xyz[to] - place))
        if left <= room:
            return OnEdge(element, place + left * direction, direction, 0.0)
        onward = _onward(plates, element, side, int(ends[to]), direction)
        if onward is None:
            return OnEdge(element, xyz[to], direction, left - room)
        element, side, place, left, along = *onward, xyz[to], left - room, direction


def _onward(plates: Plates, element: int, side: int, node: int, direction: Floats) -> tuple[int, int] | None:
    """The free side that goes on from a node with no more than a small kink; None if there is none or a choice."""
    found = []
    for other in plates.at_node.get(node, ()):
        for k in range(4):
            ends = plates.ends[other, k]
            if not plates.free[other, k] or (other, k) == (element, side) or node not in ends or NONE in ends:
                continue
            xyz = plates.mesh.xyz[ends]
            leaving = (xyz[1] - xyz[0]) * (1.0 if ends[0] == node else -1.0)
            if leaving @ direction >= PARALLEL * np.linalg.norm(leaving):
                found.append((other, k))
    return found[0] if len(found) == 1 else None
