"""Unit loads in a case: what is read, and every contradiction with its place and remedy."""

import pytest

from fatigue.case import case_warnings, check_files, load_case
from fatigue.case.given_loads import given_loads
from fatigue.errors import CaseError, DataError
from tests.case.case_text import MINIMAL

PRESSURE = '[[body.unit_load]]\nname = "pressure"\nunit = "kPa"\nnodal_forces = "loads.csv"\n'
GRAVITY = '[[body.unit_load]]\nname = "gravity"\nunit = "g"\nnodal_forces = "loads.csv"\nrole = "gravity"\n'
OF_MISSION = '[[mission.unit_load]]\nname = "gravity"\nunit = "g"\nconstant = 1.0\n'
STATIC = '[[mission.event]]\nname = "lift"\nper_1000_km = 1.0\n'


def of_event(name="pressure", unit="kPa", **keys) -> str:
    """Table of what the last event gives of a load."""
    lines = [f"{key} = {value}" for key, value in keys.items()]
    return "\n".join(["[[mission.event.unit_load]]", f'name = "{name}"', f'unit = "{unit}"', *lines, ""])


def test_defaults(load):
    """What a load leaves out takes the documented value."""
    case = load(MINIMAL + PRESSURE + of_event(history='"p.csv"'))
    (body_load,), (given,) = case.body.unit_load, case.mission.event[-1].unit_load
    assert (body_load.role, body_load.when_missing, body_load.elements_carry_load) == ("other", "error", False)
    assert (given.own_column, given.scale, given.shift_s, given.interpolation) == ("u_pressure", 1.0, 0.0, "fourier")


def test_files_of_loads_are_inputs(load):
    """Forces and histories are found, hashed and watched by their keys."""
    case = load(MINIMAL + PRESSURE + of_event(history='"p.csv"'))
    files = case.input_files()
    assert files["body.unit_load[1].nodal_forces"].name == "loads.csv"
    assert files["mission.event[3].unit_load[1].history"].name == "p.csv"
    with pytest.raises(DataError, match=r"mission\.event\[3\]\.unit_load\[1\]\.history"):
        check_files(case)


def test_where_a_load_comes_from(load):
    """The event's table, then its column, then the mission, then nothing."""
    case = load(MINIMAL + GRAVITY + OF_MISSION + PRESSURE.replace("unit =", 'when_missing = "zero"\nunit ='))
    first = case.mission.event[0]
    gravity, pressure = given_loads(case, first, ())
    assert (gravity.way, gravity.constant, pressure.way) == ("constant", 1.0, "missing")
    gravity, pressure = given_loads(case, first, ["time_s", "u_gravity", "u_pressure"])
    assert (gravity.way, gravity.column, pressure.way) == ("column", "u_gravity", "column")
    case = load(MINIMAL + of_event("gravity", "g", constant=0.5, scale=2.5) + GRAVITY + OF_MISSION)
    (gravity,) = given_loads(case, case.mission.event[-1], ["u_gravity"])
    assert (gravity.way, gravity.constant) == ("constant", 1.25)


def test_a_load_that_is_not_given(load):
    """An error that names event, load and the three ways, unless it may be zero."""
    case = load(MINIMAL + PRESSURE)
    with pytest.raises(CaseError) as refusal:
        given_loads(case, case.mission.event[0], ["q_1"])
    text = str(refusal.value)
    assert "the unit load 'pressure' is not given: no column u_pressure in" in text
    assert "when_missing = 'zero'" in text


def test_a_static_load_case(load):
    """No history: its values make the record, and the residue is half unless said."""
    case = load(MINIMAL + PRESSURE + STATIC + of_event(values="[0.0, 1, 0.5]", scale=2.0))
    event = case.mission.event[-1]
    assert (event.history, event.static_values, case.residue(event)) == (None, 3, "half")
    (pressure,) = given_loads(case, event, ())
    assert (pressure.way, pressure.values) == ("values", (0.0, 2.0, 1.0))
    assert case.input_files().keys() == load(MINIMAL + PRESSURE).input_files().keys()


WRONG = [
    (PRESSURE + PRESSURE, "body.unit_load[2].name: the unit load 'pressure' is there already"),
    (PRESSURE.replace('"pressure"', '"2p"'), 'body.unit_load[1].name: "2p" String should match'),
    (
        PRESSURE.replace("nodal", "element"),
        "unit_load[1].element_forces: unit load 'pressure' gives element_forces",
    ),
    (PRESSURE.replace('nodal_forces = "loads.csv"\n', ""), "body.unit_load[1].nodal_forces: neither nodal_forces nor"),
    (
        PRESSURE + 'element_forces = "e.csv"\n',
        "unit_load[1].nodal_forces: nodal_forces and element_forces are both",
    ),
    (
        PRESSURE + "elements_carry_load = true\n",
        "elements_carry_load: true is given with nodal_forces",
    ),
    (
        PRESSURE + of_event("pressur", constant=1.0),
        "name: there is no unit load 'pressur'. Write 'pressure'",
    ),
    (of_event(constant=1.0), "unit_load[1].name: there is no unit load 'pressure'. Define it by a [[body.unit_load]]"),
    (PRESSURE + of_event(unit="Pa", constant=1.0), "unit_load[1].unit: 'Pa' is not the unit of unit load 'pressure'"),
    (PRESSURE + of_event(unit="kpa", constant=1.0), "unit_load[1].unit: 'kpa' is not the unit of unit load 'pressure'"),
    (GRAVITY + OF_MISSION.replace('"g"', '"m/s2"'), "mission.unit_load[1].unit: 'm/s2' is not the unit of unit load"),
    (GRAVITY + OF_MISSION + OF_MISSION, "mission.unit_load[2].name: the unit load 'gravity' is there already"),
    (OF_MISSION, "mission.unit_load[1].name: there is no unit load 'gravity'"),
    (PRESSURE + of_event(), "none of history, constant, values is given"),
    (PRESSURE + of_event(constant=1.0, values="[1, 2]"), "constant and values are given together"),
    (PRESSURE + of_event(history='"p.csv"', constant=1.0), "history and constant are given together"),
    (PRESSURE + of_event(constant=1.0) * 2, "unit_load[2].name: the unit load 'pressure' is there already"),
    (PRESSURE + of_event(values="[0, 1]"), "values of 'pressure' are given beside the history of the event"),
    (PRESSURE + STATIC + of_event(values="[1.0]"), "[1.0] has fewer than 2 values"),
    (PRESSURE + of_event(constant=1.0, shift_s=1.0), "shift_s is given without a history"),
    (PRESSURE + of_event(constant=1.0, interpolation='"linear"'), "interpolation is given without a history"),
    (PRESSURE + of_event(constant=1.0, column='"c"'), "column is given without a history"),
    (PRESSURE + of_event(constant=1.0, scale=0.0), "0 takes the load out"),
    (PRESSURE + of_event(history='"p.csv"', interpolation='"cubic"'), "should be 'fourier' or 'linear'"),
    (PRESSURE + of_event(constant="nan"), "should be a finite number"),
    (PRESSURE + STATIC, "mission.event[4].history ('lift'): the key is missing"),
    (PRESSURE + STATIC + of_event(constant=1.0), "mission.event[4].history ('lift'): the key is missing"),
    (PRESSURE + STATIC + of_event(history='"p.csv"'), "a history of 'pressure' is given for an event without one"),
    (
        PRESSURE + GRAVITY + STATIC + of_event(values="[0, 1]") + of_event("gravity", "g", values="[1, 1, 2]"),
        "the lists have unequal lengths: 2 of 'pressure', 3 of 'gravity'",
    ),
    (PRESSURE + STATIC + "start_s = 1.0\n" + of_event(values="[0, 1]"), "start_s ('lift'): 1 is given for a static"),
    (
        PRESSURE + STATIC.replace("per_1000_km", "share") + "speed_km_h = 80.0\n" + of_event(values="[0, 1]"),
        "share ('lift'): share = 1 is given for a static load case",
    ),
    (
        PRESSURE + STATIC + "speed_km_h = 80.0\n" + of_event(values="[0, 1]"),
        "speed_km_h ('lift'): 80 is given for an event counted by number",
    ),
    (PRESSURE + of_event(value="[1, 2]", constant=1.0), "unknown key with the value [1, 2]. Write 'values'"),
]


@pytest.mark.parametrize(("more", "message"), WRONG, ids=[message[:50] for _, message in WRONG])
def test_contradictions(load, more, message):
    """Each has its place, its values and its remedy."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL + more)
    assert message in str(refusal.value)


def test_a_mistake_elsewhere_hides_none(load):
    """Unknown loads are told beside a wrong curve."""
    with pytest.raises(CaseError) as refusal:
        load(MINIMAL.replace("master-aluminium", "master-gold") + PRESSURE + of_event("preasure", constant=1.0))
    assert {problem.code for problem in refusal.value.problems} == {"unknown_curve", "unknown_unit_load"}


def test_malformed_lists_are_told_by_the_models(load):
    """A table in the place of a list, a list of numbers, a load without a name."""
    for more in ("[mission.unit_load]\nname = 1\n", "[body.unit_load]\nx = 1\n"):
        with pytest.raises(CaseError):
            load(MINIMAL + more)


def test_names_that_look_alike_warn(tmp_path):
    """Two loads that differ in a letter's case."""
    path = tmp_path / "case.toml"
    path.write_text(MINIMAL + PRESSURE + PRESSURE.replace('"pressure"', '"Pressure"'))
    assert any("unit loads" in f"{warning}" for warning in case_warnings(load_case(path)))
