"""Checks that name what there is not, or what does not go together, are refused by the key of the case."""

import pytest

from fatigue.case import load_case
from fatigue.errors import CaseError, DataError
from fatigue.pipeline.solve.body import read_body
from tests.compared_case import CASES, write_case

FILES = '[checks]\nstatic_cases = "cases.csv"\nendurance_lines = "lines.csv"\n'
AT_POINTS = "case,kind,group,point,sx_MPa\na,state,stops,p1,10\nb,state,stops,p1,20\n"


def refusal(folder, text, error=CaseError, **files):
    """Message of the refusal of a case."""
    path = write_case(folder, text, **files)
    with pytest.raises(error) as refused:
        read_body(load_case(path), strict=False)
    return str(refused.value)


def endurance(**keys):
    """Table of an endurance check, by default a right one."""
    given = {"cases": "ride", "perp": "across"} | keys
    lines = [f"{key} = {value!r}".replace("'", '"') for key, value in given.items() if value is not None]
    return "\n".join(["[[checks.endurance]]", *lines, ""])


def interaction(*keys):
    """Table of an interaction."""
    return "\n".join(["[[checks.interaction]]", 'rule = "en1993"', *keys, ""])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (interaction('welds = ["V"]'), "interaction[1].welds: 'V' is not one of the welds to assess. Name one of the"),
        (interaction() + interaction(), "interaction[2]: is there already, with the same keys. Remove one of them."),
        (
            FILES + endurance(cases="rides"),
            "endurance[1].cases: 'rides' is not one of the groups of static load cases.",
        ),
        (FILES + endurance(welds=["w"]), "endurance[1].welds: 'w' is not one of the welds to assess. Name one of the"),
        (FILES + endurance(points=["p"]), "endurance[1].points: 'p' is not one of the stress points. Name one of the"),
        (
            FILES + endurance(perp="acros"),
            "endurance[1].perp: 'acros' is not one of the endurance lines. Write 'across'.",
        ),
        (
            FILES + endurance(perp="sheared"),
            "endurance[1].perp: line 'sheared' is for shear, not for perp. Name it under",
        ),
        (FILES + endurance() + endurance(), "endurance[2]: is there already, with the same keys. Remove one of them."),
        (
            FILES + endurance(curve="fillet-36"),
            "endurance[1].curve: curve 'fillet-36' has neither a cut-off nor a knee:",
        ),
        (FILES + endurance(curve="fillet"), "endurance[1].curve: there is no curve 'fillet'. "),
        (FILES + endurance(curve="master-steel"), "endurance[1].curve: curve 'master-steel' is "),
    ],
)
def test_wrong_checks(tmp_path, text, message):
    """File, table, key, value and what to do stand in one line."""
    assert refusal(tmp_path, text).startswith(f"case.toml: checks.{message}")


def test_a_group_of_stresses_at_points_is_not_for_welds(tmp_path):
    """Stresses as they are belong to their points, not to welds."""
    message = refusal(tmp_path, FILES + endurance(cases="stops"), cases=AT_POINTS)
    assert message.startswith("case.toml: checks.endurance[1].cases: group 'stops' has stresses at points, and welds")
    message = refusal(tmp_path, FILES + endurance(cases="stops", points=["p2"]), cases=AT_POINTS)
    assert message.startswith("case.toml: checks.endurance[1].points: 'p2' is not one of the points of group 'stops'.")


def test_a_weld_without_a_shear_curve(tmp_path):
    """An interaction needs one, of a weld that it names and of one weld at least."""
    for keys, place in ((('welds = ["W"]',), "interaction[1].welds"), ((), "interaction[1]")):
        path = write_case(tmp_path, interaction(*keys))
        (tmp_path / "welds.csv").write_text("weld\nW\n", encoding="utf-8")
        with pytest.raises(CaseError) as refused:
            read_body(load_case(path), strict=False)
        assert str(refused.value).startswith(f"case.toml: checks.{place}: ")
        assert str(refused.value).endswith("Give curve_shear in the table of welds.")


def test_thirteen_loads_are_too_many_for_a_combination(tmp_path):
    """Of one component any number may alternate; a combination has 4^k / 2 pairs of corners."""
    loads = "".join(f"load {i},alternating,many,1,1,,\n" for i in range(13))
    text = FILES + endurance(cases="many", shear="sheared")
    path = write_case(tmp_path, text, cases=CASES + loads)
    assert read_body(load_case(path), strict=False).compared.groups["many"].loads.shape == (13, 3)
    message = refusal(tmp_path, text + "limit = 1.0\n", cases=CASES + loads)
    assert message.startswith(
        "case.toml: checks.endurance[1].cases: the 13 alternating cases of group 'many' have 2^13"
    )
    assert message.endswith("Combine at most 12 cases, or leave limit out: components alone have no bound.")


def test_all_checks_are_told_at_once(tmp_path):
    """A mistake in one check hides none in another."""
    message = refusal(tmp_path, FILES + endurance(perp="x") + endurance(cases="y") + interaction('welds = ["V"]'))
    assert len(message.splitlines()) == 3


def test_mistakes_in_the_files_come_before_names(tmp_path):
    """A bad table is told by its rows."""
    message = refusal(tmp_path, FILES + endurance(), DataError, cases=CASES.replace("roll,", "pitch,"))
    assert message.startswith("cases.csv: column group, case, row 3: group ride, case pitch repeats row 2.")


def test_an_interaction_without_welds_needs_one_shear_curve(tmp_path):
    """A right case is read, with the groups and lines that are compared."""
    body = read_body(load_case(write_case(tmp_path, FILES + interaction() + endurance())), strict=True)
    assert sorted(body.compared.groups) == ["ride", "stops"]
    assert sorted(body.compared.lines) == ["across", "along", "sheared"]
