"""Weld lines that lie on each other, as far as their geometry tells: proposals for welds that have no common name."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fatigue.decide.compare.finished import Finished

Floats = NDArray[np.float64]

NEAR_MM = 5.0  # between every point of either line and the other line
LENGTH = 0.05  # relative difference of their lengths
EQUAL_MM = 1e-3  # of two distances: more than one weld may lie on the same nodes
AT_ONCE = 2_000_000  # distances from points to edges held together


@dataclass(frozen=True, slots=True)
class Proposal:
    """Two welds whose lines lie on each other [mm]; ``others`` are welds of either result that do so as well."""

    weld: str
    other_weld: str
    distance_mm: float
    others: tuple[str, ...] = ()


def proposals(a: Finished, b: Finished, of_a: Sequence[str], of_b: Sequence[str]) -> list[Proposal]:
    """Welds, of some of either result, that are mutually nearest within ``NEAR_MM`` and of equal length.

    Where several welds lie on the same line, plate thickness and faces with a toe decide; where these are the same,
    too, the proposal names the ``others`` and is none to be used.
    """
    if not of_a or not of_b:
        return []
    mine, theirs = _lines(a, of_a), _lines(b, of_b)
    boxes = [np.stack([np.concatenate([xyz.min(0), xyz.max(0)]) for xyz in lines]) for lines in (mine, theirs)]
    near = cKDTree(boxes[0]).query_ball_tree(cKDTree(boxes[1]), NEAR_MM, p=np.inf)
    lengths = [one.welds["length_mm"].reindex(welds).to_numpy() for one, welds in ((a, of_a), (b, of_b))]
    from_a: dict[int, dict[int, float]] = {}
    from_b: dict[int, dict[int, float]] = {}
    for i, j in ((i, j) for i, some in enumerate(near) for j in some):
        if abs(lengths[0][i] - lengths[1][j]) <= LENGTH * max(lengths[0][i], lengths[1][j]):
            apart = max(to_line(mine[i], theirs[j]), to_line(theirs[j], mine[i]))
            if apart <= NEAR_MM:
                from_a.setdefault(i, {})[j] = from_b.setdefault(j, {})[i] = apart
    kinds_a, kinds_b = _kinds(a, of_a), _kinds(b, of_b)
    found = []
    for i, distance in from_a.items():
        best = _nearest(distance, kinds_a[i], kinds_b)
        back = {k for j in best for k in _nearest(from_b[j], kinds_b[j], kinds_a)}
        if i in back:
            others = (*(of_b[k] for k in best[1:]), *(of_a[k] for k in sorted(back - {i})))
            found.append(Proposal(of_a[i], of_b[best[0]], distance[best[0]], others))
    return found


def _nearest(distance: Mapping[int, float], kind: object, kinds: Sequence[object]) -> list[int]:
    """Those at the least distance; where there are several, those of the same kind if there is any."""
    least = min(distance.values())
    equal = [j for j, d in distance.items() if d <= least + EQUAL_MM]
    return [j for j in equal if kinds[j] == kind] or equal


def to_line(points: Floats, line: Floats) -> float:
    """Largest distance of some points (p, 3) from a line through others (n, 3) [mm].

    >>> to_line(np.array([[5.0, 3.0, 0.0]]), np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]]))
    3.0
    """
    start, edge = (line, np.zeros_like(line)) if len(line) == 1 else (line[:-1], np.diff(line, axis=0))
    square = np.einsum("ij,ij->i", edge, edge)
    at_once, largest = max(1, AT_ONCE // len(start)), 0.0
    for first in range(0, len(points), at_once):
        away = points[first : first + at_once, None] - start
        along = np.divide(np.einsum("pij,ij->pi", away, edge), square, out=np.zeros(away.shape[:2]), where=square > 0.0)
        away -= np.clip(along, 0.0, 1.0)[..., None] * edge
        largest = max(largest, float(np.sqrt(np.einsum("pij,pij->pi", away, away).min(axis=1)).max()))
    return largest


def _lines(of: Finished, welds: Sequence[str]) -> list[Floats]:
    """Points of some lines in their order, the first once more at the end of a closed one, (n, 3) each [mm]."""
    points, here = of.points, of.points.stations
    rows = np.lexsort((points.order[here], points.part[here], points.weld[here]))
    number = {name: i for i, name in enumerate(points.names)}
    begin = np.searchsorted(points.weld[here][rows], np.arange(len(points.names) + 1))
    lines = [points.xyz[rows[begin[i] : begin[i + 1]]] for i in (number[weld] for weld in welds)]
    closed = of.welds["closed"].reindex(welds)
    return [np.vstack([xyz, xyz[:1]]) if is_closed else xyz for xyz, is_closed in zip(lines, closed, strict=True)]


def _kinds(of: Finished, welds: Sequence[str]) -> list[object]:
    """What tells welds on one line apart: plate thickness, and the faces with a toe."""
    return [
        *of.welds.loc[list(welds), ["thickness_min_mm", "thickness_max_mm", "surface"]].itertuples(
            index=False, name=None
        )
    ]
