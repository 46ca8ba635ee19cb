"""Stations: order of the register, stress of some of them, those that the end treatment changes."""

from dataclasses import fields

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.pipeline.solve.model import read_model
from fatigue.pipeline.solve.stations import modal_stress, stations_of
from fatigue.weld.structural_stress import LineStress, RawEnds, StructuralStress
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


def test_modal_stress_of_some_stations(model):
    """Treated stress, with size factor and rule of the curve."""
    treated = model.stations.treated
    for name, rows in (("master-aluminium", np.array([0, 3])), ("iiw-aluminium-40", np.array([13]))):
        stress = modal_stress(model.stations, rows, model.body.curves[name])
        assert np.array_equal(stress.bending, treated.bending[rows])
        assert np.array_equal(stress.at(np.array([len(rows) - 1])).membrane, treated.membrane[rows[-1:]])
        assert stress.rule.uses_bending_ratio == (name == "master-aluminium")
        assert stress.size == pytest.approx(8.0 ** (1.6 / 7.2) if stress.rule.uses_bending_ratio else 1.0)
        assert stress.rule is model.body.curves[name].rule


def with_raw(model, changed):
    """Stations of the model whose membrane stress was another one before the end treatment, by factors of some rows."""
    stations = model.stations
    membrane = stations.treated.membrane.copy()
    for row, factor in changed.items():
        membrane[row] = factor * membrane[row] + 1.0
    ends = np.array(sorted([*changed, 3]))  # row 3 is treated, but comes out as it was
    before = {part.name: getattr(stations.treated, part.name)[ends] for part in fields(StructuralStress)}
    solved = LineStress(
        line=model.lines,
        treated=stations.treated,
        raw_ends=RawEnds(ends, StructuralStress(**(before | {"membrane": membrane[ends]}))),
        at_end=stations.at_end,
        at_corner=stations.at_corner,
        summed_corner=stations.summed_corner,
        unresolved=np.zeros(len(stations), dtype=np.bool_),
    )
    return stations_of(model.lines, solved, model.welds), membrane


def test_the_raw_stress_is_kept_where_the_end_treatment_changed_it(model):
    """With all five components; elsewhere it is that of the treated stations."""
    stations, raw = with_raw(model, {0: 2.0, 7: 4.0})
    assert stations.raw_ends.rows.tolist() == [0, 7]
    assert np.array_equal(stations.raw_ends.stress.membrane, raw[[0, 7]])
    assert np.array_equal(stations.raw_ends.stress.twist_shear, stations.treated.twist_shear[[0, 7]])


def test_modal_stress_knows_its_raw_ends(model):
    """Those among the rows asked for, and again among some of them."""
    stations, raw = with_raw(model, {0: 2.0, 6: 3.0, 7: 4.0})
    stress = modal_stress(stations, np.array([0, 3, 6, 7, 9]), model.body.curves["master-aluminium"])
    assert stress.raw_ends.rows.tolist() == [0, 2, 3]
    assert np.array_equal(stress.raw_ends.stress.membrane, raw[[0, 6, 7]])
    some = stress.at(np.array([1, 3, 4]))
    assert some.raw_ends.rows.tolist() == [1]
    assert np.array_equal(some.raw_ends.stress.membrane, raw[[7]])
    assert np.array_equal(some.raw_ends.stress.bending, stations.treated.bending[[7]])
