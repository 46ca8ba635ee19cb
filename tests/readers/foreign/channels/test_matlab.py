"""MATLAB files of version 4 to 7 as scipy writes them, of version 7.3 as MATLAB lays them out in HDF5."""

import io

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
        ({"t": T, "q": Q[:-1]}, "no_channels", "q has 199 x 3 values, and time 200"),
        ({"q": Q}, "no_time", "q has 200 x 3 values, and there is no time"),
        ({"data": np.column_stack([np.arange(200), Q])}, "no_time", "counts 0, 1, 2: samples or seconds"),
        ({"time": 738000 + T / 86400, "q": Q}, "date_column", "look like date numbers"),
        ({"t": T, "t_unit": "mm", "q": Q}, "time_unit", "'mm' is no unit of time"),
        ({"t": T}, "no_channels", "no array in it is a channel"),
        ({"t": T, "q": np.where(Q[5, 1] == Q, np.nan, Q)}, "not_a_number", "sample 6"),
    ],
)
def test_what_cannot_be_told_is_refused(write, variables, code, said):
    """In one line."""
    problem = refused(write(**variables))
    assert problem.code == code
    assert said in str(problem)


def test_sparse_and_logical_arrays_are_numbers(write):
    """As they are in MATLAB."""
    (group,) = read_channels(write(t=T, q=scipy.sparse.csc_array(Q), door=Q[:, 0] > 0))
    at = [one.name for one in group.channels].index("door")
    np.testing.assert_array_equal(group.values([k for k in range(4) if k != at]), Q.T)
    assert set(group.values([at])[0]) == {0.0, 1.0}


def cell(*contents):
    """A cell array."""
    array = np.empty(len(contents), object)
    array[:] = contents
    return array


def test_the_export_of_simpack(write):
    """A structure of results, elements and channels, each with its values; time is one of them."""
    results = {f"q_{k}": {"values": Q[:, k - 1], "unit": "m"} for k in (1, 2, 3)}
    path = write(timeInt={"time": {"values": T, "unit": "s"}, "flexState": {"car": results}})
    history = read_coordinates(path, None, None)
    np.testing.assert_array_equal(history.time, T)
    np.testing.assert_array_equal(history.q, Q.T)
    assert history.mode.tolist() == [1, 2, 3]
    assert history.unit == ("m", "m", "m")


def test_a_structure_of_several_vectors_is_no_channel(write):
    """Although one of them is called y, as the values of a channel are."""
    (group,) = read_channels(write(car={"time": T, "x": Q[:, 0], "y": Q[:, 1], "z": Q[:, 2]}))
    assert [one.name for one in group.channels] == ["x", "y", "z"]


def test_numbers_of_modes_beside_a_matrix(write):
    """Its columns are these modes, not 1, 2, 3; with names as well."""
    assert read_coordinates(write(t=T, q=Q, modes=np.array([7, 8, 12])), None, None).mode.tolist() == [7, 8, 12]
    names = cell("first bending", "second bending", "torsion")
    history = read_coordinates(write(t=T, q=Q, mode_ids=np.array([7, 8, 12]), names=names), None, None)
    assert history.mode.tolist() == [7, 8, 12]
    assert history.name == ("first bending", "second bending", "torsion")
    assert read_coordinates(write(t=T, modes=Q), None, None).mode.tolist() == [1, 2, 3]


def test_names_for_several_matrices(write):
    """Each begins with its matrix, and the coordinates are told from their rates."""
    path = write(t=T, q=Q, qd=2 * Q, names=cell("q_4", "q_5", "q_6"))
    (group,) = read_channels(path)
    assert {one.name for one in group.channels} == {f"{m} q_{k}" for m in ("q", "qd") for k in (4, 5, 6)}
    own = read_coordinates(write(t=T, q=Q, qd=2 * Q, q_names=cell("q_4", "q_5", "q_6")), None, None)
    assert own.mode.tolist() == [4, 5, 6]
    np.testing.assert_array_equal(own.q, Q.T)


def test_units_and_several_lists_of_names(write):
    """A list of units is none of names; of others the one that is called names, else none can be meant."""
    lists = {"chan_names": cell("q_4", "q_5", "q_6"), "units": cell("mm", "mm", "m"), "about": cell("a", "b", "c")}
    history = read_coordinates(write(t=T, q=Q, **lists), None, None)
    assert history.mode.tolist() == [4, 5, 6]
    assert history.unit == ("mm", "mm", "m")
    assert "'about' or 'notes'" in refused(write(t=T, q=Q, about=cell("a", "b", "c"), notes=cell("d", "e", "f"))).what


def test_names_as_rows_of_characters_and_vectors_in_cells(write):
    """As old scripts keep them."""
    history = read_coordinates(write(t=T, q=Q, names=np.array(["q_4 ", "q_15", "q_6 "])), None, None)
    assert history.mode.tolist() == [4, 15, 6]
    history = read_coordinates(write(t=T, q=cell(*Q.T), names=cell("q_4", "q_15", "q_6")), None, None)
    assert history.mode.tolist() == [4, 15, 6]
    np.testing.assert_array_equal(history.q, Q.T)


def test_times_are_told_apart_by_their_length(write):
    """Each with the arrays as long; what is as long as none is told."""
    groups = {g.name: g for g in read_channels(write(t=T, time_slow=T[::2], t_slow=T[::2], q=Q, v=Q[:99, 0]))}
    assert len(groups) == 1
    groups = {g.name: g for g in read_channels(write(fast_time=T, slow_time=T[::2], q=Q, speed=Q[::2, 0], v=Q[:99, 0]))}
    assert set(groups) == {"fast_time", "slow_time"}
    np.testing.assert_array_equal(groups["slow_time"].time, T[::2])
    assert [one.name for one in groups["slow_time"].channels] == ["speed"]
    (left_out,) = groups["fast_time"].warnings
    assert "v has 99 values" in left_out.what


def test_vectors_stand_in_the_order_of_their_numbers(write):
    """MATLAB saves them by the alphabet; fields of a structure keep the order that they have in MATLAB."""
    path = write(t=T, q_1=Q[:, 0], q_10=Q[:, 1], q_2=Q[:, 2])
    assert read_coordinates(path, None, None).mode.tolist() == [1, 2, 10]
    (group,) = read_channels(write(car={"time": T, "roll": Q[:, 0], "bounce": Q[:, 1]}))
    assert [one.name for one in group.channels] == ["roll", "bounce"]


def test_complex_arrays_that_are_no_channels_do_no_harm(write):
    """Eigenvalues beside the histories."""
    history = read_coordinates(write(t=T, q=Q, eigenvalues=np.array([1j, 2, 3])), None, None)
    assert "eigenvalues has 3 values" in history.warnings[0].what


def test_objects_beside_arrays_are_told(tmp_path):
    """They may be what is missing."""
    pytest.importorskip("h5py", reason="the package h5py is not installed")
    write_matlab_73(tmp_path / "run.mat", t=T, q=Q, names=np.array([1.0, 2.0]), objects={"names": "string"})
    history = read_coordinates(tmp_path / "run.mat", None, None)
    assert "names is an object of the class string" in history.warnings[0].what


def test_two_variables_of_one_name_are_refused(tmp_path):
    """As of a file that something was appended to; scipy takes the last."""
    first, second = io.BytesIO(), io.BytesIO()
    scipy.io.savemat(first, {"t": T, "q": Q})
    scipy.io.savemat(second, {"q": 2 * Q})
    (tmp_path / "run.mat").write_bytes(first.getvalue() + second.getvalue()[128:])
    assert "two variables are called 'q'" in refused(tmp_path / "run.mat").what


def test_any_text_may_begin_a_file(tmp_path):
    """Its version and its byte order stand behind 124 bytes."""
    scipy.io.savemat(tmp_path / "run.mat", {"t": T, "q": Q})
    whole = (tmp_path / "run.mat").read_bytes()
    (tmp_path / "run.mat").write_bytes(b"measured on track 5".ljust(116) + whole[116:])
    assert read_coordinates(tmp_path / "run.mat", None, None).mode.tolist() == [1, 2, 3]


def test_version_4_of_the_other_end(tmp_path):
    """As UNIX stations wrote it."""
    blocks = []
    for name, array in (("t", T[:, None]), ("q", Q)):
        head = np.array([1000, *array.shape, 0, len(name) + 1], ">i4").tobytes()
        blocks.append(head + name.encode() + b"\0" + array.T.astype(">f8").tobytes())
    (tmp_path / "run.mat").write_bytes(b"".join(blocks))
    np.testing.assert_array_equal(read_coordinates(tmp_path / "run.mat", None, None).q, Q.T)


def test_what_takes_no_room_in_the_file_takes_none_in_memory(tmp_path):
    """A sparse matrix of a single value, and an array of 7.3 that was never written."""
    h5py = pytest.importorskip("h5py", reason="the package h5py is not installed")
    single = scipy.sparse.csc_array((np.ones(1), ([5], [7])), shape=(10**7, 10**6))
    scipy.io.savemat(tmp_path / "run.mat", {"t": T, "k": single})
    assert "k is a sparse matrix, too large" in refused(tmp_path / "run.mat").what
    write_matlab_73(tmp_path / "new.mat", t=T)
    with h5py.File(tmp_path / "new.mat", "r+") as file:
        file.create_dataset("q", (10**7, 10**6), "f8", chunks=(1000, 1000), compression="gzip")
    assert "promises 10000000000000 values" in refused(tmp_path / "new.mat").what


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
