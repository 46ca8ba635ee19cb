"""Which variants are drawn beside each other."""

from fatigue.study.page.chosen import facing, groups
from fatigue.study.quantities import Variant
from tests.study.page.studied_example import CLAIMS, VARIANTS, studied


def test_groups_differ_in_one_thing_and_those_of_claims_come_first():
    """The converter frequency on worn wheels, which two claims are about, comes before that on sound ones."""
    found = groups(studied())
    assert [group.title for group in found] == ["fe, with contact = worn", "contact", "fe", "contact, with fe = 14"]
    assert found[0].labels == ("fe = 9.2", "fe = 14")
    for group in found:
        names = [
            {k for k in one.settings if one.settings[k] != group.variants[0].settings[k]} for one in group.variants
        ]
        assert max(map(len, names)) == 1


def test_variants_that_differ_in_several_things_are_one_group():
    """Where nothing differs in one thing alone the first variants are drawn."""
    variants = (Variant("base", {"a": 1, "b": 1}), Variant("other", {"a": 2, "b": 2}))
    (group,) = groups(studied(variants=variants, claims=()))
    assert (group.title, group.labels) == ("", ("base", "other"))


def test_maps_face_what_a_claim_about_lives_compares():
    """Two variants of a claim about lives, the one it starts from first; else base and another; of one variant none."""
    assert facing(studied()) == (VARIANTS[2], VARIANTS[3])
    assert facing(studied(claims=CLAIMS[:1])) == (VARIANTS[0], VARIANTS[2])
    assert facing(studied(claims=(), variants=VARIANTS[:1])) is None
