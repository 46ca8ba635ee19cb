"""ASAM MDF files of version 4 and 3, written by the package that reads them."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_channels, read_coordinates, recognise

asammdf = pytest.importorskip("asammdf", reason="the package asammdf is not installed")

TIME = 3.0 + 0.004 * np.arange(500)
ROWS = np.random.default_rng(7).standard_normal((3, 500))


def signal(name, samples, *, time=TIME, unit="mm", **more):
    """One channel."""
    return asammdf.Signal(samples=samples, timestamps=time, name=name, unit=unit, **more)


def write(path, *groups, version="4.10"):
    """Write groups of channels."""
    with asammdf.MDF(version=version) as file:
        for channels in groups:
            file.append(channels, common_timebase=True)
        file.save(path, overwrite=True)
    return path


@pytest.mark.parametrize(("version", "name"), [("4.10", "run.mf4"), ("4.20", "run.mf4"), ("3.30", "run.mdf")])
def test_values_names_units_and_times_come_back(tmp_path, version, name):
    """The start of the master is kept; values exactly."""
    path = write(tmp_path / name, [signal(f"q_{k}", ROWS[k]) for k in range(3)], version=version)
    (group,) = read_channels(path)
    assert recognise(path).key == "mdf"
    assert [(one.name, one.unit) for one in group.channels] == [("q_0", "mm"), ("q_1", "mm"), ("q_2", "mm")]
    np.testing.assert_allclose(group.time, TIME, rtol=1e-12)
    np.testing.assert_array_equal(group.values([2, 0]), ROWS[[2, 0]])


def test_conversions_are_applied(tmp_path):
    """Whole numbers with a linear conversion, as controllers log them."""
    raw = np.arange(500, dtype=np.int16) - 250
    path = write(tmp_path / "run.mf4", [signal("q_1", raw, conversion={"a": 0.5, "b": 2.0})])
    np.testing.assert_allclose(read_channels(path)[0].values([0])[0], 0.5 * raw + 2.0)


def test_invalid_samples_are_missing(tmp_path):
    """And a missing sample of a coordinate is refused by its name."""
    invalid = np.zeros(500, dtype=bool)
    invalid[40:43] = True
    path = write(tmp_path / "run.mf4", [signal("q_1", ROWS[0], invalidation_bits=invalid), signal("q_2", ROWS[1])])
    (group,) = read_channels(path)
    first, second = group.values([0, 1])
    np.testing.assert_array_equal(np.isnan(first), invalid)
    np.testing.assert_array_equal(second, ROWS[1])
    with pytest.raises(DataError, match=r"sample 41: .* in column 'q_1'"):
        read_coordinates(path, None, None)


def test_groups_of_other_time_bases_are_named(tmp_path):
    """Coordinates in both are refused; a slow group of other channels is left out and told."""
    slow = TIME[::5]
    both = write(tmp_path / "a.mf4", [signal("q_1", ROWS[0])], [signal("q_2", ROWS[1, ::5], time=slow)])
    with pytest.raises(DataError, match="different time bases"):
        read_coordinates(both, None, None)
    one = write(tmp_path / "b.mf4", [signal("q_1", ROWS[0])], [signal("speed", ROWS[1, ::5], time=slow)])
    history = read_coordinates(one, None, None)
    assert history.mode.tolist() == [1]
    assert [warning.code for warning in history.warnings] == ["channels_left_out"]


def test_one_name_in_two_groups_is_read_from_each(tmp_path):
    """The package finds channels by name; here group and place count."""
    slow = TIME[::5]
    path = write(tmp_path / "run.mf4", [signal("load", ROWS[0])], [signal("load", ROWS[1, ::5], time=slow)])
    first, second = read_channels(path)
    np.testing.assert_array_equal(first.values([0])[0], ROWS[0])
    np.testing.assert_array_equal(second.values([0])[0], ROWS[1, ::5])


def test_channels_of_text_are_left_out(tmp_path):
    """Strings, and numbers that a conversion turns into words."""
    words = signal("state", np.array([b"on", b"off"] * 250), unit="", encoding="utf-8")
    gear = signal("gear", np.ones(500, np.uint8), conversion={"val_0": 1, "text_0": b"first", "default": b"none"})
    path = write(tmp_path / "run.mf4", [signal("q_1", ROWS[0]), words, gear])
    assert [one.name for group in read_channels(path) for one in group.channels] == ["q_1"]


def test_a_master_that_is_no_time_is_refused(tmp_path):
    """Distance along the track is no clock."""
    path = tmp_path / "run.mf4"
    with asammdf.MDF(version="4.10") as file:
        file.append([signal("q_1", ROWS[0])], common_timebase=True)
        file.groups[0].channels[file.masters_db[0]].sync_type = 3
        file.save(path, overwrite=True)
    with pytest.raises(DataError, match="is distance, not time"):
        read_coordinates(path, None, None)


@pytest.mark.parametrize("share", [0.02, 0.1, 0.4, 0.8, 0.97])
@pytest.mark.parametrize("version", ["4.10", "3.30"])
def test_a_file_that_is_cut_is_refused_in_one_line(tmp_path, share, version, capfd):
    """Or tells the sample that is missing; without a word of the package on the terminal."""
    name = "run.mf4" if version >= "4" else "run.mdf"
    path = write(tmp_path / name, [signal(f"q_{k}", ROWS[k]) for k in range(3)], version=version)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(DataError) as caught:
        read_coordinates(path, None, None)
    assert len(caught.value.problems) == 1
    assert capfd.readouterr() == ("", "")


def test_elements_of_arrays_are_channels(tmp_path):
    """The package gives the first element for the array itself, which is no channel then."""
    rows = np.rec.fromarrays([ROWS[:, :].T.copy()], dtype=np.dtype([("load", "(3,)<f8")]))
    path = write(tmp_path / "run.mf4", [signal("q_1", ROWS[0]), signal("load", rows)])
    (group,) = read_channels(path)
    assert [one.name for one in group.channels] == ["q_1", "load[0]", "load[1]", "load[2]"]
    np.testing.assert_array_equal(group.values([1, 2, 3]), ROWS)


def test_groups_of_one_name_are_counted(tmp_path):
    """So that each can be asked for."""
    path = write(tmp_path / "run.mf4", [signal("q_1", ROWS[0])], [signal("load", ROWS[1, ::5], time=TIME[::5])])
    assert [group.name for group in read_channels(path)] == ["Python (1)", "Python (2)"]


def test_time_is_taken_beside_another_master(tmp_path):
    """A group may be ordered over time and over distance; the package takes the last of the two."""
    path = tmp_path / "run.mf4"
    with asammdf.MDF(version="4.10") as file:
        file.append([signal("q_1", ROWS[0]), signal("way", 50.0 * TIME, unit="m")], common_timebase=True)
        way = file.groups[0].channels[2]
        way.channel_type, way.sync_type = 2, 3
        file.save(path, overwrite=True)
    (group,) = read_channels(path)
    assert [one.name for one in group.channels] == ["q_1"]
    np.testing.assert_allclose(group.time, TIME, rtol=1e-12)


def test_a_master_in_milliseconds_is_time(tmp_path):
    """Against the standard, and as some write it; a master in degrees is none."""
    for unit, said in (("ms", None), ("deg", "is in deg, which is no unit of time")):
        path = tmp_path / f"{unit}.mf4"
        with asammdf.MDF(version="4.10") as file:
            file.append([signal("q_1", ROWS[0], time=1000 * TIME)], common_timebase=True)
            file.groups[0].channels[0].unit = unit
            file.save(path, overwrite=True)
        (group,) = read_channels(path)
        if said is None:
            np.testing.assert_allclose(group.time, TIME, rtol=1e-12)
        else:
            assert said in group.without_time


def test_raw_frames_of_a_bus_are_refused(tmp_path):
    """With the way to channels."""
    frames = np.zeros(500, dtype=[("CAN_DataFrame.ID", "u4"), ("CAN_DataFrame.DataBytes", "(8,)u1")])
    source = asammdf.Source(name="CAN", path="CAN", comment="", source_type=2, bus_type=2)
    path = tmp_path / "run.mf4"
    with asammdf.MDF(version="4.10") as file:
        file.append([signal("CAN_DataFrame", frames, unit="", source=source)], common_timebase=True)
        file.groups[0].channel_group.flags |= 0x2
        file.save(path, overwrite=True)
    with pytest.raises(DataError, match="frames of a bus"):
        read_channels(path)


def test_a_file_that_was_not_finalised_is_refused(tmp_path):
    """With the way out: its counts are those of the moment at which recording began."""
    path = write(tmp_path / "run.mf4", [signal("q_1", ROWS[0])])
    path.write_bytes(b"UnFinMF " + path.read_bytes()[8:])
    with pytest.raises(DataError, match="not finalised"):
        read_channels(path)


def test_compressed_blocks_are_read(tmp_path):
    """Transposed and deflated."""
    path = write(tmp_path / "run.mf4", [signal("q_1", ROWS[0])])
    with asammdf.MDF(path) as file:
        file.save(tmp_path / "small.mf4", compression=2, overwrite=True)
    np.testing.assert_array_equal(read_channels(tmp_path / "small.mf4")[0].values([0])[0], ROWS[0])
