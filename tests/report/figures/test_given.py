"""Figures take tables of pandas and Arrow alike, and refuse what is no such table in one line."""

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

import fatigue
from fatigue.errors import DataError
from fatigue.report import figures

TARGET = 1e7


@pytest.fixture(scope="module")
def tables(result_folder):
    """Tables of the small result, as pandas reads them; cycles and nodes of one point and weld."""
    found = {name: pd.read_parquet(result_folder / f"{name}.parquet") for name in ("nodes", "welds", "cycles")}
    of_weld = {name: found[name][found[name]["weld"] == "W1 bracket"] for name in ("nodes", "cycles")}
    return found | {"points": of_weld["nodes"], "cycles": of_weld["cycles"]}


def test_tables_of_arrow_give_the_same_figures(result_folder):
    """What `fatigue.read_table` reads goes into a figure as it is."""
    for draw, table in (
        (lambda table: figures.weld_lives(table, TARGET), "welds"),
        (lambda table: figures.weld_strips(table, TARGET), "nodes"),
        (figures.ratio_histogram, "nodes"),
    ):
        theirs = draw(pd.read_parquet(result_folder / f"{table}.parquet"))
        assert draw(fatigue.read_table(result_folder, table)).plotly().to_json() == theirs.plotly().to_json()
        assert draw(pq.read_table(result_folder / f"{table}.parquet")).plotly().to_json() == theirs.plotly().to_json()


def test_the_register_may_list_welds_that_are_not_assessed(tables):
    """They have no life and are not drawn."""
    welds = tables["welds"]
    excluded = welds.head(1).assign(
        weld="left out", utilisation=np.nan, life_km=np.nan, fulfilled=None, status="excluded"
    )
    drawn = figures.weld_lives(pd.concat([welds.astype({"fulfilled": object}), excluded]), TARGET)
    assert drawn.plotly().to_json() == figures.weld_lives(welds, TARGET).plotly().to_json()


@pytest.mark.parametrize(
    ("draw", "words"),
    [
        (lambda t: figures.weld_lives(t["welds"].drop(columns="life_km"), TARGET), "welds: the table lacks the column"),
        (lambda t: figures.weld_lives(t["welds"].to_dict("list"), TARGET), "welds: an object of type dict is no table"),
        (lambda t: figures.weld_lives("result", TARGET), "welds: an object of type str"),
        (lambda t: figures.weld_lives(t["welds"], 0.0), "target_km: 0.0 is no mileage"),
        (lambda t: figures.weld_lives(t["welds"], float("nan")), "target_km: nan"),
        (lambda t: figures.weld_lives(t["welds"], "1e7"), "target_km: '1e7'"),
        (lambda t: figures.weld_strips(t["welds"], TARGET), "nodes: the table lacks the columns part, order, toe"),
        (lambda t: figures.weld_strips(t["nodes"].head(0), TARGET), "nodes: the table has no rows"),
        (lambda t: figures.along_weld(t["nodes"], TARGET), "points: these are points of . welds, 'W1 bracket'"),
        (lambda t: figures.along_weld(t["points"], -1), "target_km: -1"),
        (lambda t: figures.along_weld(t["points"], TARGET, {"top": [1.0]}), r"stress\['top'\]: one value for"),
        (lambda t: figures.time_against_frequency(t["nodes"]), "nodes: the table lacks the column kurtosis"),
        (lambda t: figures.ratio_histogram(t["cycles"]), "nodes: the table lacks the column dirlik_ratio"),
        (lambda t: figures.drawn_points(t["cycles"]), "nodes: the table lacks the columns life_km_same_ratio"),
        (lambda t: figures.exceedance(t["cycles"], {"tangent": 1.0}), "passes_per_km: there is none for event 'curve'"),
        (lambda t: figures.exceedance(t["cycles"].head(0), {}), "cycles: the table has no rows"),
        (lambda t: figures.rainflow_matrices(t["cycles"], np.ones(3)), "per_km: 3 values for"),
        (lambda t: figures.rainflow_matrices(t["cycles"], 1.0), "per_km: one value for"),
        (lambda t: figures.sn_with_spectrum(t["cycles"], np.ones(len(t["cycles"])), {}, "mean", "MPa"),
         "laws: there is none for survival level 'mean'"),
        (lambda t: figures.damage_by_event(["a"], pd.DataFrame({"x": [0.5, 0.5]}), {"x": ""}), "points: one value for"),
        (lambda t: figures.damage_by_event(["a"], pd.DataFrame({"x": [0.5]}), {}), "weights: there is none for event"),
        (lambda t: figures.shares(["a", "b"], np.ones(3), "share"), "values: 3 values for 2 rows"),
        (lambda t: figures.worst_faces(t["welds"]), "nodes: the table lacks the columns part, order, toe"),
        (lambda t: figures.line_rows(t["welds"], frozenset()), "stations: the table lacks the column part"),
        (lambda t: figures.scene(t["cycles"], np.array([0]), TARGET), "stations: the table lacks the columns x_mm"),
        (lambda t: figures.projections(t["nodes"], np.array([0]), np.inf), "target_km: inf"),
        (lambda t: figures.damage_by_band(t["nodes"]), "bands: the table lacks the columns low_hz, high_hz, share"),
        (lambda t: figures.bands_of_welds(["a"], np.ones((2, 1)), pd.DataFrame({"low_hz": [1.0], "high_hz": [2.0]})),
         "shares: 2 values for 1 row"),
        (lambda t: figures.damage_on_track(t["nodes"]), "track: the table lacks the columns start_km"),
        (lambda t: figures.along_weld(t["points"], TARGET, marked=(1, 99, "top")), "marked: no point has the part"),
        (lambda t: figures.damage_by_method(t["cycles"], {}), "damage: the table lacks the columns damage_per_pass"),
        (lambda t: figures.ranges_by_method(t["cycles"], np.ones(3), 1.0), "moments: 3 values for 4 rows"),
        (lambda t: figures.cycles_close_by([[], []], ["first"], {}), "titles: one value for 2 rows"),
    ],
)  # fmt: skip
def test_what_cannot_be_drawn_is_refused(tables, draw, words):
    """The argument, what is wrong with it, and what to give."""
    with pytest.raises(DataError, match=f"^{words}"):
        draw(tables)
