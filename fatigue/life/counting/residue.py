"""The residue of a pass: the reversals that four-point counting leaves open, on which the next pass goes on.

The residue is the chain of running extremes from both ends. Seen from the first sample, a range counts as long as it is
not exceeded: the reversals that widen the range of all samples so far, up to the last of them. From there on it is the
same seen from the last sample. Of equal extremes the later one stays, as on the stack of ``reversals``.

A residue holds all that a pass can do to its neighbours: with closed(.) the damage of the cycles that close within a
pass, ``damage(A B C ...) = closed(A) + closed(B) + ... + damage(res(A) res(B) ...)``.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]

AT_ONCE = 32  # samples that are passed over together where none of them is an extreme


@dataclass(frozen=True, slots=True, eq=False)
class BlockResidue:
    """Residues of one pass at n points, top and bottom surface, in the order of time.

    Attributes
    ----------
    membrane, bending : (r,) stresses at the reversals of all points, one point after the other [MPa]
    first, length : (n, 2) where the residue of each surface begins, and of how many reversals it is
    """

    membrane: Floats
    bending: Floats
    first: Counts
    length: Counts

    def at(self, rows: slice | NDArray[np.intp]) -> Self:
        """Take some points."""
        return type(self)(self.membrane, self.bending, self.first[rows], self.length[rows])

    def replaced(self, where: NDArray[np.bool_], others: Self, of_others: NDArray[np.bool_]) -> Self:
        """Put other residues in place of those ``where`` (n, 2): the ``of_others``, in their order."""
        first, length = self.first.copy(), self.length.copy()
        first[where] = len(self.membrane) + others.first[of_others]
        length[where] = others.length[of_others]
        m, b = (np.concatenate(pair) for pair in ((self.membrane, others.membrane), (self.bending, others.bending)))
        return type(self)(m, b, first, length)

    @classmethod
    def of_padded(cls, membrane: NDArray[np.floating], bending: NDArray[np.floating], length: Counts) -> Self:
        """Residues from the fronts of rows (n, 2, r)."""
        kept = np.arange(membrane.shape[2]) < length[..., None]
        first = (np.cumsum(length) - length.ravel()).reshape(length.shape)
        return cls(membrane[kept].astype(np.float64), bending[kept].astype(np.float64), first, length.copy())

    @classmethod
    def joined(cls, parts: Sequence[Self]) -> Self:
        """Points of several blocks, one block after the other."""
        begin = np.cumsum([0, *(len(part.membrane) for part in parts)])
        return cls(
            np.concatenate([part.membrane for part in parts]),
            np.concatenate([part.bending for part in parts]),
            np.concatenate([part.first + n for part, n in zip(parts, begin, strict=False)]),
            np.concatenate([part.length for part in parts]),
        )


def _surface_of_each(length: Counts) -> NDArray[np.intp]:
    return np.repeat(np.arange(length.size), length.ravel())


def residue_of_rows(membrane: Floats, bending: Floats) -> BlockResidue:
    """Residues of membrane + bending and membrane - bending of histories (n, t) [MPa]."""
    length = np.empty((len(membrane), 2), np.int64)
    places = collect_places(membrane, bending, length)
    rows = _surface_of_each(length) // 2
    first = (np.cumsum(length) - length.ravel()).reshape(length.shape)
    return BlockResidue(membrane[rows, places], bending[rows, places], first, length)


def residue_indices(signal: Floats) -> NDArray[np.intp]:
    """Sample indices (r,) of the residue of one signal (t,).

    >>> residue_indices(np.array([-2.0, 1, -3, 5, -1, 3, -4, 4, -2])).tolist()
    [0, 1, 2, 3, 6, 7, 8]
    """
    place = np.empty(signal.size, np.intp)
    return place[: residue_places(signal, signal.size, place)]


@compiled()
def any_beyond(s: NDArray[np.floating], begin: int, end: int, lowest: float, highest: float) -> bool:
    """Whether any of some samples reaches one of two bounds."""
    beyond = np.int32(0)
    for i in range(begin, end):
        beyond |= np.int32(s[i] >= highest) | np.int32(s[i] <= lowest)
    return bool(beyond != 0)


@compiled()
def residue_places(s: NDArray[np.floating], n: int, place: NDArray[np.integer]) -> int:
    """Write the places of the residue among the first n samples, or reversals, to ``place`` and return how many."""
    if n == 0:
        return 0
    highest = lowest = s[0]
    place[0], kept, up = 0, 1, 0
    for begin in range(1, n, AT_ONCE):
        end = min(begin + AT_ONCE, n)
        if not any_beyond(s, begin, end, lowest, highest):
            continue
        for i in range(begin, end):
            if highest > s[i] > lowest:
                continue
            if highest == lowest == s[i]:  # level so far
                place[0] = i
                continue
            direction = 1 if s[i] >= highest else -1
            if direction != up:
                if kept >= 3 and s[place[kept - 1]] == s[place[kept - 3]]:  # the range between them closes now
                    kept -= 2
                kept += 1
            place[kept - 1] = i
            up = direction
            highest, lowest = max(highest, s[i]), min(lowest, s[i])
    return seen_from_end(s, n, place, kept)


@compiled()
def seen_from_end(s: NDArray[np.floating], n: int, place: NDArray[np.integer], kept: int) -> int:
    """Append what follows the last of the extremes that are ``kept``, the last one to exceed all samples before it."""
    last = place[kept - 1]
    if last == n - 1:
        return kept
    behind, up = n - 1, 0  # the chain grows backwards from the end of ``place``, which has room for it
    place[behind] = n - 1
    highest = lowest = s[n - 1]
    for i in range(n - 2, last - 1, -1):
        if highest >= s[i] >= lowest:
            continue
        direction = 1 if s[i] > highest else -1
        behind -= int(direction != up)
        place[behind] = i
        up = direction
        highest, lowest = max(highest, s[i]), min(lowest, s[i])
    for k in range(behind, n):  # the first of these is ``last`` itself
        place[kept - 1 + k - behind] = place[k]
    return int(kept - 1 + n - behind)


@compiled()
def collect_places(membrane: Floats, bending: Floats, length: Counts) -> NDArray[np.intp]:
    """Sample indices of the residues of both surfaces of all rows, one after the other; writes their ``length``."""
    points, samples = membrane.shape
    s, place = np.empty(samples), np.empty(samples, np.intp)
    found = np.empty(64 * points, np.intp)
    total = 0
    for row in range(points):
        for surface in range(2):
            side = 1.0 - 2.0 * surface
            for i in range(samples):
                s[i] = membrane[row, i] + side * bending[row, i]
            n = residue_places(s, samples, place)
            if total + n > found.size:
                more = np.empty(2 * (total + n), np.intp)
                more[:total] = found[:total]
                found = more
            found[total : total + n] = place[:n]
            length[row, surface] = n
            total += n
    return found[:total]
