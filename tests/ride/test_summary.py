"""What is said of a ride: lines of the page's width, what no event has said once, figures that a reader can hold."""

import numpy as np

from fatigue.case.channels import Equipment, Ride
from fatigue.ride.channel import ChannelRecord
from fatigue.ride.flutter import tracked
from fatigue.ride.standards.equipment import read_vibration_table
from fatigue.ride.story import tables_of_channels
from fatigue.ride.summary import WIDTH, RideSummary

RIDE = Ride(equipment=(Equipment.model_validate({"channel": "converter", "class": "1A", "mass_kg": 6600.0}),))
NAMES = {"bogie": ("bogie y", "y"), "equipment": ("converter", "y"), "floor": ("floor <b>mid</b>\x1b z", "z")}


class _Case:
    """The rules alone, which is all that tables of channels ask of a case."""

    ride = RIDE


def said(values, events=("worn",), is_acceleration=True):
    """Text of a ride of a bogie, a converter and a floor with the same values in every event."""
    records = [
        ChannelRecord(event, *(name, role, direction), is_acceleration, np.asarray(values), 0.005, 1.0, 0.1)
        for event in events
        for role, (name, direction) in NAMES.items()
    ]
    of = [tracked(one, RIDE) for one in records]
    tables = tables_of_channels(_Case(), records, of, read_vibration_table(None))
    return RideSummary("title", tuple(events), "points", {**tables, "hot_damage": []}, {}, ()).as_text()


def noise(seconds=30.0):
    """Noise of 1 m/s2 at 200 Hz."""
    return np.random.default_rng(5).standard_normal(round(seconds * 200.0))


def test_no_line_is_wider_than_the_page():
    """Long lines go on below, further in; no character of control gets through."""
    text = said(noise())
    assert max(map(len, text.splitlines())) <= WIDTH
    assert "\x1b" not in text
    (start,) = (i for i, line in enumerate(text.splitlines()) if line.startswith("  vibration of 'converter'"))
    assert text.splitlines()[start + 1].startswith("    ")


def test_what_no_event_has_is_said_once():
    """The reasons of three events that lack the same are one block; of a single event they stand in its own."""
    three = said(noise(), ("a", "b", "c"), is_acceleration=False)
    assert three.count("not had: alarm of 'bogie y' (no acceleration") == 1
    assert three.index("In every event") > three.index("'c'")
    one = said(noise(), is_acceleration=False)
    assert one.count("not had: alarm of 'bogie y' (no acceleration") == 1
    assert "In every event" not in one


def test_a_dead_sensor_tells_nothing():
    """A constant has no index, no comparison and no frequency; its alarm says that it could not have gone off."""
    text = said(np.full(6000, 0.2))
    assert "alarm of 'bogie y' (6 cycles at 8 m/s2): none, largest peak 0 m/s2 (the channel does not vary" in text
    assert "vibration of 'converter', " in text
    for number in ("rms 0", "sliding_rms, ", "bogie_peak, 0", "instability_frequency, 4-12 Hz", "by filter", "e-1"):
        assert number not in text
