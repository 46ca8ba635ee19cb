"""The reference trailer of tests: its frame bodies, each made once, and the verification numbers beside the tests."""

import json
from functools import cache
from pathlib import Path

from fatigue.vehicle.assembly import suspended
from fatigue.vehicle.definition import Car, Suspension, Vehicle
from fatigue.vehicle.frame_body import frame_body

DATA = Path(__file__).parent / "data" / "vehicle"
BODIES = {  # bases of the verification numbers
    "S": Car(basis="weak", keep_hz=25.0),
    "R": Car(basis="strong", keep_hz=80.0),
    "W80": Car(basis="weak", keep_hz=80.0),
    "full80": Car(basis="full", keep_hz=80.0),
}


@cache
def oracles(name):
    """The verification numbers of a file in ``tests/data/vehicle``."""
    return json.loads((DATA / f"{name}.json").read_text())


@cache
def body(basis="S"):
    """The frame body in one of the bases of the verification numbers."""
    return frame_body(BODIES[basis])


@cache
def trailer(setting="hard"):
    """The trailer with one of its suspensions, ready for any speed and conicity; eight modes."""
    return suspended(Vehicle(suspension=Suspension(setting=setting)), body())
