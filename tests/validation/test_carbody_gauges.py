"""The gauges of the shipped car body: their files, and what they read."""

import pandas as pd
import pytest

from fatigue.gauges.histories.story import histories
from tests.carbody_gauges import gauge_forces
from tests.carbody_loads import FOLDER


@pytest.fixture(scope="module")
def rows():
    """Row of every gauge."""
    found = histories(FOLDER / "case_gauges.toml", FOLDER / "gauges.csv", threads=2)
    assert found.warnings == ()
    return {row.gauge: row for row in found.gauges}


def test_shipped_forces_are_cut_from_those_of_the_run():
    """The elements under the gauges and beside them, number by number."""
    pd.testing.assert_frame_equal(pd.read_parquet(FOLDER / "gauge_forces.parquet"), gauge_forces())


def test_a_gauge_on_an_element_and_one_at_a_stress_point_there_agree(rows):
    """The rosette's first grid and the point in the middle of its element, by two ways from the same run."""
    pad, point = rows["pad_a"], rows["beside_bracket"]
    assert pad.rms_ue == pytest.approx(point.rms_ue, rel=1e-6)
    assert pad.angle_sensitivity == pytest.approx(point.angle_sensitivity, rel=1e-4)
    assert pad.nearest_weld.startswith("W1_roof_bracket")
    assert pad.distance_to_weld_mm == pytest.approx(12.5)


def test_what_the_docs_say_of_them(rows):
    """docs/gauges.md: across the weld 10.5 at 1 %, along it 0.14 at 66 %, the bracket 31 at 1.4 %."""
    assert (rows["pad_a"].rms_ue, rows["pad_a"].angle_sensitivity) == pytest.approx((10.5, 0.01), rel=0.05)
    assert (rows["pad_c"].rms_ue, rows["pad_c"].angle_sensitivity) == pytest.approx((0.14, 0.66), rel=0.05)
    assert (rows["bracket_front"].rms_ue, rows["bracket_front"].angle_sensitivity) == pytest.approx(
        (31.0, 0.014), rel=0.05
    )
    assert rows["pad_long"].elements == 3
    assert [name for name, row in rows.items() if row.stand_in] == ["seam_toe", "stub_toe"]
