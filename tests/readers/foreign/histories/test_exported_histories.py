"""Histories with the oddities of one program or one office: units apart, counts of rows, fixed columns, two tables."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_coordinates

ROWS = "0,1,2\n0.1,3,4\n"
MILLISECONDS = "0,1,2\n100,3,4\n"
BLANKS = "0 1 2\n100 3 4\n"


@pytest.fixture
def read(tmp_path):
    """Return a function that reads text as a file of coordinates."""

    def of(text, encoding="utf-8"):
        path = tmp_path / "run.csv"
        path.write_bytes(text.encode(encoding))
        return read_coordinates(path, None, None)

    return of


@pytest.mark.parametrize(
    "content",
    [
        pytest.param("time,q_1,q_2\nms\n" + MILLISECONDS, id="a unit alone below the names"),
        pytest.param("time q_1 q_2\n (ms)  (no units)  (no units)\n" + BLANKS, id="bracketed units at blanks"),
        pytest.param("time,q_1,q_2\nms,1,1\n" + MILLISECONDS, id="a unit one"),
        pytest.param("time [msec.],q_1,q_2\n" + MILLISECONDS, id="a unit with a point"),
        pytest.param("time [ms],q_1 [1],q_2 [1]\n" + MILLISECONDS, id="ones that are no mode numbers"),
        pytest.param("Simulationszeit [ms],q_1,q_2\n" + MILLISECONDS, id="a compound of time"),
        pytest.param("Elapsed time (ms),q_1,q_2\n" + MILLISECONDS, id="time that has elapsed"),
        pytest.param("index,time,q_1,q_2\n0,0,1,2\n1,0.1,3,4\n", id="an index with a name"),
        pytest.param("Unnamed: 0,time,q_1,q_2\n0,0,1,2\n1,0.1,3,4\n", id="an index written twice"),
        pytest.param("No.;time;q_1;q_2\n1;0;1;2\n2;0,1;3;4\n", id="numbers of the rows"),
        pytest.param("# 1,2,3\ntime,q_1,q_2\n" + ROWS, id="columns counted in a comment"),
        pytest.param("Sample rate: 10 Hz,,\ntime,q_1,q_2\n" + ROWS, id="a sentence and separators"),
    ],
)
def test_read_with_the_right_numbers(read, content):
    """Each states the same three columns."""
    history = read(content)
    np.testing.assert_allclose(history.time, [0, 0.1])
    np.testing.assert_array_equal(history.q, [[1, 3], [2, 4]])
    np.testing.assert_array_equal(history.mode, [1, 2])


def test_minus_signs_of_typography(read):
    """U+2212 is a minus sign."""
    np.testing.assert_array_equal(read("time;q_1\n0;\u22121,5\n1;2\n").q, [[-1.5, 2]])


def test_fixed_columns_that_touch(read):
    """A sign that follows an exponent at once begins the next number."""
    text = "".join(f"{t:12.5E}{a:12.5E}{b:12.5E}\n" for t, a, b in ((0, -1, -2), (0.1, -3, -4)))
    history = read("time q_1 q_2\n" + text.replace("E", "D"))
    np.testing.assert_array_equal(history.q, [[-1, -3], [-2, -4]])


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("sep=;\ntime,q_1\n0,1\n1,2\n", "line 1: the file declares sep=;, and its columns are separated by ','"),
        ("Sample rate: 20 Hz,\ntime,q_1\n0,1\n0.1,2\n", "line 1: the header states 20 Hz"),
        ("Delta_X\t0.2\t0.2\ntime\tq_1\tq_2\n0\t1\t2\n0.1\t3\t4\n", "line 1: the header states a step of 0.2 s"),
        ("time,q_1\n" + 9 * "0,1\n" + "time,q_2\n0,1\n1,2\n", "line 11: 'time,q_2' stands among .* another table"),
        ("time,q_1\n" + 9 * "0,1\n" + "ms,-\n0,1\n", "line 11: 'ms,-' stands among the rows of numbers"),
        ("time,q_1\n0,1\n1,2\nms,-\n0,1\n", "line 2: a row of numbers .* among the lines of the header"),
        ("time,q_1\n0,1\n1,2\n#N/A,3\n", "line 4: '#N/A' in time is no number"),
        ("time,q_1\n" + 9 * "0,1\n" + "#DIV/0!,2\n2,3\n", "line 11: '#DIV/0!,2' is no row of numbers"),
        ("time,0,1,2\nq_1,1,2,3\nq_2,1,2,3\n", "line 1: the table lies on its side"),
        ("time,q_1\n0 sec,1\n1 sec,2\n", "line 2: no row of numbers: '0 sec' is a number with a unit"),
        ("time;q_1\n1.000.000;1\n1.000.100;2\n", "line 2: no row of numbers: '1.000.000' has thousands separators"),
        ("time q_1\n 0.000-1.000\n 1.000-2.000\n", "line 2: .* numbers stand without anything between"),
        ("time,run,q_1\n0,a,1\n1,a,2\n", "line 2: no row of numbers: 'a' is no number"),
        ("time,q_1,rest\n0,1,\n1,2,\n", "line 1: 3 names stand above rows of 2 numbers; 'rest' holds nothing"),
    ],
)
def test_refused_as_what_it_is(read, content, message):
    """Contradictions and tables that are none are told with their line."""
    with pytest.raises(DataError, match=message):
        read(content)


def test_a_percentage_is_a_unit(read):
    """A sign that is no letter is kept as the unit, to be compared."""
    assert read("time,q_1 [%]\n0,1\n1,2\n").unit == ("%",)


@pytest.mark.parametrize("key", ["unit", "units", "Unit", "unit_string"])
def test_units_in_the_metadata_of_parquet(tmp_path, key):
    """Each of the usual keys counts."""
    table = pa.table({"time": [0.0, 100.0], "q_1": [1.0, 2.0]})
    kinds = pa.schema([pa.field("time", pa.float64(), metadata={key: "ms"}), pa.field("q_1", pa.float64())])
    pq.write_table(table.cast(kinds), tmp_path / "run.parquet")
    np.testing.assert_allclose(read_coordinates(tmp_path / "run.parquet", None, None).time, [0, 0.1])


def test_parquet_columns_that_a_map_leaves_out(tmp_path):
    """Texts and dates beside the columns of a map are not read; without the map they are refused."""
    path = tmp_path / "run.parquet"
    dates = pa.array([0, 1], pa.timestamp("s"))
    pq.write_table(pa.table({"time": [0.0, 1.0], "q_1": [1.0, 2.0], "run": ["a", "a"], "at": dates}), path)
    np.testing.assert_array_equal(read_coordinates(path, {"q_1": 3}, None).mode, [3])
    with pytest.raises(DataError, match=r"column 'run': a column holds no numbers .* by --columns"):
        read_coordinates(path, {"q_1": 3, "run": 4}, None)
    with pytest.raises(DataError, match="the column holds dates"):
        read_coordinates(path, None, None)


@pytest.mark.parametrize("legend", ["{} = {}\n", "{}: {}\n", "{}   {}\n", "{}\t{}\n"])
@pytest.mark.parametrize("row", ["", "A\tB\tC\n", "A\tB\tC\n(msec)\t( )\t( )\n"])
def test_a_legend_of_letters_names_the_columns(read, legend, row):
    """As Adams and plotting programs write them; a row of the letters below belongs to it."""
    names = ("Time (msec)", ".FLEX_BODY_1_Q.Q7", ".FLEX_BODY_1_Q.Q12")
    head = ".plot_1 : Last_Run\n" + "".join(map(legend.format, "ABC", names)) + "\n" + row
    history = read(head + "0\t1\t2\n10\t3\t4\n20\t5\t6\n")
    assert history.mode.tolist() == [7, 12]
    np.testing.assert_allclose(history.time, [0.0, 0.01, 0.02])


def test_a_legend_of_letters_has_every_column(read):
    """Else it is free text, and the columns are as nameless as before."""
    assert read("A: Time\nB: Q7\n\n0\t1\t2\n1\t3\t4\n").mode.tolist() == [0, 0]


def test_more_columns_than_letters(read):
    """Z is followed by AA."""
    letters = [chr(65 + k) for k in range(26)] + ["AA", "AB"]
    names = ["Time", *(f"Q{k}" for k in range(7, 34))]
    head = "".join(f"{a}: {name}\n" for a, name in zip(letters, names, strict=True))
    rows = "".join("\t".join(str(float(n + k)) for k in range(28)) + "\n" for n in range(3))
    assert read(head + rows).mode.tolist() == list(range(7, 34))


@pytest.mark.parametrize("legend", ["A: Time\nB: Q7\n", "1: Time\n2: Q7\n"])
def test_a_broken_first_row_below_a_legend_is_refused(read, legend):
    """It is no title: the record would begin later than it did."""
    with pytest.raises(DataError, match="line 4"):
        read(legend + "\n0\t12\t3\n1\t4\n2\t5\n3\t6\n")
