"""The worst point of every weld of a group, which alone decides its verdict."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.solve.stations import Stations

HistogramPoints = Literal["worst", "all", "none"]  # each weld's worst and those above a share; all counted; none

ABOVE = 0.1  # of the damage limit: a histogram is kept of toe points from there on, and of each weld's worst one
EQUAL = 1.0 - 1e-12  # what is so close to the worst point is as bad: only the order of sums differs


@dataclass(frozen=True, slots=True)
class WorstPoint:
    """The toe point of a weld with the shortest life: index of weld, station and face."""

    weld: int
    station: int
    face: int


def worst_points(stations: Stations, result: GroupResult) -> tuple[WorstPoint, ...]:
    """The worst toe point of every weld; the first along the line where several are equal.

    A point that a bound has settled is never worse than the worst one that was counted.
    """
    counted = (result.tier == 0)[:, None]
    utilisation = np.where(counted & stations.toe, result.mission.utilisation, -1.0)
    worst = []
    for weld, (first, end) in enumerate(pairwise(stations.first.tolist())):
        of_weld = utilisation[first:end]
        at, face = divmod(int((of_weld >= EQUAL * of_weld.max()).argmax()), 2)
        worst.append(WorstPoint(weld, first + at, face))
    return tuple(worst)


def histogram_points(
    stations: Stations, result: GroupResult, worst: Sequence[WorstPoint], *, everything: bool
) -> list[WorstPoint]:
    """The points of some welds whose histograms are kept, along the lines: counted ones only.

    ``worst`` are the worst toe points of the welds. A face without a toe is kept with ``everything`` only.
    """
    counted = np.repeat((result.tier == 0)[:, None], 2, axis=1)
    if not everything:
        counted &= stations.toe & (result.mission.utilisation >= ABOVE)
        counted[[point.station for point in worst], [point.face for point in worst]] = True
    return [WorstPoint(int(stations.weld[at]), int(at), int(face)) for at, face in np.argwhere(counted)]
