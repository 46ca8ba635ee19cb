"""Most distant pair of a part of a path: by pairs of the points that are far enough out, or in the plane by its hull.

Ties are settled by the order of the points: all pairs with ``d^2 >= (1 - TIE) d^2_max`` count as equal, and of these
the one whose first point, then whose second point comes first is taken. Rounding must not choose between the turns of
a motion that repeats itself.

By distances. Two points whose distances from any centre add up to less than the largest distance known cannot be the
pair. On most parts few points are left, and all their pairs are looked at.

By hulls, in the plane, where many points are left, or where parts lie in one another so that their samples would be
looked at too often. The two points farthest apart are vertices of the convex hull, which is put together from the
hulls of blocks. The largest distance of a place from all points is a convex function of the place, so a block has a
point of such a pair only where a vertex of its own hull is one, or nearly. The first such point in time is P: had it a
partner before it, that one would have come first.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.path.hulls import (
    BLOCK,
    Hulls,
    Room,
    first_reaching,
    in_order,
    largest_block,
    merge_hulls,
    reaches,
    room_for,
)

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

TIE = 1e-9  # of the square of the largest distance
FEW = 16  # points up to which all pairs are looked at
PAIRS = 256  # that may be looked at for each sample, before hulls are made, whose loops take two seconds to compile
SHORT = 256  # samples, below which hulls are not asked
ARC = 16  # vertices of a hull in one box


class Search(NamedTuple):
    """Work space of a search by hulls in a path."""

    room: Room
    ring: Indices
    boxes: Floats
    is_far: NDArray[np.bool_]


def search_in(z: Floats) -> Search:
    """Prepare searches by hulls in a path z (n + 2, dimensions)."""
    points = len(z) + BLOCK
    ring, boxes = np.empty(points, np.int64), np.empty((points // ARC + 1, 4))
    return Search(room_for(points), ring, boxes, np.empty(points, np.bool_))


@compiled()
def most_distant(z: Floats, i: int, end: int, patient: bool, far: Indices, centre: Floats) -> tuple[int, int, float]:
    """Most distant pair of the first point, the samples i to ``end`` (excluded) and the last point of a part.

    The rows n and n + 1 of z (n + 2, dimensions) are the first and the last point, those before them the samples.
    Returned are the rows of both points, the earlier one first, and the square of the largest distance. The first is
    -1 where the pair is not found: where too many points are far from one another for a search without hulls, and in a
    long part if the search is not ``patient``. In space it is always found. ``far`` (n + 2,) and
    ``centre`` (dimensions,) are work space.
    """
    plane = z.shape[1] == 2
    if plane and not patient and end - i >= SHORT:
        return -1, -1, 0.0
    count = far_points(z, far, centre, i, end)
    if plane and count > FEW and count * count > PAIRS * (end - i):
        return -1, -1, 0.0
    largest = 0.0
    for j in range(count):
        for k in range(j + 1, count):
            largest = max(largest, square_between(z, far[j], far[k]))
    for j in range(count):
        for k in range(j + 1, count):
            if square_between(z, far[j], far[k]) >= (1.0 - TIE) * largest:
                return far[j], far[k], largest
    return far[0], far[count - 1], largest


@compiled()
def square_from(z: Floats, place: Floats, row: int) -> float:
    """Square of the distance of a point from a place."""
    square = 0.0
    for axis in range(z.shape[1]):
        d = z[row, axis] - place[axis]
        square += d * d
    return square


@compiled()
def square_between(z: Floats, p: int, q: int) -> float:
    """Square of the distance of two points."""
    square = 0.0
    for axis in range(z.shape[1]):
        d = z[q, axis] - z[p, axis]
        square += d * d
    return square


@compiled()
def farthest(z: Floats, place: Floats, i: int, end: int) -> int:
    """Row of the point of a part that is farthest from a place."""
    n = len(z) - 2
    far, largest = n, -1.0
    for k in range(i, end + 2):
        row = k if k < end else n + k - end
        square = square_from(z, place, row)
        if square > largest:
            far, largest = row, square
    return far


@compiled()
def far_points(z: Floats, far: Indices, centre: Floats, i: int, end: int) -> int:
    """Write the points of a part that may be in its most distant pair, in their order, and return how many there are.

    Seen from the middle of two points that are far from one another, two points nearer in sum than these are not it.
    """
    n = len(z) - 2
    nearest = -1.0
    if end - i > FEW:
        one = farthest(z, z[n], i, end)
        other = farthest(z, z[one], i, end)
        for axis in range(z.shape[1]):
            centre[axis] = 0.5 * (z[one, axis] + z[other, axis])
        widest = square_from(z, centre, farthest(z, centre, i, end))
        least = math.sqrt(square_between(z, one, other)) * (1.0 - 2.0 * TIE) - math.sqrt(widest)
        nearest = least * least if least > 0.0 else -1.0
    found = 0
    for k in range(i - 1, end + 1):
        row = k if i <= k < end else (n if k < i else n + 1)
        if nearest < 0.0 or square_from(z, centre, row) >= nearest:
            far[found] = row
            found += 1
    return found


def by_hull(z: Floats, hulls: Hulls, search: Search, i: int, end: int) -> tuple[int, int, float]:
    """Most distant pair of a part in the plane, as ``most_distant`` returns it."""
    n, (hull, merged, stack, kept) = len(z) - 2, search.room
    h = hull_of_part(z, *hulls, search.ring, hull, merged, stack, kept, i, end)
    lay_round(z, hull, h, search.ring)
    largest, apexes = far_vertices(z, search.ring, h, search.boxes, search.is_far, hull)
    enough = (1.0 - TIE) * largest
    p = n
    if not reaches(z, n, hull, apexes, enough):
        p = first_reaching(z, *hulls, hull, apexes, i, end, enough)
    hull[0] = p  # the apexes are not needed any more
    q = first_reaching(z, *hulls, hull, 1, i if p == n else p + 1, end, enough)
    return p, q if q < end else n + 1, largest


@compiled()
def hull_of_part(
    z: Floats,
    levels: Indices,
    offsets: Indices,
    vertices: Indices,
    ring: Indices,
    hull: Indices,
    merged: Indices,
    stack: Indices,
    kept: NDArray[np.bool_],
    i: int,
    end: int,
) -> int:
    """Write the hull of a part into ``hull`` and return how many vertices it has."""
    n = len(z) - 2
    h = in_order(z, n, n + 2, hull)
    while i < end:
        level = largest_block(levels, i, end)
        if level >= 0:
            block, following = levels[level] + i // (BLOCK << level), i + (BLOCK << level)
            points, first, after = vertices, offsets[block], offsets[block + 1]
        else:
            following = min(end, (i // BLOCK + 1) * BLOCK)
            points, first, after = ring, 0, in_order(z, i, following, ring)
        h = merge_hulls(z, h, points, first, after, hull, merged, stack, kept)
        i = following
    return h


@compiled()
def far_vertices(
    z: Floats, ring: Indices, h: int, boxes: Floats, is_far: NDArray[np.bool_], apex: Indices
) -> tuple[float, int]:
    """Square of the largest distance of h vertices of a hull, and how many vertices are in a pair that ties with it.

    The vertices are given once round the hull; those found are written to ``apex``. ``ARC`` vertices at a time lie in a
    small box; two boxes are looked into only where their far corners are far enough apart.
    """
    arcs = (h + ARC - 1) // ARC
    for arc in range(arcs):
        box = boxes[arc]
        box[0] = box[1] = math.inf
        box[2] = box[3] = -math.inf
        for k in range(arc * ARC, min(h, (arc + 1) * ARC)):
            x, y = z[ring[k], 0], z[ring[k], 1]
            box[0], box[1], box[2], box[3] = min(box[0], x), min(box[1], y), max(box[2], x), max(box[3], y)
    for k in range(h):
        is_far[k] = False
    largest = enough = 0.0
    for marking in (False, True):
        for one in range(arcs):
            for other in range(one, arcs):
                width = max(boxes[one, 2] - boxes[other, 0], boxes[other, 2] - boxes[one, 0])
                height = max(boxes[one, 3] - boxes[other, 1], boxes[other, 3] - boxes[one, 1])
                if (width * width + height * height) * (1.0 + 2.0 * TIE) < largest:
                    continue
                for j in range(one * ARC, min(h, (one + 1) * ARC)):
                    for k in range(max(j + 1, other * ARC), min(h, (other + 1) * ARC)):
                        square = square_between(z, ring[j], ring[k])
                        if marking and square >= enough:
                            is_far[j] = is_far[k] = True
                        largest = max(largest, square)
        enough = (1.0 - TIE) * largest
    apexes = 0
    for k in range(h):
        if is_far[k]:
            apex[apexes] = ring[k]
            apexes += 1
    return largest, apexes


@compiled()
def lay_round(z: Floats, hull: Indices, h: int, ring: Indices) -> None:
    """Write the vertices of a hull, ordered by x, once round it: below its ends from left to right, above them back."""
    a, b = hull[0], hull[h - 1]
    front, back = 0, h - 1
    for k in range(h):
        v = hull[k]
        turn = (z[b, 0] - z[a, 0]) * (z[v, 1] - z[a, 1]) - (z[b, 1] - z[a, 1]) * (z[v, 0] - z[a, 0])
        if turn <= 0.0:
            ring[front] = v
            front += 1
        else:
            ring[back] = v
            back -= 1
