"""Convex hulls of blocks of a path in the plane, so that a search need not look at every sample.

The sample of a block that is farthest from any point is a vertex of the convex hull of the block. Blocks of ``BLOCK``
samples, of twice as many and so on have their hulls once and for all: whatever part of the path is asked for is a few
of these blocks and some samples at its ends. A block whose hull has no vertex far enough from a point is skipped whole.

The vertices of a hull are kept in the order of x (then y), so that two hulls are merged without sorting. Rounding may
leave out a vertex that protrudes by a few units in the last place, so blocks are skipped only where they miss a
distance by more than ``DOUBT`` of its square.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

BLOCK = 16  # samples of the smallest blocks
DOUBT = 1e-12


class Hulls(NamedTuple):
    """Hulls of all whole blocks of a path; block k of a level holds ``BLOCK << level`` samples from k times as many on.

    Attributes
    ----------
    levels : (l + 1,) number of the first block of each level, and how many blocks there are
    offsets : (blocks + 1,) where the vertices of each block begin
    vertices : sample indices of the vertices, in the order of x and y
    """

    levels: Indices
    offsets: Indices
    vertices: Indices


class Room(NamedTuple):
    """Work space for hulls of so many points."""

    hull: Indices
    merged: Indices
    stack: Indices
    kept: NDArray[np.bool_]


def room_for(points: int) -> Room:
    """Work space for hulls of so many points."""
    hull, merged, stack = (np.empty(points, np.int64) for _ in range(3))
    return Room(hull, merged, stack, np.empty(points, np.bool_))


def hulls_of(z: Floats, n: int) -> Hulls:
    """Hulls of all whole blocks of the first n points of z (., 2)."""
    blocks: list[int] = []
    while (BLOCK << len(blocks)) <= n:
        blocks.append(n // (BLOCK << len(blocks)))
    levels = np.cumsum([0, *blocks], dtype=np.int64)
    offsets = np.zeros(levels[-1] + 1, np.int64)
    vertices = np.empty(len(blocks) * n, np.int64)  # pages that are not written take no memory
    write_hulls(z, levels, offsets, vertices, *room_for(n + BLOCK))
    return Hulls(levels, offsets, vertices)


@compiled()
def before(z: Floats, i: int, j: int) -> bool:
    """Whether the point i comes before the point j in the order of x, then y."""
    return bool(z[i, 0] < z[j, 0] or (z[i, 0] == z[j, 0] and z[i, 1] < z[j, 1]))


@compiled()
def in_order(z: Floats, i: int, end: int, points: Indices) -> int:
    """Write the points i to ``end`` (excluded), a few, in the order of x, then y, and return how many there are."""
    for point in range(i, end):
        j = point - i
        while j > 0 and before(z, point, points[j - 1]):
            points[j] = points[j - 1]
            j -= 1
        points[j] = point
    return end - i


@compiled()
def hull_of(z: Floats, points: Indices, n: int, stack: Indices, kept: NDArray[np.bool_], hull: Indices) -> int:
    """Write the vertices of the hull of n ordered points, in their order, and return how many there are.

    Two chains from the left to the right turn one way only, the lower and the upper one (Andrew, 1979).
    """
    for k in range(n):
        kept[k] = False
    for side in (1.0, -1.0):
        top = 0
        for k in range(n):
            x, y = z[points[k], 0], z[points[k], 1]
            while top >= 2:
                a, b = points[stack[top - 2]], points[stack[top - 1]]
                turn = (z[b, 0] - z[a, 0]) * (y - z[a, 1]) - (z[b, 1] - z[a, 1]) * (x - z[a, 0])
                if side * turn > 0.0:
                    break
                top -= 1
            stack[top] = k
            top += 1
        for k in range(top):
            kept[stack[k]] = True
    vertices = 0
    for k in range(n):
        if kept[k]:
            hull[vertices] = points[k]
            vertices += 1
    return vertices


@compiled()
def merge_hulls(
    z: Floats,
    n: int,
    other: Indices,
    j: int,
    end: int,
    hull: Indices,
    merged: Indices,
    stack: Indices,
    kept: NDArray[np.bool_],
) -> int:
    """Replace n ordered points by their hull with other ones, j to ``end`` (excluded); the number of its vertices."""
    i, points = 0, n + end - j
    for k in range(points):
        if j == end or (i < n and not before(z, other[j], hull[i])):
            merged[k] = hull[i]
            i += 1
        else:
            merged[k] = other[j]
            j += 1
    return hull_of(z, merged, points, stack, kept, hull)


@compiled()
def write_hulls(
    z: Floats,
    levels: Indices,
    offsets: Indices,
    vertices: Indices,
    hull: Indices,
    merged: Indices,
    stack: Indices,
    kept: NDArray[np.bool_],
) -> None:
    """Write the hulls of the blocks of all levels, block by block; each of two blocks of the level below."""
    for level in range(levels.size - 1):
        for k in range(levels[level + 1] - levels[level]):
            block = levels[level] + k
            if level == 0:
                found = in_order(z, k * BLOCK, (k + 1) * BLOCK, merged)
                found = hull_of(z, merged, found, stack, kept, hull)
            else:
                child = levels[level - 1] + 2 * k
                left, middle, right = offsets[child], offsets[child + 1], offsets[child + 2]
                for v in range(left, middle):
                    hull[v - left] = vertices[v]
                found = merge_hulls(z, middle - left, vertices, middle, right, hull, merged, stack, kept)
            for v in range(found):
                vertices[offsets[block] + v] = hull[v]
            offsets[block + 1] = offsets[block] + found


@compiled()
def largest_block(levels: Indices, i: int, end: int) -> int:
    """Level of the largest block that begins at sample i and ends before ``end``; -1: there is none."""
    level = -1
    while level + 2 < levels.size and i % (BLOCK << (level + 1)) == 0 and i + (BLOCK << (level + 1)) <= end:
        level += 1
    return level


@compiled()
def reaches(z: Floats, i: int, points: Indices, n: int, square: float) -> bool:
    """Whether the square of the distance of point i from one of n points is not smaller than ``square``."""
    for k in range(n):
        dx, dy = z[i, 0] - z[points[k], 0], z[i, 1] - z[points[k], 1]
        if dx * dx + dy * dy >= square:
            return True
    return False


@compiled()
def first_reaching(
    z: Floats,
    levels: Indices,
    offsets: Indices,
    vertices: Indices,
    points: Indices,
    n: int,
    i: int,
    end: int,
    square: float,
) -> int:
    """First of the samples i to ``end`` (excluded) that ``reaches`` one of n points, or ``end``."""
    in_doubt = (1.0 - DOUBT) * square
    while i < end:
        level = largest_block(levels, i, end)
        while level >= 0:
            block = levels[level] + i // (BLOCK << level)
            far = False
            for k in range(offsets[block], offsets[block + 1]):
                if reaches(z, vertices[k], points, n, in_doubt):
                    far = True
                    break
            if not far:
                break
            level -= 1
        if level >= 0:
            i += BLOCK << level
            continue
        stop = min(end, (i // BLOCK + 1) * BLOCK)
        while i < stop:
            if reaches(z, i, points, n, square):
                return i
            i += 1
    return end
