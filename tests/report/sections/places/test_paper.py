"""What goes to paper: details near or beyond the limit, one row of every other weld, figures without gaps."""

from dataclasses import dataclass

import pandas as pd
import pytest

from fatigue.report.page import report_page
from fatigue.report.sections.places.paper import MOST_PRINTED, all_passed, on_paper
from tests.report.reading import Page
from tests.report.tiny_result import Recipe, write_result


@dataclass
class Given:
    """What ``on_paper`` asks of a result."""

    assessed: pd.DataFrame
    detailed: tuple[str, ...]


def result(utilisations):
    """Register of welds with these utilisations, worst first."""
    rows = pd.DataFrame({"weld": [f"W{i}" for i in range(len(utilisations))], "utilisation": utilisations})
    rows = rows.assign(fulfilled=True, life_km=1e6, life_years=2.0, load_factor=1.0, worst_node=7)
    rows = rows.assign(worst_surface="top", worst_arc_length_mm=0.0, governing_event="a", curve="c")
    return Given(rows, tuple(rows["weld"][:40]))


@pytest.mark.parametrize(
    ("utilisations", "printed", "high", "left_out"),
    [
        ([2.0, 0.75, 0.7499, 0.1], 2, 2, 0),
        ([0.5, 0.1], 1, 0, 0),
        ([1.0], 1, 1, 0),
        ([1.0] * (MOST_PRINTED + 3), MOST_PRINTED, MOST_PRINTED + 3, 3),
    ],
)
def test_details_begin_at_three_quarters(utilisations, printed, high, left_out):
    """Of those, ten at most; of none, the worst. Every other weld has its row."""
    found = on_paper(result(utilisations), ())
    assert (found.detailed, found.high, found.left_out) == (printed, high, left_out)
    others = [] if found.others is None else [row[0].text for row in found.others.rows]
    assert [*found.welds, *others] == [f"W{i}" for i in range(len(utilisations))]


def test_very_many_others_are_told(monkeypatch):
    """What has no row is counted."""
    monkeypatch.setattr("fatigue.report.sections.places.paper.MOST_OTHERS", 2)
    assert on_paper(result([1.0, 0.4, 0.3, 0.2, 0.1]), ()).unlisted == 2


def test_a_weld_below_is_on_the_screen_only(tmp_path):
    """Its details are not printed, its numbers are in the table for paper."""
    folder = write_result(tmp_path, Recipe(welds=("W0", "W1", "W2"), level=20.0))
    welds = pd.read_parquet(folder / "welds.parquet").sort_values("utilisation", ascending=False)
    assert (welds["utilisation"] >= 0.75).tolist() == [True, False, False]
    page = Page(report_page(folder))
    classes = [given["class"] for tag, given in page.tags if tag == "details" and "weld" in given["class"].split()]
    assert classes == ["weld", "weld screen", "weld screen"]
    rows = page.tables["other-welds"][1:]
    assert [row[0] for row in rows] == welds["weld"].tolist()[1:]
    assert [float(row[4]) for row in rows] == pytest.approx(welds["utilisation"].tolist()[1:], rel=5e-3)


def test_known_values_take_one_line_where_all_agree():
    """One that does not agree brings the table to paper."""
    assert all_passed([{"passed": True}] * 2) == "All 2 known values agree within their tolerances."
    assert all_passed([{"passed": True}, {"passed": False}]) == ""
    assert all_passed([]) == ""
