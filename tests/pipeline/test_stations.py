"""Stations: order of the register, shapes of some of them, those that the end treatment changes."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.pipeline.model import read_model
from fatigue.pipeline.stations import shapes_of, stations_of, treated_rows
from tests.small_case import small_case


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    """The solved small case; weld B on a curve of its own."""
    case = small_case()
    case.welds["curve"] = [None, "iiw-aluminium-40"]
    return read_model(load_case(case.write(tmp_path_factory.mktemp("case"))), strict=False)


def test_stations_follow_the_register(model):
    """Welds in the order of the table of welds, nodes along their line, whatever order the lines come in."""
    backwards = stations_of(model.lines[::-1], [weld.name for weld in model.welds])
    assert np.array_equal(backwards.node, model.stations.node)
    assert model.stations.weld.tolist() == [0] * 7 + [1] * 7
    assert model.stations.arc_length.tolist() == pytest.approx([0, 10, 20, 30, 40, 50, 60] * 2)


def test_shapes_of_some_stations(model):
    """Treated or raw stress as asked, with size factor and law of the curve."""
    for name, stress, rows in (
        ("master-aluminium", model.stations.treated, np.array([0, 3])),
        ("iiw-aluminium-40", model.stations.raw, np.array([13])),
    ):
        shapes = shapes_of(model.stations, stress, rows, model.curves[name], "actual")
        assert np.array_equal(shapes.bending, stress.bending[rows])
        assert np.array_equal(shapes.at(np.array([-1])).membrane, stress.membrane[rows[-1:]])
        assert shapes.uses_bending_ratio == (name == "master-aluminium")
        assert shapes.size == pytest.approx(8.0 ** (1.6 / 7.2) if shapes.uses_bending_ratio else 1.0)
        assert shapes.law is model.curves[name].law


def test_treated_stations_are_those_with_another_raw_stress(model):
    """Here the end treatment of uniform lines changes nothing; a changed end is found."""
    raw = model.stations.raw.membrane.copy()
    raw[7] *= 2.0
    changed = replace(model.stations, raw=replace(model.stations.raw, membrane=raw))
    assert set(treated_rows(changed)) - set(treated_rows(model.stations)) <= {7}
    assert 7 in treated_rows(changed)
