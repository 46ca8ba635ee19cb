"""A block of stations: how many of them are counted at a time does not matter."""

import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.pipeline.count import block
from tests.small_case import small_case


@pytest.mark.parametrize("share", [0.0, 0.5])
def test_a_curve_with_a_knee_is_counted_some_stations_at_a_time(tmp_path, monkeypatch, share):
    """Histograms are large; the load factor, which is looked for where they say, and all else stays what it was."""
    case = small_case()
    case.curve |= {"extension": "haibach"}
    case.weld_nodes["x_mm"] *= 1.0 + 0.3 * (case.weld_nodes["x_mm"] > 30.0)
    path = case.write(tmp_path / "case")
    tables = []
    for rows in (block.ROWS_WITH_HISTOGRAM, 3):
        monkeypatch.setattr(block, "ROWS_WITH_HISTOGRAM", rows)
        assess(load_case(path), tmp_path / str(rows), share=share, report=False)
        tables.append(pd.read_parquet(tmp_path / str(rows) / "nodes.parquet"))
    pd.testing.assert_frame_equal(*tables, rtol=1e-12)
    assert tables[0].load_factor.notna().any()
