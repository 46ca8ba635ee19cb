"""Which variants are drawn beside each other: those that differ in one thing only, those of claims first."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from fatigue.study.claims.place import variant_of
from fatigue.study.claims.verdict import Verdict
from fatigue.study.page.studied import Studied
from fatigue.study.quantities import Variant
from fatigue.study.variants.varied.names import shown

MOST_LINES = 6  # of one figure
MOST_GROUPS = 4
MOST_OF_ONE_NAME = 2


@dataclass(frozen=True, slots=True)
class Group:
    """Variants that differ in one thing, or all of a study; ``labels`` say of each what it is."""

    title: str
    variants: tuple[Variant, ...]
    labels: tuple[str, ...]


def groups(of: Studied) -> list[Group]:
    """Groups to draw: of each thing that is varied, at most two, those with more variants of claims first.

    Where no two variants differ in one thing alone, the first variants are one group.
    """
    claimed = claimed_variants(of)
    found: list[tuple[int, int, Group]] = []
    for name in dict.fromkeys(name for one in of.variants for name in one.settings):
        same: dict[tuple[tuple[str, str], ...], list[Variant]] = {}
        for one in of.variants:
            others = tuple((key, shown(value)) for key, value in one.settings.items() if key != name)
            same.setdefault(others, []).append(one)
        several = [(others, members) for others, members in same.items() if len(members) > 1]
        several.sort(key=lambda pair: -sum(claimed[one.name] for one in pair[1]))  # the base comes first of equals
        for others, members in several[:MOST_OF_ONE_NAME]:
            weight = sum(claimed[one.name] for one in members)
            found.append((weight, len(found), _group(of, name, dict(others), members)))
    if not found and of.variants:
        first = tuple(of.variants[:MOST_LINES])
        return [Group("", first, tuple(one.name for one in first))]
    return [group for _, _, group in sorted(found, key=lambda one: (-one[0], one[1]))[:MOST_GROUPS]]


def claimed_variants(of: Studied) -> Counter[str]:
    """How often claims name each variant."""
    terms = (term for verdict in of.verdicts for side in verdict.claim.expressions for term in side.terms)
    return Counter(one.name for term in terms if (one := variant_of(term, of.variants)) is not None)


def facing(of: Studied) -> tuple[Variant, Variant] | None:
    """Two variants to lay side by side: those of the first claim about lives, else base and the most claimed other.

    None of a study of one variant.
    """
    for verdict in of.verdicts:
        if pair := _compared(verdict, of.variants):
            return pair
    if len(of.variants) < 2:
        return None
    claimed = claimed_variants(of)
    return of.variants[0], max(of.variants[1:], key=lambda one: claimed[one.name])


def _compared(verdict: Verdict, variants: Sequence[Variant]) -> tuple[Variant, Variant] | None:
    """The two variants whose lives a claim compares; None of any other claim."""
    terms = [term for side in verdict.claim.expressions for term in side.terms if term.quantity.startswith("life")]
    meant = [variant for term in terms if (variant := variant_of(term, variants)) is not None]
    return (meant[1], meant[0]) if len(meant) == 2 and meant[0] is not meant[1] else None


def _group(of: Studied, name: str, others: dict[str, str], members: Sequence[Variant]) -> Group:
    """Group of variants that differ in one thing; what else is off the base stands in the title."""
    base = of.variants[0].settings
    off = [f"{key} = {value}" for key, value in others.items() if value != shown(base.get(key))]
    kept = tuple(members[:MOST_LINES])
    labels = tuple(f"{name} = {shown(one.settings[name])}" for one in kept)
    return Group(f"{name}, with {', '.join(off)}" if off else name, kept, labels)
