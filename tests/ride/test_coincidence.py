"""Rows of coincidence: hunting of a bogie beside modes of equipment, with and without a channel at the equipment."""

from dataclasses import fields, replace

import numpy as np
import pytest

from fatigue.case.channels import EquipmentMode, Ride
from fatigue.results.columns import TABLES
from fatigue.ride.coincidence import CoincidenceRow, coincidence_rows
from fatigue.ride.flutter import tracked
from fatigue.vibration.coincidence import amplification
from tests.ride.channels import RATE, hung, hunting, record


def modes(channel="converter"):
    """Give the converter on soft and on stiff mounts."""
    return tuple(
        EquipmentMode(name=f"converter, {f} Hz", frequency_hz=f, damping_ratio=0.05, channel=channel) for f in (9.2, 14)
    )


def rows(*records, ride=None):
    """Rows of an event of these channels."""
    ride = ride or Ride(equipment_mode=modes())
    return coincidence_rows("worn", [tracked(r, ride) for r in records], ride, {r.name: r for r in records})


def test_rows_have_the_columns():
    """Every column of the table is a field of the row, in order."""
    assert [f.name for f in fields(CoincidenceRow)] == [c.name for c in TABLES["coincidence"]]


def test_hunting_meets_the_converter():
    """A burst of 9 Hz under a converter of 9.2 Hz: red, amplified, coherent, a quarter of a period behind."""
    lateral = hunting(f=9.0)
    found = rows(record(lateral), record(hung(lateral, 9.2, 0.05), "converter", "equipment"))
    close, far = found
    assert (close.equipment, close.flag, close.within) == ("converter, 9.2 Hz", "red", "hot")
    assert close.f_hunt_hz == pytest.approx(9.0, abs=0.02)
    assert close.amplification == pytest.approx(amplification(close.f_hunt_hz, 9.2, 0.05))
    assert close.coherence > 0.9
    assert close.coherence > close.coherence_event > close.chance_coherence / 2
    assert close.phase_deg == pytest.approx(close.oscillator_phase_deg, abs=5)
    assert 60 < close.phase_deg < 100
    assert close.reason is None
    assert (far.flag, far.amplification) == ("amber", pytest.approx(1.69, abs=0.02))
    assert far.coherence == close.coherence


def test_normal_contact():
    """Without a hot stretch frequency and coherence are those of the whole event."""
    lateral = hunting(between=(0.0, 60.0), rms=0.4, f=6.5)
    close, _ = rows(record(lateral), record(hung(lateral, 9.2, 0.05), "converter", "equipment"))
    assert close.within == "event"
    assert close.f_hunt_hz == pytest.approx(6.5, abs=0.05)
    assert close.coherence == close.coherence_event
    assert close.averages == pytest.approx(56, abs=1)


def test_unrelated_channel():
    """A channel that has nothing to do with the bogie has a coherence of chance, which is said."""
    close, _ = rows(record(hunting()), record(hunting(rms=0.0, seed=9), "converter", "equipment"))
    assert close.coherence < close.chance_coherence
    assert close.reason.endswith("is chance: the phase means nothing")


def test_channel_of_another_rate_and_start():
    """A channel at 1000 Hz that starts two seconds later is compared as if it were on the grid of the bogie."""
    lateral = hunting(f=9.0, rate=1000.0)
    converter = hung(lateral, 9.2, 0.05, rate=1000.0)
    plain, _ = rows(record(lateral, step=1e-3), record(converter, "converter", "equipment", step=1e-3))
    mixed, _ = rows(
        record(lateral[::4], step=4e-3), record(converter[2000:], "converter", "equipment", step=1e-3, start=3.0)
    )
    assert mixed.phase_deg == pytest.approx(plain.phase_deg, abs=2)
    assert mixed.coherence == pytest.approx(plain.coherence, abs=0.03)


@pytest.mark.parametrize(
    ("channel", "other", "reason"),
    [
        (None, "converter", "the mode has no channel"),
        ("fan", "converter", "the event has no channel 'fan'"),
        ("bogie", "converter", "the channel of the mode is the hunting channel itself"),
    ],
)
def test_no_channel_to_compare(channel, other, reason):
    """Amplification and flag need no channel; coherence and phase do, and say what is missing."""
    ride = Ride(equipment_mode=modes(channel))
    close, _ = rows(record(hunting()), record(hunting(seed=2), other, "equipment"), ride=ride)
    assert np.isfinite(close.amplification)
    assert close.flag is not None
    assert np.isnan([close.coherence, close.phase_deg, close.coherence_event]).all()
    assert close.reason.startswith(reason)


def test_slow_channel():
    """A channel sampled at 15 Hz knows nothing of 8.3 Hz."""
    slow = record(hunting()[::13], "converter", "equipment", step=13 / RATE)
    close, _ = rows(record(hunting()), slow)
    assert close.reason.startswith("sampled at 15.38 Hz: nothing is known at 8.3")


def test_short_hot_stretch():
    """A hot stretch of 3 s holds too few segments: the coherence is that of the event alone."""
    lateral = hunting(between=(20.0, 23.0), rms=6.0)
    close, _ = rows(record(lateral), record(hung(lateral, 9.2, 0.05), "converter", "equipment"))
    assert np.isnan(close.coherence)
    assert np.isfinite(close.coherence_event)
    assert close.reason.startswith("hot stretches hold fewer than four segments of 2 s")


def test_silent_equipment():
    """A channel that does not move has no coherence, and the reason."""
    close, _ = rows(record(hunting()), record(np.zeros(12_000), "converter", "equipment"))
    assert np.isnan(close.coherence)
    assert close.reason == "one of the two channels is silent"


def test_no_channel_of_a_bogie():
    """Without a lateral channel of a bogie every mode has a row with the reason, and no numbers."""
    for other in (record(hunting(), role="floor"), record(hunting(), direction="z")):
        for row in rows(other):
            assert row.channel is None
            assert row.flag is None
            assert np.isnan([row.f_hunt_hz, row.amplification]).all()
            assert row.reason == "no channel of the event has the role 'bogie' and the direction 'y'"


def test_a_bogie_without_a_track():
    """A silent bogie has the reason of its track; another one beside it has its numbers."""
    found = rows(record(np.zeros(12_000), "front"), record(hunting(), "rear"))
    assert [row.channel for row in found] == ["front", "front", "rear", "rear"]
    assert found[0].reason.startswith("nothing vibrates")
    assert np.isnan(found[0].f_hunt_hz)
    assert found[2].flag is not None


def test_no_modes():
    """Without modes of equipment there is nothing to compare."""
    assert rows(record(hunting()), ride=Ride()) == []
    assert rows(replace(record(hunting()), role="floor"), ride=Ride()) == []
