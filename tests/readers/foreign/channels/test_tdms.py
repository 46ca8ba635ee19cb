"""NI TDMS files, written by the package that reads them."""

import datetime

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_channels, read_coordinates, recognise

nptdms = pytest.importorskip("nptdms", reason="the package nptdms is not installed")

ROWS = np.random.default_rng(5).standard_normal((3, 400))
START = datetime.datetime(2026, 3, 4, 12, 0, 0)


def write(path, channels, *, mode="w"):
    """Write channels: group, name, values, properties."""
    with nptdms.TdmsWriter(path, mode=mode) as writer:
        writer.write_segment([nptdms.ChannelObject(g, n, v, properties=p) for g, n, v, p in channels])
    return path


def timed(step=0.005, offset=0.0, start=START, **more):
    """Properties of a channel with time."""
    return {"wf_increment": step, "wf_start_offset": offset, "wf_start_time": start, "wf_samples": 1} | more


def test_values_names_units_and_times_come_back(tmp_path):
    """The start offset is kept; values exactly."""
    path = write(
        tmp_path / "run.tdms",
        [("Flex", f"q_{k}", ROWS[k], timed(offset=1.5, unit_string="mm")) for k in range(3)],
    )
    (group,) = read_channels(path)
    assert recognise(path).key == "tdms"
    assert group.name == "Flex"
    assert [(one.name, one.unit) for one in group.channels] == [("q_0", "mm"), ("q_1", "mm"), ("q_2", "mm")]
    np.testing.assert_allclose(group.time, 1.5 + 0.005 * np.arange(400), rtol=1e-15)
    np.testing.assert_array_equal(group.values([2, 0]), ROWS[[2, 0]])


def test_whole_numbers_are_scaled_as_the_file_says(tmp_path):
    """A linear scale among the properties; what is stored are 16 bits."""
    raw = np.arange(-200, 200, dtype=np.int16)
    scale = {
        "NI_Number_Of_Scales": 1,
        "NI_Scale[0]_Scale_Type": "Linear",
        "NI_Scale[0]_Linear_Slope": 0.25,
        "NI_Scale[0]_Linear_Y_Intercept": 3.0,
        "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
    }
    path = write(tmp_path / "run.tdms", [("g", "q_1", raw, timed(**scale))])
    np.testing.assert_allclose(read_channels(path)[0].values([0])[0], 0.25 * raw + 3.0)


def test_segments_follow_each_other(tmp_path):
    """As a recording writes them."""
    path = tmp_path / "run.tdms"
    write(path, [("g", "q_1", ROWS[0], timed())])
    write(path, [("g", "q_1", ROWS[1], timed())], mode="a")
    (group,) = read_channels(path)
    np.testing.assert_array_equal(group.values([0])[0], np.concatenate(ROWS[:2]))
    assert group.time[-1] == pytest.approx(0.005 * 799)


def test_stamps_put_all_groups_on_one_clock(tmp_path):
    """Half a second later is another time base, which is told; without a stamp somewhere offsets alone count."""
    later = START + datetime.timedelta(seconds=0.5)
    path = write(tmp_path / "a.tdms", [("a", "q_1", ROWS[0], timed()), ("b", "q_2", ROWS[1], timed(start=later))])
    first, second = read_channels(path)
    assert (first.time[0], second.time[0]) == (0.0, 0.5)
    with pytest.raises(DataError, match=r"group 'b' \(1 channel, 400 samples, from 0.5 s every 0.005 s"):
        read_coordinates(path, None, None)
    unstamped = timed() | {"wf_start_time": datetime.datetime(1904, 1, 1)}
    path = write(tmp_path / "b.tdms", [("a", "q_1", ROWS[0], timed(start=later)), ("b", "q_2", ROWS[1], unstamped)])
    assert read_coordinates(path, None, None).mode.tolist() == [1, 2]


def test_channels_of_one_group_on_other_steps_are_told_apart(tmp_path):
    """A slow channel beside fast ones."""
    path = write(
        tmp_path / "run.tdms", [("g", "q_1", ROWS[0], timed()), ("g", "speed", ROWS[1, :40], timed(step=0.05))]
    )
    fast, slow = read_channels(path)
    assert (fast.name, slow.name) == ("g", "g, other times 1")
    history = read_coordinates(path, None, None)
    assert history.mode.tolist() == [1]
    assert [warning.code for warning in history.warnings] == ["channels_left_out"]


def test_a_channel_of_time_serves_where_there_are_no_increments(tmp_path):
    """Without either the file is refused."""
    time = 0.01 * np.arange(400)
    path = write(tmp_path / "a.tdms", [("g", "Time [s]", time, {}), ("g", "q_1", ROWS[0], {})])
    np.testing.assert_allclose(read_coordinates(path, None, None).time, time)
    path = write(tmp_path / "b.tdms", [("g", "q_1", ROWS[0], {})])
    with pytest.raises(DataError, match="have no wf_increment, and none of them is named time"):
        read_coordinates(path, None, None)


def test_channels_of_text_are_left_out(tmp_path):
    """Comments of the driver are no channel."""
    text = np.array(["a", "b"], dtype="U1")
    path = write(tmp_path / "run.tdms", [("g", "q_1", ROWS[0], timed()), ("g", "note", text, {})])
    assert [one.name for group in read_channels(path) for one in group.channels] == ["q_1"]


def test_a_recording_that_was_not_stopped_is_read_and_told(tmp_path):
    """What is there counts; the warning says so."""
    path = write(tmp_path / "run.tdms", [("g", "q_1", ROWS[0], timed())])
    path.write_bytes(path.read_bytes()[:-400])
    history = read_coordinates(path, None, None)
    np.testing.assert_array_equal(history.q[0], ROWS[0, :350])
    assert [warning.code for warning in history.warnings] == ["cut"]


@pytest.mark.parametrize("share", [0.02, 0.05, 0.1])
def test_a_file_cut_in_its_names_is_refused_in_one_line(tmp_path, share, capfd):
    """Without a word of the package on the terminal."""
    path = write(tmp_path / "run.tdms", [("g", f"q_{k}", ROWS[0, :20], timed()) for k in range(30)])
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(DataError) as caught:
        read_coordinates(path, None, None)
    assert caught.value.problems[0].code in ("tdms_damaged", "no_coordinates")
    assert capfd.readouterr() == ("", "")


def test_increments_are_in_their_own_unit(tmp_path):
    """Milliseconds are turned into seconds; a spectrum or a profile over distance is no time history."""
    in_ms = timed(step=5.0, offset=100.0, wf_xunit_string="ms")
    (group,) = read_channels(write(tmp_path / "a.tdms", [("g", "q_1", ROWS[0], in_ms)]))
    np.testing.assert_allclose(group.time, 0.1 + 0.005 * np.arange(400), rtol=1e-12)
    for more, said in (({"wf_xunit_string": "Hz"}, "over Hz"), ({"wf_xname": "Frequency"}, "over Frequency")):
        path = write(tmp_path / "b.tdms", [("g", "q_1", ROWS[0], timed(**more))])
        with pytest.raises(DataError, match=f"{said}, not over time"):
            read_coordinates(path, None, None)


def test_a_channel_of_stamps_is_time(tmp_path):
    """Date and time beside the values, in seconds from the first; another column of dates is left out."""
    stamps = np.datetime64("2026-03-04T12:00:00", "us") + 10_000 * np.arange(400)
    path = write(
        tmp_path / "run.tdms", [("g", "Time", stamps, {}), ("g", "q_1", ROWS[0], {}), ("g", "checked", stamps, {})]
    )
    (group,) = read_channels(path)
    assert [one.name for one in group.channels] == ["q_1"]
    np.testing.assert_allclose(group.time, 0.01 * np.arange(400), rtol=1e-12)
    np.testing.assert_array_equal(group.values([0])[0], ROWS[0])


def test_channels_that_a_cut_left_empty_are_named(tmp_path):
    """A coordinate that is lost without a word would be taken for a mode that does not move."""
    path = write(tmp_path / "run.tdms", [("g", f"q_{k + 1}", ROWS[k], timed()) for k in range(3)])
    path.write_bytes(path.read_bytes()[: -8 * 400])
    history = read_coordinates(path, None, None)
    assert history.mode.tolist() == [1, 2]
    assert "nothing of 'q_3'" in history.warnings[0].what


def test_a_file_without_numbers_is_refused(tmp_path):
    """Not listed as nothing."""
    path = write(tmp_path / "run.tdms", [("g", "note", np.array(["a", "b"], dtype="U1"), {})])
    with pytest.raises(DataError, match="no channels of numbers"):
        read_channels(path)
