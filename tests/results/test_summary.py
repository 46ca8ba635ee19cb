"""What is printed of a result."""

from dataclasses import replace

import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.results.summary import result_summary


def test_worst_first_and_only_toes(small_result):
    """Welds and points by utilisation; a face without toe is not among the worst points."""
    found = result_summary(small_result, top=100)
    assert found.welds.utilisation.is_monotonic_decreasing
    assert found.points.utilisation.is_monotonic_decreasing
    assert len(found.points) == 14 + 7
    assert not found.fulfilled


def test_text_has_units_verdict_and_assumptions(small_result):
    """No table without the rules it rests on."""
    text = result_summary(small_result, top=3).as_text()
    assert text.startswith("small case: 2 of 2 welds miss their target of 1e+06 km")
    assert "Curve master-aluminium (mean-2sigma); thickness actual; no knee; mean stress none; damage limit 1" in text
    assert "life_km" in text
    assert "The 3 worst points" in text


def test_only_some_welds(small_result):
    """Filtered, or refused with the names there are."""
    assert set(result_summary(small_result, top=5, only=["A"]).points.weld) == {"A"}
    with pytest.raises(DataError, match=r"there is no weld 'Z'\. Choose of A, B"):
        result_summary(small_result, top=5, only=["Z"])


def test_of_very_many_welds_the_worst_are_printed(small_result, monkeypatch):
    """The others are counted, and the verdict is that of all."""
    monkeypatch.setattr("fatigue.results.summary.MOST_WELDS", 1)
    text = result_summary(small_result, top=3).as_text()
    assert "2 of 2 welds miss" in text
    assert "and 1 welds with a longer life, see welds.parquet" in text


def test_many_welds_that_are_not_assessed_are_told_by_their_reasons(small_result):
    """Thousands of folds do not bury the one that matters: every kind of reason has a line with its number."""
    found = result_summary(small_result, top=1)
    rows = [(f"fold_{k}", f"a fold at node {k}", "") for k in range(500)]
    rows.insert(250, ("seam", "ground flush", ""))
    left_out = pd.DataFrame(rows, columns=["weld", "reason", "description"])
    text = replace(found, not_assessed=left_out).as_text()
    assert "Not assessed: 501 welds" in text
    lines = [line.split(maxsplit=2) for line in text.splitlines()]
    assert ["500", "fold_0", "a fold at node 0"] in lines
    assert ["1", "seam", "ground flush"] in lines
    assert len(text.splitlines()) < 30
    few = replace(found, not_assessed=left_out[245:255].reset_index(drop=True)).as_text()
    assert all(f"fold_{k}" in few for k in (245, 253))
