"""The printed summary to the letter, of a result made by hand."""

import math

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import CaseError, DataError
from fatigue.results.summary import MOST_LEFT_OUT, Summary, assumptions, result_summary

LEFT_OUT = {"weld": ["C", "longer name"], "reason": ["excluded by hand", "two\nlines"], "description": ["", "x"]}
RULES = {
    "survival": {"master-steel": "mean-2sigma", "mine": "as tabulated"},
    "extension": "none",
    "knee_cycles": 1e7,
    "thickness_rule": "actual",
    "mean_stress": "none",
    "screening": {"share_of_limit": 0.0},
}


def summary(fulfilled=(False, True), points=2, left_out=LEFT_OUT):
    """Two welds, one of which lives for ever, and their worst points."""
    welds = {
        "weld": ["A", "B"],
        "life_km": [123456.789, math.inf],
        "life_years": [0.25, np.nan],
        "utilisation": [8.1, 0.0],
        "load_factor": [0.55556, math.inf],
        "worst_node": [7, 12345],
        "worst_surface": ["top", "bottom"],
        "governing_event": ["fast", None],
        "fulfilled": list(fulfilled),
        "worst_summed_corner": [False, False],
    }
    point = {
        "weld": "A",
        "node": 7,
        "surface": "top",
        "arc_length_mm": 10.0,
        "life_km": 123456.789,
        "utilisation": 8.1,
        "life_km_dirlik": 2e12,
        "dirlik_ratio": np.nan,
        "dirlik_verdict": "not_assessed",
        "governing_event": "fast",
    }
    frames = pd.DataFrame(welds), pd.DataFrame(left_out), pd.DataFrame([point] * points)
    return Summary("a title", "the rules", 1.2e7, *frames)


def test_the_text_to_the_letter():
    """Numbers right, texts left, three digits, a dash for nothing, no infinity, no line within a cell."""
    points = ["weld", "node", "face", "arc_length_mm", "life_million_km", "utilisation", "life_million_km_dirlik"]
    points += ["dirlik_ratio", "governing_event"]
    assert summary().as_text() == "\n".join(
        [
            "a title: 1 of 2 welds miss their target of 1.2e+07 km",
            "the rules",
            "",
            "weld  life_million_km  life_years  utilisation  load_factor   node  face    governing_event",
            "A               0.123       0.250         8.10        0.556      7  top     fast",
            "B           > 1000000           -            0       > 1e12  12345  bottom  -",
            "",
            "Not assessed: 2 welds",
            "weld         reason",
            "C            excluded by hand",
            "longer name  two lines",
            "",
            "The 2 worst points",
            "  ".join(points),
            "A        7  top              10            0.123         8.10               > 1000000             -  fast",
            "A        7  top              10            0.123         8.10               > 1000000             -  fast",
        ]
    )


def test_one_of_a_kind():
    """One point, one weld left out, none that misses: said as one says it."""
    one = {name: values[:1] for name, values in LEFT_OUT.items()}
    text = summary(fulfilled=(True, True), points=1, left_out=one).as_text()
    assert text.startswith("a title: every weld meets its target of 1.2e+07 km")
    assert "Not assessed: 1 weld\n" in text
    assert "\nThe worst point\n" in text
    nothing = {name: [] for name in LEFT_OUT}
    assert "Not assessed" not in summary(left_out=nothing).as_text()


def test_limit_of_those_told_one_by_one():
    """Twenty are listed, twenty-one are counted by their reasons, the most frequent first."""
    reasons = ["a fold at node 1", "ground flush", "ground flush"] * 7
    for count in (MOST_LEFT_OUT, MOST_LEFT_OUT + 1):
        left_out = pd.DataFrame({"weld": range(count), "reason": reasons[:count], "description": ""})
        text = summary(left_out=left_out).as_text()
        assert ("all of them are in welds.parquet" in text) == (count > MOST_LEFT_OUT)
    lines = [line.split(maxsplit=2) for line in text.splitlines()]
    most = lines.index(["14", "1", "ground flush"])
    assert lines[most + 1] == ["7", "0", "a fold at node 1"]


def test_a_life_at_the_end_of_the_scale():
    """Up to 1e12 km a number, above it no more than that."""
    text = summary().points.assign(life_km=[1e12, 1.0001e12])
    found = Summary("t", "r", 1.0, summary().welds, pd.DataFrame(LEFT_OUT), text).as_text().splitlines()
    assert found[-2].split()[4] == "1000000"
    assert found[-1].split()[4:6] == [">", "1000000"]


def test_for_machines():
    """Every frame as records, and one word for all welds."""
    record = summary().as_record()
    assert record["fulfilled"] is False
    assert summary(fulfilled=(True, True)).as_record()["fulfilled"] is True
    assert record["target_km"] == 1.2e7
    assert [row["weld"] for row in record["welds"]] == ["A", "B"]
    assert [row["weld"] for row in record["not_assessed"]] == ["C", "longer name"]
    assert len(record["points"]) == 2


@pytest.mark.parametrize(
    ("rules", "limit", "expected"),
    [
        ({}, 1.0, "no knee; mean stress none; damage limit 1"),
        (
            {"extension": "haibach", "mean_stress": "asme", "thickness_rule": "asme"},
            0.5,
            "haibach at 1e+07 cycles; mean stress asme; damage limit 0.5",
        ),
        (
            {"screening": {"share_of_limit": 0.1}},
            1.0,
            "no knee; mean stress none; damage limit 1; points proven below 0.1 of it have bounds only",
        ),
    ],
)
def test_the_rules_in_one_line(rules, limit, expected):
    """Every curve with its survival, and all that a number of the result rests on."""
    line = assumptions({"rules": RULES | rules, "mission": {"damage_limit": limit}})
    thickness = rules.get("thickness_rule", "actual")
    assert line == f"Curve master-steel (mean-2sigma), mine (as tabulated); thickness {thickness}; {expected}"


@pytest.mark.parametrize("top", [0, -1, 2.0, "3", None])
def test_no_number_of_points(small_result, top):
    """Refused before anything is read; one point is the least."""
    with pytest.raises(CaseError, match=r"is no number of points\. Give a whole number from 1 on"):
        result_summary(small_result, top=top)
    assert len(result_summary(small_result, top=1).points) == 1


def test_some_welds_leave_the_others_out(small_result):
    """Also those that are not assessed; one that is unknown is told first in the order of names."""
    found = result_summary(small_result, top=3, only=["B"])
    assert found.welds["weld"].tolist() == ["B"]
    assert found.not_assessed.empty
    with pytest.raises(DataError, match="there is no weld 'Y'"):
        result_summary(small_result, top=3, only=["Z", "A", "Y"])
