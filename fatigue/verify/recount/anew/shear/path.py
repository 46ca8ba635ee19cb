"""Half cycles of the path of two stresses once more, a part at a time, all its points at once.

Of a part the most distant pair P, Q is one half cycle; from P to Q the path is real where it is as far from P as never
before, and what lies between is an excursion, counted like what is before P and behind Q. Vertices that are as far as
never before are found from a running maximum; between two of them lies one excursion at most.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError
from scipy.spatial.distance import cdist

from fatigue.verify.recount.anew.shear.walk_rounding import walk_bounds

Floats = NDArray[np.float64]

TIE = 1e-9  # of the square of the largest distance
SMALL = 1e-9  # of the largest distance of all: shorter half cycles are left out
SAME = 1e-12  # as far as before
ALIKE = 1.0 - 1e-9  # of the largest range: what is said of the largest half cycle is said of these
FEW = 200  # points of which all distances are looked at
AT_ONCE = 1 << 20  # distances in memory


class HalfCycles(NamedTuple):
    """Half cycles (h,): sample index and fraction of both ends, range, path length, path moment.

    ``length_bound`` and ``moment_bound`` are what rounding may do to the last two; ``is_sure`` says of the largest
    half cycles whether it leaves the two ends as they are, and is true of all others.
    """

    start: Floats
    end: Floats
    range: Floats
    length: Floats
    moment: Floats
    length_bound: Floats
    moment_bound: Floats
    is_sure: Floats


def half_cycles(z: Floats, *, recurs: bool, rounding: float = 0.0) -> HalfCycles:
    """Half cycles of a path z (t, 2); of one that recurs from the first point of its most distant pair on.

    ``rounding`` is how far a point may be from where it is.
    """
    samples, first = len(z), 0
    if recurs and np.ptp(z, axis=0).any():
        first = most_distant(z)[0]
        z = np.concatenate([z[first:], z[: first + 1]])
    found: list[tuple[float, ...]] = []
    waiting, largest = [(0.0, len(z) - 1.0)], 0.0
    while waiting:
        start, end = waiting.pop()
        inner = np.arange(np.floor(start) + 1, np.ceil(end))
        t = np.concatenate([[start], inner, [end]])
        points = np.concatenate([[at(z, start)], z[inner.astype(np.intp)], [at(z, end)]])
        if not np.ptp(points, axis=0).max() > 0.1 * SMALL * largest:
            continue
        p, q = most_distant(points)
        distance = float(np.hypot(*(points[q] - points[p])))
        if distance <= SMALL * largest:
            continue
        largest = largest or distance
        length, area, excursions = _walked(points[p : q + 1], t[p : q + 1])
        moment = area / (np.pi * distance**2 / 4.0)
        may_be = walk_bounds(points[p : q + 1], moment, rounding) if rounding > 0.0 else (0.0, 0.0)
        closed = recurs and end - start == len(z) - 1.0
        is_sure = distance < ALIKE * largest or is_one_pair(points[:-1] if closed else points, distance, rounding)
        found.append((t[p], t[q], distance, length, moment, *may_be, is_sure))
        waiting += [(a, b) for a, b in [(start, t[p]), (t[q], end), *excursions] if b > a]
    table = np.array(sorted(found)).reshape(-1, 8)
    if recurs and samples:
        table[:, :2] = (table[:, :2] + first) % samples
    return HalfCycles(*table.T)


def most_distant(points: Floats) -> tuple[int, int]:
    """First of all pairs of points (n, 2) that are as far apart as the most distant ones, but for rounding."""
    far, enough = _ends(points)
    p = int(far.argmax())
    q = p + 1 + int((((points[p + 1 :] - points[p]) ** 2).sum(axis=1) >= enough).argmax())
    return p, q


def is_one_pair(points: Floats, largest: float, rounding: float) -> bool:
    """Whether rounding leaves the most distant pair of points (n, 2) as it is: alone, or the first of all that tie.

    ``largest`` is their distance, ``rounding`` how far a point may be from where it is.
    """
    if rounding == 0.0:
        return True
    by = 4.0 * rounding * largest
    with_doubtful, sure = (np.count_nonzero(_ends(points, more)[0]) for more in (-by, by))
    return with_doubtful in (2, sure)


def _ends(points: Floats, more: float = 0.0) -> tuple[NDArray[np.bool_], float]:
    """Which points (n, 2) are as far from another one as the most distant ones, but for rounding; and what is enough.

    This is the square of that distance, and so much ``more``.
    """
    corners = points if len(points) <= FEW else points[_corners(points)]
    rows = max(1, AT_ONCE // len(corners))
    some = (corners[first : first + rows] for first in range(0, len(corners), rows))
    largest = np.concatenate([cdist(few, corners, "sqeuclidean").max(axis=1) for few in some])
    enough = float((1.0 - TIE) * largest.max() + more)
    far = np.zeros(len(points), dtype=bool)
    for end in corners[largest >= enough]:
        far |= ((points - end) ** 2).sum(axis=1) >= enough
    return far, enough


def at(z: Floats, t: float) -> Floats:
    """Point of a path at a sample index and fraction."""
    k = int(t)
    return np.asarray(z[k] if k == t else (1.0 - (t - k)) * z[k] + (t - k) * z[k + 1])


def _corners(points: Floats) -> NDArray[np.intp]:
    """Points among which the most distant ones are: the corners of the hull, of a straight path its two ends."""
    try:
        hull = np.asarray(ConvexHull(points).vertices, dtype=np.intp)
    except QhullError:
        far = points[((points - points[0]) ** 2).sum(axis=1).argmax()]
        along = points @ (far - points[0])
        hull = np.array([along.argmin(), along.argmax()])
    return hull


def _walked(points: Floats, t: Floats) -> tuple[float, float, list[tuple[float, float]]]:
    """Length and area moment of the real part from the first point to the last one, and the excursions from it."""
    seen = points - points[0]
    r = np.hypot(*seen.T)
    farthest = np.maximum.accumulate(r)
    reached = np.flatnonzero(r >= np.concatenate([[0.0], farthest[:-1]]) * (1.0 - SAME))
    left, last = reached[:-1], reached[1:]  # from one such vertex to the next one
    a, d = seen[last - 1], seen[last] - seen[last - 1]
    ad, dd = (a * d).sum(axis=1), (d * d).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        behind = (-ad + np.sqrt(np.maximum(ad**2 - dd * ((a * a).sum(axis=1) - farthest[left] ** 2), 0.0))) / dd
        dips = -2.0 * ad / dd
    adjacent = last == left + 1
    u = np.where(adjacent, np.where(ad < 0.0, dips, 0.0), behind)
    u = np.clip(np.nan_to_num(u, nan=0.0, posinf=1.0), 0.0, 1.0)
    back = t[last - 1] + u * (t[last] - t[last - 1])
    jumps = (u > 0.0) | ~adjacent
    area = np.abs(a[:, 0] * d[:, 1] - a[:, 1] * d[:, 0])
    excursions = list(zip(t[left[jumps]].tolist(), back[jumps].tolist(), strict=True))
    return float(((1.0 - u) * np.sqrt(dd)).sum()), float(((1.0 - u) * area).sum()), excursions
