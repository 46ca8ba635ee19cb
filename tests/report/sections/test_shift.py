"""A shift study on the page: its figure names welds, settings and the word screening; nothing without one."""

import numpy as np
import pandas as pd

from fatigue.report import figures
from fatigue.report.figures.shift import SCREENING
from fatigue.report.page import report_page
from fatigue.results import read_provenance
from fatigue.shift.story import shift
from fatigue.shift.summary import SCREENING as SAID
from tests.shift.oscillating_case import oscillating
from tests.shift.test_story import assessed


def study(dampings=(0.015,), frequencies=(9.0, 10.0, 12.0)):
    """Rows of two points of two welds at some settings, of which the second point is never the worst."""
    rows = [
        (weld, f, z, (1e6 + 1e5 * abs(f - 10.0)) * worse, f == 10.0 and z == 0.015, worse == 1.0)
        for weld in ("A", "B")
        for z in dampings
        for f in frequencies
        for worse in (1.0, 2.0)
    ]
    columns = ["weld", "frequency_hz", "damping_ratio", "life_km", "is_as_assessed", "is_worst_of_weld"]
    return pd.DataFrame(rows, columns=columns)


def test_lives_are_drawn_against_frequency():
    """A curve for each weld and damping, of the worst points; the setting as assessed is marked."""
    fig = figures.life_against_setting(study(dampings=(0.01, 0.015)), ["A", "B"], 2e6).plotly()
    assert [trace.name for trace in fig.data] == ["A", "A, 1 %", "B", "B, 1 %"]
    np.testing.assert_allclose(fig.data[0].y, [1.1e6, 1e6, 1.2e6])
    assert list(fig.data[0].marker.symbol) == ["circle", "circle-open", "circle"]
    assert fig.layout.annotations[0].text == SCREENING == SAID
    assert {shape.x0 for shape in fig.layout.shapes} == {0, 10.0}


def test_damping_alone_is_the_axis():
    """Where no frequency moves, lives stand against damping."""
    fig = figures.life_against_setting(study(dampings=(0.01, 0.015, 0.03), frequencies=(10.0,)), ["A"], 2e6).plotly()
    np.testing.assert_allclose(fig.data[0].x, [0.01, 0.015, 0.03])
    assert "damping" in fig.layout.xaxis.title.text


def test_the_page_has_it_only_after_a_study(tmp_path):
    """Section, limits and warnings appear with the table."""
    result = assessed(oscillating(gives_damping=False), tmp_path)
    assert "If a mode were elsewhere" not in report_page(result)
    shift(result, mode=2, to_hz=[11.0, 12.0], damping=0.001, threads=1)
    assert [warning["code"] for warning in read_provenance(result)["shift_study"]["warnings"]] == ["shift_short"]
    page = report_page(result)
    assert "If a mode were elsewhere" in page
    assert "assumed: the modes have none" in page
    assert "Screening without feedback: the modal force stays" in page
    assert "lasts 1.8 times as long as the moved mode" in page
