"""Which points are recounted: the worst of every weld, or of as many welds as do not take all day, and some others."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.layout import Layout

MOST_SAMPLES = 100_000_000  # stress samples that are counted at the worst points: some ten minutes
EQUAL = 1.0 - 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """Points to recount.

    Attributes
    ----------
    points : ascending numbers in the layout
    welds : index of each weld whose worst point is among them, ascending
    what : the choice in words; empty where the worst point of every weld is in it
    """

    points: NDArray[np.int64]
    welds: NDArray[np.int64]
    what: str


def worst_points(body: Layout, toe: NDArray[np.bool_], utilisation: NDArray[np.float64]) -> NDArray[np.int64]:
    """Worst toe point of every weld, of those that are equal but for rounding the first; arrays are (p,)."""
    severity = np.where(toe & ~np.isnan(utilisation), utilisation, -1.0)
    first = 2 * body.first
    return np.array(
        [a + (severity[a:b] >= EQUAL * severity[a:b].max()).argmax() for a, b in pairwise(first)], dtype=np.int64
    )


def choose(
    body: Layout,
    worst: NDArray[np.int64],
    utilisation: NDArray[np.float64],
    named: NDArray[np.int64],
    *,
    sample: int | None,
    seed: int,
    most: int,
) -> Choice:
    """The worst and the named points of every weld, and some drawn from the others.

    Where these are more than ``most`` points it is done for fewer welds: half of them are those with the
    highest utilisation, half are drawn from the others.

    Parameters
    ----------
    body : the points
    worst : worst point of every weld
    utilisation : of every point, (p,)
    named : further points to recount with their weld
    sample : how many others to draw; None: all points
    seed : of what is drawn
    most : how many points there may be, apart from those drawn
    """
    every = np.arange(len(body.welds), dtype=np.int64)
    if sample is None:
        return Choice(np.arange(body.points, dtype=np.int64), every, "")
    rng = np.random.default_rng(seed)
    must = np.union1d(worst, named)
    if len(must) <= most:
        others = _without(must, body.points)
        return Choice(np.union1d(must, others[rng.permutation(len(others))[:sample]]), every, "")

    by_utilisation = np.argsort(-utilisation[worst], kind="stable")
    severe, others = by_utilisation[: most // 2], by_utilisation[most // 2 :]
    welds = np.union1d(severe, rng.permutation(others)[: most - len(severe)])
    others = _without(_of_welds(body, must, welds), body.points)
    drawn = others[rng.permutation(len(others))[:sample]]
    welds = np.union1d(welds, body.weld[drawn // 2]).astype(np.int64)
    what = (
        f"the worst points of {len(welds)} of {len(every)} welds, {len(severe)} with the shortest lives and "
        f"{len(welds) - len(severe)} drawn, and {len(drawn)} other points: all would take long"
    )
    return Choice(np.union1d(_of_welds(body, must, welds), drawn), welds, what)


def groups_of_welds(body: Layout, welds: Sequence[int], modes: int, most: int) -> list[list[int]]:
    """Neighbouring welds in groups that have at most so many forces, stations times modes, or are one weld."""
    stations = np.diff(body.first)
    groups: list[list[int]] = [[]]
    held = 0
    for weld in welds:
        if groups[-1] and held + stations[weld] * modes > most:
            groups.append([])
            held = 0
        groups[-1].append(weld)
        held += int(stations[weld]) * modes
    return groups


def _of_welds(body: Layout, points: NDArray[np.int64], welds: NDArray[np.int64]) -> NDArray[np.int64]:
    return points[np.isin(body.weld[points // 2], welds)]


def _without(points: NDArray[np.int64], among: int) -> NDArray[np.int64]:
    """All numbers below ``among`` that are not in ``points``, ascending."""
    others = np.ones(among, dtype=bool)
    others[points] = False
    return np.flatnonzero(others)
