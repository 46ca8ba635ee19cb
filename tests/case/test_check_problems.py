"""Interactions and endurance checks in a case: what is read, and every contradiction with its place and remedy."""

import pytest

from fatigue.errors import CaseError
from tests.case.case_text import MINIMAL

FILES = '[checks]\nstatic_cases = "cases.csv"\nendurance_lines = "lines.csv"\n'
ENDURANCE = '[[checks.endurance]]\ncases = "ride"\nperp = "F3"\nshear = "H"\n'


def refusal(load, text):
    """Message of the refusal of a case with some tables behind the others."""
    with pytest.raises(CaseError) as refused:
        load(MINIMAL + text)
    return str(refused.value)


def interaction(*keys):
    """Table of an interaction."""
    return "\n".join(["[[checks.interaction]]", *keys, ""])


def test_rules_with_what_they_need(load):
    """Each rule takes the keys that it has a use for; iiw and en1999 take them from the user."""
    case = load(
        MINIMAL
        + interaction('rule = "en1993"', 'welds = ["a", "b"]')
        + interaction('rule = "iiw"', "cv = 0.5", "damage_limit = 0.5")
        + interaction('rule = "en1999"', "damage_limit = 0.3")
    )
    assert [one.rule for one in case.checks.interaction] == ["en1993", "iiw", "en1999"]
    assert case.checks.interaction[0].welds == ("a", "b")


def test_an_endurance_check(load):
    """Lines by component; the files of cases and lines are inputs."""
    case = load(MINIMAL + FILES + ENDURANCE + 'limit = 1.1\nwelds = ["a"]\n')
    (check,) = case.checks.endurance
    assert check.lines == {"perp": "F3", "shear": "H"}
    assert case.input_files()["checks.static_cases"].name == "cases.csv"
    assert case.input_files()["checks.endurance_lines"].name == "lines.csv"


WRONG_INTERACTIONS = [
    (['rule = "iiw"', "damage_limit = 0.5"], "cv: the key is missing although rule = 'iiw' is given, and it has no"),
    (['rule = "iiw"', "cv = 1.0"], "damage_limit: the key is missing although rule = 'iiw' is given, and it has no"),
    (['rule = "en1999"'], "damage_limit: the key is missing although rule = 'en1999' is given, and it has no default."),
    (['rule = "en1999"', "damage_limit = 1", "cv = 1"], "cv: 1 is given, and rule 'en1999' has no use for it. Remove"),
    (
        ['rule = "en1993"', "damage_limit = 0.5"],
        "damage_limit: 0.5 is given, and rule 'en1993' has no use for it. Remove it; it is for 'iiw' and 'en1999'.",
    ),
    (['rule = "en1993"', "alpha = 0.9"], "alpha: 0.9 is given, and rule 'en1993' has no use for it. Remove it; it is"),
    (
        ['rule = "dnv"', "alpha = 0.9"],
        "rule: 'dnv' compares principal stress ranges, which need the stress along the weld, and line forces do not",
    ),
    (['rule = "en1990"'], "rule: \"en1990\" should be 'en1993', 'iiw', 'en1999' or 'dnv'."),
    (['rule = "en1993"', 'welds = ["a", "b", "a"]'], "welds: names 'a' twice. Name it once."),
    (['rule = "en1993"', "welds = []"], "welds: [] is empty. Give a list of the welds; left out: every weld with"),
    (['rule = "iiw"', "cv = 0.0", "damage_limit = 0.5"], "cv: 0.0 should be greater than 0."),
]


@pytest.mark.parametrize(("keys", "message"), WRONG_INTERACTIONS)
def test_wrong_interactions(load, keys, message):
    """Every contradiction names its key, its value and the way out."""
    assert refusal(load, interaction(*keys)).startswith(f"case.toml: checks.interaction[1].{message}")


WRONG_CHECKS = [
    ('[[checks.endurance]]\ncases = "ride"\n', "endurance[1].perp: neither an endurance line nor a curve is given. "),
    (
        '[[checks.endurance]]\ncases = "ride"\nperp = "F3"\nlimit = 1.0\n',
        "endurance[1].limit: limit = 1 is given for 1",
    ),
    (
        '[[checks.endurance]]\ncases = "ride"\nperp = "F3"\nwelds = []\n',
        "endurance[1].welds: [] is empty. Give a list of welds; left out together with points: every weld.",
    ),
    (
        '[[checks.endurance]]\ncases = "ride"\nperp = "F3"\npoints = []\n',
        "endurance[1].points: [] is empty. Give a list of stress points.",
    ),
    (
        '[[checks.endurance]]\ncases = "ride"\ncurve = "c"\nlimit = 1.0\n',
        "endurance[1].limit: limit = 1 is given for 0",
    ),
    (ENDURANCE + "kappa = [1.0]\n", "endurance[1].limit: the key is missing although kappa is given, and it has no"),
    (ENDURANCE + "kappa = [1.0]\nlimit = 1.1\n", "endurance[1].kappa: [1.0] is given without lines of both perp and"),
    (ENDURANCE + 'par = "E4"\n', "endurance[1].par: a line for the stress along the weld is given for welds, and line"),
    (
        ENDURANCE + 'par = "E4"\npoints = ["p"]\nwelds = ["a"]\n',
        "endurance[1].par: a line for the stress along the weld is given for welds, and line forces do not have this",
    ),
    (
        ENDURANCE + 'par = "E4"\npoints = ["p"]\nlimit = 1.0\nkappa = [0.5, -2.1]\n',
        "endurance[1].kappa: with -2.1 the combination is negative for some stresses. Give coefficients from -2 to 2.",
    ),
    (ENDURANCE + 'points = ["p", "p"]\n', "endurance[1].points: names 'p' twice. Name it once."),
    ('[[checks.endurance]]\nperp = "F3"\n', "endurance[1].cases: the key is missing. Give the group of static load"),
]


@pytest.mark.parametrize(("text", "message"), WRONG_CHECKS)
def test_wrong_endurance_checks(load, text, message):
    """Every contradiction names its key, its value and the way out."""
    assert refusal(load, FILES + text).startswith(f"case.toml: checks.{message}")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (ENDURANCE, "static_cases: the key is missing although [[checks.endurance]] is given. Give the file of the"),
        (
            '[checks]\nstatic_cases = "c.csv"\n' + ENDURANCE,
            "endurance_lines: the key is missing although [[checks.endurance]] names the line 'F3'. Give the file of",
        ),
        (
            '[checks]\nstatic_cases = "c.csv"\n',
            "static_cases: static_cases = 'c.csv' is given, and no [[checks.endurance]] compares its cases. Add",
        ),
        (
            FILES + '[[checks.endurance]]\ncases = "ride"\ncurve = "c"\n',
            "endurance_lines: endurance_lines = 'lines.csv' is given, and no [[checks.endurance]] names a line. Name a",
        ),
        (
            '[checks]\nstatic_cases = "a\\tb.csv"\n' + ENDURANCE.replace("perp", "curve").replace('shear = "H"', ""),
            'static_cases: the path "a\\tb.csv" holds a tab (\\t), as',
        ),
    ],
)
def test_files_and_checks_belong_together(load, text, message):
    """A file that nothing reads, and a check without its file, are told by their key."""
    assert refusal(load, text).startswith(f"case.toml: checks.{message}")


def test_points_have_the_stress_along_the_weld(load):
    """A line for it, and coefficients of the product, go with points."""
    case = load(MINIMAL + FILES + ENDURANCE + 'par = "E4"\npoints = ["p"]\nlimit = 1.1\nkappa = [0.5, -1]\n')
    assert list(case.checks.endurance[0].lines) == ["perp", "par", "shear"]


def test_a_case_of_static_cases_alone_is_no_assessment(load):
    """Without an event there is no mission, whatever is compared beside it."""
    text = MINIMAL[: MINIMAL.index("[[mission.event]]")] + FILES + ENDURANCE
    with pytest.raises(CaseError, match=r"mission\.event: the key is missing\. Give one \[\[mission\.event\]\] table"):
        load(text)
