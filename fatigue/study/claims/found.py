"""The value of a claim's side under one seed, from the numbers of a study; where there is none, the reason."""

import difflib
import fnmatch
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from fatigue.study.claims.expression import Expression, Term
from fatigue.study.claims.place import variant_of
from fatigue.study.quantities import Number, Variant

MOST_NAMED = 3


@dataclass(frozen=True, slots=True)
class Found:
    """A value, its unit, and the reason why it is NaN; of several welds the one it is of."""

    value: float
    unit: str = ""
    reason: str = ""
    weld: str = ""


class Numbers:
    """Numbers of a study, looked up by variant, seed and quantity."""

    def __init__(self, variants: Sequence[Variant], numbers: Iterable[Number]) -> None:
        self.variants = tuple(variants)
        self._by_place: dict[tuple[str, int, str], list[Number]] = {}
        for number in numbers:
            self._by_place.setdefault((number.variant, number.seed, number.quantity), []).append(number)
        self._quantities = dict.fromkeys(quantity for _, _, quantity in self._by_place)

    def side(self, side: float | Expression, seed: int) -> Found:
        """Value of one side of a claim under one seed."""
        if not isinstance(side, Expression):
            return Found(float(side))
        above = self.term(side.above, seed)
        if side.below is None:
            return above
        below = self.term(side.below, seed)
        reasons = [found.reason for found in (above, below) if math.isnan(found.value) and found.reason]
        if above.unit and below.unit and above.unit != below.unit:
            reasons.append(f"{side.above} is in {above.unit}, {side.below} in {below.unit}")
            return Found(math.nan, "", "; ".join(reasons))
        unit = "" if above.unit == below.unit else f"{above.unit}/({below.unit})"
        value = _quotient(above.value, below.value)
        if math.isnan(value) and not reasons:
            reasons = [f"{above.value:g} over {below.value:g} is no number"]
        return Found(value, unit, "; ".join(dict.fromkeys(reasons)), above.weld)

    def term(self, term: Term, seed: int) -> Found:
        """Value of one term under one seed: of the run, of a weld, or the worst of those a pattern means."""
        variant = variant_of(term, self.variants)
        if variant is None:
            return Found(math.nan, "", f"no variant has the settings of {term}")
        there = self._by_place.get((variant.name, seed, term.quantity), [])
        if not there and term.quantity not in self._quantities:
            near = difflib.get_close_matches(term.quantity, self._quantities, n=1)
            nearest = f", the nearest is {near[0]}" if near else ""
            return Found(math.nan, "", f"no run has a {term.quantity}{nearest}")
        if not there:
            return Found(math.nan, "", f"seed {seed} of {variant.name!r} has no {term.quantity}")
        wanted = [one for one in there if _is_meant(one.weld, term.weld)]
        if not wanted and not term.weld:
            wanted = there  # no number of the whole run: the worst of all welds
        if not wanted:
            names = sorted({one.weld for one in there if one.weld})
            few = ", ".join(names[:MOST_NAMED]) + (", ..." if len(names) > MOST_NAMED else "")
            return Found(math.nan, "", f"no weld is named {term.weld!r}; there are {few or 'none'}")
        return _worst(wanted)


def _is_meant(weld: str, pattern: str) -> bool:
    """Whether a weld has the name, or the pattern with * and ? fits it."""
    if not pattern or weld == pattern:
        return weld == pattern
    return bool(weld) and fnmatch.fnmatchcase(weld, pattern.replace("[", "[[]"))


def _worst(numbers: Sequence[Number]) -> Found:
    """Shortest life, else largest value; one that is missing makes nothing worse, and is told where all are."""
    known = [one for one in numbers if not math.isnan(one.value)]
    if not known:
        reasons = dict.fromkeys(one.reason for one in numbers if one.reason)
        return Found(math.nan, numbers[0].unit, "; ".join(reasons) or "there is no number and no reason why")
    pick = min if known[0].quantity.startswith("life") else max
    worst = pick(known, key=lambda one: one.value)
    return Found(worst.value, worst.unit, "", worst.weld)


def _quotient(above: float, below: float) -> float:
    """One over another: 0 below gives an infinite ratio, 0 over 0 and infinite over infinite none."""
    if math.isnan(above) or math.isnan(below):
        return math.nan
    if below == 0.0:
        return math.nan if above == 0.0 else math.copysign(math.inf, above)
    return math.nan if math.isinf(above) and math.isinf(below) else above / below
