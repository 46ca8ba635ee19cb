"""Stations: order of the register, shapes of some of them, those that the end treatment changes."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.pipeline.model import read_model
from fatigue.pipeline.stations import shapes_of, treated_rows
from tests.small_case import small_case


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    """The solved small case; weld B on a curve of its own."""
    case = small_case()
    case.welds["curve"] = [None, "iiw-aluminium-40"]
    return read_model(load_case(case.write(tmp_path_factory.mktemp("case"))), strict=False)


def test_stations_follow_the_register(model):
    """Welds in the order of the table of welds, nodes along their line."""
    assert model.lines.weld == ("A", "B")
    assert model.stations.weld.tolist() == [0] * 7 + [1] * 7
    assert model.stations.arc_length.tolist() == pytest.approx([0, 10, 20, 30, 40, 50, 60] * 2)


def test_shapes_of_some_stations(model):
    """Treated stress, with size factor and law of the curve."""
    treated = model.stations.treated
    for name, rows in (("master-aluminium", np.array([0, 3])), ("iiw-aluminium-40", np.array([13]))):
        shapes = shapes_of(model.stations, rows, model.curves[name], "actual")
        assert np.array_equal(shapes.bending, treated.bending[rows])
        assert np.array_equal(shapes.at(np.array([len(rows) - 1])).membrane, treated.membrane[rows[-1:]])
        assert shapes.uses_bending_ratio == (name == "master-aluminium")
        assert shapes.size == pytest.approx(8.0 ** (1.6 / 7.2) if shapes.uses_bending_ratio else 1.0)
        assert shapes.law is model.curves[name].law


def test_shapes_know_the_ends_as_they_are_without_treatment(model):
    """Those among the rows asked for, and again among some of them."""
    stations, changed = model.stations, {0: 2.0, 6: 3.0, 7: 4.0}
    raw = stations.treated.membrane.copy()
    for row, factor in changed.items():
        raw[row] = factor * raw[row] + 1.0
    stations = replace(stations, raw=replace(stations.treated, membrane=raw))
    shapes = shapes_of(stations, np.array([0, 3, 6, 7, 9]), model.curves["master-aluminium"], "actual")
    assert shapes.raw_ends.rows.tolist() == [0, 2, 3]
    assert np.array_equal(shapes.raw_ends.membrane, raw[[0, 6, 7]])
    some = shapes.at(np.array([1, 3, 4]))
    assert some.raw_ends.rows.tolist() == [1]
    assert np.array_equal(some.raw_ends.membrane, raw[[7]])
    assert np.array_equal(some.raw_ends.bending, stations.treated.bending[[7]])


def test_treated_stations_are_those_with_another_raw_stress(model):
    """Here the end treatment of uniform lines changes nothing; a changed end is found."""
    raw = model.stations.raw.membrane.copy()
    raw[7] *= 2.0
    changed = replace(model.stations, raw=replace(model.stations.raw, membrane=raw))
    assert set(treated_rows(changed)) - set(treated_rows(model.stations)) <= {7}
    assert 7 in treated_rows(changed)
