"""Forward through what a result has stored: utilisations under a strength of each weld, a mission, a distance.

The way is that of ``whatif``: a strength scales the law of the curve of a weld, knees at the same numbers of cycles.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.case.load import parsed_case
from fatigue.decide.of_result import case_text, shear_method
from fatigue.decide.whatif.asked import TwoCases
from fatigue.decide.whatif.change import Change, unchanged
from fatigue.decide.whatif.curves import Curves, OneCurve, curves_of
from fatigue.decide.whatif.difference import Differences
from fatigue.decide.whatif.forward import Forward, forward
from fatigue.decide.whatif.stored import Kind, Stored, StoredRanges, stored_ranges
from fatigue.errors import DataError, Problem
from fatigue.life.curves import DamageLaw
from fatigue.results import case_of, read_table

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Base:
    """A result as it is stored: the change that is none, the curve of each weld, and histograms that were read."""

    stored: Stored
    change: Change
    curves: Curves
    ranges: dict[Kind, StoredRanges]

    def ranges_of(self, kind: Kind) -> StoredRanges:
        """Histograms of a kind, read once."""
        if kind not in self.ranges:
            self.ranges[kind] = stored_ranges(self.stored, kind)
        return self.ranges[kind]

    def curve(self, weld: int) -> OneCurve:
        """Curve of a weld by its number."""
        return self.curves.curves[self.curves.of_weld[self.stored.welds[weld]]]

    @cached_property
    def keys(self) -> pd.DataFrame:
        """Key of every point."""
        return self.stored.keys()

    @cached_property
    def at_end(self) -> NDArray[np.bool_]:
        """Points (n,) near a weld end."""
        found: NDArray[np.bool_] = read_table(self.stored.folder, "nodes", ["at_end"])["at_end"].to_numpy()
        return found

    def is_treated_over_thickness(self, weld: int, row: int) -> bool:
        """Whether a point lies at a weld end that is treated over the thickness of the plate."""
        return bool(self.at_end[row]) and bool(pd.isna(self.stored.of_welds["end_length_mm"].iloc[weld]))

    @cached_property
    def limit(self) -> Floats:
        """Damage limit (w,) of every weld."""
        return np.array([self.curve(weld).limit for weld in range(len(self.stored.welds))])

    @cached_property
    def slope(self) -> Floats:
        """First slope (w,) of the curve of every weld."""
        return np.array([self.curve(weld).slope for weld in range(len(self.stored.welds))])


def base_of(stored: Stored, folder: Path) -> Base:
    """A result as it is stored.

    Raises
    ------
    DataError : shear decides about its verdicts, whose sums are known at one load only; a curve is another one now
    """
    if method := shear_method(stored.record):
        what = f"verdicts rest on normal stress and shear (multiaxial method {method!r}), of which one sum is stored"
        raise DataError(Problem("backsolve_shear", str(folder), what, "Assess with method = 'report' for an answer"))
    base = parsed_case(case_of(stored.record, folder), case_text(stored.record))
    nothing = Differences((), ())
    curve_of_weld = dict(zip(stored.of_welds["weld"], stored.of_welds["curve"], strict=True))
    curves = curves_of(stored.record, folder, TwoCases(base, base), nothing, curve_of_weld)
    return Base(stored, unchanged(stored.record), curves, {})


def with_strength(base: Base, x: Floats) -> Forward:
    """Damage of all points, the ranges of the curve of each weld times ``x`` (w,)."""
    curves = []
    for weld, factor in enumerate(x.tolist()):
        one = base.curve(weld)
        curves.append(replace(one, after=replace(one.after, rule=replace(one.after.rule, law=_scaled(one, factor)))))
    of_weld = {name: number for number, name in enumerate(base.stored.welds)}
    return forward(base.stored, base.change, Curves(tuple(curves), of_weld), base.ranges_of)


def _scaled(one: OneCurve, x: float) -> DamageLaw:
    law = one.after.rule.law
    if x == 1.0:
        return law
    return DamageLaw(law.slopes, law.log_constants + law.slopes * np.log(x), law.knees * x, law.cutoff * x)


def with_weights(base: Base, weights: Floats, rows: Rows) -> Floats:
    """Utilisation per km (p,) of some points with other passes and runs per km (r,), over the damage limit."""
    stored = base.stored
    some = replace(
        stored,
        weld=stored.weld[rows],
        toe=stored.toe[rows],
        counted=np.ones(len(rows), np.bool_),  # bounds as they stand: sums keep them so
        damage_per_km=stored.damage_per_km[rows],
        per_pass=stored.per_pass[rows],
        thickness=stored.thickness[rows],
        attachment=stored.attachment[rows],
    )
    change = replace(base.change, after=replace(base.change.after, weights=weights))
    found = forward(some, change, base.curves, base.ranges_of)
    return np.asarray(found.damage.value / found.limit)


def worst_of_welds(base: Base, values: Floats, known: NDArray[np.bool_]) -> tuple[Floats, NDArray[np.int64]]:
    """Largest value of the known points of every weld (w,), and its row; -inf and -1 without any."""
    welds = len(base.stored.welds)
    rows = np.flatnonzero(known)
    ascending = rows[np.lexsort([-rows, values[rows]])]  # of equal ones the first stays
    row = np.full(welds, -1, np.int64)
    row[base.stored.weld[ascending]] = ascending
    return np.where(row >= 0, values[row], -np.inf), row


def with_counted(stored: Stored, rows: NDArray[np.int64], per_pass: Floats) -> Stored:
    """The same with the damage of some points counted, instead of a bound."""
    damage, counted, per_km = stored.per_pass.copy(), stored.counted.copy(), stored.damage_per_km.copy()
    weights = _weights(stored)
    damage[rows], counted[rows], per_km[rows] = per_pass, True, per_pass @ weights
    return replace(stored, per_pass=damage, counted=counted, damage_per_km=per_km)


def _weights(stored: Stored) -> Floats:
    return unchanged(stored.record).before.weights
