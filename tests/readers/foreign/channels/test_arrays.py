"""NumPy files: archives of named arrays, structured arrays and matrices."""

import io
import zipfile

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_channels, read_coordinates, recognise

T = 0.01 * np.arange(120)
Q = np.random.default_rng(4).standard_normal((120, 3))


def refused(path):
    """The refusal of a file."""
    with pytest.raises(DataError) as caught:
        read_coordinates(path, None, None)
    return caught.value.problems[0]


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_named_arrays(tmp_path, save):
    """A vector of time and a matrix, names in a list of texts."""
    save(tmp_path / "run.npz", time=T, q=Q, names=np.array(["q_4", "q_9", "q_2"]))
    history = read_coordinates(tmp_path / "run.npz", None, None)
    assert recognise(tmp_path / "run.npz").key == "npz"
    assert history.mode.tolist() == [4, 9, 2]
    np.testing.assert_array_equal(history.q, Q.T)


def test_a_structured_array(tmp_path):
    """Its fields are channels."""
    table = np.zeros(120, [("time", "f8"), ("q_1", "f4"), ("q_2", ">i4")])
    table["time"], table["q_1"], table["q_2"] = T, Q[:, 0], np.arange(120)
    np.save(tmp_path / "run.npy", table)
    history = read_coordinates(tmp_path / "run.npy", None, None)
    assert recognise(tmp_path / "run.npy").key == "npy"
    np.testing.assert_array_equal(history.q, [Q[:, 0].astype(np.float32), np.arange(120)])


@pytest.mark.parametrize("order", ["C", "F"])
def test_a_matrix_whose_first_column_is_time(tmp_path, order):
    """The others are counted from 1; without time it is refused."""
    np.save(tmp_path / "run.npy", np.asarray(np.column_stack([T, Q]), order=order))
    history = read_coordinates(tmp_path / "run.npy", None, None)
    assert history.mode.tolist() == [1, 2, 3]
    np.testing.assert_array_equal(history.time, T)
    np.save(tmp_path / "run.npy", Q)
    assert refused(tmp_path / "run.npy").code in ("no_time", "no_channels")


def test_pickled_objects_are_never_read(tmp_path):
    """They could do anything."""
    np.save(tmp_path / "run.npy", np.array([T, "q"], dtype=object), allow_pickle=True)
    assert refused(tmp_path / "run.npy").code == "pickled"


def test_objects_in_an_archive_are_told(tmp_path):
    """They are not read, and what stands beside them is."""
    np.savez(tmp_path / "run.npz", t=T, q=Q, meta=np.array({"speed": 350}, dtype=object))
    history = read_coordinates(tmp_path / "run.npz", None, None)
    assert "meta is a pickled object" in history.warnings[0].what
    assert "np.savez" in history.warnings[0].remedy


def test_a_structured_array_in_an_archive_is_a_group(tmp_path):
    """Its fields hide no other array of their name."""
    table = np.zeros(60, [("t", "f8"), ("speed", "f8")])
    table["t"] = T[::2]
    np.savez(tmp_path / "run.npz", t=T, q=Q, track=table)
    groups = {group.name: group for group in read_channels(tmp_path / "run.npz")}
    np.testing.assert_array_equal(groups["track"].time, T[::2])
    np.testing.assert_array_equal(groups[""].time, T)


def test_other_files_in_an_archive_and_arrays_twice(tmp_path):
    """A text beside the arrays does no harm; an array twice is refused."""
    np.savez(tmp_path / "run.npz", t=T, q=Q)
    with zipfile.ZipFile(tmp_path / "run.npz", "a") as archive:
        archive.writestr("README.txt", "run 7")
    assert read_coordinates(tmp_path / "run.npz", None, None).mode.tolist() == [1, 2, 3]
    data = io.BytesIO()
    np.save(data, Q)
    with zipfile.ZipFile(tmp_path / "run.npz", "a") as archive, pytest.warns(UserWarning, match="Duplicate"):
        archive.writestr("q.npy", data.getvalue())
    assert refused(tmp_path / "run.npz").what == "two arrays are called 'q'"


def test_a_header_cannot_take_all_memory(tmp_path):
    """What it promises is compared with what is there, in an archive as well."""
    data = io.BytesIO()
    np.lib.format.write_array_header_1_0(data, {"descr": "<f8", "fortran_order": False, "shape": (10**12,)})
    (tmp_path / "run.npy").write_bytes(data.getvalue() + bytes(80))
    assert "promises 1000000000000 values" in refused(tmp_path / "run.npy").what
    with zipfile.ZipFile(tmp_path / "run.npz", "w") as archive:
        archive.writestr("q.npy", data.getvalue() + bytes(80))
    assert "array 'q'" in refused(tmp_path / "run.npz").where


@pytest.mark.parametrize("name", ["run.npy", "run.npz"])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.95])
def test_a_file_that_is_cut_is_refused(tmp_path, name, share):
    """In one line."""
    table = np.column_stack([T, Q])
    (np.save if name.endswith("npy") else np.savez)(tmp_path / name, table)
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[: int(share * len(whole))])
    assert refused(tmp_path / name).code in ("cut", "npy_damaged", "foreign_format", "no_channels")


def test_other_time_bases_are_other_groups(tmp_path):
    """Vectors that are not as long as time are no channels beside it."""
    np.savez(tmp_path / "run.npz", time=T, q_1=Q[:, 0], speed=np.ones(7))
    (group,) = read_channels(tmp_path / "run.npz")
    assert [one.name for one in group.channels] == ["q_1"]
