"""Rows of the tables ``claims`` and ``claim_seeds``."""

from collections.abc import Sequence
from dataclasses import dataclass

from fatigue.study.claims.verdict import Verdict


@dataclass(frozen=True, slots=True)
class ClaimRow:
    """One row of ``claims``; its columns are described in the data dictionary."""

    claim: int
    text: str
    paper: str
    statement: str | None
    verdict: str
    reason: str | None
    seeds: int
    needed: int
    hold: int
    reverse: int
    unit: str | None
    left_mean: float
    left_sd: float
    left_min: float
    left_max: float
    right_mean: float
    right_sd: float
    right_min: float
    right_max: float
    ratio_mean: float
    ratio_sd: float
    ratio_min: float
    ratio_max: float


@dataclass(frozen=True, slots=True)
class ClaimSeedRow:
    """One row of ``claim_seeds``; its columns are described in the data dictionary."""

    claim: int
    seed: int
    left: float
    right: float
    ratio: float
    says: str
    reason: str | None


def claim_rows(verdicts: Sequence[Verdict]) -> list[ClaimRow]:
    """Rows of ``claims``, in the order of the study."""
    return [_row(number, one) for number, one in enumerate(verdicts, 1)]


def claim_seed_rows(verdicts: Sequence[Verdict]) -> list[ClaimSeedRow]:
    """Rows of ``claim_seeds``: both sides under every seed."""
    return [
        ClaimSeedRow(number, of.seed, of.left, of.right, of.ratio, of.says, of.reason or None)
        for number, one in enumerate(verdicts, 1)
        for of in one.of_seeds
    ]


def _row(number: int, one: Verdict) -> ClaimRow:
    scatters = (one.left, one.right, one.ratio)
    return ClaimRow(
        number,
        one.claim.text,
        one.claim.paper,
        one.claim.statement() or None,
        one.verdict,
        one.reason or None,
        len(one.of_seeds),
        one.needed,
        one.count("holds"),
        one.count("reverse"),
        one.unit or None,
        *(value for of in scatters for value in (of.mean, of.sd, of.low, of.high)),
    )
