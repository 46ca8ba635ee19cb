"""Modal coordinates among the channels of a file."""

from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.channels.coordinates import coordinates_of
from fatigue.readers.foreign.channels.group import ChannelGroup, RecordedChannel

PATH = Path("run.bin")
TIME = 2.0 + 0.01 * np.arange(50)


def group(channels, *, name="", time=TIME, without_time=""):
    """Group whose channels hold their position plus the time; names may carry a unit after a bar."""
    parts = [one.partition("|") for one in channels]
    stated = tuple(RecordedChannel(n, u) for n, _, u in parts)
    samples = 50 if time is None else time.size
    rows = np.arange(len(channels))[:, None] + np.zeros(samples)

    def values(at):
        return rows[list(at)]

    return ChannelGroup(name, stated, samples, time, values, without_time)


def refused(groups, columns=None, time_column=None):
    """Codes and texts of the refusal."""
    with pytest.raises(DataError) as caught:
        coordinates_of(PATH, groups, columns, time_column)
    return caught.value.problems[0]


def test_channels_with_a_number_are_coordinates():
    """In the order of the file, with the file's own start and units."""
    history = coordinates_of(PATH, [group(["q_7|mm", "q_3|mm"])], None, None)
    assert history.mode.tolist() == [7, 3]
    assert history.time[0] == 2.0
    assert history.unit == ("mm", "mm")
    np.testing.assert_array_equal(history.q, np.array([[0.0], [1.0]]) + np.zeros(50))
    assert not history.warnings


@pytest.mark.parametrize("none", ["-", "1", "no_units", "None", " "])
def test_labels_that_say_no_unit_are_none(none):
    """As ``no_units`` of Adams, or ``-`` of loggers; a unit in the name stays."""
    assert coordinates_of(PATH, [group([f"q_7|{none}", f"q_3 [mm]|{none}"])], None, None).unit == ("", "mm")


def test_channels_without_a_number_stay_behind_and_are_told():
    """A speed beside coordinates is none; a unit load is kept."""
    history = coordinates_of(PATH, [group(["speed", "q_1", "u_pressure"])], None, None)
    assert history.name == ("q_1", "u_pressure")
    (warning,) = history.warnings
    assert warning.code == "channels_left_out"
    assert "'speed'" in warning.what


def test_without_any_number_all_channels_are_taken():
    """They may be joined in order."""
    history = coordinates_of(PATH, [group(["first", "second"])], None, None)
    assert history.mode.tolist() == [0, 0]


def test_groups_on_one_time_base_are_one():
    """As files with a data set for each channel are."""
    history = coordinates_of(PATH, [group(["q_1"], name="a"), group(["q_2"], name="b", time=TIME.copy())], None, None)
    assert history.mode.tolist() == [1, 2]


def test_groups_on_other_time_bases_are_named():
    """With their steps; naming the columns of one of them is the way out."""
    groups = [group(["q_1"], name="fast"), group(["q_2"], name="slow", time=TIME[::2])]
    problem = refused(groups)
    assert problem.code == "several_times"
    assert "group 'fast' (1 channel, 50 samples, from 2 s every 0.01 s)" in problem.what
    assert "group 'slow' (1 channel, 25 samples, from 2 s every 0.02 s)" in problem.what
    assert coordinates_of(PATH, groups, {"q_2": 2}, None).q.shape == (1, 25)


def test_a_shifted_start_is_another_time_base():
    """The same step and another start offset are not one grid."""
    assert refused([group(["q_1"], name="a"), group(["q_2"], name="b", time=TIME + 0.004)]).code == "several_times"


def test_groups_of_other_channels_do_not_disturb():
    """A slow group without any number, as of a GPS, is left out and told."""
    history = coordinates_of(PATH, [group(["q_1"]), group(["latitude"], name="gps", time=TIME[::10])], None, None)
    assert history.mode.tolist() == [1]
    assert "all of group 'gps'" in history.warnings[0].what


def test_channels_without_time_are_refused():
    """With the reason that the reader gives, unless a channel of the group is time."""
    problem = refused([group(["q_1"], time=None, without_time="its channels have no increment")])
    assert problem.code == "no_time"
    assert "no increment" in problem.what


def test_a_channel_of_the_group_may_be_its_time():
    """By its name, in its unit."""
    times = group(["Time|ms", "q_1"], time=None)
    history = ChannelGroup("", times.channels, 50, None, lambda at: np.array([1000 * TIME, 3 + 0 * TIME])[list(at)])
    found = coordinates_of(PATH, [history], None, None)
    np.testing.assert_allclose(found.time, TIME, rtol=1e-15)
    assert found.mode.tolist() == [1]


def test_a_map_of_columns_names_channels_without_their_unit():
    """As it does in tables of text; a name that is nowhere is refused with those that are there."""
    history = coordinates_of(PATH, [group(["Bounce [mm]", "Pitch [mm]"])], {"Pitch": 4}, None)
    assert history.mode.tolist() == [4]
    assert history.q[0, 0] == 1.0
    problem = refused([group(["Bounce", "Pitch"])], {"Roll": 1})
    assert problem.code == "no_column"
    assert "'Bounce', 'Pitch'" in problem.what


def test_a_unit_that_name_and_file_state_differently_is_refused():
    """One of them is wrong."""
    problem = refused([group(["q_1 [mm]|m"])])
    assert problem.code == "header"
    assert "channel 'q_1 [mm]'" in problem.where


def test_a_missing_sample_is_refused_by_name():
    """NaN, as a reader marks it."""
    broken = ChannelGroup(
        "", (RecordedChannel("q_1"),), 50, TIME, lambda at: np.where(np.arange(50) == 7, np.nan, 1.0)[None]
    )
    problem = refused([broken])
    assert problem.code == "not_a_number"
    assert "sample 8" in problem.where


def test_an_empty_file_has_no_coordinates():
    """No group has a channel."""
    assert refused([group([])]).code == "no_coordinates"
