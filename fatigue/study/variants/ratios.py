"""Each variant over the one it differs from in one thing, seed by seed: the same irregularities, another vehicle.

A variant that differs from the base in several things is laid beside each variant that lacks one of them, and beside
the base.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isnan

from fatigue.study.quantities import Number, Variant, is_life
from fatigue.study.variants.scatter import Key, by_variant, spread, usable
from fatigue.study.variants.varied.names import shown


@dataclass(frozen=True, slots=True)
class RatioRow:
    """One quantity of one variant over that of another; fields are columns of ``ratios.parquet``."""

    variant: str
    against: str
    changed: str
    quantity: str
    weld: str
    ratio: float
    sd: float
    min: float
    max: float
    n: int
    sd_log10: float
    agree: int
    seeds_above: str
    seeds_below: str
    reason: str


def pairs(variants: Sequence[Variant]) -> Iterator[tuple[Variant, Variant, str]]:
    """Variants to be compared, what each is compared with, and what differs; the first variant is the base.

    >>> base, fe = Variant("base", {"fe": 9.2, "worn": False}), Variant("fe=14", {"fe": 14.0, "worn": False})
    >>> worn = Variant("worn=true", {"fe": 9.2, "worn": True})
    >>> both = Variant("both", {"fe": 14.0, "worn": True})
    >>> for one, other, changed in pairs([base, fe, worn, both]):
    ...     print(f"{one.name} against {other.name}: {changed}")
    fe=14 against base: fe=14 / 9.2
    worn=true against base: worn=true / false
    both against worn=true: fe=14 / 9.2
    both against fe=14: worn=true / false
    both against base: fe=14 / 9.2, worn=true / false
    """
    base = variants[0]
    by_settings = {_key(variant.settings): variant for variant in reversed(variants)}
    for variant in variants[1:]:
        differing = [name for name in variant.settings if variant.settings[name] != base.settings[name]]
        others = []
        for name in differing if len(differing) > 1 else ():
            others.append(by_settings.get(_key({**variant.settings, name: base.settings[name]})))
        for other in (*others, base):
            if other is not None and other is not variant:
                yield variant, other, _changed(variant, other)


def _key(settings: Mapping[str, object]) -> tuple[tuple[str, type, object], ...]:
    return tuple((name, type(value) if isinstance(value, bool) else object, value) for name, value in settings.items())


def _changed(variant: Variant, other: Variant) -> str:
    names = [name for name in variant.settings if variant.settings[name] != other.settings[name]]
    return ", ".join(f"{name}={shown(variant.settings[name])} / {shown(other.settings[name])}" for name in names)


def ratio_rows(variants: Sequence[Variant], numbers: Iterable[Number]) -> list[RatioRow]:
    """Ratios of every quantity between the variants that are to be compared."""
    found = by_variant(numbers)
    rows = []
    for variant, other, changed in pairs(variants):
        mine, its = found.get(variant.name, {}), found.get(other.name, {})
        rows += [_row(variant.name, other.name, changed, key, mine[key], its.get(key, {})) for key in mine]
    return rows


def _row(
    variant: str, against: str, changed: str, key: Key, mine: Mapping[int, Number], its: Mapping[int, Number]
) -> RatioRow:
    life = is_life(key[0])
    ratios: dict[int, float] = {}
    reasons: list[str] = []
    for seed, number in mine.items():
        why = _why_none(number, its.get(seed), of_logarithm=life)
        if why:
            reasons.append(f"seed {seed}: {why}")
        else:
            ratios[seed] = number.value / its[seed].value
    of = spread(list(ratios.values()), of_logarithm=life)
    above, below = ([seed for seed in ratios if _side(ratios[seed]) == side] for side in (1, -1))
    agree = len(above) if of.mean > 1.0 else len(below) if of.mean < 1.0 else 0
    reason = reasons[0] if reasons else ""
    reason += f" (and {len(reasons) - 1} more seeds)" if len(reasons) > 1 else ""
    return RatioRow(
        variant=variant,
        against=against,
        changed=changed,
        quantity=key[0],
        weld=key[1],
        ratio=of.mean,
        sd=of.sd,
        min=of.least,
        max=of.most,
        n=of.n,
        sd_log10=of.sd_log10,
        agree=agree,
        seeds_above=", ".join(map(str, above)),
        seeds_below=", ".join(map(str, below)),
        reason=reason,
    )


def _side(ratio: float) -> int:
    return (ratio > 1.0) - (ratio < 1.0)


def _why_none(number: Number, other: Number | None, *, of_logarithm: bool) -> str:
    """Why two numbers have no ratio; empty where they have one."""
    if other is None:
        return "the other variant has no such number"
    for one in (number, other):
        if isnan(one.value):
            return one.reason or "there is no number"
        if one.value in (inf, -inf):
            return "it is infinite"
    if of_logarithm and not (usable(number.value, of_logarithm=True) and usable(other.value, of_logarithm=True)):
        return "it is 0 or below"
    return "it would be divided by 0" if other.value == 0.0 else ""
