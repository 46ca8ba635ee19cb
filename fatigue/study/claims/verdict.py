"""Verdicts: seed by seed whether the sentence holds or its reverse, and what all of them say together."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fatigue.study.claims.claim import Claim, Operator
from fatigue.study.claims.found import Found, Numbers
from fatigue.study.quantities import is_life

Word = Literal["reproduced", "contradicted", "not decidable"]
Says = Literal["holds", "reverse", "same", "unknown"]
REPRODUCED: Word = "reproduced"
CONTRADICTED: Word = "contradicted"
UNDECIDED: Word = "not decidable"


@dataclass(frozen=True, slots=True)
class OfSeed:
    """Both sides under one seed; ``right`` with the factor in it, the nearer end where there are two."""

    seed: int
    left: float
    right: float
    ratio: float  # left over right; NaN where nothing is compared or right is 0
    says: Says
    reason: str = ""


@dataclass(frozen=True, slots=True)
class Scatter:
    """Mean, standard deviation (of a sample, NaN of one), least and greatest of what is known; all NaN of nothing."""

    mean: float
    sd: float
    low: float
    high: float
    known: int


@dataclass(frozen=True, slots=True)
class Verdict:
    """What a study says of one claim."""

    claim: Claim
    verdict: Word
    reason: str
    of_seeds: tuple[OfSeed, ...]
    needed: int
    unit: str
    is_logarithmic: bool  # means are geometric, sd is that of log10: lives and damage

    def count(self, says: Says) -> int:
        """Number of seeds that say something."""
        return sum(one.says == says for one in self.of_seeds)

    @property
    def left(self) -> Scatter:
        """Scatter of the left side."""
        return scatter([one.left for one in self.of_seeds], logarithmic=self.is_logarithmic)

    @property
    def right(self) -> Scatter:
        """Scatter of the right side."""
        return scatter([one.right for one in self.of_seeds], logarithmic=self.is_logarithmic)

    @property
    def ratio(self) -> Scatter:
        """Scatter of left over right, seed by seed."""
        return scatter([one.ratio for one in self.of_seeds], logarithmic=self.is_logarithmic)


def verdict(claim: Claim, numbers: Numbers, seeds: Sequence[int]) -> Verdict:
    """Verdict about one claim: both sides of the same seed are compared, and seeds counted."""
    if claim.undecidable is not None:
        return Verdict(claim, UNDECIDED, claim.undecidable, (), 0, "", is_logarithmic=False)
    of_seeds, units = zip(*(_of_seed(claim, numbers, seed) for seed in claim.seeds or seeds), strict=True)
    needed = claim.needed(len(of_seeds))
    word, reason = judged(of_seeds, needed)
    unit = next((one for one in units if one), "")
    logarithmic = any(is_life(term.quantity) for side in claim.expressions for term in side.terms)
    return Verdict(claim, word, reason, of_seeds, needed, unit, logarithmic)


def judged(of_seeds: Sequence[OfSeed], needed: int) -> tuple[Word, str]:
    """Verdict of what the seeds say, and the reason where nothing can be decided.

    Reproduced if at least ``needed`` seeds hold, contradicted if at least as many hold the reverse; if both do, the
    seeds divide, and nothing is decided.
    """
    says = [one.says for one in of_seeds]
    holds, reverse = says.count("holds") >= needed, says.count("reverse") >= needed
    if holds != reverse:
        return (REPRODUCED, "") if holds else (CONTRADICTED, "")
    parts = [f"{says.count(word)} of {len(says)} seeds {_TOLD[word]}" for word in _TOLD if word in says]
    known = f"{', '.join(parts)}; {needed} have to agree"
    reasons = dict.fromkeys(one.reason for one in of_seeds if one.reason)
    return UNDECIDED, ". ".join((known, *reasons))


_TOLD: dict[Says, str] = {
    "holds": "hold the sentence",
    "reverse": "hold its reverse",
    "same": "have both sides equal",
    "unknown": "have no number",
}


def compared(left: float, operator: Operator, right: Sequence[float], tolerance: float = 0.0) -> Says:
    """Whether a sentence holds, its reverse, or neither: within the tolerance, a share of the larger side, or unknown.

    ``right`` is one number, or for 'between' the lower and the upper end, which belong to what lies between.

    >>> compared(2.0, ">", [1.0]), compared(1.0, ">", [1.0]), compared(3.0, "between", [1.0, 2.0])
    ('holds', 'same', 'reverse')
    """
    if math.isnan(left) or any(map(math.isnan, right)):
        return "unknown"
    if operator == "between":
        low, high = right
        if low > high:
            return "unknown"
        clear = [_is_above(left, low, tolerance), _is_above(high, left, tolerance)]
        if "reverse" in clear:
            return "reverse"
        return "same" if tolerance > 0.0 and "same" in clear else "holds"
    (other,) = right
    return _is_above(left, other, tolerance) if operator == ">" else _is_above(other, left, tolerance)


def _is_above(one: float, other: float, tolerance: float) -> Says:
    """Whether one is above the other by more than the tolerance, below by more, or neither."""
    if one == other:
        return "same"
    finite = math.isfinite(one) and math.isfinite(other)
    if finite and abs(one - other) <= tolerance * max(abs(one), abs(other)):
        return "same"
    return "holds" if one > other else "reverse"


def scatter(values: Sequence[float], *, logarithmic: bool = False) -> Scatter:
    """Scatter of the values that are known; logarithmic: the mean is geometric, sd that of log10.

    >>> scatter([1.0, 100.0], logarithmic=True).mean
    10.0
    """
    known = np.array([value for value in values if not math.isnan(value)])
    if not known.size:
        return Scatter(math.nan, math.nan, math.nan, math.nan, 0)
    with np.errstate(all="ignore"):
        by_log = logarithmic and bool((known > 0.0).all())
        scale = np.log10(known) if by_log else known
        mean, sd = float(scale.mean()), float(scale.std(ddof=1)) if known.size > 1 else math.nan
        mean = float(10.0**mean) if by_log else mean
    return Scatter(mean, sd, float(known.min()), float(known.max()), int(known.size))


def _of_seed(claim: Claim, numbers: Numbers, seed: int) -> tuple[OfSeed, str]:
    """Both sides of a claim under one seed, and the unit of the left one."""
    assert claim.left_side is not None
    assert claim.operator is not None
    left = numbers.side(claim.left_side, seed)
    sides = [numbers.side(side, seed) for side in claim.right_sides]
    ends = [claim.factor * side.value for side in sides]
    reasons = _reasons(left, sides)
    says = "unknown" if reasons else compared(left.value, claim.operator, ends, claim.tolerance)
    if says == "unknown" and not reasons:
        reasons = [f"the lower end {ends[0]:g} is above the upper end {ends[1]:g}"]
    right = _nearer(left.value, ends)
    ratio = left.value / right if right != 0.0 and math.isfinite(left.value) and math.isfinite(right) else math.nan
    of_seed = OfSeed(seed, left.value, right, ratio, says, "; ".join(dict.fromkeys(reasons)))
    return of_seed, left.unit


def _reasons(left: Found, sides: Sequence[Found]) -> list[str]:
    """Reasons why both sides cannot be compared: one is missing, or their units differ."""
    missing = [one.reason or "no number" for one in (left, *sides) if math.isnan(one.value)]
    unlike = [side.unit for side in sides if side.unit and left.unit and side.unit != left.unit]
    return missing + [f"left is in {left.unit}, right in {unit}" for unit in unlike]


def _nearer(left: float, ends: Sequence[float]) -> float:
    """End of 'between' that is nearer to the left side on a scale of ratios; the one right side there is."""
    if len(ends) == 1 or math.isnan(left):
        return ends[0]
    return min(ends, key=lambda end: abs(left - end) if math.isfinite(end) else math.inf)
