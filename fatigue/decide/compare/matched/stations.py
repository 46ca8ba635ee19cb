"""Stations of the matched welds of two results that are at the same place, or nearest to each other."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fatigue.decide.compare.finished import Ints, Points

Floats = NDArray[np.float64]

SAME_MM = 1e-3  # between stations at one place
INWARD_MM = 10.0 * SAME_MM  # by which ends are moved into their parts, so that two legs of a kink stay apart
FINER = 0.5  # of the finer spacing: further away a station stands for another place


@dataclass(frozen=True, slots=True, eq=False)
class MatchedStations:
    """Stations of the first result and what the other has nearest, s of them.

    Attributes
    ----------
    first, second : (s,) numbers of the stations
    distance : (s,) between them [mm]
    comparable : (s,) whether they are within half the finer spacing of the two lines there
    """

    first: Ints
    second: Ints
    distance: Floats
    comparable: NDArray[np.bool_]


def match_stations(a: Points, b: Points, partner: Ints) -> MatchedStations:
    """The station of the other result for every station of a matched weld; ``partner`` (w,) numbers of welds, or -1.

    The station of the same part and order where it is at the same place, else the nearest one of the matched weld: so
    nodes may be numbered anew and lines run the other way.
    """
    weld_of_b = partner[a.weld[a.stations]]
    first = np.flatnonzero(weld_of_b >= 0)
    weld = weld_of_b[first]
    there = pd.MultiIndex.from_arrays([b.weld[b.stations], b.part[b.stations], b.order[b.stations]])
    wanted = pd.MultiIndex.from_arrays([weld, a.part[a.stations][first], a.order[a.stations][first]])
    second = there.get_indexer(wanted).astype(np.int64)
    known = second >= 0
    mine, theirs = (one.xyz + INWARD_MM * _inward(one) for one in (a, b))
    known[known] = np.linalg.norm(mine[first[known]] - theirs[second[known]], axis=1) <= SAME_MM
    if not known.all():
        second[~known] = _nearest(mine[first[~known]], theirs, weld[~known], b.weld[b.stations])
    distance = np.linalg.norm(a.xyz[first] - b.xyz[second], axis=1)
    finer = np.fmin(spacing(a)[first], spacing(b)[second])
    comparable = distance <= np.fmax(SAME_MM, FINER * np.nan_to_num(finer))
    return MatchedStations(first, second, distance, comparable)


def _nearest(mine: Floats, theirs: Floats, weld: Ints, weld_there: Ints) -> Ints:
    """Nearest places on the matched welds; these lie apart in a fourth dimension, so that one tree serves all."""
    apart = 10.0 * float(np.ptp(np.vstack([mine, theirs]), axis=0).max()) + 1.0
    tree = cKDTree(np.column_stack([theirs, apart * weld_there]))
    return np.asarray(tree.query(np.column_stack([mine, apart * weld]))[1], np.int64)


def spacing(points: Points) -> Floats:
    """Length of the shorter edge at every station (s,) [mm]; NaN of a line of one station."""
    rows, edge = _edges(points)
    length = np.full(len(edge) + 2, np.nan)
    length[1:-1] = np.where(_same_line(points, rows), np.linalg.norm(edge, axis=1), np.nan)
    found = np.empty(len(rows))
    found[rows] = np.fmin(length[:-1], length[1:])
    return found


def _inward(points: Points) -> Floats:
    """Unit vectors from the ends of all parts into them, (s, 3); 0 at other stations."""
    rows, edge = _edges(points)
    length = np.linalg.norm(edge, axis=1, keepdims=True)
    unit = np.divide(edge, length, out=np.zeros_like(edge), where=length > 0.0)
    same = _same_line(points, rows)
    before, behind = np.append(False, same), np.append(same, False)
    padded = np.vstack([np.zeros(3), unit, np.zeros(3)])
    towards = np.where((behind & ~before)[:, None], padded[1:], 0.0)
    found = np.empty_like(towards)
    found[rows] = np.where((before & ~behind)[:, None], -padded[:-1], towards)
    return found


def _edges(points: Points) -> tuple[Ints, Floats]:
    """Stations in the order of their lines (s,), and from each of them to the next (s - 1, 3) [mm]."""
    here = points.stations
    rows = np.lexsort((points.order[here], points.part[here], points.weld[here]))
    return rows, np.diff(points.xyz[rows], axis=0)


def _same_line(points: Points, rows: Ints) -> NDArray[np.bool_]:
    """Whether neighbouring stations belong to one part of one weld, (s - 1,)."""
    weld, part = points.weld[points.stations][rows], points.part[points.stations][rows]
    return np.asarray((weld[1:] == weld[:-1]) & (part[1:] == part[:-1]))
