"""The tables of claims, and what is refused in them."""

import pytest

from fatigue.errors import CaseError
from fatigue.study.claims.claim import Claim, read_claims
from fatigue.study.claims.expression import parsed

SOUND = {"text": "hunting", "left": "f_hunt", "operator": "between", "right": [7.0, 8]}
LIKE = {"text": "x", "left": "a[fe=9.2]", "operator": ">", "right": "a[fe=14]", "factor": 2}


def test_sides_are_numbers_or_expressions():
    """A number, a pair and an expression are all right sides."""
    one, two = read_claims([SOUND, LIKE], (1, 2, 3, 4))
    assert one.right_sides == (7.0, 8.0)
    assert two.right_sides == (parsed("a[fe=14]"),)
    assert two.statement() == "a[fe=9.2] > 2 x a[fe=14]"
    assert one.statement() == "f_hunt between 7 and 8"


def test_three_quarters_of_the_seeds_have_to_agree_where_nothing_is_said():
    """The default number of seeds is three quarters of them, rounded up."""
    claim = Claim.model_validate(SOUND)
    assert [claim.needed(n) for n in (1, 2, 3, 4, 8, 12)] == [1, 2, 3, 3, 6, 9]
    assert Claim.model_validate(SOUND | {"agree": 2}).needed(4) == 2


def test_a_sentence_without_data():
    """A reason stands instead of what is compared, never beside it."""
    (claim,) = read_claims([{"text": "x", "undecidable": "the paper gives no data"}], (1,))
    assert claim.expressions == ()
    assert claim.statement() == ""
    with pytest.raises(CaseError, match="left and operator and right and undecidable are given"):
        read_claims([SOUND | {"undecidable": "no data"}], (1,))


@pytest.mark.parametrize(
    ("table", "place", "what"),
    [
        ({"left": "x"}, "text", "the key is missing"),
        ({"text": "x"}, "left", "the key is missing"),
        ({"text": "x", "left": "a", "operator": ">"}, "right", "the key is missing"),
        (SOUND | {"operator": "="}, "operator", "should be '>', '<' or 'between'"),
        (SOUND | {"operator": ">"}, "right", "has two right sides"),
        (SOUND | {"right": 7}, "right", "'between' has one end"),
        (SOUND | {"right": [7, 8, 9]}, "right", "the list has 3 items"),
        (SOUND | {"right": [8, 7]}, "right", "the lower end 8 is above the upper end 7"),
        (SOUND | {"right": True}, "right", "True is no side"),
        (SOUND | {"left": "a[fe"}, "left", "no = follows the name"),
        (LIKE | {"right": "a[fe=14"}, "right", "the bracket is not closed"),
        (LIKE | {"factor": 0}, "factor", "greater than 0"),
        (LIKE | {"tolerance": 1.0}, "tolerance", "less than 1"),
        (LIKE | {"agree": 0}, "agree", "greater than or equal to 1"),
        (LIKE | {"agree": 5}, "agree", "can never be reached by the 4 seeds"),
        (LIKE | {"seeds": [1, 2], "agree": 3}, "agree", "can never be reached by 2 seeds"),
        (LIKE | {"seeds": [1, 9]}, "seeds", "the study has no seed 9"),
        (LIKE | {"seeds": [1, 1]}, "seeds", "twice"),
        (LIKE | {"wrong": ">"}, "wrong", "unknown key"),
    ],
)
def test_what_is_refused(table, place, what):
    """A mistake names claim, key and value, once."""
    with pytest.raises(CaseError) as refused:
        read_claims([LIKE, table], (1, 2, 3, 4))
    told = [one for one in refused.value.problems if one.where.startswith(f"study.toml: claim[2].{place}")]
    assert len(told) == 1
    assert what in told[0].what
    assert told[0].remedy


def test_all_mistakes_at_once():
    """Mistakes of several claims come together."""
    with pytest.raises(CaseError) as refused:
        read_claims([LIKE | {"agree": 9}, SOUND | {"left": "["}, {"text": ""}], (1, 2))
    assert {one.where[: len("study.toml: claim[1]")][-2] for one in refused.value.problems} == set("123")
