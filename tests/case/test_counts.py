"""Checks that are to decide: those that the case does not make are refused."""

import pytest

from fatigue.case import load_case
from fatigue.errors import CaseError
from tests.small_case import small_case

COUNTS = [
    ("throat_perp", "body.weld_throats"),
    ("throat_par", "body.weld_throats"),
    ("throat_root", "body.weld_throats"),
    ("hot_spot", "body.stress_points"),
    ("nominal", "body.stress_points"),
    ("parent", "body.stress_points"),
    ("interaction", "checks.interaction"),
    ("endurance", "checks.endurance"),
]


@pytest.mark.parametrize(("check", "needed"), COUNTS)
def test_a_check_that_is_not_made_cannot_decide(tmp_path, check, needed):
    """The refusal names the check and what is missing."""
    case = small_case()
    case.extra = f'[checks]\ncounts = ["{check}"]\n'
    with pytest.raises(CaseError) as refusal:
        load_case(case.write(tmp_path))
    expected = f"case.toml: checks.counts: '{check}' is to decide, but {needed} is not given. Give {needed}"
    assert str(refusal.value).startswith(expected)


def test_a_check_that_is_made_may_decide(tmp_path):
    """With throats all three checks of theirs may; twice or of another name they are refused."""
    case = small_case()
    case.body = {"weld_throats": "weld_throats.csv"}
    case.extra = '[checks]\ncounts = ["throat_perp", "throat_root"]\n'
    assert load_case(case.write(tmp_path)).checks.counts == ("throat_perp", "throat_root")
    for counts in ('["throat_perp", "throat_perp"]', '["throat"]', '"throat_perp"', "[1]"):
        case.extra = f"[checks]\ncounts = {counts}\n"
        with pytest.raises(CaseError):
            load_case(case.write(tmp_path))
