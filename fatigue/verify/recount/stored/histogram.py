"""Cycles of a pass sorted into classes of their range as they should be, beside the classes in the table."""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import OnePass
from fatigue.verify.recount.layout import Key
from fatigue.verify.recount.stored.compare import TOLERANCE, Row
from fatigue.verify.recount.stored.rows import place

Floats = NDArray[np.float64]

CLASSES, PER_DECADE, LOWEST = 512, 64, 1e-3  # the first class begins at 0, the last has no end
KINDS = {"S": "range_MPa", "dS": "equivalent_range_dS"}  # columns of the table of cycles
COLUMNS = ("count_per_pass", "power_sum_per_pass")
ROUND_OFF = 1e-12  # of a range at the edge of a class


def histogram_rows(
    key: Key, event: RecountEvent, one: OnePass, k: float, found: pd.DataFrame, *, of_loop: bool = False
) -> Iterator[Row]:
    """The classes of one event or loop at one point: of each kind of range the class that differs most.

    ``k`` is the exponent. What lies so close to edges that rounding decides about its class may be in any of those
    classes, and cycles of nothing but rounding in any below. A cycle that a loop replaces counts less than nothing;
    where the same one closes, the table may keep the rounding of a difference.
    """
    where, n = f"{place(key)}, event '{event.name}'", one.rows["count"]
    numbers = found["bin"].to_numpy(dtype=float)
    is_class = found["kind"].isin(KINDS).to_numpy() & (numbers >= 0) & (numbers < CLASSES)
    if not is_class.all():
        astray = {"bin": float(np.count_nonzero(~is_class))}
        yield Row(f"{where}, rows of no class", astray, {"bin": 0.0}, {"bin": 1.0})
    for kind, name in KINDS.items():
        own = found[is_class & (found["kind"] == kind).to_numpy()]
        stored = [_sums(own["bin"].to_numpy(dtype=np.int64), own[column].to_numpy(dtype=float)) for column in COLUMNS]
        x, rho = one.rows[name], one.cycle_bounds[name]
        expected, bounds = _expected(x, n, k, rho)
        of_rounding = slice(int(_class(np.array([2.0 * rho]))[0]) + 1)
        bounds[0][of_rounding] += one.bounds["cycles_per_pass"]
        bounds[1][of_rounding] += one.bounds["cycles_per_pass"] * (2.0 * rho) ** k
        if of_loop:
            bounds[1] += max(1, len(x)) * _grown(_ends(x), k, rho)
        for column, a, b, bound in zip(COLUMNS, expected, stored, bounds, strict=True):
            off = np.maximum(np.abs(a - b) - bound, 0.0) / np.where(a != 0.0, np.abs(a), 1.0)
            off = np.where((a == 0.0) & (off > 0.0), 1.0, off)
            worst = int(off.argmax())
            text = f"{where}, {kind}, class {worst}"
            scale = {column: abs(float(a[worst] if a[worst] != 0.0 else b[worst]))}
            yield Row(text, {column: float(b[worst])}, {column: float(a[worst])}, scale, bounds={column: bound[worst]})


def _expected(x: Floats, n: Floats, k: float, rho: float) -> tuple[list[Floats], list[Floats]]:
    """``sum n`` and ``sum n x^k`` of every class, and what rounding may do to them."""
    near = np.maximum(rho, ROUND_OFF * x)
    low, at, high = _class(np.maximum(x - near, 0.0)), _class(x), _class(x + near)
    power = n * x**k
    size, grown = np.abs(power), np.abs(n) * _grown(x, k, rho)
    unsure = low != high
    stretches, which = np.unique(low[unsure] * CLASSES + high[unsure], return_inverse=True)

    def any_of(values: Floats) -> Floats:
        found = np.zeros(CLASSES)
        for stretch, value in zip(stretches.tolist(), np.bincount(which, values[unsure], len(stretches)), strict=True):
            found[stretch // CLASSES : stretch % CLASSES + 1] += value
        return found

    return [_sums(at, n), _sums(at, power)], [any_of(np.abs(n)), any_of(size + grown) + _sums(at, grown)]


def _grown(x: Floats, k: float, rho: float) -> Floats:
    """What rounding of ranges and of sums may do to their powers."""
    return np.asarray((x + rho) ** k - x**k + TOLERANCE**2 * x**k)


def _ends(x: Floats) -> Floats:
    """Upper ends of the classes, of the last one the largest range."""
    ends = LOWEST * 10.0 ** (np.arange(1, CLASSES + 1) / PER_DECADE)
    ends[-1] = max(ends[-1], x.max(initial=0.0))
    return np.asarray(ends)


def _class(x: Floats) -> NDArray[np.int64]:
    decades = np.log10(np.maximum(x, LOWEST)) - np.log10(LOWEST)
    return np.asarray(np.clip(np.floor(decades * PER_DECADE), 0, CLASSES - 1), dtype=np.int64)


def _sums(at: NDArray[np.int64], values: Floats) -> Floats:
    return np.bincount(at, values, CLASSES).astype(np.float64)
