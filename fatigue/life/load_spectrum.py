"""Load spectra of counted cycles: how often ranges, means, pairs of reversals and levels occur.

A class holds [lower, upper), the last one its upper edge as well. Counts and power sums are those of the exact ranges;
classes say only where a cycle is listed.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

ROUNDING = 1e-12  # of the cycles that were added and taken away


@dataclass(frozen=True, slots=True, eq=False)
class LoadCycles:
    """Cycles of one signal; all arrays are (c,), in the unit of the signal.

    Attributes
    ----------
    first, second : the two reversals in time, with whatever constant the signal stands on
    range : between them, as it was counted without the constant
    count : 1, or 0.5 for a half cycle; below 0 for a cycle that a sequence of events replaces
    """

    first: Floats
    second: Floats
    range: Floats
    count: Floats

    def raised(self, constant: float) -> Self:
        """The same cycles on a constant; ranges keep their last bit."""
        return type(self)(self.first + constant, self.second + constant, self.range, self.count)

    @property
    def lowest(self) -> Floats:
        """Smaller reversal of each cycle."""
        return np.minimum(self.first, self.second)

    @property
    def highest(self) -> Floats:
        """Larger reversal of each cycle."""
        return np.maximum(self.first, self.second)

    @property
    def mean(self) -> Floats:
        """Mean of the two reversals."""
        return 0.5 * self.first + 0.5 * self.second


@dataclass(frozen=True, slots=True, eq=False)
class RangeSpectrum:
    """Range spectrum in b classes; all arrays are (b,).

    Attributes
    ----------
    count : sum n of the class
    power_sum : sum n S**k of the class, from the ranges themselves
    largest : largest range of the class; NaN of an empty one
    reached : sum n of all ranges at or above the lower edge, also of those above the last class
    """

    count: Floats
    power_sum: Floats
    largest: Floats
    reached: Floats

    def __add__(self, other: Self) -> Self:
        """Both together."""
        largest = np.fmax(self.largest, other.largest)
        return type(self)(
            self.count + other.count, self.power_sum + other.power_sum, largest, self.reached + other.reached
        )

    def times(self, weight: float) -> Self:
        """The same ``weight`` times as often."""
        return type(self)(weight * self.count, weight * self.power_sum, self.largest, weight * self.reached)


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """Cells of a matrix of classes that hold cycles: row and column of each, and sum n there; all arrays are (c,)."""

    row: Indices
    column: Indices
    count: Floats

    def times(self, weight: float) -> Self:
        """The same ``weight`` times as often."""
        return type(self)(self.row, self.column, weight * self.count)


def class_of(values: Floats, edges: Floats) -> Indices:
    """Index of the class [lower, upper) of each value, the last one closed; -1 for a value in none.

    >>> class_of(np.array([0.0, 1.0, 2.0, 2.5, -1.0]), np.array([0.0, 1.0, 2.0]))
    array([ 0,  1,  1, -1, -1])
    """
    last = len(edges) - 2
    index = np.searchsorted(edges, values, side="right") - 1
    index = np.where(values == edges[-1], last, index)
    return np.where(index > last, -1, index)


def range_spectrum(cycles: LoadCycles, edges: Floats, slope: float) -> RangeSpectrum:
    """Range spectrum of cycles in the classes between ``edges`` (b + 1,); ``slope`` k is that of the power sums.

    >>> S = np.array([3.0, 4.0, 4.0, 8.0, 9.0, 8.0, 6.0])
    >>> n = np.array([0.5, 0.5, 1.0, 0.5, 0.5, 0.5, 0.5])
    >>> found = range_spectrum(LoadCycles(0.0 * S, S, S, n), np.linspace(0.0, 10.0, 6), 3.0)
    >>> found.count, found.reached
    (array([0. , 0.5, 1.5, 0.5, 1.5]), array([4. , 4. , 3.5, 2. , 1.5]))
    """
    S, n = cycles.range, cycles.count
    classes = len(edges) - 1
    at = class_of(S, edges)
    inside = at >= 0
    largest = np.full(classes, np.nan)
    there = inside & (n > 0.0)
    np.fmax.at(largest, at[there], S[there])
    first = np.searchsorted(edges, S, side="right")  # so many lower edges does a range reach
    reached = np.bincount(first, n, classes + 2)[::-1].cumsum()[::-1][1 : classes + 1]
    power_sum = np.bincount(at[inside], (n * S**slope)[inside], classes).astype(np.float64)
    return RangeSpectrum(np.bincount(at[inside], n[inside], classes).astype(np.float64), power_sum, largest, reached)


def no_spectrum(classes: int) -> RangeSpectrum:
    """Spectrum of no cycles."""
    return RangeSpectrum(np.zeros(classes), np.zeros(classes), np.full(classes, np.nan), np.zeros(classes))


def summed(parts: Sequence[RangeSpectrum]) -> RangeSpectrum:
    """Spectra of several events in one, in the same classes; what adds up to nothing but rounding is nothing."""
    sums = {}
    for name in ("count", "power_sum", "reached"):
        values = np.stack([getattr(part, name) for part in parts])
        sums[name] = _rounded(values.sum(axis=0), np.abs(values).sum(axis=0))
    return RangeSpectrum(largest=np.fmax.reduce([part.largest for part in parts]), **sums)


def _rounded(net: Floats, gross: Floats) -> Floats:
    """Sums of numbers of both signs, 0 where only their rounding is left."""
    return np.where(np.abs(net) > ROUNDING * gross, net, 0.0)


def cells(row: Indices, column: Indices, count: Floats, columns: int) -> Cells:
    """Sum of cycles cell by cell, row by row; what lies in no class (-1) is left out, and so are empty cells."""
    inside = (row >= 0) & (column >= 0)
    place, of_cycle = np.unique(row[inside] * columns + column[inside], return_inverse=True)
    total = np.bincount(of_cycle, count[inside], len(place))
    held = total != 0.0
    return Cells(place[held] // columns, place[held] % columns, total[held])


def joined_cells(parts: list[Cells], columns: int) -> Cells:
    """Cells of several matrices in one; what adds up to nothing but rounding is empty."""
    row, column, count = (np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(Cells))
    net, gross = cells(row, column, count, columns), cells(row, column, np.abs(count), columns)
    of_gross = np.searchsorted(gross.row * columns + gross.column, net.row * columns + net.column)
    held = _rounded(net.count, gross.count[of_gross]) != 0.0
    return Cells(net.row[held], net.column[held], net.count[held])


def range_mean(cycles: LoadCycles, ranges: Floats, levels: Floats) -> Cells:
    """Cycles by class of range (rows) and class of mean (columns)."""
    return cells(class_of(cycles.range, ranges), class_of(cycles.mean, levels), cycles.count, len(levels) - 1)


def from_to(cycles: LoadCycles, levels: Floats) -> Cells:
    """Cycles by class of their first reversal in time (rows) and of their second (columns), direction kept."""
    return cells(class_of(cycles.first, levels), class_of(cycles.second, levels), cycles.count, len(levels) - 1)


def up_crossings(cycles: LoadCycles, levels: Floats) -> Floats:
    """How often ascending ``levels`` (l,) are crossed upwards: sum n of the cycles with minimum < u <= maximum.

    Exactly the up-crossings ``s[i] < u <= s[i+1]`` of the samples where every cycle closes (``repeat``), half of the
    crossings in both directions where the rest is half cycles (``half``).

    >>> s = np.array([-2.0, 4.0])
    >>> cycles = LoadCycles(s[:1], s[1:], np.array([6.0]), np.array([1.0]))
    >>> up_crossings(cycles, np.array([-2.0, 0.0, 4.0, 5.0]))
    array([0., 1., 1., 0.])
    """
    begin = np.searchsorted(levels, cycles.lowest, side="right")
    end = np.searchsorted(levels, cycles.highest, side="right")
    room = len(levels) + 1
    return (np.bincount(begin, cycles.count, room) - np.bincount(end, cycles.count, room)).cumsum()[:-1]


def power_sums(cycles: LoadCycles, exponents: Floats) -> Floats:
    """Sums n S**m for each exponent m, (x,)."""
    return np.array([float(np.sum(cycles.count * cycles.range**m)) for m in exponents])


def damage_equivalent(power_sum: Floats, exponent: Floats, cycles: float) -> Floats:
    """Constant range that does the same in ``cycles`` cycles on one slope, ``(sum n S**m / N)**(1/m)``.

    NaN where the sum is negative: a sequence takes away more than it adds.

    >>> damage_equivalent(np.array([1163.0]), np.array([3.0]), 8.0)
    array([5.25811293])
    """
    return np.where(power_sum >= 0.0, np.maximum(power_sum, 0.0) / cycles, np.nan) ** (1.0 / exponent)


def uniform_edges(lowest: float, highest: float, classes: int) -> Floats:
    """Edges (classes + 1,) of classes of equal width over all values; one unit wide in all where nothing varies."""
    if not lowest < highest:
        lowest, highest = (lowest, lowest + 1.0) if lowest == 0.0 else (lowest - 0.5, lowest + 0.5)
    return np.linspace(lowest, highest, classes + 1)
