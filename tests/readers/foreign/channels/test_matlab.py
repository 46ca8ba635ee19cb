"""MATLAB files of version 4 to 7 as scipy writes them, of version 7.3 as MATLAB lays them out in HDF5."""

import numpy as np
import pytest
import scipy.io
import scipy.sparse

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_channels, read_coordinates, recognise
from tests.readers.foreign.channels.matlab_73_writer import write_matlab_73

T = 1.0 + 0.01 * np.arange(200)
Q = np.random.default_rng(4).standard_normal((200, 3))
WRITERS = {
    "v5": lambda path, **variables: scipy.io.savemat(path, variables),
    "v5 compressed": lambda path, **variables: scipy.io.savemat(path, variables, do_compression=True),
    "v7.3": write_matlab_73,
}


@pytest.fixture(params=WRITERS)
def write(request, tmp_path):
    """Write variables and return the file."""
    if request.param == "v7.3":
        pytest.importorskip("h5py", reason="the package h5py is not installed")

    def written(**variables):
        WRITERS[request.param](tmp_path / "run.mat", **variables)
        return tmp_path / "run.mat"

    return written


def refused(path):
    """The refusal of a file of coordinates."""
    with pytest.raises(DataError) as caught:
        read_coordinates(path, None, None)
    return caught.value.problems[0]


@pytest.mark.parametrize("q", [Q, Q.T], ids=["in columns", "in rows"])
@pytest.mark.parametrize("t", [T, T[:, None], T[None]], ids=["flat", "column", "row"])
def test_a_vector_of_time_and_a_matrix(write, t, q):
    """The side that is as long as time is time; channels are counted from 1."""
    path = write(t=t, q=q)
    history = read_coordinates(path, None, None)
    assert recognise(path).key in ("mat", "mat73")
    assert history.mode.tolist() == [1, 2, 3]
    np.testing.assert_array_equal(history.time, T)
    np.testing.assert_array_equal(history.q, Q.T)


def test_vectors_beside_time(write):
    """Each by its own name, whole numbers and single precision alike; other lengths stay behind."""
    path = write(time_s=T, q_7=Q[:, 0].astype(np.float32), q_9=np.arange(200, dtype=np.int16), other=np.ones(7))
    history = read_coordinates(path, None, None)
    assert history.mode.tolist() == [7, 9]
    np.testing.assert_array_equal(history.q[1], np.arange(200))


def test_a_list_of_names_beside_a_matrix(write):
    """As many names as channels, in a cell array."""
    path = write(time=T, q=Q, labels=np.array(["q_12", "q_7", "q_9"], dtype=object))
    assert read_coordinates(path, None, None).mode.tolist() == [12, 7, 9]


def test_structures_are_groups(write):
    """Each on its own time; a structure without time is on that around it."""
    path = write(flex={"time": T, "q": Q}, track={"time": T[::4], "speed": np.ones(50)}, t=T, car={"a": np.ones(200)})
    groups = {group.name: group for group in read_channels(path)}
    assert [one.name for one in groups["flex"].channels] == ["q(1)", "q(2)", "q(3)"]
    np.testing.assert_array_equal(groups["track"].time, T[::4])
    np.testing.assert_array_equal(groups["car"].time, T)
    assert read_coordinates(path, None, None).mode.tolist() == [1, 2, 3]


def test_a_structure_of_values_name_and_unit_is_a_channel(write):
    """As post-processors export them."""
    channels = {f"c{k}": {"values": Q[:, k], "unit": "mm", "name": f"q_{k + 4}"} for k in range(3)}
    history = read_coordinates(write(time=T, **channels), None, None)
    assert history.mode.tolist() == [4, 5, 6]
    assert history.unit == ("mm",) * 3


def test_the_structure_with_time_of_simulink(write):
    """Signals with values and a label; several columns of one are counted."""
    signals = [{"values": Q[:, :2], "label": "q"}, {"values": Q[:, 2:], "label": "speed"}]
    path = write(out={"time": T, "signals": np.array(signals, dtype=object), "blockName": "model/scope"})
    (group,) = read_channels(path)
    assert [one.name for one in group.channels] == ["q(1)", "q(2)", "speed"]
    np.testing.assert_array_equal(group.values([0, 1, 2]), Q.T)


def test_time_in_ms_is_turned_into_seconds(write):
    """By its name; coordinates are never."""
    assert read_coordinates(write(t_ms=1e3 * T, q=Q), None, None).time[0] == pytest.approx(1.0)


def test_the_first_column_is_time_if_it_rises_evenly(write):
    """In a matrix alone; else the file has no time and is refused."""
    history = read_coordinates(write(data=np.column_stack([T, Q])), None, None)
    np.testing.assert_array_equal(history.time, T)
    np.testing.assert_array_equal(history.q, Q.T)
    assert refused(write(data=Q)).code in ("no_time", "no_channels")


@pytest.mark.parametrize(
    ("variables", "code", "said"),
    [
        ({"t": T, "q": np.ones((200, 200))}, "ambiguous", "200 rows and 200 columns"),
        ({"t": T, "q": Q + 1j}, "complex", "complex"),
        ({"t": T, "time": 2 * T, "q": Q}, "several_times", "is time, too, as long, and differs"),
        ({"t": T}, "no_channels", "no array in it is a channel"),
        ({"t": T, "q": np.where(Q[5, 1] == Q, np.nan, Q)}, "not_a_number", "sample 6"),
    ],
)
def test_what_cannot_be_told_is_refused(write, variables, code, said):
    """In one line."""
    problem = refused(write(**variables))
    assert problem.code == code
    assert said in str(problem)


def test_sparse_and_logical_arrays_are_numbers(tmp_path):
    """As they are in MATLAB."""
    scipy.io.savemat(tmp_path / "run.mat", {"t": T, "q": scipy.sparse.csc_array(Q), "door": Q[:, 0] > 0})
    (group,) = read_channels(tmp_path / "run.mat")
    np.testing.assert_array_equal(group.values([0, 1, 2, 3])[:3], Q.T)
    assert set(group.values([3])[0]) == {0.0, 1.0}


def test_version_4_is_read(tmp_path):
    """Arrays alone, of double precision."""
    scipy.io.savemat(tmp_path / "run.mat", {"t": T, "q": Q}, format="4")
    np.testing.assert_array_equal(read_coordinates(tmp_path / "run.mat", None, None).q, Q.T)


def test_objects_are_told_with_the_way_out(tmp_path):
    """A timeseries is an object that MATLAB alone can read."""
    pytest.importorskip("h5py", reason="the package h5py is not installed")
    write_matlab_73(tmp_path / "run.mat", ts=Q, objects={"ts": "timeseries"})
    with pytest.raises(DataError, match=r"ts is an object of the class timeseries.*x\.Time"):
        read_channels(tmp_path / "run.mat")


@pytest.mark.parametrize("share", [0.05, 0.3, 0.7, 0.99])
def test_a_file_that_is_cut_is_refused(write, share):
    """Without a traceback of the package."""
    path = write(t=T, q=Q)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    assert refused(path).code in ("mat_damaged", "no_channels", "no_time", "foreign_format", "unknown_binary")
