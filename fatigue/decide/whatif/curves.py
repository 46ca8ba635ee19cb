"""The curve of every weld before and after: how damage follows from the same cycles on another law.

A cycle has the range x = S size / (I(r) f) on its curve, with the factor of the plate and what is of the cycle itself:
its bending ratio, its stress ratio. Where only the law and the size change, x is scaled. Where what is of the cycle
falls away, ranges S are entered instead. Where the new curve asks for something of the cycle that the old one did not,
only its bounds are known, or nothing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fatigue.case import Case
from fatigue.decide.whatif.asked import TwoCases
from fatigue.decide.whatif.difference import Differences
from fatigue.errors import DataError, Problem, refuse
from fatigue.life.curves import DamageLaw
from fatigue.life.rule import CycleRule
from fatigue.pipeline.solve.assessed_body import assessed_body
from fatigue.pipeline.solve.rated.rated_curves import AskedCurve, RatedCurve, curves_of_case, rated_curves
from fatigue.readers.neutral.body.strength_factors import StrengthFactor, read_strength_factors

Floats = NDArray[np.float64]
Ranges = Literal["dS", "S", "none"]


class Between(NamedTuple):
    """Smallest and largest value of a factor, (n,) each."""

    least: Floats
    most: Floats


@dataclass(frozen=True, slots=True, eq=False)
class OneCurve:
    """A curve before and after.

    Attributes
    ----------
    before, after : the curve as it is used
    limit_before, limit : allowed damage sum on it
    """

    before: RatedCurve
    after: RatedCurve
    limit_before: float
    limit: float

    @property
    def is_same(self) -> bool:
        """Whether the law of a cycle is the same; sizes may differ."""
        return _same_law(self.before.rule.law, self.after.rule.law) and self.same_cycle

    @property
    def same_cycle(self) -> bool:
        """Whether what is of the cycle itself enters both in the same way."""
        return _of_cycle(self.before.rule) == _of_cycle(self.after.rule)

    @property
    def ranges(self) -> Ranges:
        """Which ranges of the result the new law is entered with; none: cycles have to be counted again."""
        if self.same_cycle:
            return "dS"
        rule = self.after.rule
        return "S" if rule.stress_ratio == "none" and not rule.mean_stress else "none"

    @property
    def same_size(self) -> bool:
        """Whether plates of any thickness have the same factor on the range."""
        return _of_size(self.before) == _of_size(self.after)

    @property
    def slope(self) -> float:
        """Exponent of the power sums of the result."""
        return float(self.before.rule.law.slopes[0])

    @property
    def is_exact(self) -> bool:
        """Whether the damage of every cycle is multiplied by one number: both laws of one slope, and the same one."""
        old, new = self.before.rule.law, self.after.rule.law
        return self.same_cycle and old.is_straight and new.is_straight and old.slopes[0] == new.slopes[0]

    def range_factors(self, thickness: Floats, attachment: Floats) -> Between:
        """Factor (n,) from the range that ``ranges`` names to that of the new law."""
        after = self.after.size(thickness, attachment)
        if self.ranges == "dS":
            same = after / self.before.size(thickness, attachment)
            return Between(same, same)
        least, most = _of_bending(self.after.rule)
        return Between(after / most, after / least)

    def equivalent_factors(self, thickness: Floats, attachment: Floats) -> Between | None:
        """Factor (n,) from the equivalent range of the old law to that of the new one; None: nothing bounds it."""
        own = self.range_factors(thickness, attachment)
        if self.ranges == "dS":
            return own
        if self.before.rule.mean_stress or self.before.rule.stress_ratio != "none":
            return None
        least, most = _of_bending(self.before.rule)
        before = self.before.size(thickness, attachment)
        return Between(own.least * least / before, own.most * most / before)


@dataclass(frozen=True, slots=True, eq=False)
class Curves:
    """Curves of all welds; ``of_weld`` has the number of the curve of each, by the name of the weld."""

    curves: tuple[OneCurve, ...]
    of_weld: Mapping[str, int]


def curves_of(
    record: Mapping[str, Any], folder: Path, cases: TwoCases, found: Differences, curve_of_weld: Mapping[str, str]
) -> Curves:
    """Curves before and after; ``curve_of_weld`` are their names in the result.

    Raises
    ------
    CaseError : a curve that is not there, or that has no place for what is asked of it
    DataError : a curve is not what it was when the result was computed, or a file is gone that tells about curves
    """
    base, changed = cases.base, cases.changed
    names = dict.fromkeys(curve_of_weld.values())
    known = {name: _factors(record["curves"][name]) for name in names}
    before = _rated(base, list(names), known)
    refuse(DataError, [_other_curve(record, name) for name in names if not _is_recorded(record, before[name], base)])
    of_weld = dict(curve_of_weld)
    if ("curve", "name") in (one.key for one in found.keys):
        body = assessed_body(record, folder, None)
        own = {weld.name: weld.curve for weld in body.welds}
        of_weld = {weld: own[weld] or changed.curve.name for weld in curve_of_weld}
        if base.checks.strength_factors is not None:
            table = base.resolve(base.checks.strength_factors)
            factors, _ = read_strength_factors(table, curves_of_case(changed), strict=False)
            own_factors = tuple(one for one in factors if one.curve == changed.curve.name)
            known = {**known, changed.curve.name: own_factors}
    after = _rated(changed, list(dict.fromkeys(of_weld.values())), known)
    pairs = {weld: (curve_of_weld[weld], of_weld[weld]) for weld in curve_of_weld}
    every = list(dict.fromkeys(pairs.values()))
    limits = base.mission.damage_limit, changed.mission.damage_limit
    return Curves(
        tuple(
            OneCurve(before[a], after[b], before[a].damage_limit(limits[0]), after[b].damage_limit(limits[1]))
            for a, b in every
        ),
        {weld: every.index(pair) for weld, pair in pairs.items()},
    )


def _rated(
    case: Case, names: Sequence[str], factors: Mapping[str, tuple[StrengthFactor, ...]]
) -> dict[str, RatedCurve]:
    """Curves of a case as it uses them at toes."""
    asked = [AskedCurve(name, f"{case.path.name}: curve.name") for name in names]
    every = [factor for name in names for factor in factors.get(name, ())]
    return rated_curves(case, curves_of_case(case), asked, every)


def _factors(recorded: Mapping[str, Any]) -> tuple[StrengthFactor, ...]:
    """Factors on a curve as the provenance has them."""
    return tuple(StrengthFactor(**factor) for factor in recorded.get("factors", ()))


def _is_recorded(record: Mapping[str, Any], rated: RatedCurve, case: Case) -> bool:
    """Whether a curve is what the result was computed with."""
    used, law = record["curves"][rated.curve.name]["used"], rated.rule.law
    limit = rated.damage_limit(case.mission.damage_limit)
    pairs: list[tuple[ArrayLike, ArrayLike]] = [
        (law.slopes, used["slopes"]),
        (law.log_constants, used["log_constants"]),
        (law.knees, used["knees"]),
        (law.cutoff, used["cutoff"]),
        (rated.on_range, used.get("factor_on_range", 1.0)),
        (limit, used.get("damage_limit", limit)),
    ]
    return all(_is_close(ours, stored) for ours, stored in pairs)


def _is_close(ours: ArrayLike, stored: ArrayLike) -> bool:
    a, b = np.asarray(ours, np.float64), np.asarray(stored, np.float64)
    return a.shape == b.shape and np.allclose(a, b, rtol=1e-12)


def _other_curve(record: Mapping[str, Any], name: str) -> Problem:
    what = f"curve '{name}' of this version is another one than that of the result"
    return Problem("changed_curve", str(record["case_file"]), what, "Assess again with this version")


def _of_size(rated: RatedCurve) -> tuple[object, ...]:
    """What the factor of a plate on the range depends on."""
    curve = rated.curve
    of = curve.allowances
    thickness = (curve.thickness_reference, curve.thickness_exponent, of.thickness_effective, rated.thickness_rule)
    bending = (of.bending_factor, of.bending_reference, of.bending_exponent)
    return curve.applies, *thickness, *bending, rated.on_range


def _of_cycle(rule: CycleRule) -> tuple[object, ...]:
    """What is of the cycle itself in its range."""
    return rule.uses_bending_ratio, rule.bending_factor, rule.stress_ratio, rule.yield_of_damage


def _of_bending(rule: CycleRule) -> tuple[float, float]:
    """Smallest and largest number that bending may divide a range by: that of pure membrane and of pure bending."""
    of_membrane, of_bending = rule.ratio_factor(np.array([0.0, 1.0])).tolist()
    return of_membrane, of_bending


def _same_law(old: DamageLaw, new: DamageLaw) -> bool:
    numbers = ((old.slopes, new.slopes), (old.log_constants, new.log_constants), (old.knees, new.knees))
    return old.cutoff == new.cutoff and all(np.array_equal(a, b) for a, b in numbers)
