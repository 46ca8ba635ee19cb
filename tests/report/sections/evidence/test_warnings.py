"""Warnings by what the reader has to do: every one has its group, and its code stands beside it."""

import tomllib
from importlib.resources import files

from fatigue.explain import all_codes
from fatigue.report.sections.evidence import warnings
from fatigue.report.sections.evidence.warnings import UNKNOWN, group_of_code, grouped


def a_warning(code, where="W1", **more):
    """A warning of a code."""
    return {"code": code, "where": where, "what": "is so", "remedy": "Do it", **more}


def test_every_warning_of_a_result_has_its_group():
    """All that ``fatigue explain`` knows as warnings of a result; and no code stands in two groups."""
    pages = all_codes().values()
    of_results = {page.code for page in pages if page.kind == "warning of a result"}
    assert len(of_results) > 60
    assert of_results <= set(group_of_code())
    tables = tomllib.loads((files("fatigue.report.sections.evidence") / "warning_groups.toml").read_text("utf-8"))
    codes = [code for table in tables.values() for code in table["codes"]]
    assert len(codes) == len(set(codes))
    assert set(codes) <= {page.code for page in pages if page.kind != "refusal"}


def test_groups_and_their_order():
    """The groups in the order of what to do, the codes as they came, how many of each."""
    found = grouped(
        [
            a_warning("not_utf8"),
            a_warning("model_dependent", count=7),
            a_warning("end_unresolved"),
            a_warning("end_unresolved", "W2"),
            a_warning("short_edge"),
            a_warning("never_heard_of"),
        ]
    )
    assert [(group.title, [(kind.code, kind.count, kind.others) for kind in group.kinds]) for group in found] == [
        ("Mend the model", [("end_unresolved", 2, 1), ("short_edge", 1, 0)]),
        ("Judge as engineer", [("model_dependent", 7, 0), ("never_heard_of", 1, 0)]),
        ("For information", [("not_utf8", 1, 0)]),
    ]
    assert group_of_code().get("never_heard_of", UNKNOWN) == "judge"
    assert grouped([]) == []


def test_a_long_list_of_welds_is_cut(monkeypatch):
    """Behind one of them."""
    monkeypatch.setattr(warnings, "LONGEST_PLACE", 12)
    (group,) = grouped([a_warning("short_edge", "W1, W2, W3, W4, W5")])
    assert group.kinds[0].entries[0]["where"] == "W1, W2, W3 and others, see provenance.json"
