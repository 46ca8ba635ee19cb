"""Tables of verdicts."""

from dataclasses import asdict, fields

from fatigue.results.dictionary.claims import CLAIM_SEEDS, CLAIMS
from fatigue.study.claims import claim_rows, claim_seed_rows, read_claims, verdicts
from fatigue.study.claims.rows import ClaimRow, ClaimSeedRow
from tests.study.claims.studied import SEEDS, VARIANTS, numbers


def test_rows_have_the_columns_of_the_dictionary():
    """Every field is a column, in the same order."""
    assert [field.name for field in fields(ClaimRow)] == [column.name for column in CLAIMS]
    assert [field.name for field in fields(ClaimSeedRow)] == [column.name for column in CLAIM_SEEDS]


def test_rows_of_verdicts():
    """One row of each claim, one of each seed of those that are tried."""
    worn = {"left": "conv_y_rms[contact=worn]", "operator": ">", "right": "conv_y_rms", "factor": 3}
    claims = read_claims([{"text": "a", "paper": "b", **worn}, {"text": "c", "undecidable": "no data"}], SEEDS)
    found = verdicts(claims, VARIANTS, numbers(), SEEDS)
    one, two = (asdict(row) for row in claim_rows(found))
    assert (one["claim"], one["verdict"], one["hold"], one["needed"]) == (1, "reproduced", 4, 3)
    assert one["statement"] == "conv_y_rms[contact=worn] > 3 x conv_y_rms"
    assert (two["verdict"], two["reason"], two["seeds"], two["statement"]) == ("not decidable", "no data", 0, None)
    rows = claim_seed_rows(found)
    assert [(row.claim, row.seed, row.says) for row in rows] == [(1, seed, "holds") for seed in SEEDS]
    assert rows[0].left == 2.3
