"""Universal files of data sets 58, written by the package that reads them, and one as its description has it."""

import gc
import warnings

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_channels, read_coordinates, recognise

pyuff = pytest.importorskip("pyuff", reason="the package pyuff is not installed")

ROWS = np.random.default_rng(9).standard_normal((3, 256))


def data_set(name, samples, **more):
    """One data set 58 of a time history."""
    return {
        "type": 58,
        "func_type": 1,
        "rsp_node": 4,
        "rsp_dir": 3,
        "ref_node": 0,
        "ref_dir": 0,
        "rsp_ent_name": "NONE",
        "ref_ent_name": "NONE",
        "data": samples,
        "x": 2.0 + 0.0078125 * np.arange(samples.size),
        "id1": name,
        "id2": "NONE",
        "id3": "01-Dec-26 10:00:00",
        "id4": "NONE",
        "id5": "NONE",
        "func_id": 0,
        "ver_num": 0,
        "load_case_id": 0,
        "ord_data_type": 4,
        "abscissa_spacing": 1,
        "abscissa_min": 2.0,
        "abscissa_inc": 0.0078125,
        "z_axis_value": 0,
        "abscissa_spec_data_type": 17,
        "abscissa_axis_lab": "Time",
        "abscissa_axis_units_lab": "s",
        "ordinate_spec_data_type": 8,
        "ordinate_axis_lab": "Displacement",
        "ordinate_axis_units_lab": "mm",
        "orddenom_spec_data_type": 0,
        "z_axis_spec_data_type": 0,
        "binary": 0,
    } | more


def write(path, sets):
    """Write data sets."""
    path.unlink(missing_ok=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the package leaves a file open behind binary sets
        pyuff.UFF(str(path)).write_sets(list(sets), mode="add")
        gc.collect()
    return path


@pytest.mark.parametrize("binary", [0, 1])
def test_values_names_units_and_times_come_back(tmp_path, binary):
    """The start is kept; values to the digits that text has, exactly in binary."""
    path = write(tmp_path / "run.uff", [data_set(f"q_{k}", ROWS[k], binary=binary) for k in range(3)])
    assert recognise(path).key == "universal"
    (group,) = read_channels(path)
    assert [(one.name, one.unit) for one in group.channels] == [("q_0", "mm"), ("q_1", "mm"), ("q_2", "mm")]
    np.testing.assert_allclose(group.time, 2.0 + 0.0078125 * np.arange(256), rtol=1e-12)
    np.testing.assert_allclose(group.values([2, 0]), ROWS[[2, 0]], rtol=0 if binary else 1e-11)


def test_instants_of_their_own_are_kept(tmp_path):
    """An uneven abscissa stands beside the values."""
    x = np.cumsum(np.random.default_rng(1).uniform(0.001, 0.002, 256))
    path = write(tmp_path / "run.uff", [data_set("q_1", ROWS[0], abscissa_spacing=0, x=x)])
    np.testing.assert_allclose(read_channels(path)[0].time, x, rtol=1e-4)


def test_names_are_the_line_by_which_sets_differ(tmp_path):
    """Test name first, channel second; without any, the node and its direction."""
    sets = [data_set("run 7", ROWS[k], id2=f"q_{k}") for k in range(2)]
    assert [one.name for one in read_channels(write(tmp_path / "a.uff", sets))[0].channels] == ["q_0", "q_1"]
    sets = [data_set("run 7", ROWS[k], rsp_node=5 + k, rsp_dir=-3) for k in range(2)]
    assert [one.name for one in read_channels(write(tmp_path / "b.uff", sets))[0].channels] == [
        "node 5 -z",
        "node 6 -z",
    ]


def test_other_starts_are_other_groups(tmp_path):
    """And are refused as coordinates of one event."""
    sets = [data_set("q_1", ROWS[0]), data_set("q_2", ROWS[1], abscissa_min=2.5, x=2.5 + 0.0078125 * np.arange(256))]
    path = write(tmp_path / "run.uff", sets)
    assert [group.time[0] for group in read_channels(path)] == [2.0, 2.5]
    with pytest.raises(DataError, match="different time bases"):
        read_coordinates(path, None, None)


def test_milliseconds_are_seconds(tmp_path):
    """By the label of the abscissa; a label that is no time is refused."""
    path = write(tmp_path / "a.uff", [data_set("q_1", ROWS[0], abscissa_axis_units_lab="ms")])
    assert read_channels(path)[0].time[0] == pytest.approx(0.002)
    with pytest.raises(DataError, match="'furlong', which is no unit of time"):
        read_channels(write(tmp_path / "b.uff", [data_set("q_1", ROWS[0], abscissa_axis_units_lab="furlong")]))


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"func_type": 4}, "it holds frequency response functions, no time history"),
        ({"func_type": 2}, "it holds auto spectra"),
        ({"abscissa_spec_data_type": 18}, "its abscissa is no time"),
    ],
)
def test_what_is_no_time_history_is_refused(tmp_path, more, said):
    """By the name of what it is."""
    with pytest.raises(DataError, match=said):
        read_channels(write(tmp_path / "run.uff", [data_set("q_1", ROWS[0], **more)]))


def test_a_file_without_histories_is_refused(tmp_path):
    """A mesh alone, say."""
    path = tmp_path / "mesh.unv"
    path.write_text("    -1\n  2411\n         1         1         1        11\n" + "0.0 0.0 0.0\n" + "    -1\n")
    with pytest.raises(DataError, match="no data set 58"):
        read_channels(path)


@pytest.mark.parametrize("share", [0.05, 0.3, 0.6, 0.95])
@pytest.mark.parametrize("binary", [0, 1])
def test_a_file_that_is_cut_is_refused_or_told(tmp_path, share, binary, capfd):
    """Never fewer samples than the header promises, and no word of the package on the terminal."""
    path = write(tmp_path / "run.uff", [data_set("q_1", ROWS[0], binary=binary)])
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(DataError) as caught:
        read_coordinates(path, None, None)
    assert caught.value.problems[0].code in ("cut", "uff_damaged", "no_channels")
    assert capfd.readouterr() == ("", "")


def test_the_line_that_calls_all_q_names_them(tmp_path):
    """Numbers of records are no modes, though they differ first."""
    sets = [data_set(f"Record {k + 1}", ROWS[k], id2=f"q_{k + 7}") for k in range(3)]
    assert read_coordinates(write(tmp_path / "run.uff", sets), None, None).mode.tolist() == [7, 8, 9]


def test_spectra_beside_histories_are_left_out_and_told(tmp_path):
    """Modal tests keep both in one file."""
    path = write(tmp_path / "run.uff", [data_set("q_1", ROWS[0]), data_set("H11", ROWS[1], func_type=4)])
    history = read_coordinates(path, None, None)
    assert history.mode.tolist() == [1]
    (warning,) = history.warnings
    assert warning.code == "channels_left_out"
    assert "'H11': it holds frequency response functions" in warning.what


def test_complex_values_and_functions_over_nothing_are_refused(tmp_path):
    """A general function has to say that it is over time."""
    both = ROWS[0] + 1j * ROWS[1]
    with pytest.raises(DataError, match="complex"):
        read_channels(write(tmp_path / "a.uff", [data_set("q_1", both, ord_data_type=6)]))
    bare = {"func_type": 0, "abscissa_spec_data_type": 0, "abscissa_axis_lab": "NONE"}
    path = write(tmp_path / "b.uff", [data_set("q_1", ROWS[0], abscissa_axis_units_lab="NONE", **bare)])
    with pytest.raises(DataError, match="nothing says that its abscissa is time"):
        read_channels(path)
    assert read_channels(write(tmp_path / "c.uff", [data_set("q_1", ROWS[0], **bare)]))[0].time[0] == 2.0


@pytest.mark.parametrize("order", [1, 2])
def test_numbers_of_other_machines_are_refused(tmp_path, order):
    """Both byte orders are read; DEC and IBM numbers would be taken for IEEE ones without a word."""
    path = write(tmp_path / "run.uff", [data_set("q_1", ROWS[0], binary=1, byte_ordering=order)])
    np.testing.assert_array_equal(read_channels(path)[0].values([0])[0], ROWS[0])
    whole = path.read_bytes()
    at = whole.index(b"    58b") + 13
    path.write_bytes(whole[:at] + b"     1" + whole[at + 6 :])
    with pytest.raises(DataError, match="floating point format 1"):
        read_channels(path)


def test_displacements_without_label_are_in_the_length_of_the_file(tmp_path):
    """Data set 164: so many in a metre. A label counts more, and other values have none of it."""
    units = {
        "type": 164,
        "units_code": 5,
        "units_description": "mm (milli-newton)",
        "temp_mode": 1,
        "length": 1000.0,
        "force": 1000.0,
        "temp": 1.0,
        "temp_offset": 273.15,
    }
    bare = {"ordinate_axis_units_lab": "NONE"}
    sets = [data_set("q_1", ROWS[0], **bare), data_set("q_2", ROWS[1], ordinate_axis_units_lab="m")]
    sets.append(data_set("q_3", ROWS[2], ordinate_spec_data_type=0, **bare))
    (group,) = read_channels(write(tmp_path / "run.uff", [units, *sets]))
    assert [one.unit for one in group.channels] == ["mm", "m", ""]


def test_windows_line_ends_are_read(tmp_path):
    """And the line end that some write between binary values and the mark of the end."""
    path = write(tmp_path / "run.uff", [data_set("q_1", ROWS[0])])
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    np.testing.assert_allclose(read_channels(path)[0].values([0])[0], ROWS[0], rtol=1e-11)
    path = write(tmp_path / "binary.uff", [data_set("q_1", ROWS[0], binary=1)])
    whole = path.read_bytes()
    path.write_bytes(whole[: whole.rindex(b"    -1")] + b"\r\n    -1\r\n")
    np.testing.assert_array_equal(read_channels(path)[0].values([0])[0], ROWS[0])
