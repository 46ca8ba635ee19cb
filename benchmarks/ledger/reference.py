"""What is right, written as the standard reads and sharing no code with anybody who is measured."""

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from benchmarks.ledger.signals import FlatBand

Floats = NDArray[np.float64]


def turning_points(x: Floats) -> list[float]:
    """First sample, every sample where the direction changes, last sample; plateaus are one sample."""
    moving = x[np.append(True, np.diff(x) != 0)]
    turns = np.ones(moving.size, np.bool_)
    turns[1:-1] = np.diff(np.sign(np.diff(moving))) != 0
    points: list[float] = moving[turns].tolist()
    return points


def half_cycles(x: Floats) -> Floats:
    """Ranges of ASTM E1049-85, 5.4.4, ascending: a full cycle stands twice, a half cycle once."""
    stack: list[float] = []
    ranges: list[float] = []
    for point in turning_points(x):
        stack.append(point)
        while len(stack) >= 3:
            X, Y = abs(stack[-1] - stack[-2]), abs(stack[-2] - stack[-3])
            if X < Y:
                break
            if len(stack) == 3:  # Y contains the start
                ranges.append(Y)
                stack.pop(0)
            else:
                ranges += [Y, Y]
                del stack[-3:-1]
    ranges += [abs(b - a) for a, b in pairwise(stack)]
    return np.sort(np.array(ranges))


def closed_cycles(x: Floats) -> Floats:
    """Ranges of ASTM E1049-85, 5.4.5, ascending, each of them twice: begun at its largest sample, the block recurs."""
    first = int(np.argmax(x))
    return half_cycles(np.concatenate([x[first:], x[: first + 1]]))


def power_sum(halves: Floats, k: float) -> float:
    """``sum n S^k`` of ranges that stand once for a half cycle, rounded once at the end."""
    return 0.5 * math.fsum(S**k for S in halves.tolist())


def dirlik(band: FlatBand, k: float) -> float:
    """Sum of ``(2 a)^k`` over the cycles of one second, a their amplitude, by Dirlik (1985), for one spectrum."""
    m0, m1, m2, m4 = (band.moment(order) for order in (0, 1, 2, 4))
    gamma = m2 / math.sqrt(m0 * m4)
    xm = m1 / m0 * math.sqrt(m2 / m4)
    d1 = 2.0 * (xm - gamma**2) / (1.0 + gamma**2)
    r = (gamma - xm - d1**2) / (1.0 - gamma - d1 + d1**2)
    d2 = (1.0 - gamma - d1 + d1**2) / (1.0 - r)
    d3 = 1.0 - d1 - d2
    q = 1.25 * (gamma - d3 - d2 * r) / d1
    rayleigh = 2.0 ** (k / 2) * math.gamma(1.0 + k / 2)
    per_peak = d1 * q**k * math.gamma(1.0 + k) + rayleigh * (d2 * abs(r) ** k + d3)
    return math.sqrt(m4 / m2) * (2.0 * math.sqrt(m0)) ** k * per_peak


def tovo_benasciutti(band: FlatBand, k: float) -> float:
    """The same by Benasciutti and Tovo (2005)."""
    m0, m1, m2, m4 = (band.moment(order) for order in (0, 1, 2, 4))
    a1, a2 = m1 / math.sqrt(m0 * m2), m2 / math.sqrt(m0 * m4)
    b = (a1 - a2) * (1.112 * (1.0 + a1 * a2 - (a1 + a2)) * math.exp(2.11 * a2) + (a1 - a2)) / (a2 - 1.0) ** 2
    narrow = math.sqrt(m2 / m0) * (2.0 * math.sqrt(2.0 * m0)) ** k * math.gamma(1.0 + k / 2)
    return narrow * (b + (1.0 - b) * a2 ** (k - 1.0))
