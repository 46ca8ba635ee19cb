"""Which variant a term means, and what is refused before anything runs."""

import pytest

from fatigue.errors import CaseError
from fatigue.study.claims.claim import Claim
from fatigue.study.claims.expression import parsed
from fatigue.study.claims.place import is_same, refuse_unplaced, variant_of
from fatigue.study.quantities import Variant
from tests.study.claims.studied import VARIANTS


def name_of(text, variants=VARIANTS):
    """Name of the variant of a term."""
    found = variant_of(parsed(text).above, variants)
    return found and found.name


def test_what_is_not_named_stays_at_the_base():
    """Settings are those of the base but for what stands between brackets."""
    assert name_of("x") == "base"
    assert name_of("x[fe=14]") == "fe=14"
    assert name_of("x[fe=14.0, contact=worn]") == "both"
    assert name_of("x[contact=worn, fe=9.2]") == "contact=worn"


def test_a_variant_by_its_name():
    """A variant may be named itself, with settings on top of it."""
    assert name_of('x[variant="both"]') == "both"
    assert name_of("x[variant=both, contact=sound]") == "fe=14"


@pytest.mark.parametrize(
    ("held", "asked", "same"),
    [
        (9.2, 9.2, True),
        (350, 350.0, True),
        (True, 1, False),
        (True, True, True),
        ("worn", "worn", True),
        ("2", 2, True),
        (2, "2", True),
        ("a", 2, False),
    ],
)
def test_values_are_compared_by_what_they_are(held, asked, same):
    """Numbers are compared by value, truth values are no numbers, a text that reads as a number is one."""
    assert is_same(held, asked) is same


@pytest.mark.parametrize(
    ("left", "what", "remedy"),
    [
        ("conv_y_rms[fee=14]", "the study does not vary 'fee'", "Write 'fe'"),
        ("conv_y_rms[fe=14.1]", "no variant has fe = 14.1", "Write '14.0', or add it to the study"),
        ("conv_y_rms[contact=wrn]", 'no variant has contact = "wrn"', "Write 'worn', or add it to the study"),
        ("conv_y_rms[variant=bothh]", "there is no variant 'bothh'", "Write 'both'"),
        ("conv_yy_rms", "the study has no quantity 'conv_yy_rms'", "Write 'conv_y_rms'"),
        ("conv_y_rms[fe=14] / conv_y_rm[fe=14]", "the study has no quantity 'conv_y_rm'", "Write 'conv_y_rms'"),
    ],
)
def test_what_is_not_there_is_refused_with_the_nearest(left, what, remedy):
    """Names and values that the study does not have are told with the nearest one."""
    claims = [Claim.model_validate({"text": "x", "left": left, "operator": ">", "right": 1})]
    with pytest.raises(CaseError) as refused:
        refuse_unplaced(claims, VARIANTS, ["conv_y_rms", "f_hunt"])
    (problem,) = refused.value.problems
    assert what == problem.what
    assert problem.remedy == remedy
    assert problem.where.startswith("study.toml: claim[1]: ")


def test_a_combination_that_is_not_there_says_how_to_add_it():
    """Values that are there alone and not together are told with the lines that add them."""
    claims = [Claim.model_validate({"text": "x", "left": "a", "operator": ">", "right": "a[fe=14,contact=worn]"})]
    keys = {"fe": "vehicle.converter.fe_hz", "contact": "vehicle.contact.state"}
    with pytest.raises(CaseError) as refused:
        refuse_unplaced(claims, VARIANTS[:3], keys=keys)
    (problem,) = refused.value.problems
    assert problem.what == 'no variant of the study has fe = 14, contact = "worn" together'
    assert 'set = { "vehicle.converter.fe_hz" = 14, "vehicle.contact.state" = "worn" }' in problem.remedy
    assert 'combine = "full"' in problem.remedy


def test_a_study_that_varies_nothing():
    """A study of the base alone has nothing to name."""
    claims = [Claim.model_validate({"text": "x", "left": "a[fe=1]", "operator": ">", "right": 1})]
    with pytest.raises(CaseError, match="It varies nothing"):
        refuse_unplaced(claims, [Variant("base", {})])
    refuse_unplaced(
        [Claim.model_validate({"text": "x", "left": "a", "operator": ">", "right": 1})], [Variant("base", {})]
    )
