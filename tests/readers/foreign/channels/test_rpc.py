"""RPC III time histories, written as their description has them, in whole numbers and floating point ones."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_channels, read_coordinates, recognise
from tests.readers.foreign.channels.rpc_writer import write_rpc

VALUES = np.random.default_rng(3).standard_normal((3, 300)) * np.array([[1.0], [50.0], [1e-3]])


def refused(path):
    """The refusal of a file."""
    with pytest.raises(DataError) as caught:
        read_channels(path)
    return caught.value.problems[0]


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(("kind", "close"), [("i2", 0.5 / 32752), ("f4", 1e-7)])
@pytest.mark.parametrize(("frame", "per_group"), [(64, 2), (64, 3), (300, 1), (512, 1)])
def test_values_come_back(tmp_path, order, kind, close, frame, per_group):
    """To half a step of the whole numbers, or to single precision; the last group is filled up."""
    path = tmp_path / "run.rsp"
    stored = write_rpc(path, VALUES, order=order, kind=kind, frame=frame, per_group=per_group)
    (group,) = read_channels(path)
    assert [one.name for one in group.channels] == ["q_1", "q_2", "q_3"]
    assert {one.unit for one in group.channels} == {"mm"}
    np.testing.assert_allclose(group.time, 0.01 * np.arange(group.samples), rtol=1e-12)
    np.testing.assert_allclose(group.values([0, 1, 2]), stored, rtol=1e-12)
    largest = np.abs(VALUES).max(axis=1, keepdims=True)
    assert (np.abs(group.values([0, 1, 2])[:, :300] - VALUES) <= 1.001 * close * largest).all()
    np.testing.assert_array_equal(group.values([2, 0]), group.values([0, 1, 2])[[2, 0]])


def test_a_stated_number_of_samples_ends_the_last_frame(tmp_path):
    """Where a program writes it; else the filling of the last frame cannot be told from samples."""
    path = tmp_path / "run.rsp"
    write_rpc(path, VALUES, SAMPLES=300)
    assert read_channels(path)[0].samples == 300
    write_rpc(path, VALUES)
    assert read_channels(path)[0].samples == 320


def test_a_last_group_that_is_not_filled_up_is_read(tmp_path):
    """Some programs end the file behind the last frame of each channel."""
    path = tmp_path / "run.rsp"
    write_rpc(path, VALUES, frame=50, per_group=4, kind="f4")
    whole = path.read_bytes()
    head = len(whole) - 4 * 3 * 400
    blocks = np.frombuffer(whole[head:], "<f4").reshape(2, 3, 200)
    path.write_bytes(whole[:head] + blocks[0].tobytes() + blocks[1, :, :100].tobytes())
    np.testing.assert_allclose(read_channels(path)[0].values([0, 1, 2]), VALUES, rtol=1e-6)


def test_an_independent_reader_agrees_on_one_frame_a_group(tmp_path):
    """The package rpc-reader, whose whole numbers are of 32768 parts."""
    package = pytest.importorskip("rpc_reader.rpc_reader", reason="the package rpc-reader is not installed")
    path = tmp_path / "run.rsp"
    write_rpc(path, VALUES, frame=100, per_group=1)
    other = package.ReadRPC(path)
    other.import_rpc_data_from_file()
    ours = read_channels(path)[0].values([0, 1, 2])
    np.testing.assert_allclose(other.get_data().T * 32768 / 32752, ours, rtol=1e-12)


def test_modal_coordinates_are_found_among_the_channels(tmp_path):
    """By the numbers in their names, with their unit."""
    path = tmp_path / "run.rsp"
    write_rpc(path, VALUES, names=["speed", "q_12", "q_7"], units=["km/h", "mm", "mm"], kind="f4")
    history = read_coordinates(path, None, None)
    assert history.mode.tolist() == [12, 7]
    assert history.unit == ("mm", "mm")
    assert recognise(path).key == "rpc"


@pytest.mark.parametrize(
    ("keys", "code", "said"),
    [
        ({"FILE_TYPE": "HISTOGRAM"}, "no_channels", "the file holds histogram, no time history"),
        ({"FORMAT": "ASCII"}, "rpc_header", "FORMAT is ASCII"),
        ({"DATA_TYPE": "COMPLEX"}, "rpc_header", "DATA_TYPE is COMPLEX"),
        ({"CHANNELS": None}, "rpc_header", "CHANNELS is missing"),
        ({"CHANNELS": "3.5"}, "rpc_header", "CHANNELS is '3.5'"),
        ({"CHANNELS": 99999999}, "cut", "99999999 channels"),
        ({"FRAMES": 0}, "rpc_header", "no frames"),
        ({"FRAMES": 10**9}, "cut", "take"),
        ({"PTS_PER_GROUP": 100}, "rpc_header", "no whole number of frames"),
        ({"DELTA_T": "0"}, "rpc_header", "DELTA_T is 0"),
        ({"DELTA_T": "nan"}, "rpc_header", "DELTA_T is 'nan'"),
        ({"SCALE.CHAN_2": "wide"}, "rpc_header", "SCALE.CHAN_2 is 'wide'"),
        ({"SCALE.CHAN_2": None}, "rpc_header", "SCALE.CHAN_2 is missing"),
        ({"NUM_HEADER_BLOCKS": 9999}, "cut", "9999 blocks"),
    ],
)
def test_a_header_that_makes_no_sense_is_refused(tmp_path, keys, code, said):
    """With the key and its value."""
    path = tmp_path / "run.rsp"
    write_rpc(path, VALUES, **keys)
    problem = refused(path)
    assert problem.code == code
    assert said in problem.what


@pytest.mark.parametrize("share", [0.3, 0.6, 0.999])
def test_a_file_that_is_cut_is_refused(tmp_path, share):
    """In the header or in the samples, with the bytes that are there and those that were promised."""
    path = tmp_path / "run.rsp"
    write_rpc(path, VALUES)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    assert refused(path).code in ("cut", "rpc_header")


@pytest.mark.parametrize(("kind", "frame", "per_group"), [("i2", 64, 2), ("f4", 64, 5), ("i2", 512, 1)])
def test_a_last_frame_that_seems_to_be_filled_up_is_told(tmp_path, kind, frame, per_group):
    """Zeros behind a record that hangs at -16 under gravity would be its largest cycle."""
    path = tmp_path / "run.rsp"
    stored = write_rpc(path, VALUES - 16.0, kind=kind, frame=frame, per_group=per_group)
    (group,) = read_channels(path)
    (warning,) = group.warnings
    assert warning.code == "filled_up"
    assert f"the last {stored.shape[1] - 300} samples, from 3 s on, are 0" in warning.what
    assert group.samples == stored.shape[1]


def test_a_last_frame_filled_with_its_last_values_is_told(tmp_path):
    """As other programs do; a record that ends with a whole frame is not."""
    path = tmp_path / "run.rsp"
    held = np.concatenate([VALUES, np.repeat(VALUES[:, -1:], 20, axis=1)], axis=1)
    write_rpc(path, held)
    assert "the last 20 samples, from 3 s on, are those before them" in read_channels(path)[0].warnings[0].what
    write_rpc(path, VALUES, frame=50)
    assert read_channels(path)[0].warnings == ()
    write_rpc(path, VALUES, SAMPLES=300)
    assert read_channels(path)[0].warnings == ()


def test_channels_without_a_description_are_no_modes(tmp_path):
    """Their positions are listed as names; a mode they name only where they are joined in order."""
    path = tmp_path / "run.rsp"
    write_rpc(path, VALUES, names=["", "", ""])
    assert [one.name for one in read_channels(path)[0].channels] == ["channel 1", "channel 2", "channel 3"]
    history = read_coordinates(path, None, None)
    assert history.mode.tolist() == [0, 0, 0]
    np.testing.assert_array_equal(history.q, read_channels(path)[0].values([0, 1, 2]))


def test_a_number_that_is_none_is_refused_by_its_place(tmp_path):
    """A signalling one, as a flipped bit makes it, without a warning of numpy."""
    path = tmp_path / "run.rsp"
    write_rpc(path, VALUES, kind="f4", frame=100, per_group=3)
    whole = bytearray(path.read_bytes())
    at = len(whole) - 4 * 300 + 4 * 7  # sample 8 of the third channel
    whole[at : at + 4] = b"\x01\x00\x80\x7f"
    path.write_bytes(whole)
    with pytest.raises(DataError, match=r"sample 8: .* in column 'q_3'"):
        read_coordinates(path, None, None)
