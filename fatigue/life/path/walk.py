"""The loops of the path counter: half cycle by half cycle, each walked from its beginning to its end.

A part of the path waits until its turn comes, so that nothing is nested, however long the path is. In a walk every
piece of the real part is passed once in all; an excursion is jumped over by the hulls of its blocks, if they were made.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.path.hulls import Hulls, first_reaching, hulls_of
from fatigue.life.path.most_distant import by_hull, most_distant, search_in, square_between

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

SMALL = 1e-9  # of the largest distance of the record; shorter half cycles are dropped
AT_END = 1e-12  # an excursion that ends this close behind a sample, over its segment, ends at the sample
DOUBT = 1e-11  # samples that miss the distance by this much of its square are looked at
NOWHERE = -1.0
UNKNOWN = -1, -1, 0.0
PATIENCE = 16  # times that every sample is looked at, on average, before hulls are made
NO_HULLS = Hulls(np.zeros(1, np.int64), np.zeros(1, np.int64), np.zeros(0, np.int64))
ROOM = 4  # rows of what waits that a part may need beside one for each of its samples
DONE, NEEDS_HULLS, NEEDS_ROOM = 0, 1, 2  # what a walk ends with


class Path(NamedTuple):
    """How far a path is walked.

    Attributes
    ----------
    z : (n + 2, dimensions) its points, and work space
    found : (h, 5) half cycles
    waiting : (w, 2) parts of it that wait, by their two ends
    used : (2,) rows of both that are used
    seen : (2,) square of the range up to which half cycles are dropped; samples of all searches
    far, centre : (n + 2,) and (dimensions,) work space
    """

    z: Floats
    found: Floats
    waiting: Floats
    used: Indices
    seen: Floats
    far: Indices
    centre: Floats


def half_cycles(z: Floats, recurs: bool) -> tuple[Floats, int]:
    """Half cycles of a path, each ``t_P, t_Q, R, L, g`` (h, 5), in no order, and the sample that t counts from.

    ``z`` (n + 2, dimensions) has two rows more than the path has samples, as work space. A path that recurs begins at
    the first point of its most distant pair, and ends there. Hulls are made, and their loops compiled, only where a
    part needs them.
    """
    first, n = 0, len(z) - 2
    if recurs and n > 1:
        first = _first(z)
        z = np.concatenate([z[first:n], z[: first + 1], z[n:]])
    return _walked_by_hulls(_begun(z)), first


def _first(z: Floats) -> int:
    """First point of the most distant pair of a path."""
    n = len(z) - 2
    z[n], z[n + 1] = z[0], z[n - 1]
    p, _, _ = most_distant(z, 1, n - 1, True, np.empty(n + 2, np.int64), np.zeros(z.shape[1]))
    if p < 0:
        p, _, _ = by_hull(z, hulls_of(z, n), search_in(z), 1, n - 1)
    return 0 if p == n else int(p)


def _begun(z: Floats) -> Path:
    """A path of which nothing is known, all of it one part."""
    n = len(z) - 2
    found, waiting, used = np.empty((n + 2, 5)), np.empty((n + ROOM, 2)), np.array([0, int(n > 1)])
    waiting[0] = 0.0, n - 1.0
    return Path(z, found, waiting, used, np.zeros(2), np.empty(n + 2, np.int64), np.zeros(z.shape[1]))


def _walked_by_hulls(path: Path) -> Floats:
    """Half cycles of a path walked to its end, with hulls for the parts that need them."""
    z, found, waiting, used, *_ = path
    hulls, search, known = NO_HULLS, search_in(z), UNKNOWN
    while (state := walked(*path, *hulls, *known)) != DONE:
        known = UNKNOWN
        if state == NEEDS_ROOM:
            found, waiting = (np.concatenate([rows, np.empty_like(rows)]) for rows in (found, waiting))
            path = path._replace(found=found, waiting=waiting)
            continue
        if hulls is NO_HULLS:
            hulls = hulls_of(z, len(z) - 2)
        start, end = waiting[used[1] - 1]
        known = by_hull(z, hulls, search, math.floor(start) + 1, math.ceil(end))
    return found[: used[0]]


@compiled()
def walked(
    z: Floats,
    found: Floats,
    waiting: Floats,
    used: Indices,
    seen: Floats,
    far: Indices,
    centre: Floats,
    levels: Indices,
    offsets: Indices,
    vertices: Indices,
    p: int,
    q: int,
    square: float,
) -> int:
    """Walk a path to its end, or until the part that waits last needs hulls for its most distant pair, or more room.

    ``p``, ``q`` and ``square`` are the pair of the part that waits last, or ``UNKNOWN``.
    """
    n = len(z) - 2
    while used[1] > 0:
        part = used[1] - 1
        start, end = waiting[part, 0], waiting[part, 1]
        i, after = math.floor(start) + 1, math.ceil(end)
        if used[0] == len(found) or part + after - i + ROOM > len(waiting):
            return NEEDS_ROOM
        place(z, n, start)
        place(z, n + 1, end)
        if p < 0:
            seen[1] += end - start
            p, q, square = most_distant(z, i, after, seen[1] <= PATIENCE * n, far, centre)
            if p < 0:
                return NEEDS_HULLS
        used[1] = part
        if square > seen[0]:
            if used[0] == 0:
                seen[0] = SMALL * SMALL * square
            t_p = start if p == n else float(p)
            t_q = end if q == n + 1 else float(q)
            used[1] = put_part(waiting, put_part(waiting, part, start, t_p), t_q, end)
            ends = t_p, t_q
            length, area = walk(z, levels, offsets, vertices, far, p, q, i, after, ends, waiting, used)
            square = square_between(z, p, q)
            row = found[used[0]]
            row[0], row[1], row[2], row[3] = t_p, t_q, math.sqrt(square), length
            row[4] = area / (0.25 * math.pi * square)
            used[0] += 1
        p = -1
    return DONE


@compiled()
def put_part(waiting: Floats, used: int, start: float, end: float) -> int:
    """Let a part wait, unless it is empty, and return how many wait."""
    if end <= start:
        return used
    waiting[used, 0], waiting[used, 1] = start, end
    return used + 1


@compiled()
def place(z: Floats, row: int, t: float) -> None:
    """Write the point of a path at t, index and fraction, into a row of z."""
    k = math.floor(t)
    fraction = t - k
    for axis in range(z.shape[1]):
        z[row, axis] = z[k, axis]
        if fraction > 0.0:
            z[row, axis] += fraction * (z[k + 1, axis] - z[k, axis])


@compiled()
def walk(
    z: Floats,
    levels: Indices,
    offsets: Indices,
    vertices: Indices,
    far: Indices,
    p: int,
    q: int,
    first: int,
    after: int,
    ends: tuple[float, float],
    waiting: Floats,
    used: Indices,
) -> tuple[float, float]:
    """Length and area moment of the real part between two points; the excursions are added to what waits.

    With r the distance from p: the real part is where r is as large as never before, an excursion lasts from where r
    begins to fall to where it is as large again, ``|a + u d| = rho``, in general inside a segment d.
    """
    n, t_p, t_q = len(z) - 2, ends[0], ends[1]
    stop = after if q == n + 1 else q
    length = area = square = 0.0  # square: rho^2
    left = NOWHERE  # where the excursion began
    a, t_a = p, t_p
    following = first if p == n else p + 1
    while True:
        last = following >= stop
        b, t_b = (q, t_q) if last else (following, float(following))
        aa, ad, dd = products(z, p, a, b)
        if left == NOWHERE and ad >= 0.0:
            length += math.sqrt(dd)
            area += moment(z, p, a, b)
        elif dd > 0.0:
            if left == NOWHERE:
                left, square = t_a, aa
                u = -2.0 * ad / dd
            else:
                u = (-ad + math.sqrt(max(ad * ad - dd * (aa - square), 0.0))) / dd
            if u <= 1.0 + AT_END or last:
                u = min(u, 1.0)
                used[1] = put_part(waiting, used[1], left, t_a + u * (t_b - t_a))
                left = NOWHERE
                length += (1.0 - u) * math.sqrt(dd)
                area += (1.0 - u) * moment(z, p, a, b)
        if last:
            return length, area
        a, following = b, following + 1
        if left != NOWHERE:
            enough = (1.0 - DOUBT) * square
            if z.shape[1] == 2:
                far[0] = p
                following = first_reaching(z, levels, offsets, vertices, far, 1, following, stop, enough)
            else:
                while following < stop and square_between(z, p, following) < enough:
                    following += 1
            a = following - 1
        t_a = float(a)


@compiled()
def products(z: Floats, p: int, a: int, b: int) -> tuple[float, float, float]:
    """Products a.a, a.d and d.d of a point a, seen from p, and of the step d from a to b."""
    aa = ad = dd = 0.0
    for axis in range(z.shape[1]):
        x, d = z[a, axis] - z[p, axis], z[b, axis] - z[a, axis]
        aa += x * x
        ad += x * d
        dd += d * d
    return aa, ad, dd


@compiled()
def moment(z: Floats, p: int, a: int, b: int) -> float:
    """Area of the parallelogram of two points, seen from p: ``|a x b| = |a x (b - a)|``."""
    square = 0.0
    for i in range(z.shape[1]):
        for j in range(i + 1, z.shape[1]):
            part = (z[a, i] - z[p, i]) * (z[b, j] - z[a, j]) - (z[a, j] - z[p, j]) * (z[b, i] - z[a, i])
            square += part * part
    return float(math.sqrt(square))
