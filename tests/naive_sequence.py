"""Cycles across events, slow and obviously right: passes are put one behind the other and counted as one record."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
import rainflow
from numpy.typing import NDArray

from tests import naive

Floats = NDArray[np.float64]


def damage_repeat(signal: Sequence[float], k: float) -> float:
    """``sum n S^k`` of a block that recurs: the `rainflow` package on the block turned to its maximum and closed."""
    s = np.asarray(signal, dtype=float)
    if len(np.unique(s)) < 2:
        return 0.0
    turned = np.roll(s, -int(s.argmax()))
    return sum(n * S**k for S, n in rainflow.count_cycles(np.append(turned, turned[0])))


def damage_half(signal: Sequence[float], k: float) -> float:
    """``sum n S^k`` of a single pass; two samples, which the `rainflow` package leaves out, are half a cycle."""
    s = np.asarray(signal, dtype=float)
    if len(s) == 2:
        return 0.5 * abs(s[1] - s[0]) ** k
    return sum(n * S**k for S, n in rainflow.count_cycles(s)) if len(np.unique(s)) > 1 else 0.0


def residue(signal: Sequence[float]) -> list[float]:
    """What four-point counting leaves of a signal; a constant one leaves one point."""
    _, rest = naive.four_point(naive.turning_points(signal))
    return [x for _, x in rest] or list(signal[:1])


def transitions(
    events: Mapping[str, Sequence[float]], half: Mapping[str, bool], order: Sequence[str], k: float
) -> float:
    """What one run of a loop adds, by the explicit record of one pass for each stint."""
    record = [x for name in order for x in events[name]]
    alone = [(damage_half if half[name] else damage_repeat)(events[name], k) for name in order]
    return damage_repeat(record, k) - sum(alone)


def pairing_sum(residues: Sequence[tuple[Sequence[float], float]], k: float) -> float:
    """``sum weight x S^k`` of the peaks and valleys of residues, the highest with the lowest, and so on."""
    peaks: list[list[float]] = []
    valleys: list[list[float]] = []
    for values, weight in residues:
        padded = [values[0], *values, values[-1]]
        for (before, x), (_, behind) in pairwise(pairwise(padded)):
            if x >= before and x >= behind:
                peaks.append([x, weight])
            if x <= before and x <= behind:
                valleys.append([x, weight])
    peaks.sort(key=lambda p: -p[0])
    valleys.sort(key=lambda v: v[0])
    total = 0.0
    while peaks and valleys and peaks[0][0] > valleys[0][0]:
        weight = min(peaks[0][1], valleys[0][1])
        total += weight * (peaks[0][0] - valleys[0][0]) ** k
        for side in (peaks, valleys):
            side[0][1] -= weight
            if side[0][1] <= 0:
                side.pop(0)
    return total
