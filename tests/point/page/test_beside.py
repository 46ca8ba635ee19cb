"""Checks beside the toe at the place of a point: those of the result, and none of another place."""

import pandas as pd

from fatigue.point.page.story import point
from tests.checks_case import write_checks_case
from tests.point.cases import result_of
from tests.report.reading import Page


def test_checks_at_a_place(tmp_path):
    """Every row of the table there, the one that uses up most first, on the page and for machines."""
    folder = result_of(write_checks_case(tmp_path / "case"), tmp_path / "result")
    checks = pd.read_parquet(folder / "checks.parquet")
    placed = checks[checks["part"].notna()]
    row = placed.iloc[-1]
    here = placed[(placed["weld"] == row["weld"]) & (placed["order"] == row["order"])]
    found = point(folder, row["weld"], order=int(row["order"]), output=tmp_path / "page.html")
    assert len(found.beside) == len(here) > 0
    assert found.beside["utilisation_stress"].is_monotonic_decreasing
    table = Page((tmp_path / "page.html").read_text(encoding="utf-8")).tables["checks-beside"]
    assert len(table) == 1 + len(here)
    assert {cells[1] for cells in table[1:]} <= {"✓ met", "✕ missed", "not assessed"}
    assert len(found.as_record()["checks_beside"]) == len(here)


def test_without_checks(results, tmp_path):
    """No table, no heading."""
    found = point(results("plain"), "A", output=tmp_path / "page.html")
    assert found.beside.empty
    assert found.as_record()["checks_beside"] == []
    assert "Checks beside" not in (tmp_path / "page.html").read_text(encoding="utf-8")
