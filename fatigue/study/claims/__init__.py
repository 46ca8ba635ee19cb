"""Sentences as tests: reproduced, contradicted, or not decidable.

``claim`` are the ``[[claim]]`` tables, ``expression`` the grammar of their sides, ``place`` finds the variants they
mean, ``found`` the values under a seed, ``verdict`` compares and counts, ``rows`` are what is written.
"""

from fatigue.study.claims.claim import Claim, read_claims
from fatigue.study.claims.found import Numbers
from fatigue.study.claims.place import refuse_unplaced
from fatigue.study.claims.rows import claim_rows, claim_seed_rows
from fatigue.study.claims.story import verdicts
from fatigue.study.claims.verdict import CONTRADICTED, REPRODUCED, UNDECIDED, Verdict, verdict

__all__ = [
    "CONTRADICTED",
    "REPRODUCED",
    "UNDECIDED",
    "Claim",
    "Numbers",
    "Verdict",
    "claim_rows",
    "claim_seed_rows",
    "read_claims",
    "refuse_unplaced",
    "verdict",
    "verdicts",
]
