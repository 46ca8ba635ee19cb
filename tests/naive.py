"""Slow, obviously right rainflow counting and damage, written from the rules and not from the program."""

from itertools import groupby, pairwise
from math import isclose, nan

import numpy as np
from numpy.typing import ArrayLike

from fatigue.life.curves import DamageLaw

Point = tuple[int, float]  # sample index, value
Cycle = tuple[int, int, float]  # sample indices of the two reversals, count


def turning_points(signal: ArrayLike) -> list[Point]:
    """Keep the ends and the local extremes; a plateau counts as its last sample, at the beginning as its first."""
    values = [float(x) for x in np.asarray(signal, dtype=float)]
    plateaus = [list(group) for _, group in groupby(enumerate(values), key=lambda point: point[1])]
    if len(plateaus) < 2:
        return []
    points = [plateaus[0][0], *(plateau[-1] for plateau in plateaus[1:])]
    inner = [b for (before, b), (_, after) in pairwise(pairwise(points)) if (b[1] > before[1]) == (b[1] > after[1])]
    return [points[0], *inner, points[-1]]


def four_point(points: list[Point]) -> tuple[list[tuple[Point, Point]], list[Point]]:
    """Take out inner ranges that are not larger than both neighbours until none is left: closed cycles and residue."""
    rest, closed = list(points), []
    found = True
    while found:
        found = False
        for k in range(len(rest) - 3):
            a, b, c, d = (x for _, x in rest[k : k + 4])
            if abs(c - b) <= abs(b - a) and abs(c - b) <= abs(d - c):
                closed.append((rest[k + 1], rest[k + 2]))
                del rest[k + 1 : k + 3]
                found = True
                break
    return closed, rest


def cycles(signal: ArrayLike, residue: str) -> list[Cycle]:
    """Count closed cycles whole and the residue as half cycles; a recurring block from its maximum to the next one."""
    s = np.asarray(signal, dtype=float)
    first, path = 0, s
    if residue == "repeat" and s.size:
        first = next(i for i in range(int(s.argmax()), s.size) if i + 1 == s.size or s[i + 1] < s.max())
        path = np.append(np.roll(s, -first), s[first])
    closed, rest = four_point(turning_points(path))
    pairs = [(a, b, 1.0) for a, b in closed] + [(a, b, 0.5) for a, b in pairwise(rest)]
    return [((first + a[0]) % s.size, (first + b[0]) % s.size, n) for a, b, n in pairs]


def spectrum(found: list[Cycle], signal: ArrayLike) -> dict[tuple[float, float], float]:
    """Add up the counts by range and mean."""
    s = np.asarray(signal, dtype=float)
    totals: dict[tuple[float, float], float] = {}
    for i, j, n in found:
        key = (float(abs(s[i] - s[j])), float(s[i] + s[j]) / 2)
        totals[key] = totals.get(key, 0.0) + n
    return totals


def ratio_factor(r: float) -> float:
    """I(r)^(1/m) of ASME VIII-2 5.5.5.2."""
    return (1.23 - 0.364 * r - 0.17 * r * r) / (1.007 - 0.306 * r - 0.178 * r * r)


def damage_of(x: float, law: DamageLaw) -> float:
    """Damage of one cycle: the segment is the first whose lower knee is not above x."""
    if x < law.cutoff:
        return 0.0
    segment = next((j for j, knee in enumerate(law.knees) if x >= knee), len(law.knees))
    return float(x ** law.slopes[segment] / np.exp(law.log_constants[segment]))


def surface_count(
    membrane: ArrayLike,
    bending: ArrayLike,
    size: float,
    same_ratio: float,
    law: DamageLaw,
    *,
    uses_bending_ratio: bool,
    residue: str,
    yield_MPa: float | None,
    mean_stress: bool,
) -> dict[str, float]:
    """Evaluate every cycle of membrane + bending on its own, after ASME VIII-2 5.5.5.2 and Palmgren-Miner."""
    m, b = np.asarray(membrane, dtype=float), np.asarray(bending, dtype=float)
    s = m + b
    total = dict.fromkeys(("damage", "damage_same_ratio", "damage_mean_stress", "cycles", "power_sum"), 0.0)
    total |= {"max_range": 0.0, "r_largest": nan, "max_equivalent_range": 0.0, "dS_power_sum": 0.0}
    for i, j, n in cycles(s, residue):
        low, high = min(s[i], s[j]), max(s[i], s[j])
        S, dm, db = high - low, abs(m[i] - m[j]), abs(b[i] - b[j])
        x = S * size / ratio_factor(db / (dm + db)) if uses_bending_ratio else S * size
        f_M = 1.0
        if yield_MPa is not None and (low + high) / 2 >= yield_MPa / 2 and low > 0 and high - low <= 2 * yield_MPa:
            f_M = (1 - low / high) ** (1 / 3.6)
        dS = x / f_M if mean_stress else x
        total["damage"] += n * damage_of(dS, law)
        total["damage_mean_stress"] += n * damage_of(x / f_M, law) if yield_MPa is not None else nan
        total["damage_same_ratio"] += n * damage_of(
            S * size / (ratio_factor(same_ratio) if uses_bending_ratio else 1.0), law
        )
        total["cycles"] += n
        total["power_sum"] += n * S ** law.slopes[0]
        total["dS_power_sum"] += n * dS ** law.slopes[0]
        total["max_equivalent_range"] = max(total["max_equivalent_range"], dS)
        if total["max_range"] < S and not isclose(S, total["max_range"], rel_tol=1e-14):
            total["max_range"], total["r_largest"] = S, low / high if high != 0 else nan
    return total


def at_vertices(
    membrane: ArrayLike, bending: ArrayLike, side: float, residue: str
) -> tuple[list[float], list[float], list[float]]:
    """Membrane and bending stress with each reversal at its vertex, and its shift: by the parabola as it is fitted."""
    m, b = (np.asarray(x, dtype=float) for x in (membrane, bending))
    s, t = m + side * b, len(m)
    moved_m, moved_b, shifts = m.tolist(), b.tolist(), [0.0] * t
    inner = range(t) if residue == "repeat" else range(1, t - 1)
    for i in inner:
        three = [(i - 1) % t, i, (i + 1) % t]
        before, here, after = s[three]
        if not (here > max(before, after) or here < min(before, after)):
            continue
        second, first, _ = np.polyfit([-1.0, 0.0, 1.0], s[three], 2)
        p = -first / (2.0 * second)
        shifts[i] = p
        moved_m[i] = float(np.polyval(np.polyfit([-1.0, 0.0, 1.0], m[three], 2), p))
        moved_b[i] = float(np.polyval(np.polyfit([-1.0, 0.0, 1.0], b[three], 2), p))
    return moved_m, moved_b, shifts
