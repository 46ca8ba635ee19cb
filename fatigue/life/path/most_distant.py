"""Most distant pair of a part of a path: of few points by all pairs, in the plane by its hull, in space by distances.

Ties are settled by the order of the points: all pairs with ``d^2 >= (1 - TIE) d^2_max`` count as equal, and of these
the one whose first point, then whose second point comes first is taken. Rounding must not choose between the turns of
a motion that repeats itself.

In the plane. The two points farthest apart are vertices of the convex hull, which is put together from the hulls of
blocks. The largest distance of a place from all points is a convex function of the place, so a block has a point of
such a pair only where a vertex of its own hull is one, or nearly. The first such point in time is P: had it a partner
before it, that one would have come first.

In space. Two points whose distances from any centre add up to less than the largest distance known cannot be the pair.
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
    hulls_of,
    largest_block,
    merge_hulls,
    reaches,
    sort_points,
)

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

TIE = 1e-9  # of the square of the largest distance
FEW = 2 * BLOCK  # points up to which all pairs are looked at
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
    distance: Floats


@compiled()
def search_in(z: Floats, n: int) -> Search:
    """Prepare searches in a path of n samples in z (n + 2, dimensions), see ``most_distant``."""
    points = n + 2 + BLOCK
    room = Room(np.empty(points, np.int64), np.empty(points, np.int64), np.empty(points, np.bool_))
    hulls = hulls_of(z, n if z.shape[1] == 2 else 0, room)
    hull, ring = np.empty(points, np.int64), np.empty(points, np.int64)
    boxes = np.empty((points // ARC + 1, 4))
    return Search(hulls, room, hull, ring, boxes, np.empty(points, np.bool_), np.empty(points))


@compiled()
def most_distant(z: Floats, search: Search, i: int, end: int) -> Pair:
    """Most distant pair of the first point, the samples i to ``end`` (excluded) and the last point of a part.

    The rows n and n + 1 of z (n + 2, dimensions) are the first and the last point, those before them the samples.
    """
    if end - i <= FEW:
        return by_all_pairs(z, i, end)
    return by_hull(z, search, i, end) if z.shape[1] == 2 else by_distances(z, search, i, end)


@compiled()
def square_between(z: Floats, p: int, q: int) -> float:
    """Square of the distance of two points."""
    square = 0.0
    for axis in range(z.shape[1]):
        d = z[q, axis] - z[p, axis]
        square += d * d
    return square


@compiled()
def point_at(k: int, i: int, end: int, n: int) -> int:
    """Row of the point k of a part: its first point, its samples i to ``end``, its last point."""
    if k == 0:
        return n
    return n + 1 if k == end - i + 1 else i + k - 1


@compiled()
def by_all_pairs(z: Floats, i: int, end: int) -> Pair:
    """Most distant pair by the definition."""
    n, points = len(z) - 2, end - i + 2
    largest = 0.0
    for j in range(points):
        for k in range(j + 1, points):
            largest = max(largest, square_between(z, point_at(j, i, end, n), point_at(k, i, end, n)))
    for j in range(points):
        for k in range(j + 1, points):
            p, q = point_at(j, i, end, n), point_at(k, i, end, n)
            if square_between(z, p, q) >= (1.0 - TIE) * largest:
                return Pair(p, q, largest)
    return Pair(n, n + 1, largest)


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
    apex[0] = p
    q = first_reaching(z, search.hulls, apex, 1, i if p == n else p + 1, end, enough)
    return Pair(p, q if q < end else n + 1, largest)


@compiled()
def hull_of_part(z: Floats, search: Search, i: int, end: int) -> int:
    """Write the hull of a part into ``search.hull`` and return how many vertices it has."""
    n = len(z) - 2
    hulls, hull, samples = search.hulls, search.hull, search.ring
    hull[0], hull[1] = n, n + 1
    sort_points(z, hull, 2)
    h = 2
    while i < end:
        level = largest_block(hulls, i, end)
        if level >= 0:
            block = hulls.levels[level] + i // (BLOCK << level)
            first, after = hulls.offsets[block], hulls.offsets[block + 1]
            h = merge_hulls(z, hull, h, hulls.vertices[first:after], after - first, search.room, hull)
            i += BLOCK << level
        else:
            stop = min(end, (i // BLOCK + 1) * BLOCK)
            for k in range(i, stop):
                samples[k - i] = k
            sort_points(z, samples, stop - i)
            h = merge_hulls(z, hull, h, samples, stop - i, search.room, hull)
            i = stop
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


@compiled()
def by_distances(z: Floats, search: Search, i: int, end: int) -> Pair:
    """Most distant pair of a part in any number of dimensions."""
    n, points, dimensions = len(z) - 2, end - i + 2, z.shape[1]
    one = other = n
    for _ in range(3):  # a point that is far from one that is far from the first
        far = 0.0
        for k in range(points):
            square = square_between(z, one, point_at(k, i, end, n))
            if square > far:
                far, other = square, point_at(k, i, end, n)
        one, other = other, one
    largest = square_between(z, one, other)
    distance, widest = search.distance, 0.0
    for k in range(points):
        p = point_at(k, i, end, n)
        square = 0.0
        for axis in range(dimensions):
            d = z[p, axis] - 0.5 * (z[one, axis] + z[other, axis])
            square += d * d
        distance[k] = np.sqrt(square)
        widest = max(widest, distance[k])
    candidates, far = search.hull, 0
    for k in range(points):
        if (distance[k] + widest) * (1.0 + 2.0 * TIE) >= np.sqrt(largest):
            candidates[far] = k
            far += 1
    for j in range(far):
        for k in range(j + 1, far):
            p, q = point_at(candidates[j], i, end, n), point_at(candidates[k], i, end, n)
            largest = max(largest, square_between(z, p, q))
    for j in range(far):
        for k in range(j + 1, far):
            p, q = point_at(candidates[j], i, end, n), point_at(candidates[k], i, end, n)
            if square_between(z, p, q) >= (1.0 - TIE) * largest:
                return Pair(p, q, largest)
    return Pair(n, n + 1, largest)
