"""A figure as plotly.js takes it is what plotly itself would write of it."""

import json

import numpy as np
import pandas as pd
import plotly.graph_objects as go
import pytest

from fatigue.report import figures
from fatigue.report.figures.drawn import Figure
from fatigue.report.page import report_page
from fatigue.report.sections import embed
from tests.report.reading import Page, values


def by_plotly(figure):
    """Traces and layout as plotly writes them, what is empty left out as it is nothing to be drawn."""
    written = json.loads(figure.plotly().to_json(remove_uids=True))
    written["layout"].pop("template")
    return written


def test_every_figure_of_the_page_is_as_plotly_writes_it(result_folder, monkeypatch):
    """Arrays to the byte, numbers and texts, of all figures of a report."""
    drawn = []
    add = embed.Figures.add

    def added(self, id_, fig, *args, **options):
        drawn.append(fig)
        return add(self, id_, fig, *args, **options)

    monkeypatch.setattr(embed.Figures, "add", added)
    page = Page(report_page(result_folder))
    assert len(drawn) == len(page.figures) > 10
    for figure in drawn:
        content = json.loads(json.dumps(figure.content(), allow_nan=False))
        for part, written in by_plotly(figure).items():
            assert content[part] == written


def test_a_mistyped_attribute_is_refused():
    """By plotly, which all figures of the tests are given to."""
    with pytest.raises(ValueError, match="markr"):
        Figure([{"type": "scatter", "markr": {"size": 3}}], {}).content()


@pytest.mark.parametrize(
    ("array", "dtype"),
    [
        (np.array([0, 100]), "i1"),
        (np.array([-1, 300]), "i2"),
        (np.array([70_000]), "i4"),
        (np.array([2**40]), "f8"),
        (np.array([1, 2], dtype=np.uint8), "u1"),
        (np.array([1.5, np.inf, np.nan]), "f8"),
        (np.array([[1.5, 2.5, np.nan]], dtype=np.float32), "f4"),
        (pd.Series([1.0, 2.0]), "f8"),
    ],
)
def test_arrays_keep_their_numbers(array, dtype):
    """Of whole numbers the smallest type that holds them; what is not finite stays."""
    [trace] = Figure([{"type": "scatter", "x": array}], {}).content()["data"]
    assert trace["x"]["dtype"] == dtype
    np.testing.assert_array_equal(values(trace["x"]), np.asarray(array))


def test_what_json_cannot_say_is_null():
    """Outside of arrays; texts and missing values in arrays of objects are lists."""
    customdata = np.array([["a", np.nan], ["b", 2]], dtype=object)
    trace = {"type": "scatter", "y": [1.0, np.nan], "customdata": customdata, "x": np.array([])}
    content = Figure([trace], {"height": np.float64(30.0), "xaxis": {"range": (0.0, np.float64(np.inf))}}).content()
    assert content["data"][0] == {"type": "scatter", "y": [1.0, None], "customdata": [["a", None], ["b", 2]], "x": []}
    assert content["layout"] == {"height": 30.0, "xaxis": {"range": [0.0, None]}}


def test_a_notebook_shows_a_figure_by_its_name(monkeypatch):
    """As plotly shows its own."""
    shown = []

    def show(figure):
        shown.append(figure)

    monkeypatch.setattr(go.Figure, "show", show)
    figures.shares(["mode 1"], np.array([1.0]), "share [%]")._ipython_display_()
    assert [trace.type for trace in shown[0].data] == ["bar"]
