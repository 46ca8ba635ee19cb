"""Hunting on worn treads, against the numbers of another program."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fatigue.vehicle.definition import Car, Contact, Suspension, Vehicle
from fatigue.vehicle.frame_body import frame_body
from fatigue.vehicle.in_time.contact import equivalent_conicity
from fatigue.vehicle.limit_cycle import frequency_of, limit_cycle

ORACLES = json.loads((Path(__file__).parents[1] / "data/vehicle/limit_cycles.json").read_text())["rows"]


@pytest.fixture(scope="module")
def body():
    """The body of the reference trailer."""
    return frame_body(Car())


def vehicle(row):
    """The vehicle of a row of the oracles."""
    of = Vehicle()
    return replace(
        of,
        converter=replace(of.converter, fe_hz=row["fe"]),
        suspension=Suspension(setting=row["setting"]),
        contact=Contact(saturation_mu=row["creep_saturation_mu"]),
        run=replace(of.run, speed_km_h=row["V"]),
    )


@pytest.mark.parametrize("row", ORACLES, ids=lambda row: f"{row['setting']}-{row['fe']}-{row['creep_saturation_mu']}")
def test_limit_cycles_of_another_program(row, body):
    """Frequency within 1e-3, amplitudes and accelerations within 1 %; what comes out is ten times as close."""
    found = limit_cycle(vehicle(row), body)
    assert found.frequency_hz == pytest.approx(row["frequency_hz"], rel=1e-4)
    assert found.wheelsets_mm[0] == pytest.approx(row["ws1_y_amplitude_mm"], rel=1e-3)
    assert found.wheelsets_mm[2] == pytest.approx(row["ws3_y_amplitude_mm"], rel=1e-3)
    for name in ("bog_y", "conv_y", "roof_mid_y"):
        assert found.rms[name] == pytest.approx(row[f"{name}_acc_rms"], rel=1e-3)
    assert found.steady == row["steady"]


def test_a_limit_cycle_has_the_conicity_that_neither_grows_nor_decays(body):
    """Harmonic linearisation: 2.9 mm of the wheelset make a conicity near the 0.709 at which hunting sets in."""
    row = ORACLES[0]
    assert (row["setting"], row["fe"], row["creep_saturation_mu"]) == ("hard", 9.2, None)
    found = limit_cycle(vehicle(row), body)
    conicity = float(equivalent_conicity(found.wheelsets_mm.mean() / 1000.0, 0.1, 1.2, 0.002))
    assert conicity == pytest.approx(0.709, abs=0.15)


def test_a_tread_that_is_not_worn_brings_the_vehicle_to_rest(body):
    """Conicity 0.1 in the middle as well: stable, so the push dies out, and there is no frequency."""
    found = limit_cycle(Vehicle(contact=Contact(worn_conicity=0.1)), body)
    assert np.isnan(found.frequency_hz)
    assert found.steady
    assert (found.wheelsets_mm < 1e-3).all()


def test_frequency_of_what_does_not_swing():
    """One crossing is no period."""
    assert np.isnan(frequency_of(np.array([-1.0, 1.0, 1.0]), 0.1))
    assert np.isnan(frequency_of(np.zeros(9), 0.1))
