"""Cycles across events: what a known order of events adds to the damage of its passes, and what no order exceeds.

Every event is counted as if it followed on itself. Where another event follows, some of its cycles do not close, and
others close across events. All of them are cycles of residues (``counting.residue``), so that one run of a loop of
stints ``e_1 ... e_n`` adds

    T = rep( res(e_1) res(e_2) ... res(e_n) ) - sum_j own(e_j),     own(e) = rep(res(e)), or half(res(e)) if e is half,

however many passes a stint has. T may be negative: [5, -5] and [-5, 5] are one cycle in turn, and two apart.

Where only the number w_e of stints is known, the highest peak of all residues is paired with the lowest valley, each as
often as it occurs, and so on: sorted pairs cross every interval of stress at least as often as any order of
these reversals, so their damage is no lower for a damage d_1 that is convex.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.counting.block import BlockStress
from fatigue.life.counting.factors import add_trials, trials
from fatigue.life.counting.residue import BlockResidue
from fatigue.life.counting.reversals import find_cycles
from fatigue.life.counting.tally import SurfaceCycles, nothing_counted, plain, tally
from fatigue.life.curves import DamageLaw
from fatigue.life.rule import M_SS, CycleRule, equivalent_range

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]
Indices = NDArray[np.intp]

AT_ONCE = 4096  # points whose cycles are listed at a time

_DIFFERENCES = ("damage", "damage_mean_stress", "cycles", "power_sum")


class Residues(NamedTuple):
    """Residues of e events at n points, their constant stresses kept apart.

    ``membrane``, ``bending`` (r,) are the stresses at all reversals; ``first`` and ``length`` (e, n, 2) say which are
    of an event, a point and a surface; ``constant_m``, ``constant_b`` (e, n) are added to them [MPa]; ``half`` (e,)
    says whose own residues are half cycles.
    """

    membrane: Floats
    bending: Floats
    first: Counts
    length: Counts
    constant_m: Floats
    constant_b: Floats
    half: NDArray[np.bool_]

    def at(self, rows: slice | NDArray[np.intp]) -> Self:
        """Take some points."""
        of_points = {name: getattr(self, name)[:, rows] for name in ("first", "length", "constant_m", "constant_b")}
        return self._replace(**of_points)


@dataclass(frozen=True, slots=True, eq=False)
class LoopCount:
    """What one run of a loop adds to n points; arrays are (n, 2), top and bottom surface.

    ``damage``, ``damage_mean_stress``, ``cycles``, ``power_sum`` and ``histogram`` are as in ``BlockCount``: of the
    cycles that close in the loop, less those of each event by itself. ``max_range``, ``r_largest`` and
    ``max_equivalent_range`` are of the cycles that close.
    """

    damage: Floats
    damage_mean_stress: Floats
    cycles: Floats
    power_sum: Floats
    max_range: Floats
    r_largest: Floats
    max_equivalent_range: Floats
    histogram: Floats


def residues_of(
    events: list[BlockResidue], constant_m: list[Floats], constant_b: list[Floats], half: list[bool]
) -> Residues:
    """Put the residues of some events side by side; ``constant_m``, ``constant_b`` (n,) are of each event [MPa]."""
    begin = np.cumsum([0, *(len(one.membrane) for one in events)])
    return Residues(
        np.concatenate([one.membrane for one in events]),
        np.concatenate([one.bending for one in events]),
        np.stack([one.first + n for one, n in zip(events, begin, strict=False)]),
        np.stack([one.length for one in events]),
        np.stack(constant_m),
        np.stack(constant_b),
        np.array(half, np.bool_),
    )


def count_loop(residues: Residues, order: tuple[int, ...], size: Floats, rule: CycleRule) -> LoopCount:
    """Count one run of a loop at n points of the thickness factors ``size`` (n,); ``order`` has numbers of events."""
    closing, replaced = (nothing_counted(len(size), rule.law) for _ in range(2))
    for some, of_some in _some_points(residues):
        stress = _sized(size[some])
        tally(_cycles(of_some, order, recurs=True), stress, rule, closing.at(some), samples=1)
        for event in order:
            own = _cycles(of_some, (event,), recurs=not of_some.half[event])
            tally(own, stress, rule, replaced.at(some), samples=1)
    difference = {name: closing.totals[name] - replaced.totals[name] for name in _DIFFERENCES}
    if rule.yield_MPa is None:
        difference["damage_mean_stress"] = np.full((len(size), 2), np.nan)
    return LoopCount(
        **difference,
        max_range=closing.totals["max_range"].copy(),
        r_largest=closing.totals["r_largest"].copy(),
        max_equivalent_range=closing.totals["max_equivalent_range"].copy(),
        histogram=closing.histogram - replaced.histogram,
    )


def loop_at_factors(
    residues: Residues, order: tuple[int, ...], size: Floats, rule: CycleRule, first: Floats, step: Floats, factors: int
) -> Floats:
    """Damage (n, 2, g) that one run of a loop adds with all stresses times ``first exp(i step)``.

    As in ``count.count_at_factors``. What replaces cycles of an event is the negative of what that event has.
    """
    tried = trials(first, step, factors)
    for some, of_some in _some_points(residues):
        stress = _sized(size[some])
        add_trials(_cycles(of_some, order, recurs=True), stress, rule, tried.at(some))
        for event in order:
            own = _cycles(of_some, (event,), recurs=not of_some.half[event])
            add_trials(own._replace(weight=-own.weight), stress, rule, tried.at(some))
    return tried.damage


def _some_points(residues: Residues) -> Iterator[tuple[slice, Residues]]:
    """Some points at a time."""
    for first in range(0, residues.length.shape[1], AT_ONCE):
        some = slice(first, first + AT_ONCE)
        yield some, residues.at(some)


def _sized(size: Floats) -> BlockStress:
    """Points of some thickness factors, with nothing else of their own."""
    n = len(size)
    return BlockStress(np.zeros((n, 0)), np.zeros((n, 0)), size, np.zeros((n, 2)))


class _Path(NamedTuple):
    """Work space: stresses along a chain of reversals, and its cycles as ``find_cycles`` gives them."""

    membrane: Floats
    bending: Floats
    stress: Floats
    turned: Floats
    step: NDArray[np.int8]
    reversal: Indices
    start: Indices
    end: Indices
    weight: Floats
    number: Indices


def _path_for(residues: Residues, order: tuple[int, ...]) -> _Path:
    longest = int(residues.length[list(order)].sum(axis=0).max(initial=1))
    m, b, s, turned, weight = (np.empty(longest + 1) for _ in range(5))
    reversal, start, end = (np.empty(longest + 2, np.intp) for _ in range(3))
    return _Path(m, b, s, turned, np.empty(longest + 1, np.int8), reversal, start, end, weight, np.empty(1, np.intp))


def _cycles(residues: Residues, order: tuple[int, ...], *, recurs: bool) -> SurfaceCycles:
    """Cycles of the chain of the residues of some events, at both surfaces of all points."""
    most = int(residues.length[list(order)].sum()) + 2 * residues.length.shape[1]
    values, at = (np.empty((2, most)), np.empty((2, most))), np.empty((2, most), np.intp)
    cycles = SurfaceCycles(np.empty(most, np.intp), *values, np.empty(most), at)
    found = list_cycles(_plain(residues), np.array(order), recurs, _path_for(residues, order), cycles)
    return SurfaceCycles._make(part[..., :found] for part in cycles)


def _plain(residues: Residues) -> Residues:
    return Residues._make(np.require(array, requirements=["C", "W"]) for array in residues)


@compiled()
def put_stint(residues: Residues, event: int, at: tuple[int, int], n: int, path: _Path) -> int:
    """Put the residue of an event behind n reversals of a path and return how many there are."""
    row, surface = at
    side = 1.0 - 2.0 * surface
    first = residues.first[event, row, surface]
    for k in range(first, first + residues.length[event, row, surface]):
        path.membrane[n] = residues.membrane[k] + residues.constant_m[event, row]
        path.bending[n] = residues.bending[k] + residues.constant_b[event, row]
        path.stress[n] = path.membrane[n] + side * path.bending[n]
        n += 1
    return n


@compiled()
def list_cycles(residues: Residues, order: Counts, recurs: bool, path: _Path, cycles: SurfaceCycles) -> int:
    """List the cycles of a chain of residues at all points, as if the reversals were samples; returns how many."""
    found = 0
    for surface in range(2 * residues.length.shape[1]):
        n = 0
        for j in range(order.size):
            n = put_stint(residues, order[j], (surface // 2, surface % 2), n, path)
        signal = path.stress[:n].reshape((1, n))
        closed = find_cycles(
            signal,
            recurs,
            path.turned[: n + 1],
            path.step,
            path.reversal,
            path.start,
            path.end,
            path.weight,
            path.number,
        )
        for c in range(closed):
            cycles.surface[found], cycles.weight[found] = surface, path.weight[c]
            i, j = path.start[c], path.end[c]
            cycles.at[0, found], cycles.at[1, found] = i, j
            cycles.membrane[0, found], cycles.membrane[1, found] = path.membrane[i], path.membrane[j]
            cycles.bending[0, found], cycles.bending[1, found] = path.bending[i], path.bending[j]
            found += 1
    return found


class Convex(NamedTuple):
    """A convex damage of one range S at least as large as that of any cycle: largest of ``S^k exp(log_scale)``.

    ``exponents`` and ``log_scales`` (c,) of a point of the thickness factor 1. ``stress_exponent`` is that of the
    largest stress where f_M may apply, 0 where it cannot.
    """

    exponents: Floats
    log_scales: Floats
    stress_exponent: float
    yield_MPa: float  # noqa: N815


def convex_damage(rule: CycleRule) -> Convex:
    """The first slope extended, with pure membrane (r = 0); all slopes, where one is steeper than those below it.

    With f_M a cycle has ``dS / f_M = dS (max / S)^(1/m)``, which is convex in S for a given largest stress.
    """
    law = rule.law
    segments = slice(0, 1) if _steepens(law) else slice(None)
    k = law.slopes[segments]
    g = float(equivalent_range(1.0, 1.0, rule.ratio_factor(np.zeros(())), 1.0))
    log_scales = k * np.log(g) - law.log_constants[segments]
    yield_MPa = rule.yield_of_damage
    return Convex(plain(k), plain(log_scales), 1.0 / M_SS, np.inf if yield_MPa is None else float(yield_MPa))


def _steepens(law: DamageLaw) -> bool:
    return bool((np.diff(law.slopes) >= 0.0).all())


def unknown_order(residues: Residues, stints: Floats, size: Floats, rule: CycleRule) -> Floats:
    """Bound of what any order of the events adds in so many ``stints`` (e,), (n, 2) of each surface."""
    found = np.zeros((len(size), 2))
    if not len(size):
        return found
    path, convex = _path_for(residues, tuple(range(len(stints)))), convex_damage(rule)
    already = np.zeros((len(size), 2))
    for some, of_some in _some_points(residues):
        for event, times in enumerate(stints):
            own = nothing_counted(len(size[some]), rule.law)
            tally(_cycles(of_some, (event,), recurs=not of_some.half[event]), _sized(size[some]), rule, own, samples=1)
            already[some] += times * own.totals["damage"]
    pair_sorted(_plain(residues), plain(stints), plain(size), convex, path, found)
    return found - already


@compiled()
def convex_of(S: float, size: float, largest: float, convex: Convex) -> float:
    """``d_1`` of a range S at a point whose largest stress is given."""
    if S <= 0.0:
        return 0.0
    x = S * size
    if 2.0 * largest >= convex.yield_MPa and largest > S:
        x *= (largest / S) ** convex.stress_exponent
    damage = 0.0
    for j in range(convex.exponents.size):
        damage = max(damage, np.exp(convex.exponents[j] * np.log(x) + convex.log_scales[j]))
    return damage


@compiled()
def pair_sorted(
    residues: Residues,
    stints: Floats,
    size: Floats,
    convex: Convex,
    path: _Path,
    found: Floats,
) -> None:
    """Pair peaks and valleys of all events, the highest with the lowest."""
    room = path.stress.size
    peak, valley, of_peak, of_valley = np.empty(room), np.empty(room), np.empty(room), np.empty(room)
    for row in range(size.size):
        for surface in range(2):
            peaks = valleys = 0
            for event in range(stints.size):
                n = put_stint(residues, event, (row, surface), 0, path)
                s = path.stress
                for i in range(n):
                    before, behind = (s[i - 1] if i > 0 else s[i]), (s[i + 1] if i + 1 < n else s[i])
                    if s[i] >= before and s[i] >= behind:
                        peak[peaks], of_peak[peaks] = s[i], stints[event]
                        peaks += 1
                    if s[i] <= before and s[i] <= behind:
                        valley[valleys], of_valley[valleys] = s[i], stints[event]
                        valleys += 1
            by_peak, by_valley = np.argsort(-peak[:peaks]), np.argsort(valley[:valleys])
            largest = peak[by_peak[0]] if peaks > 0 else 0.0
            i = j = 0
            pairs = 0.0
            while i < peaks and j < valleys and peak[by_peak[i]] > valley[by_valley[j]]:
                weight = min(of_peak[by_peak[i]], of_valley[by_valley[j]])
                pairs += weight * convex_of(peak[by_peak[i]] - valley[by_valley[j]], size[row], largest, convex)
                of_peak[by_peak[i]] -= weight
                of_valley[by_valley[j]] -= weight
                i += int(of_peak[by_peak[i]] <= 0.0)
                j += int(of_valley[by_valley[j]] <= 0.0)
            found[row, surface] = pairs
