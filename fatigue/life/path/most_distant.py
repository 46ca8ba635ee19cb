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
)

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

TIE = 1e-9  # of the square of the largest distance
FEW = 16  # points up to which all pairs are looked at
PAIRS = 32  # that may be looked at for each sample, before hulls are made
SHORT = 256  # samples, below which hulls are not asked
ARC = 16  # vertices of a hull in one box


class Pair(NamedTuple):
    """Two points of a path by their indices, the earlier one first, and the square of the largest distance."""

    p: int
    q: int
    square: float


class Search(NamedTuple):
    """Hulls of the blocks of a path in the plane, and work space."""

    hulls: Hulls
    room: Room
    hull: Indices
    ring: Indices
    boxes: Floats
    is_far: NDArray[np.bool_]


def search_in(z: Floats) -> Search:
    """Prepare searches in a path z (n + 2, dimensions); without hulls."""
    points = len(z) + BLOCK
    room = Room(np.empty(points, np.int64), np.empty(points, np.int64), np.empty(points, np.bool_))
    none = Hulls(np.zeros(1, np.int64), np.zeros(1, np.int64), np.zeros(0, np.int64))
    hull, ring = np.empty(points, np.int64), np.empty(points, np.int64)
    return Search(none, room, hull, ring, np.empty((points // ARC + 1, 4)), np.empty(points, np.bool_))


@compiled()
def most_distant(z: Floats, search: Search, i: int, end: int, patient: bool) -> tuple[Pair, bool]:
    """Most distant pair of the first point, the samples i to ``end`` (excluded) and the last point of a part.

    The rows n and n + 1 of z (n + 2, dimensions) are the first and the last point, those before them the samples.
    Returned is also whether it is found: not where too many points are far from one another for a search without
    hulls, nor in a long part if the search is not ``patient``. In space it is always found.
    """
    plane = z.shape[1] == 2
    if plane and not patient and end - i >= SHORT:
        return Pair(0, 0, 0.0), False
    far = far_points(z, search.hull, i, end)
    if plane and far > FEW and far * far > PAIRS * (end - i):
        return Pair(0, 0, 0.0), False
    return first_pair(z, search.hull, far), True


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
def farthest(z: Floats, centre: Floats, i: int, end: int) -> tuple[int, float]:
    """Row of the point of a part that is farthest from a place, and the square of its distance."""
    n = len(z) - 2
    far, largest = n, -1.0
    for k in range(i, end + 2):
        row = k if k < end else n + k - end
        square = square_from(z, centre, row)
        if square > largest:
            far, largest = row, square
    return far, largest


@compiled()
def far_points(z: Floats, far: Indices, i: int, end: int) -> int:
    """Write the points of a part that may be in its most distant pair, in their order, and return how many there are.

    Seen from the middle of two points that are far from one another, two points nearer in sum than these are not it.
    """
    n = len(z) - 2
    nearest = -1.0
    if end - i > FEW:
        one, _ = farthest(z, z[n], i, end)
        other, square = farthest(z, z[one], i, end)
        centre = 0.5 * (z[one] + z[other])
        _, widest = farthest(z, centre, i, end)
        least = np.sqrt(square) * (1.0 - 2.0 * TIE) - np.sqrt(widest)
        nearest = least * least if least > 0.0 else -1.0
    else:
        centre = z[n]
    found = 0
    for k in range(i - 1, end + 1):
        row = k if i <= k < end else (n if k < i else n + 1)
        if square_from(z, centre, row) >= nearest:
            far[found] = row
            found += 1
    return found


@compiled()
def first_pair(z: Floats, points: Indices, count: int) -> Pair:
    """Most distant pair of points in their order, by the definition."""
    largest = 0.0
    for j in range(count):
        for k in range(j + 1, count):
            largest = max(largest, square_between(z, points[j], points[k]))
    for j in range(count):
        for k in range(j + 1, count):
            if square_between(z, points[j], points[k]) >= (1.0 - TIE) * largest:
                return Pair(points[j], points[k], largest)
    return Pair(points[0], points[count - 1], largest)


@compiled()
def by_hull(z: Floats, search: Search, i: int, end: int) -> Pair:
    """Most distant pair of a part in the plane."""
    n = len(z) - 2
    h = hull_of_part(z, search, i, end)
    largest, apexes = far_vertices(z, search, h)
    enough = (1.0 - TIE) * largest
    apex = search.hull  # the hull is not needed any more
    p = n
    if not reaches(z, n, apex, apexes, enough):
        p = first_reaching(z, search.hulls, apex, apexes, i, end, enough)
    apexes = in_order(z, p, p + 1, apex)
    q = first_reaching(z, search.hulls, apex, apexes, i if p == n else p + 1, end, enough)
    return Pair(p, q if q < end else n + 1, largest)


@compiled()
def hull_of_part(z: Floats, search: Search, i: int, end: int) -> int:
    """Write the hull of a part into ``search.hull`` and return how many vertices it has."""
    n = len(z) - 2
    hulls, hull = search.hulls, search.hull
    h = in_order(z, n, n + 2, hull)
    while i < end:
        level = largest_block(hulls, i, end)
        if level >= 0:
            block, following = hulls.levels[level] + i // (BLOCK << level), i + (BLOCK << level)
            points, first, after = hulls.vertices, hulls.offsets[block], hulls.offsets[block + 1]
        else:
            following = min(end, (i // BLOCK + 1) * BLOCK)
            points, first, after = search.ring, 0, in_order(z, i, following, search.ring)
        h = merge_hulls(z, hull, h, points, first, after, search.room)
        i = following
    return h


@compiled()
def far_vertices(z: Floats, search: Search, h: int) -> tuple[float, int]:
    """Square of the largest distance of h vertices of a hull, and how many vertices are in a pair that ties with it.

    These are written to ``search.hull``. Once round the hull, ``ARC`` vertices at a time lie in a small box; two boxes
    are looked into only where their far corners are far enough apart.
    """
    ring, boxes, is_far = search.ring, search.boxes, search.is_far
    lay_round(z, search.hull, h, ring)
    arcs = (h + ARC - 1) // ARC
    for arc in range(arcs):
        box = boxes[arc]
        box[0] = box[1] = np.inf
        box[2] = box[3] = -np.inf
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
            search.hull[apexes] = ring[k]
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
