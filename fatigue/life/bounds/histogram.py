"""Damage of a stored histogram under another law: between two bounds, from the number and the power sum of each class.

A class [a, b) keeps N = sum n and P = sum n x^k of its ranges x. In y = x^k the mean range is ybar = P / N, and the new
damage of a cycle is g(y). Where the new law is one power k' over the class, the damage lies between

    N g(ybar)    and    N [g(a^k) + (g(b^k) - g(a^k)) (ybar - a^k) / (b^k - a^k)],

the first is the lower one for k' >= k (Jensen), else the upper; both are reached by some cycles. In a class with a knee
or the cut-off it lies between P times the smallest and the largest d(x) / x^k, and, as d never falls, between
N d(a) and N d(b). The value that is given, N g(ybar), lies between the two.

Cycles across events replace some of the events' own, which count below 0. Alone they have no bounds, as what takes away
and what adds may lie anywhere in a class. Together with the passes that hold the replaced cycles they do: no pass loses
a cycle it has not got, so their weighted sum counts every range at least 0 times (``joined_classes``).
"""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import HISTOGRAM_BINS, HISTOGRAM_EDGES
from fatigue.life.curves import DamageLaw
from fatigue.life.rule import cycle_damage, segment

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

AT_ONCE = 500_000  # classes, whose numbers are 100 MB
ROUNDING = 1e-9  # relative, of sums of cycles and of their mean beside the edges of the class


@dataclass(frozen=True, slots=True, eq=False)
class Classes:
    """Classes with cycles, of any points and events, one after the other; all arrays are (c,).

    Attributes
    ----------
    of : number of the point, or whatever the damage is summed by
    bin : number of the class, whose edges are ``HISTOGRAM_EDGES``; the first begins at 0
    count, power_sum : sum n and sum n x^k of its ranges x
    largest : largest range of the event at the point, at which the last class ends; +inf: it is not known
    """

    of: Indices
    bin: Indices
    count: Floats
    power_sum: Floats
    largest: Floats

    def __len__(self) -> int:
        """Number of classes."""
        return len(self.bin)

    def some(self, rows: Indices | NDArray[np.bool_] | slice) -> Self:
        """Some of them."""
        return type(self)(self.of[rows], self.bin[rows], self.count[rows], self.power_sum[rows], self.largest[rows])

    def times(self, weight: Floats | float) -> Self:
        """The same, each ``weight`` times as often."""
        return type(self)(self.of, self.bin, weight * self.count, weight * self.power_sum, self.largest)


class Enclosed(NamedTuple):
    """A number between two bounds, of any shape; infinite bounds: nothing is known."""

    low: Floats
    value: Floats
    high: Floats


class _Edges(NamedTuple):
    """Both ends of classes and their mean in y = x^k, (c,) each; ``outside``: no cycles of one sign can have it."""

    a: Floats
    b: Floats
    mean: Floats
    outside: NDArray[np.bool_]

    def of(self, rows: Indices) -> Self:
        """Those of some classes."""
        return self._replace(a=self.a[rows], b=self.b[rows], mean=self.mean[rows], outside=self.outside[rows])


def damage_of_classes(
    classes: Classes, slope: float, law: DamageLaw, factor: Floats | float = 1.0, points: int | None = None
) -> Enclosed:
    """Damage of histograms under a law, summed by ``classes.of``.

    Parameters
    ----------
    classes : c classes; all counts of one sign within a class
    slope : exponent k of their power sums
    law : the new law
    factor : on all ranges, one number or (c,)
    points : numbers of ``of`` there are, p; None: up to the largest

    Returns
    -------
    (p,) low, value and high. Classes that no cycles of one sign can have, because more is taken away than is there,
    have infinite bounds, but where the damage is the power sum itself. Source: ``loads_and_decisions`` B2.

    >>> from fatigue.life.curves import catalogue, damage_law
    >>> law = damage_law(catalogue()["master-aluminium"], "mean-2sigma", "none", 1e7)
    >>> x, k = np.array([48.8, 49.5]), float(law.slopes[0])
    >>> one = Classes(np.array([0]), np.array([300]), np.array([2.0]), np.array([(x**k).sum()]), np.array([np.inf]))
    >>> low, value, high = damage_of_classes(one, k, law)
    >>> np.allclose([low, value, high], cycle_damage(x, law).sum(), rtol=1e-12)
    True
    """
    n = (int(classes.of.max(initial=-1)) + 1) if points is None else points
    f = np.broadcast_to(np.asarray(factor, dtype=np.float64), len(classes))
    total = Enclosed(np.zeros(n), np.zeros(n), np.zeros(n))
    for first in range(0, len(classes), AT_ONCE):
        rows = slice(first, first + AT_ONCE)
        some = classes.some(rows)
        for part, found in zip(total, class_damage(some, slope, law, f[rows]), strict=True):
            np.add(part, np.bincount(some.of, found, n), out=part)
    return total


def class_damage(classes: Classes, slope: float, law: DamageLaw, factor: Floats | float = 1.0) -> Enclosed:
    """Damage (c,) of each class, as ``damage_of_classes`` sums it up."""
    lower = np.where(classes.bin == 0, 0.0, HISTOGRAM_EDGES[classes.bin])
    is_last = classes.bin == HISTOGRAM_BINS - 1
    upper = np.where(is_last, np.maximum(classes.largest, lower), HISTOGRAM_EDGES[classes.bin + 1])
    return damage_between(classes.count, classes.power_sum, (lower, upper), slope, law, factor)


def damage_between(
    count: Floats,
    power_sum: Floats,
    ends: tuple[Floats, Floats],
    slope: float,
    law: DamageLaw,
    factor: Floats | float = 1.0,
) -> Enclosed:
    """Damage (c,) under a law of cycles whose ranges lie between two ``ends`` (c,), from their number and power sum.

    ``count`` and ``power_sum`` are sum n and sum n x^k with k the ``slope``, ``factor`` is on all ranges.
    """
    f = np.broadcast_to(np.asarray(factor, dtype=np.float64), len(count))
    sign = np.where(count < 0.0, -1.0, 1.0)
    N, P = np.abs(count), sign * power_sum
    edges = _edges(*ends, N, P, slope)
    at_a, at_b = _segment(f * edges.a, law), _segment(f * edges.b, law)
    one_power = (at_a == at_b) & ((f * edges.a >= law.cutoff) | (f * edges.b < law.cutoff))
    damages = f * edges.b >= law.cutoff
    low, value, high = (np.zeros(len(count)) for _ in range(3))
    for rows, bounds in ((one_power & damages, _on_one_power), (~one_power, _across_knees)):
        some = np.flatnonzero(rows)
        at = edges.of(some)
        low[some], value[some], high[some] = bounds(N[some], P[some], at, f[some], slope, law)
    low, value, high = sign * low, sign * value, sign * high
    low, high = np.minimum(low, high), np.maximum(low, high)
    of_power_sum = one_power & (law.slopes[at_a] == slope)  # whatever the signs are
    nothing_known = edges.outside & damages & ~of_power_sum
    return Enclosed(np.where(nothing_known, -np.inf, low), value, np.where(nothing_known, np.inf, high))


def joined_classes(classes: Classes) -> Classes:
    """Classes of the same ``of`` and ``bin`` in one, what adds up to nothing but rounding left out.

    For passes and the loops that replace some of their cycles, each with its weight (passes or runs per km): none of
    these sums is of cycles below 0 where the passes are at least those that the loops need.

    >>> two = Classes(*np.array([[3, 3], [7, 7]]), np.array([1.0, -1.0]), np.array([8.0, -8.0]), np.array([2.0, 2.0]))
    >>> len(joined_classes(two))
    0
    """
    place, of_class = np.unique(classes.of * HISTOGRAM_BINS + classes.bin, return_inverse=True)
    n = len(place)
    largest = np.zeros(n)
    np.maximum.at(largest, of_class, classes.largest)
    sums = []
    for part in (classes.count, classes.power_sum):
        net, total = np.bincount(of_class, part, n), np.bincount(of_class, np.abs(part), n)
        sums.append(np.where(np.abs(net) > ROUNDING * total, net, 0.0))
    held = (sums[0] != 0.0) | (sums[1] != 0.0)
    return Classes(
        place[held] // HISTOGRAM_BINS, place[held] % HISTOGRAM_BINS, sums[0][held], sums[1][held], largest[held]
    )


def _edges(a: Floats, b: Floats, N: Floats, P: Floats, slope: float) -> _Edges:
    """Ends of each class, and its mean between them."""
    mean = np.divide(P, N, out=np.zeros_like(P), where=N > 0.0)
    low, high = a**slope, b**slope
    outside = (mean < low * (1.0 - ROUNDING)) | (mean > high * (1.0 + ROUNDING)) | ((N == 0.0) & (P != 0.0))
    return _Edges(a, b, np.clip(mean, low, high), outside)


def _segment(x: Floats, law: DamageLaw) -> Indices:
    """Segment of the law on which each range lies."""
    return np.asarray(np.zeros(len(x), dtype=np.intp) + segment(x, law.knees))


def _on_one_power(N: Floats, P: Floats, edges: _Edges, f: Floats, k: float, law: DamageLaw) -> Enclosed:
    """Between Jensen's bound and the chord, g(y) = c y^q; both are the power sum itself where the slopes agree."""
    j = _segment(f * edges.a, law)
    q = law.slopes[j] / k
    c = np.exp(law.slopes[j] * np.log(f) - law.log_constants[j])
    y_a, y_b = edges.a**k, edges.b**k
    value = np.where(q == 1.0, P, N * edges.mean**q)
    bounded = np.isfinite(y_b) & (y_b > y_a)
    rise = np.divide(y_b**q - y_a**q, y_b - y_a, out=np.where(q > 1.0, np.inf, 0.0), where=bounded)
    rise = np.where(edges.mean > y_a, rise, 0.0)  # all of them at the lower end
    chord = np.where(q == 1.0, P, N * (y_a**q + rise * (edges.mean - y_a)))
    return Enclosed(c * np.minimum(value, chord), c * value, c * np.maximum(value, chord))


def _across_knees(N: Floats, P: Floats, edges: _Edges, f: Floats, k: float, law: DamageLaw) -> Enclosed:
    """Between P times the smallest and the largest d(f x) / x^k, at the ends and on either side of what is between."""

    def ratio(x: Floats, j: Indices | int) -> Floats:
        """d(f x) / x^k on the segment j."""
        rest = law.slopes[j] - k
        with np.errstate(divide="ignore", invalid="ignore"):
            of_x = np.where(rest == 0.0, 0.0, rest * np.log(x))
        with np.errstate(over="ignore"):
            return np.asarray(np.exp(of_x + law.slopes[j] * np.log(f) - law.log_constants[j]))

    a, b = edges.a, edges.b
    undamaged = f * a < law.cutoff
    r_a = np.where(undamaged, 0.0, ratio(a, _segment(f * a, law)))
    r_b = ratio(b, _segment(f * b, law))
    lowest, highest = np.minimum(r_a, r_b), np.maximum(r_a, r_b)
    breaks = [(float(knee), side) for j, knee in enumerate(law.knees) for side in (j, j + 1)]
    if law.cutoff > 0.0:
        breaks.append((law.cutoff, int(_segment(np.array([law.cutoff]), law)[0])))
    for place, j in breaks:
        x = place / f
        inside = (a < x) & (x <= b) & (place >= law.cutoff)
        r = ratio(np.where(inside, x, 1.0), j)
        lowest = np.where(inside, np.minimum(lowest, r), lowest)
        highest = np.where(inside, np.maximum(highest, r), highest)
    with np.errstate(divide="ignore"):
        mean = edges.mean ** (1.0 / k)
    with np.errstate(invalid="ignore", over="ignore"):
        high = np.fmin(P * highest, N * cycle_damage(f * b, law))
        low = np.fmax(P * lowest, N * cycle_damage(f * a, law))
        value = N * cycle_damage(f * mean, law)
    return Enclosed(low, np.clip(value, low, high), high)
