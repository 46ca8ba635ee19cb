"""Columns of the verdicts about the claims of a study, and of what each seed says of them."""

from fatigue.results.dictionary.column import Column

_SCATTER = {"mean": "mean", "sd": "standard deviation", "min": "least", "max": "greatest"}


def _scatter(side: str, unit: str, of: str) -> tuple[Column, ...]:
    """Columns of the scatter over seeds of one side."""
    note = {"mean": "; geometric for lives and damage", "sd": "; of log10 for lives and damage"}
    return tuple(
        Column(f"{side}_{key}", "float", unit, f"{word} of {of} over the seeds{note.get(key, '')}")
        for key, word in _SCATTER.items()
    )


CLAIMS = (
    Column("claim", "int", "-", "number of the claim in the study, from 1"),
    Column("text", "text", "-", "sentence in the words of the study"),
    Column("paper", "text", "-", "sentence it comes from, or where it stands"),
    Column("statement", "text", "-", "what is compared; missing where nothing can be"),
    Column("verdict", "text", "-", "reproduced, contradicted or not decidable, by this study and no other"),
    Column("reason", "text", "-", "why it is not decidable"),
    Column("seeds", "int", "-", "seeds it was tried under"),
    Column("needed", "int", "-", "seeds that have to agree"),
    Column("hold", "int", "-", "seeds that hold the sentence"),
    Column("reverse", "int", "-", "seeds that hold its reverse"),
    Column("unit", "text", "-", "unit of both sides, missing for a ratio"),
    *_scatter("left", "unit", "the left side"),
    *_scatter("right", "unit", "the right side, factor included; of 'between' the nearer end"),
    *_scatter("ratio", "-", "left over right, seed by seed"),
)
CLAIM_SEEDS = (
    Column("claim", "int", "-", "number of the claim in the study, from 1"),
    Column("seed", "int", "-", "seed of both sides"),
    Column("left", "float", "unit", "left side"),
    Column("right", "float", "unit", "right side, factor included; of 'between' the nearer end"),
    Column("ratio", "float", "-", "left over right"),
    Column("says", "text", "-", "holds, reverse, same (within the tolerance) or unknown"),
    Column("reason", "text", "-", "why it is unknown"),
)
CLAIMED: dict[str, tuple[Column, ...]] = {"claims": CLAIMS, "claim_seeds": CLAIM_SEEDS}
