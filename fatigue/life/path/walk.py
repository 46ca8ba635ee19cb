"""The loops of the path counter: half cycle by half cycle, each walked from its beginning to its end.

A part of the path waits until its turn comes, so that nothing is nested, however long the path is. In a walk every
piece of the real part is passed once in all; an excursion is jumped over by the hulls of its blocks, if they were made.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.path.hulls import first_reaching, hulls_of, in_order
from fatigue.life.path.most_distant import Pair, Search, by_hull, most_distant, search_in, square_between

Floats = NDArray[np.float64]

SMALL = 1e-9  # of the largest distance of the record; shorter half cycles are dropped
AT_END = 1e-12  # an excursion that ends this close behind a sample, over its segment, ends at the sample
DOUBT = 1e-11  # samples that miss the distance by this much of its square are looked at
NOWHERE = -1.0
UNKNOWN = Pair(-1, -1, 0.0)
PATIENCE = 16  # times that every sample is looked at, on average, before hulls are made


class Rows(NamedTuple):
    """A table that grows: its rows, and how many of them are used."""

    values: Floats
    used: int


class Path(NamedTuple):
    """How far a path is walked.

    Attributes
    ----------
    z : (n + 2, dimensions) its points, and work space
    search : in these points
    found, waiting : half cycles, and parts by their two ends
    smallest : square of the range up to which half cycles are dropped
    looked_at : samples of all searches
    first : sample from which it recurs
    recurs : whether only that sample is asked for
    """

    z: Floats
    search: Search
    found: Rows
    waiting: Rows
    smallest: float
    looked_at: float
    first: int
    recurs: bool


@compiled()
def with_row(rows: Rows, row: tuple[float, ...]) -> Rows:
    """The table with one row more."""
    values, used = rows
    if used == len(values):
        grown = np.empty((2 * len(values), values.shape[1]))
        for i in range(used):
            for k in range(values.shape[1]):
                grown[i, k] = values[i, k]
        values = grown
    for k in range(values.shape[1]):
        values[used, k] = row[k]
    return Rows(values, used + 1)


@compiled()
def with_part(waiting: Rows, start: float, end: float) -> Rows:
    """What waits with a part more, unless it is empty."""
    return with_row(waiting, (start, end)) if end > start else waiting


def half_cycles(z: Floats, recurs: bool) -> tuple[Floats, int]:
    """Half cycles of a path, each ``t_P, t_Q, R, L, g`` (h, 5), in no order, and the sample that t counts from.

    ``z`` (n + 2, dimensions) has two rows more than the path has samples, as work space. A path that recurs begins at
    the first point of its most distant pair, and ends there. Hulls are made, and their loops compiled, only where a
    part needs them.
    """
    first, n = 0, len(z) - 2
    if recurs:
        first = _walked_by_hulls(_begun(z, recurs)).first
        z = np.concatenate([z[first:n], z[: first + 1], z[n:]])
    found = _walked_by_hulls(_begun(z, recurs=False)).found
    return found.values[: found.used], first


def _begun(z: Floats, recurs: bool) -> Path:
    """A path of which nothing is known, all of it one part."""
    n = len(z) - 2
    found, waiting = Rows(np.empty((n + 2, 5)), 0), Rows(np.array([[0.0, n - 1.0]]), int(n > 1))
    return Path(z, search_in(z), found, waiting, 0.0, 0.0, 0, recurs)


def _walked_by_hulls(path: Path) -> Path:
    """A path walked to its end, with hulls for the parts that need them."""
    path = walked(path, UNKNOWN)
    while path.waiting.used > 0:
        z, search = path.z, path.search
        if search.hulls.vertices.size == 0:
            search = search._replace(hulls=hulls_of(z, len(z) - 2, search.room))
        start, end = path.waiting.values[path.waiting.used - 1]
        pair = by_hull(z, search, int(np.floor(start)) + 1, int(np.ceil(end)))
        path = walked(path._replace(search=search), pair)
    return path


@compiled()
def walked(path: Path, known: Pair) -> Path:
    """A path walked to its end, or until the part that waits last needs hulls for its most distant pair.

    ``known`` is the pair of the part that waits last, or ``UNKNOWN``. Of a path that recurs only that pair is found.
    """
    z, search, found, waiting, smallest, looked_at, first, recurs = path
    n = len(z) - 2
    while waiting.used > 0:
        start, end = waiting.values[waiting.used - 1, 0], waiting.values[waiting.used - 1, 1]
        place(z, n, start)
        place(z, n + 1, end)
        i, after = int(np.floor(start)) + 1, int(np.ceil(end))
        pair, is_found = known, known.p >= 0
        if not is_found:
            looked_at += end - start
            pair, is_found = most_distant(z, search, i, after, looked_at <= PATIENCE * n)
        if not is_found:
            break
        known = Pair(-1, -1, 0.0)
        waiting = Rows(waiting.values, waiting.used - 1)
        if recurs:
            first = 0 if pair.p == n else pair.p
            break
        if pair.square <= smallest:
            continue
        if found.used == 0:
            smallest = SMALL * SMALL * pair.square
        t_p = start if pair.p == n else float(pair.p)
        t_q = end if pair.q == n + 1 else float(pair.q)
        waiting = with_part(with_part(waiting, start, t_p), t_q, end)
        length, area, waiting = walk(z, search, pair, i, after, t_p, t_q, waiting)
        square = square_between(z, pair.p, pair.q)
        found = with_row(found, (t_p, t_q, np.sqrt(square), length, area / (0.25 * np.pi * square)))
    return Path(z, search, found, waiting, smallest, looked_at, first, recurs)


@compiled()
def place(z: Floats, row: int, t: float) -> None:
    """Write the point of a path at t, index and fraction, into a row of z."""
    k = int(np.floor(t))
    fraction = t - k
    for axis in range(z.shape[1]):
        z[row, axis] = z[k, axis]
        if fraction > 0.0:
            z[row, axis] += fraction * (z[k + 1, axis] - z[k, axis])


@compiled()
def walk(
    z: Floats, search: Search, pair: Pair, first: int, after: int, t_p: float, t_q: float, waiting: Rows
) -> tuple[float, float, Rows]:
    """Length and area moment of the real part between two points, and the excursions added to what waits.

    With r the distance from p: the real part is where r is as large as never before, an excursion lasts from where r
    begins to fall to where it is as large again, ``|a + u d| = rho``, in general inside a segment d.
    """
    n, p, q = len(z) - 2, pair.p, pair.q
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
            length += np.sqrt(dd)
            area += moment(z, p, a, b)
        elif dd > 0.0:
            if left == NOWHERE:
                left, square = t_a, aa
                u = -2.0 * ad / dd
            else:
                u = (-ad + np.sqrt(max(ad * ad - dd * (aa - square), 0.0))) / dd
            if u <= 1.0 + AT_END or last:
                u = min(u, 1.0)
                waiting = with_part(waiting, left, t_a + u * (t_b - t_a))
                left = NOWHERE
                length += (1.0 - u) * np.sqrt(dd)
                area += (1.0 - u) * moment(z, p, a, b)
        if last:
            return length, area, waiting
        a, following = b, following + 1
        if left != NOWHERE:
            following = first_far(z, search, p, following, stop, (1.0 - DOUBT) * square)
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
def first_far(z: Floats, search: Search, p: int, i: int, stop: int, square: float) -> int:
    """First of the samples i to ``stop`` (excluded) that is at least so far from p, or ``stop``."""
    if z.shape[1] == 2:
        only = search.hull
        return first_reaching(z, search.hulls, only, in_order(z, p, p + 1, only), i, stop, square)
    while i < stop and square_between(z, p, i) < square:
        i += 1
    return i


@compiled()
def moment(z: Floats, p: int, a: int, b: int) -> float:
    """Area of the parallelogram of two points, seen from p: ``|a x b| = |a x (b - a)|``."""
    square = 0.0
    for i in range(z.shape[1]):
        for j in range(i + 1, z.shape[1]):
            part = (z[a, i] - z[p, i]) * (z[b, j] - z[a, j]) - (z[a, j] - z[p, j]) * (z[b, i] - z[a, i])
            square += part * part
    return float(np.sqrt(square))
