"""Cycles of very long lists, merged for the page: what they add up to stays."""

import numpy as np
import pandas as pd
import pytest

from fatigue.report import merged_cycles
from fatigue.report import result as reading
from fatigue.report.page import report_page
from fatigue.report.result import read_result
from fatigue.report.sections.checks import recomputed
from fatigue.report.variants import assumptions_of, variants

WELD = "W1 bracket"


@pytest.fixture
def both(result_folder, monkeypatch):
    """The same result with its cycles one by one, and merged."""
    listed = read_result(result_folder, 2, 100)
    monkeypatch.setattr(reading, "MOST_ROWS", 0)
    return listed, read_result(result_folder, 2, 100)


def test_counts_and_damages_stay(tmp_path, monkeypatch):
    """Of each event, in far fewer rows; the largest cycle of each stays by itself, with its instants."""
    rng = np.random.default_rng(0)
    n = 20_000
    table = {name: np.zeros(n) for name in ("weld", "surface", "event", *merged_cycles._NUMBERS)}
    dS = rng.exponential(10.0, n)
    table |= {"weld": rng.integers(-1, 1, n), "surface": rng.integers(0, 2, n), "event": rng.integers(0, 2, n)}
    table |= {"part": np.ones(n), "order": rng.integers(1, 3, n), "start_s": np.arange(n), "end_s": np.arange(n) + 0.5}
    table |= {"range_MPa": 0.8 * dS, "mean_MPa": rng.uniform(0.0, 4.0, n), "count": rng.choice([0.5, 1.0], n)}
    table |= {
        "bending_ratio": rng.uniform(0.2, 0.4, n),
        "equivalent_range_dS": dS,
        "damage": table["count"] * 1e-9 * dS**3,
    }
    halves = [{name: column[part] for name, column in table.items()} for part in (slice(7000), slice(7000, n))]
    monkeypatch.setattr(merged_cycles, "number_groups", lambda *_: iter(halves))
    point = merged_cycles.ShownPoint(1, 2, "bottom", 3.0, lambda x: 1e-9 * x**3, {"a": 2.0, "b": 5.0})
    found = merged_cycles.merged_cycles(tmp_path, {"W": point}, ["a", "b"])["W"]

    own = pd.DataFrame(table)
    own = own[(own["weld"] == 0) & (own["surface"] == 1) & (own["order"] == 2)]
    assert len(found.rows) < 0.5 * len(own)
    assert found.damage_per_km == pytest.approx((own["damage"] * own["event"].map({0: 2.0, 1: 5.0})).sum())
    for number, event in enumerate("ab"):
        of_event, rows = own[own["event"] == number], found.rows[found.rows["event"] == event]
        assert rows["count"].sum() == pytest.approx(of_event["count"].sum())
        assert rows["damage"].sum() == pytest.approx(of_event["damage"].sum())
        assert (rows["count"] * 1e-9 * rows["equivalent_range_dS"] ** 3).sum() == pytest.approx(rows["damage"].sum())
        top = of_event.loc[of_event["equivalent_range_dS"].idxmax()]
        first = rows.loc[(rows["damage"] / rows["count"]).idxmax()]
        assert first[["start_s", "range_MPa", "count"]].tolist() == top[["start_s", "range_MPa", "count"]].tolist()


def test_the_page_says_the_same(both):
    """Variants to a thousandth, and the check of the damage from all cycles one by one."""
    listed, merged = both
    tables = []
    for result in both:
        used = assumptions_of(result.record, "master-aluminium")
        tables.append(variants(result.worst(WELD), result.cycles(WELD), result.passes_per_km, used)["damage_factor"])
    np.testing.assert_allclose(tables[1], tables[0], rtol=2e-3)
    assert [check.agrees for check in recomputed(merged)] == [check.agrees for check in recomputed(listed)]
    for first, second in zip(recomputed(merged), recomputed(listed), strict=True):
        assert first.difference == pytest.approx(second.difference, abs=1e-12)


def test_a_page_of_merged_cycles(result_folder, html, monkeypatch):
    """All of its parts are there."""
    monkeypatch.setattr(reading, "MOST_ROWS", 0)
    merged = report_page(result_folder)
    assert merged.count("<table") == html.count("<table")
    assert merged.count("plotly") == html.count("plotly")
