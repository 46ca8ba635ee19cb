"""What cycles across events do at most where nobody knows in which order they follow on one another.

The open reversals of all events are paired, the highest peak with the lowest valley first (ground-air-ground).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.cycles import RecountCycles, count_cycles
from fatigue.verify.recount.anew.turns import Turns

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]

HALF = 0.5


def open_and_closed(turns: Turns) -> tuple[Counts, RecountCycles]:
    """Places of the reversals that four-point counting leaves open, in time order, and the cycles that it closes.

    A pass counted once leaves the open ones as half cycles, from each to the next; ranges that are equal it takes for
    half cycles as well, and they close.
    """
    found = count_cycles(turns.stress, recurs=False)
    half, closed = found.count == HALF, found.count != HALF
    chain = np.append(found.start[half], found.end[half][-1:]).tolist() or [len(turns.time) - 1]
    s, open_, equal = turns.stress, [], []
    for place in chain:
        open_.append(place)
        while len(open_) > 3 and _closes(*s[open_[-4:]]):
            equal.append(open_[-3:-1])
            del open_[-3:-1]
    start, end = np.array(equal, dtype=np.int64).reshape(-1, 2).T
    cycles = np.concatenate([found.start[closed], start]), np.concatenate([found.end[closed], end])
    return np.array(open_), RecountCycles(*cycles, np.ones(len(cycles[0])))


def _closes(a: float, b: float, c: float, d: float) -> bool:
    """Whether the middle one of three ranges is not above the other two."""
    return bool(abs(c - b) <= min(abs(b - a), abs(d - c)))


def paired(residues: Sequence[Floats], weights: Sequence[float]) -> tuple[Floats, Floats]:
    """Ranges [MPa] of the paired peaks and valleys, and how often each pair occurs.

    ``residues`` are the open reversals of events that occur with these weights.
    """
    peaks: list[tuple[float, float]] = []
    valleys: list[tuple[float, float]] = []
    for residue, weight in zip(residues, weights, strict=True):
        is_peak, is_valley = _kinds(residue)
        peaks += [(float(s), weight) for s in residue[is_peak]]
        valleys += [(-float(s), weight) for s in residue[is_valley]]
    peaks.sort()
    valleys.sort()
    ranges, counts = [], []
    while peaks and valleys and peaks[-1][0] + valleys[-1][0] > 0.0:  # the highest and the lowest that are left
        (peak, of_peak), (minus_valley, of_valley) = peaks.pop(), valleys.pop()
        some = min(of_peak, of_valley)
        ranges.append(peak + minus_valley)
        counts.append(some)
        peaks += [(peak, of_peak - some)] if of_peak > some else []
        valleys += [(minus_valley, of_valley - some)] if of_valley > some else []
    return np.array(ranges), np.array(counts)


def _kinds(residue: Floats) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether each open reversal is a peak, and a valley: by its neighbour; a single one is both."""
    if len(residue) == 1:
        return np.ones(1, dtype=bool), np.ones(1, dtype=bool)
    rises = np.diff(residue) > 0.0
    is_peak = np.append(~rises[0], rises)
    return is_peak, ~is_peak
