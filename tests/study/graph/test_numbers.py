"""Numbers of the analysis graph beside the verification numbers of the reference trailer."""

import math

import pytest

from fatigue.study.graph.numbers import graph_numbers
from fatigue.study.vehicle_file import load_vehicle
from tests.vehicle_oracles import body, oracles


@pytest.mark.parametrize("setting", ["hard", "soft", "long_wheelbase"])
def test_the_range_of_conicity_is_that_of_the_second_program(setting):
    """Both ends of the widest stable range at 350 km/h, and the frequencies there."""
    found = graph_numbers(load_vehicle(None, {"suspension.setting": setting}), body())
    *_, low, high = oracles("stability")["critical"]["settings"][setting]["conicity_crossings"]["350"]
    for end, (at, hz, change) in (("min", low), ("max", high)):
        assert change == ("gains" if end == "min" else "loses")
        assert found[f"conicity_{end}"][0] == pytest.approx(at, rel=1e-4)
        assert found[f"conicity_{end}_hz"][0] == pytest.approx(hz, rel=1e-4)
    assert found["hunting_hz_at_crossing"] == found["conicity_max_hz"]


@pytest.mark.parametrize(("conicity", "key"), [(0.1, "0.1"), (0.3, "0.3")])
def test_critical_speeds_are_those_of_the_second_program(conicity, key):
    """The hard trailer is unstable from 109 to 273 km/h at 0.10; at 0.30 bogies hunt from 605 km/h on."""
    found = graph_numbers(load_vehicle(None, {"contact.conicity": conicity}), body())
    crossings = oracles("stability")["critical"]["settings"]["hard"]["speed_crossings"][key]
    assert found["critical_speed_km_h"][0] == pytest.approx(crossings[0][0], rel=1e-4)
    if key == "0.1":
        assert found["stable_again_km_h"][0] == pytest.approx(crossings[1][0], rel=1e-4)
        assert math.isnan(found["hunting_speed_km_h"][0])
        assert "no root above 3 Hz" in found["hunting_speed_km_h"][2]
    else:
        assert found["hunting_speed_km_h"][0] == found["critical_speed_km_h"][0]
        assert found["hunting_speed_hz"][0] == pytest.approx(crossings[0][1], rel=1e-4)


def test_a_number_that_cannot_be_had_has_its_reason():
    """The soft trailer loses stability at no speed; one without creep at no conicity keeps it."""
    soft = graph_numbers(load_vehicle(None, {"suspension.setting": "soft"}), body())
    assert math.isnan(soft["critical_speed_km_h"][0])
    assert "is stable from 60 to 700 km/h" in soft["critical_speed_km_h"][2]
    loose = {"suspension.yaw_damper_N_m": 1e3, "suspension.secondary_y_Ns_m": 0.0, "run.speed_km_h": 600.0}
    lost = graph_numbers(load_vehicle(None, loose), body())
    assert math.isnan(lost["conicity_min"][0])
    assert "no conicity from 0.01 to 1.2 is stable" in lost["conicity_min"][2]
    assert lost["least_damping"][0] < 0.0
    for value, _, reason in (*soft.values(), *lost.values()):
        assert math.isnan(value) == bool(reason)
