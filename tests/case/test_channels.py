"""Channels and the rules of a ride in a case: what contradicts itself is refused, all of it at once."""

import pytest

from fatigue.case import load_case
from fatigue.errors import CaseError
from tests.case.case_text import MINIMAL

BOGIE = '{ name = "bogie", column = "a", unit = "m/s2", role = "bogie", direction = "y" }'
MOUNT = '{ name = "mount", column = "b", unit = "g", role = "equipment", direction = "y" }'
STATIC = """
[[body.unit_load]]
name = "payload"
unit = "kPa"
nodal_forces = "f.csv"
"""


def channels(text, event, *given):
    """A case text with channels of one event."""
    return text.replace(f'name = "{event}"', f'name = "{event}"\nchannel = [{", ".join(given)}]')


TWO = channels(channels(MINIMAL, "tangent", BOGIE, MOUNT), "curve", BOGIE)


def loaded(tmp_path, text):
    """The case of a text."""
    path = tmp_path / "case.toml"
    path.write_text(text)
    return load_case(path)


def test_a_sound_case(tmp_path):
    """Channels of a name in several events, rules for each of them, several classes for one channel."""
    rules = """
    [ride]
    reference_rms = { bogie = 0.5 }
    [[ride.equipment_mode]]
    name = "converter"
    frequency_hz = 9.2
    damping_ratio = 0.05
    channel = "mount"
    [[ride.equipment]]
    channel = "mount"
    class = "1A"
    [[ride.equipment]]
    channel = "mount"
    class = "1B"
    """
    case = loaded(tmp_path, TWO + rules)
    bogie, mount = case.mission.event[0].channel
    assert (bogie.factor, mount.factor) == (1.0, 9.80665)
    assert [equipment.vibration_class for equipment in case.ride.equipment] == ["1A", "1B"]
    assert "mission.event[1].channel[1].history" not in case.input_files()


def test_a_channel_is_in_the_history_of_its_event(tmp_path):
    """By default, or where it names the same file in other words."""
    own = BOGIE.replace("{ ", '{ history = "./q_tangent.parquet", ')
    other = MOUNT.replace("{ ", '{ history = "b.csv", ')
    event = loaded(tmp_path, channels(MINIMAL, "tangent", own, other)).mission.event[0]
    assert [channel.is_in(event.history) for channel in event.channel] == [True, False]


RIDE = TWO + "[ride]\n"
REFUSED = {
    "twice in one event": (
        channels(MINIMAL, "tangent", BOGIE, BOGIE),
        r"event\[1\]\.channel\[2\]\.name: 'bogie' is already",
    ),
    "another role": (
        channels(TWO, "load", BOGIE.replace('"bogie", d', '"floor", d')),
        r"event\[3\]\.channel\[1\]\.role: 'floor', and",
    ),
    "another direction": (
        channels(TWO, "load", BOGIE.replace('"y"', '"z"')),
        r"direction: 'z', and channel 'bogie' is 'y'",
    ),
    "no acceleration": (
        channels(TWO, "load", BOGIE.replace('"m/s2"', '"-"')),
        r"unit: '-', and channel 'bogie' is in 'm/s2'",
    ),
    "scale 0": (channels(MINIMAL, "tangent", BOGIE.replace(" }", ", scale = 0.0 }")), r"scale = 0 leaves nothing"),
    "the time": (
        channels(MINIMAL, "tangent", BOGIE.replace('"a"', '"time_s"')),
        r"channel\[1\]\.column .*'time_s' is the time of the file",
    ),
    "unknown unit": (channels(MINIMAL, "tangent", BOGIE.replace("m/s2", "mm/s2")), r"unit.*'m/s2', 'g' or '-'"),
    "unknown key": (channels(MINIMAL, "tangent", BOGIE.replace("column", "columns")), r"Write 'column'"),
    "reference of no channel": (
        RIDE + "reference_rms = { bogy = 0.5 }\n",
        r"ride\.reference_rms\.bogy: there is no channel 'bogy'\. Write 'bogie'",
    ),
    "no reference": (RIDE + "reference_rms = { bogie = 0.0 }\n", r"ride\.reference_rms\.bogie: 0 is no rms"),
    "hunting band upside down": (
        RIDE + "hunting_band_hz = [12, 4]\n",
        r"ride\.hunting_band_hz: \[12\.0, 4\.0\] is no band",
    ),
    "comfort band from 0": (RIDE + "comfort_band_hz = [0, 40]\n", r"comfort_band_hz: \[0\.0, 40\.0\] is no band"),
    "alarm band of nothing": (
        RIDE + "alarm = { band_hz = [4, 4] }\n",
        r"ride\.alarm\.band_hz: \[4\.0, 4\.0\] is no band",
    ),
    "three edges": (RIDE + "hunting_band_hz = [4, 6, 12]\n", r"ride\.hunting_band_hz"),
    "mode at no channel": (
        TWO + '[[ride.equipment_mode]]\nname="c"\nfrequency_hz=9\ndamping_ratio=0.05\nchannel="moun"\n',
        r"ride\.equipment_mode\[1\]\.channel: there is no channel 'moun'\. Write 'mount'",
    ),
    "mode at a bogie": (
        TWO + '[[ride.equipment_mode]]\nname="c"\nfrequency_hz=9\ndamping_ratio=0.05\nchannel="bogie"\n',
        r"channel 'bogie' has the role 'bogie', not 'equipment'",
    ),
    "mode twice": (
        TWO + '[[ride.equipment_mode]]\nname="c"\nfrequency_hz=9\ndamping_ratio=0.05\n' * 2,
        r"ride\.equipment_mode\[2\]\.name: 'c' is there already",
    ),
    "overdamped mode": (
        TWO + '[[ride.equipment_mode]]\nname="c"\nfrequency_hz=9\ndamping_ratio=5\n',
        r"damping_ratio: 5",
    ),
    "class without channel": (MINIMAL + '[[ride.equipment]]\nchannel="mount"\nclass="1A"\n', r"no event has one"),
    "class twice": (TWO + '[[ride.equipment]]\nchannel="mount"\nclass="1A"\n' * 2, r"'mount', '1A' is there already"),
    "limits of no acceleration": (
        TWO.replace('"g"', '"-"') + '[[ride.equipment]]\nchannel="mount"\nclass="1A"\n',
        r"channel 'mount' has the unit '-', and the limits of equipment are those of accelerations",
    ),
    "a static load case": (
        channels(MINIMAL, "load", BOGIE).replace(
            'history = "q_load.parquet"', 'unit_load = [{ name = "payload", unit = "kPa", values = [0, 1] }]'
        )
        + STATIC,
        r"mission\.event\[3\]\.channel.*: channel 'bogie' is given for a static load case, which lasts no time",
    ),
}


@pytest.mark.parametrize("mistake", REFUSED)
def test_what_contradicts_itself(tmp_path, mistake):
    """One line with place, value and remedy."""
    text, words = REFUSED[mistake]
    with pytest.raises(CaseError, match=words):
        loaded(tmp_path, text)


def test_all_mistakes_are_told_at_once(tmp_path):
    """Also those that a mistake elsewhere would hide."""
    text = RIDE.replace('unit = "g"', 'unit = "kg"') + "reference_rms = { x = 1.0 }\nhuntig_band_hz = [1, 2]\n"
    with pytest.raises(CaseError) as refused:
        loaded(tmp_path, text)
    assert sorted(problem.code for problem in refused.value.problems) == ["bad_value", "unknown_channel", "unknown_key"]
