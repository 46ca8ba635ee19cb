"""The worst toe point of every weld under a variant, with no more points counted again than its verdict needs."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fatigue.pipeline.count.worst import EQUAL
from fatigue.pipeline.sensitivity.closed import Floats, Varied
from fatigue.results.dictionary.sensitivity import BASES, BOUND, COUNTED, EXACT, RECOUNT, UNDECIDED

Again = Callable[[NDArray[np.intp]], Floats | None]  # utilisation (r, 2) of some stations; None: not to be had

CLOSE = 0.1  # utilisations from there to its reciprocal are worth their number
MOST_STATIONS = 64  # of a weld that are counted again; its verdict may be undecided then
FEW_STATIONS = 8  # the same for a number where its verdict is known to stay
NOWHERE = -1
OPEN = -1  # of ``fulfilled``: undecided


@dataclass(frozen=True, slots=True)
class Weld:
    """A weld under a variant: utilisation, whether the target is met (1, 0 or ``OPEN``), and what that rests on.

    ``station`` and ``face`` are of the point that decides, ``NOWHERE`` where a bound does; ``recounted`` stations were
    counted again.
    """

    utilisation: float
    fulfilled: int
    station: int
    face: int
    basis: int
    recounted: int = 0


def worst_of_welds(
    varied: Varied,
    toe: NDArray[np.bool_],
    first: NDArray[np.intp],
    utilisation: Floats,
    again: Again | None = None,
    few: int = FEW_STATIONS,
) -> list[Weld]:
    """Every weld under a variant.

    Parameters
    ----------
    varied : what is known of the stations
    toe : (n, 2) faces that carry a weld toe; no other one governs
    first : (w + 1,) first station of each weld, and their number
    utilisation : (n, 2) as it was assessed
    again : counts stations again; None: nothing can be
    few : stations of a weld that are worth counting for a better number, where its verdict is known to stay
    """
    exact = np.where(toe, varied.exact, -1.0)
    lower = np.where(toe, 0.0 if varied.lower is None else varied.lower, 0.0)
    upper = np.where(np.isnan(exact), varied.upper, -1.0)
    done = np.zeros(len(toe), dtype=np.intp)  # how often each station was counted again
    if again is not None:
        _count_what_may_decide(
            exact, lower, upper, done, first, np.where(toe, utilisation, -1.0).max(axis=1), again, few
        )
    found = []
    for a, b in pairwise(first.tolist()):
        recounted = int(done[a:b].sum())
        judged = _judged(exact[a:b], float(lower[a:b].max(initial=0.0)), upper[a:b], a, recounted)
        if varied.tells_counted and BASES[judged.basis] == BOUND and judged.fulfilled:
            judged = _counted(judged, exact[a:b], a)
        found.append(judged)
    return found


def _count_what_may_decide(
    exact: Floats,
    lower: Floats,
    upper: Floats,
    done: NDArray[np.intp],
    first: NDArray[np.intp],
    assessed: Floats,
    again: Again,
    few: int,
) -> None:
    """Count stations again, those with the largest upper bounds first, twice as many in each round.

    ``exact`` is filled, and ``upper`` with it. A weld needs no more once its worst point is known. ``assessed`` (n,) is
    the utilisation of each station as it was assessed.
    """
    at_once = 1
    while True:
        wanted = []
        for a, b in pairwise(first.tolist()):
            best, rest = _largest(exact[a:b]), float(upper[a:b].max(initial=-1.0))
            known = max(best, float(lower[a:b].max(initial=0.0)))
            left = _worth(known, rest, float(assessed[a:b].max()), few) - int(done[a:b].sum())
            if left <= 0 or best >= rest:
                continue
            of_station = upper[a:b].max(axis=1)
            order = np.lexsort((-assessed[a:b], -of_station))
            order = order[of_station[order] > max(best, 0.0)]
            wanted += (a + order[: min(at_once, left)]).tolist()
        if not wanted:
            return
        rows = np.array(sorted(wanted), dtype=np.intp)
        value = again(rows)
        if value is None:
            return
        exact[rows] = np.where(exact[rows] == -1.0, -1.0, value)  # a face without a toe never governs
        upper[rows] = -1.0
        done[rows] += 1
        at_once *= 2


def _worth(best: float, rest: float, assessed: float, few: int) -> int:
    """How many stations are worth counting for a weld with this largest count and largest bound of the others.

    Where the verdict stays what it was a better number is worth a few, if it is close to another verdict and may be
    worse than the one assessed.
    """
    stays = best > 1.0 if assessed > 1.0 else max(best, rest) <= 1.0
    if not stays:
        return MOST_STATIONS
    is_close = best < 1.0 / CLOSE if assessed > 1.0 else max(best, rest) > CLOSE and rest > assessed
    return few if is_close else 0


def _largest(exact: Floats) -> float:
    return float(np.nanmax(exact, initial=-1.0))


def _judged(exact: Floats, lower: float, upper: Floats, first: int, recounted: int) -> Weld:
    """A weld whose points are known to be ``exact``, or else to lie below ``upper``, and the worst above ``lower``."""
    best, rest = _largest(exact), float(upper.max(initial=-1.0))
    if best >= rest:
        value, basis = max(best, 0.0), BASES.index(RECOUNT if recounted else EXACT)
        return Weld(value, int(value <= 1.0), *_place(exact, first), basis, recounted)
    at_least = max(best, lower)
    if at_least > 1.0:
        return Weld(at_least, 0, NOWHERE, NOWHERE, BASES.index(BOUND), recounted)
    if rest <= 1.0:
        return Weld(rest, 1, NOWHERE, NOWHERE, BASES.index(BOUND), recounted)
    return Weld(at_least, OPEN, NOWHERE, NOWHERE, BASES.index(UNDECIDED), recounted)


def _counted(judged: Weld, exact: Floats, first: int) -> Weld:
    """The same weld, which meets its target, with the largest number that is known in place of a bound."""
    best = _largest(exact)
    return judged if best < 0.0 else Weld(best, 1, *_place(exact, first), BASES.index(COUNTED), judged.recounted)


def _place(exact: Floats, first: int) -> tuple[int, int]:
    """Station and face of the largest number that is known, the first of equal ones; ``NOWHERE`` without any."""
    best = _largest(exact)
    if best < 0.0:
        return NOWHERE, NOWHERE
    station, face = divmod(int((exact >= EQUAL * best).argmax()), 2)
    return first + station, face
