"""From claims and the numbers of a study to verdicts, in the order of the claims."""

from collections.abc import Iterable, Sequence

from fatigue.study.claims.claim import Claim
from fatigue.study.claims.found import Numbers
from fatigue.study.claims.verdict import Verdict, verdict
from fatigue.study.quantities import Number, Variant


def verdicts(
    claims: Sequence[Claim], variants: Sequence[Variant], numbers: Iterable[Number], seeds: Sequence[int]
) -> tuple[Verdict, ...]:
    """Verdict about every claim, from the numbers of every variant under every seed."""
    found = Numbers(variants, numbers)
    return tuple(verdict(claim, found, seeds) for claim in claims)
