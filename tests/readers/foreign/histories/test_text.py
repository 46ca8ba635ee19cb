"""Histories as simulation, measurement and office programs write them, and what is said about everything else."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_coordinates
from fatigue.readers.units.channel_names import channel

CATMAN = """\
catman ASCII
Channels: 3
Separator: 9

Time  1 - default sample rate [s]\tq_1 [m]\tq_2 [m]
0,000\t1,0\t2,0
0,100\t3,0\t4,0
"""
DEWESOFT = """\
Data start: 29.11.2024 10:00:00
Sample rate: 10 Hz

Time (s)\tq_1 (m)\tq_2 (m)
0,000\t1,0\t2,0
0,100\t3,0\t4,0
"""
UTF16 = "time\tq_1\tq_2\r\n0\t1\t2\r\n0,1\t3\t4\r\n"
LABVIEW = """\
LabVIEW Measurement\t
Writer_Version\t2
Separator\tTab
Decimal_Separator\t,
Multi_Headings\tNo
X_Columns\tOne
Time_Pref\tRelative
Date\t2024/11/29
Time\t10:00:00,1
***End_of_Header***\t

Channels\t2\t\t
Samples\t2\t2\t
Y_Unit_Label\tm\tm\t
X_Dimension\tTime\tTime\t
X0\t0,0000000000000000E+0\t0,0E+0\t
Delta_X\t0,100000\t0,100000\t
***End_of_Header***\t\t\t
X_Value\tq_1\tq_2\tComment
0,000000\t1,000000\t2,000000
0,100000\t3,000000\t4,000000
"""
ADAMS_TABLE = """
 TIME\t .MODEL_1.FLEX_BODY_1.Q1\t .MODEL_1.FLEX_BODY_1.Q2
 0.0\t 1.0\t 2.0
 1.0E-01\t 3.0\t 4.0
"""
ADAMS_REQUEST = """\
A.MODEL_1.Last_Run

  Time        q_1         q_2
 (sec)        (mm)        (mm)
 0.000000E+00  1.0E+00  2.0
 1.000000E-01  3.0 4.0
"""
SIMPACK = """\
# SIMPACK 2023 result export
# Model: car
# time [s]\t$S_Body.q(1) [m]\t$S_Body.q(2) [m]
0\t1\t2
0.1\t3\t4
"""
SAME = {
    "milliseconds": "Time [ms],q_1,q_2\n0,1,2\n100,3,4\n",
    "in parentheses": "time (ms);q_1;q_2\n0;1;2\n100;3;4\n",
    "after a stroke": "Time/ms\tq_1\tq_2\n0\t1\t2\n100\t3\t4\n",
    "after a comma": '"t, ms",q_1,q_2\n0,1,2\n100,3,4\n',
    "unit row": "Time,q_1,q_2\nms,-,-\n0,1,2\n100,3,4\n",
    "unit row2": "Time,q_1,q_2\n[ms],[m],[m]\n0,1,2\n100,3,4\n",
    "unit row blanks": "Time q_1 q_2\n(ms) (-) (-)\n0 1 2\n100 3 4\n",
    "microseconds": "t[us] q_1 q_2\n0 1 2\n100000 3 4\n",
    "time_s last": "q_1,q_2,time_s\n1,2,0\n3,4,0.1\n",
    "time_ms last": "q_1,q_2,time_ms\n1,2,0\n3,4,100\n",
    "repeated time": "Time;q_1;Time;q_2\n0;1;0;2\n0,1;3;0,1;4\n",
    "repeated time num": "time_1;q_1;time_2;q_2\n0;1;0;2\n0,1;3;0,1;4\n",
    "label rows": "Mode;1;2\nFrequency [Hz];10,5;12,5\ntime;q;q\n0;1;2\n0,1;3;4\n",
    "int first then comma": "time;q_1;q_2\n0;1;2\n0,1;3;4\n",
    "int first blanks": "time q_1 q_2\n0 1 2\n0,1 3 4\n",
    "fortran": "time q_1 q_2\n 0.0D+00 0.1D+01 2.0D0\n 1.0D-01 3.0D+00 0.4D+1\n",
    "fortran noletter": "time q_1 q_2\n 0.0+00 0.1+01 2.0+0\n 1.0-01 3.0+00 0.4+1\n",
    "fortran commas": "time;q_1;q_2\n0,0D+00;0,1D+01;2,0D0\n1,0D-01;3,0D+00;0,4D+1\n",
    "repeat header": "time,q_1,q_2\n0,1,2\ntime,q_1,q_2\n0.1,3,4\n",
    "repeat header units": "time,q_1,q_2\ns,-,-\n0,1,2\n\ntime,q_1,q_2\ns,-,-\n0.1,3,4\n",
    "comment lead": "# exported\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n",
    "comment in": "time,q_1,q_2\n0,1,2\n# pause\n0.1,3,4\n",
    "sep": "sep=;\ntime;q_1;q_2\n0;1;2\n0,1;3;4\n",
    "utf16": UTF16.encode("utf-16"),
    "utf16 nobom": UTF16.encode("utf-16-le"),
    "cp1252": b"Pr\xfcfstand Tr\xe4ger \xb5\ntime;q_1;q_2\n0;1;2\n0,1;3;4\n",
    "names blanks": "Time   Mode 1   Mode 2\n0 1 2\n0.1 3 4\n",
    "names quoted": '"Time (s)" "Mode 1" "Mode 2"\n0 1 2\n0.1 3 4\n',
    "trailing": "time;q_1;q_2;\n0;1;2;\n0,1;3;4;\n",
    "trailing many": "time;q_1;q_2;;;\n0;1;2;;;\n0,1;3;4;;;\n;;;;;\n",
    "trailing ragged": "time;q_1;q_2\n0;1;2;\n0,1;3;4\n",
    "blank lines": "\n\ntime;q_1;q_2\n\n0;1;2\n\n0,1;3;4\n\n",
    "declares ok": "Number of channels: 3\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n",
    "rate ok": "Sampling rate: 10 Hz\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n",
    "time unit free": "Time unit: ms\ntime,q_1,q_2\n0,1,2\n100,3,4\n",
    "list": "# 1: time [ms]\n# 2: q_1\n# 3: q_2\n0 1 2\n100 3 4\n",
    "list notime": "1 q_1\n2 q_2\n0 1 2\n.1 3 4\n",
    "group row": "Body;Body;Body\ntime;q_1;q_2\n0;1;2\n0,1;3;4\n",
    "types row": "time;q_1;q_2\ndouble;double;double\n0;1;2\n0,1;3;4\n",
    "LabVIEW": LABVIEW,
    "catman": CATMAN,
    "Dewesoft": DEWESOFT,
    "Octave": "# name: A\n# type: matrix\n# rows: 2\n# columns: 3\n# time q_1 q_2\n 0 1 2\n 0.1 3 4\n",
    "Modelica": '"time","q[1]","q[2]"\n0,1,2\n0.1,3,4\n',
    "names in two languages": "time;$S.q(1);$S.q(2)\nZeit;Mode 1;Mode 2\ns;m;m\n0;1;2\n0,1;3;4\n",
    "channels counted": "Channel;1;2\ntime;q_1;q_2\n0;1;2\n0,1;3;4\n",
    "units apart": "Time [ms] q_1 [m] q_2 [m]\n0 1 2\n100 3 4\n",
    "units after colons": "time:ms,q_1:m,q_2:m\n0,1,2\n100,3,4\n",
    "a date in the title": "29.11.2024;;\ntime;q_1;q_2\n0;1;2\n0,1;3;4\n",
    "names divided otherwise": "time,q_1,q_2\n0 1 2\n0.1 3 4\n",
    "seconds": "seconds,q_1,q_2\n0,1,2\n0.1,3,4\n",
    "ADAMS tab": ADAMS_TABLE,
    "ADAMS request": ADAMS_REQUEST,
    "SIMPACK": SIMPACK,
    "RecurDyn": "X:Time(s),Y:FlexBody1/Mode1,Y:FlexBody1/Mode2\n0.,1.,2.,\n.1,3.,4.,\n",
    "RecurDyn pairs": "X:Time,Y:q1,X:Time,Y:q2\n0.,1.,0.,2.,\n.1,3.,.1,4.,\n",
    "MATLAB": "Time_s_,q_1,q_2\n0,1,2\n0.1,3,4\n",
    "MATLAB ms": "Time_ms_,q_1,q_2\n0,1,2\n100,3,4\n",
    "numpy": "# time q_1 q_2\n0.000000000000000000e+00 1.0 2.0\n1.000000000000000056e-01 3.0 4.0\n",
    "single quotation marks": "time;'q_1';'q_2'\n0;1;2\n0,1;3;4\n",
    "spacer": "time;;q_1;;q_2\n0;;1;;2\n0,1;;3;;4\n",
    "byte order mark": "\ufefftime;q_1;q_2\n0;1;2\n0,1;3;4\n",
    "a rule under the names": "time  q_1  q_2\n----  ---  ---\n0 1 2\n0.1 3 4\n",
    "drawn with bars": "| time | q_1 | q_2 |\n|---|---|---|\n| 0 | 1 | 2 |\n| 0.1 | 3 | 4 |\n",
    "numbered names": "time,1,2\n0,1,2\n0.1,3,4\n",
    "units first": "s,-,-\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n",
    "german": "Zeit [s];Modalkoordinate 1;Modalkoordinate 2\n0;1;2\n0,1;3;4\n",
    "numbers in quotation marks": '"time","q_1","q_2"\n"0","1","2"\n"0.1","3","4"\n',
    "quoted decimal commas": '"time","q_1","q_2"\n"0,0","1,0","2,0"\n"0,1","3,0","4,0"\n',
    "old mac": "time,q_1,q_2\r0,1,2\r0.1,3,4\r",
    "header newline in cell": '"Time\n[ms]","q_1\n[m]","q_2\n[m]"\n0,1,2\n100,3,4\n',
}

REFUSED = [
    (
        "Time [s],q_1,q_2\nms,-,-\n0,1,2\n100,3,4\n",
        "line 2: two statements of the header disagree: Time [s] has s, and ms. Correct one",
    ),
    (
        "Time,q_1,q_2\ns,-,-\nms,-,-\n0,1,2\n100,3,4\n",
        "line 3: two statements of the header disagree: Time has s, and ms. Correct one",
    ),
    ("time [foo],q_1,q_2\n0,1,2\n1,3,4\n", "column 'time [foo]': 'foo' is no unit of time. Write s, ms, us, min or h."),
    (
        "q_1,q_2,q_3\n1,2,0\n3,4,0.1\n",
        "no column is named time; the columns are 'q_1', 'q_2', 'q_3'. Name it, or its position from 1, with --time-",
    ),
    (",q_1,q_2\n0,1,2\n0.1,3,4\n", "no column is named time; the columns are '', 'q_1', 'q_2'. Name it"),
    (
        "Time;q_1;Time;q_2\n0;1;0;2\n0,1;3;0,2;4\n",
        "line 3, sample 2: time is repeated before every curve, and differs: 0.1 s in column 1, 0.2 s in column 3",
    ),
    (
        "Date,q_1,q_2\n2024-11-29 10:00:00,1,2\n2024-11-29 10:00:01,3,4\n",
        "line 2: '2024-11-29' is a date or a time of day, where seconds from the start of the run are needed",
    ),
    ("Datum;Zeit;q_1;q_2\n29.11.2024;0,0;1;2\n29.11.2024;0,1;3;4\n", "line 2: '29.11.2024' is a date or a time of day"),
    ("time;q_1;q_2\n10:00:00.1;1;2\n10:00:00.2;3;4\n", "line 2: '10:00:00' is a date or a time of day"),
    (
        "time,q_1,q_2\n0,0,1,0,2,0\n0,1,3,0,4,0\n",
        "line 1: 3 names stand above rows of 6 numbers; commas seem to stand both between the columns and in",
    ),
    (
        "time,q_1,q_2\n0,1,2\n0,1,3,5,4,5\n0,2,3,5,4,5\n",
        "line 2: 3 names stand above rows of 6 numbers; commas seem to stand both",
    ),
    (
        "0,00,1,50,2,25\n0,10,3,50,4,25\n",
        "line 1: commas seem to stand both between the columns and in the numbers. Write semicolons",
    ),
    (
        "0,1,2\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n",
        "line 1: a row of numbers (0, 1, 2) stands above the names in line 2. Remove it",
    ),
    (
        "1,2,3\n0,10.5,12.5\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n",
        "line 1: a row of numbers (1, 2, 3) stands above the names in line 3. Remove it",
    ),
    (
        "Factor;1;2\ntime;q_1;q_2\n0;1;2\n0,1;3;4\n",
        "line 1: a row of numbers named 'Factor' stands above the rows of values, and is not understood",
    ),
    (
        "time;q_1;q_2\n0;1;2\n0,1;1.234,5;4\n",
        "line 3: '1.234,5' in q_1 is no number; the table does not hold numbers only; it seems to have thousands",
    ),
    (
        'time,q_1,q_2\n0,1,2\n0.1,"1,234.5",4\n',
        "line 3: '1,234.5' in q_1 is no number; the table does not hold numbers only; it seems to have thousands",
    ),
    (
        "time;q_1;q_2\n0;1;2\n0,1;3.5;4\n0,2;3,5;4\n",
        "line 3: '3.5' in q_1 is no number; the table does not hold numbers only; other numbers have commas as",
    ),
    ("time;q_1;q_2\n0;1;2\n0,1;3;4\nEnd of file\n", "line 4: 'End of file' is no row of numbers"),
    ("time;q_1;q_2\n0;1;2\n0,1;3;4\nMax;3;4\n", "line 4: 'Max;3;4' is no row of numbers"),
    (
        "time,q_1,q_2,q_3\n0,1,2\n0.1,3,4\n",
        "line 1: 4 names stand above rows of 3 numbers. Export a name for every column",
    ),
    ("time,q_1\n0,1,2\n0.1,3,4\n", "line 1: 2 names stand above rows of 3 numbers. Export a name for every column"),
    (
        "Number of channels: 5\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n",
        "line 1: the header states 5 channels, the table has time and 2 other columns. Export again",
    ),
    ("Samples: 7\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n", "line 1: the header states 7 Samples, the table has 2 rows"),
    (
        "Sampling rate: 100 Hz\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n",
        "line 1: the header states 100 Hz, the usual step of 0.1 s makes 10 Hz",
    ),
    (
        "Time unit: ms\ntime [s],q_1,q_2\n0,1,2\n100,3,4\n",
        "line 1: two statements of the header disagree: time in ms, and 'time [s]' in s",
    ),
    (
        "# 1: time [ms]\n# 2: q_1\n# 3: q_2\n# 4: q_3\n0 1 2\n100 3 4\n",
        "line 1: 4 channels are listed above rows of 3 numbers",
    ),
    (
        "Time;Channel 1;Channel 2\ntime;q_7;q_8\n0;1;2\n0,1;3;4\n",
        "lines 1 and 2: two statements of the header disagree: Time, Channel 1, Channel 2, and time, q_7, q_8",
    ),
    ("time,q_1,q_2\n0,1,2\n0.1,NaN,4\n", "line 3, sample 2: a value is missing or no number, in column 'q_1'"),
    ("time,q_1,q_2\n0,1,2\n0.1,,4\n0.2,1,2\n", "line 3, sample 2: a value is missing or no number, in column 'q_1'"),
    (
        "time,q_1,q_2\n0,1,2\n0.1,3,4\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n",
        "line 5, sample 3: time goes from 0.1 to 0 s. Export every run to a file of its own",
    ),
]


@pytest.fixture
def read(tmp_path):
    """Read coordinates given as text or bytes."""

    def reader(content, columns=None, time_column=None):
        path = tmp_path / "q.txt"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_coordinates(path, columns, time_column)

    return reader


@pytest.mark.parametrize("content", SAME.values(), ids=SAME)
def test_one_history_in_many_layouts(read, content):
    """Time arrives in seconds and every coordinate at its mode, whatever program wrote the file."""
    history = read(content)
    order = np.argsort(history.mode)
    assert history.mode[order].tolist() == [1, 2]
    assert history.time.tolist() == [0.0, 0.1]
    assert history.q[order].tolist() == [[1.0, 3.0], [2.0, 4.0]]


@pytest.mark.parametrize(("content", "message"), REFUSED)
def test_contradictions_and_what_is_no_table(read, content, message):
    """Each is said as what it is, with its line and a remedy."""
    with pytest.raises(DataError) as refusal:
        read(content)
    assert message in str(refusal.value)


@pytest.mark.parametrize(
    ("unit", "seconds"),
    [
        *(("s", 1), ("sec", 1), ("ms", 1e-3), ("MS", 1e-3), ("us", 1e-6), ("µs", 1e-6), ("μs", 1e-6), ("ns", 1e-9)),
        *(("min", 60), ("h", 3600), ("Stunden", 3600), ("Sekunden", 1), ("d", 86400), ("-", 1), ("", 1)),
    ],
)
@pytest.mark.parametrize(
    "form", ["Time [{}]", "time ({})", "TIME <{}>", "Zeit/{}", "t [{}]", "x.time [{}]", "$S_time [{}]"]
)
def test_units_of_time(read, unit, seconds, form):
    """Times are converted by their header, exactly rounded."""
    if unit in ("", "-") and "/" in form:
        pytest.skip("no unit")
    history = read(f"q_1;{form.format(unit)}\n1;0\n2;3\n3;6\n")
    assert history.time.tolist() == [
        0.0,
        3 / round(1 / seconds) if seconds < 1 else 3.0 * seconds,
        pytest.approx(6 * seconds),
    ]


@pytest.mark.parametrize(("name", "unit"), [("$S_time : s", "s"), ("run_Time", ""), ("Mess_Zeit/ms", "ms")])
def test_names_that_end_in_time(name, unit):
    """Programs put their own word before it."""
    assert (channel(name).is_time, channel(name).unit) == (True, unit)


@pytest.mark.parametrize(
    "name",
    ["time step", "t_1", "tension_3", "timeout 4", "time constant 5", "temperature", "torque", "q_t", "x_timer 1"],
)
def test_names_that_are_not_time(name):
    """A name that only begins like time is none."""
    assert not channel(name).is_time


@pytest.mark.parametrize(
    ("name", "mode", "unit", "frequency", "half"),
    [
        ("q_1 [m]", 1, "m", None, None),
        ("q_1 [m*sqrt(kg)]", 1, "m*sqrt(kg)", None, None),
        ("Q12 (kg^0.5 m)", 12, "kg^0.5 m", None, None),
        ("q_3_mm", 3, "mm", None, None),
        ("q_3/mm", 3, "mm", None, None),
        ("q[12]", 12, "", None, None),
        ("$B_Car.q(12)", 12, "", None, None),
        ("mode 4 (roof)", 4, "", None, None),
        ("q_5 [-]", 5, "", None, None),
        ("q_5 (rad)", 5, "rad", None, None),
        ("7", 7, "", None, None),
        ("10.5", 0, "", None, None),
        ("Mode 1 (10.02 Hz)", 1, "", 10.02, 0.005),
        ("Mode 1, f=10,0 Hz [mm]", 1, "mm", 10.0, 0.05),
        ("q_2 12Hz", 2, "", 12.0, 0.5),
        ("q_2 0.012 kHz", 2, "", 12.0, 0.5),
    ],
)
def test_what_a_name_states(name, mode, unit, frequency, half):
    """Number, unit and frequency of a mode are kept apart."""
    found = channel(name)
    assert (found.mode, found.unit, found.is_time) == (mode, unit, False)
    if frequency is None:
        assert np.isnan(found.frequency)
    else:
        assert (found.frequency, found.resolution) == (pytest.approx(frequency), pytest.approx(half))


def test_frequencies_of_the_header(read):
    """In names, in a row with a label, in lines above; two statements that differ are refused."""
    for text in (
        "time;q_1 (10,5 Hz);q_2 (12,50 Hz)\n0;1;2\n1;3;4\n",
        "Frequency [Hz];10,5;12,50\ntime;q_1;q_2\n0;1;2\n1;3;4\n",
        "Mode 1: 10.5 Hz\nMode 2: 12.50 Hz\ntime;q_1;q_2\n0;1;2\n1;3;4\n",
    ):
        history = read(text)
        assert history.frequency.tolist() == [10.5, 12.5]
        assert history.resolution.tolist() == pytest.approx([0.05, 0.005])
    with pytest.raises(DataError, match=r"line 1: two statements of the header disagree: 10\.5 Hz for mode 1"):
        read("Mode 1: 10.5 Hz\ntime;q_1 (12.0 Hz)\n0;1\n1;3\n")
    with pytest.raises(DataError, match=r"line 2: two statements of the header disagree: q_1 \(10.5 Hz\), and 11.0 Hz"):
        read("time;q_1 (10.5 Hz)\nf [Hz];11.0\n0;1\n1;3\n")


def test_numbers_of_the_header(read):
    """A row of mode numbers numbers columns without one; one that disagrees with names is refused."""
    assert read("Mode;7;9\ntime;q;p\n0;1;2\n1;3;4\n").mode.tolist() == [7, 9]
    with pytest.raises(DataError, match=r"line 1: two statements of the header disagree: q_2, and mode 9"):
        read("Mode;7;9\ntime;q_7;q_2\n0;1;2\n1;3;4\n")


def test_a_time_column_by_name_or_position(read):
    """The user's word decides, with the unit in the name; a name that is there twice does not."""
    text = "a,now [ms],q_1\n5,0,1\n6,100,2\n"
    for wanted in ("now [ms]", "2"):
        history = read(text, {"q_1": 1}, wanted)
        assert history.time.tolist() == [0.0, 0.1]
        assert history.q.tolist() == [[1.0, 2.0]]
    with pytest.raises(DataError, match="2 columns are named 'q'"):
        read("time,q,q\n0,1,2\n1,2,3\n", {"q": 1})


def test_parquet_durations_and_dates(tmp_path):
    """Durations become seconds whatever their unit and name; dates, flags and metadata that contradict are refused."""
    path = tmp_path / "q.parquet"
    q = pa.array([1.0, 2.0])
    for unit, ticks in (("s", [0, 3]), ("ms", [0, 3000]), ("us", [0, 3 * 10**6]), ("ns", [0, 3 * 10**9])):
        for name in ("time", "when", "time_s"):
            pq.write_table(pa.table({"q_1": q, name: pa.array(ticks, pa.duration(unit))}), path)
            history = read_coordinates(path, None, None)
            assert history.time.tolist() == [0.0, 3.0]
            assert history.mode.tolist() == [1]
    for bad in (pa.timestamp("ms"), pa.date32(), pa.time32("s")):
        pq.write_table(
            pa.table(
                {"time": pa.array([0, 1], pa.int32() if bad != pa.timestamp("ms") else pa.int64()).cast(bad), "q_1": q}
            ),
            path,
        )
        with pytest.raises(DataError, match="column 'time': the column holds dates or times of day"):
            read_coordinates(path, None, None)
    pq.write_table(pa.table({"time": q, "q_1": pa.array([True, False])}), path)
    with pytest.raises(DataError, match="column 'q_1': a column holds no numbers"):
        read_coordinates(path, None, None)
    fields = [
        pa.field("time", pa.float64(), metadata={"unit": "ms"}),
        pa.field("q_1", pa.float64(), metadata={"unit": "mm"}),
    ]
    pq.write_table(pa.table([q, q], pa.schema(fields)), path)
    history = read_coordinates(path, None, None)
    assert (history.time.tolist(), history.unit) == ([0.001, 0.002], ("mm",))
    pq.write_table(pa.table([q, q], pa.schema([fields[0].with_name("time_s"), fields[1]])), path)
    with pytest.raises(DataError, match="column 'time_s': its name states s, its metadata ms"):
        read_coordinates(path, None, None)


def test_a_long_file_with_names_again(read):
    """Names repeated far below the head, blank lines and comments leave the rows their lines."""
    rows = [f"{k / 100:.2f};{k};{-k}" for k in range(20_000)]
    text = "time;q_1;q_2\n" + "\n".join(rows[:15_000]) + "\n\n# pause\ntime;q_1;q_2\n" + "\n".join(rows[15_000:]) + "\n"
    history = read(text)
    assert history.time.size == 20_000
    assert history.q[0].tolist() == list(range(20_000))
    assert history.lines[[0, 14_999, 15_000]].tolist() == [2, 15_001, 15_005]
    with pytest.raises(DataError, match=r"q\.txt, line 15006: 'x' in q_1 is no number"):
        read(text.replace("150.01;15001", "150.01;x"))


def test_exponents_of_fortran_far_below(read):
    """Numbers of a Fortran program, plain at the beginning."""
    rows = "".join(f" {k:d} {k:d}.0\n" for k in range(10_000))
    assert read("time q_1\n" + rows + " 1.0D+04 0.25D+01\n 1.1+004 -0.5-101\n").q[0, -2:].tolist() == [2.5, -0.5e-101]


def test_values_are_exact(read):
    """Numbers divided by blanks or by a separator are read to the last digit."""
    values = np.random.default_rng(5).standard_normal((300, 3))
    for separator, sign in ((" ", "."), ("   ", ","), (";", ","), (",", "."), ("\t", ",")):
        lines = [
            separator.join([repr(k / 8), *map(repr, row)]).replace(".", sign) for k, row in enumerate(values.tolist())
        ]
        history = read(separator.join(["t", "q_1", "q_2", "q_3"]) + "\n" + "\n".join(lines) + "\n")
        assert np.array_equal(history.q, values.T)


def test_units_of_some_columns(read):
    """A row of units may fill only some cells, and stand above the names."""
    for text in ("time;q_1;q_2\nms;;\n0;1;2\n100;3;4\n", "ms;m;\ntime;q_1;q_2\n0;1;2\n100;3;4\n"):
        assert read(text).time.tolist() == [0.0, 0.1]


def test_pandas_tables(read):
    """An index without a name that counts the rows is left out and told; names over several rows are read."""
    history = read(",time,q_1\n0,0.0,5.0\n1,0.1,6.0\n2,0.2,7.0\n")
    assert (history.mode.tolist(), history.time.tolist()) == ([1], [0.0, 0.1, 0.2])
    assert [str(remark).split(": ", 1)[1] for remark in history.remarks] == [
        "column 1 has no name and counts the rows; it is left out. Export without it."
    ]
    assert read(",time,q_1\n3,0.0,5.0\n1,0.1,6.0\n").mode.tolist() == [0, 1]
    history = read("mode;1;2\nunit;m;m\ntime;;\n0;1;2\n1;3;4\n")
    assert (history.mode.tolist(), history.unit) == ([1, 2], ("m", "m"))
    assert read("time;q_1\n0;1\n1;2\n\x1a").time.tolist() == [0.0, 1.0]


def test_a_column_by_its_name_without_the_unit(read):
    """A map or --time-column may leave units and frequencies out."""
    text = "when [ms],Time [s],q_1 [m],q_2 (12 Hz)\n0,5,1,2\n100,6,3,4\n"
    history = read(text, {"q_1": 7, "q_2": 9}, "when")
    assert (history.mode.tolist(), history.time.tolist(), history.unit) == ([7, 9], [0.0, 0.1], ("m", ""))
    assert read(text, {"q_1": 7}, "Time").time.tolist() == [5.0, 6.0]


@pytest.mark.parametrize(
    "line",
    [
        "CPU time (min): 3",
        "Run time: 12 s",
        "Number of modes: 40",
        "Integrator time step: 1e-5",
        "dt = 1e-5 s",
        "Model 3, version 5",
        "Sampled at 10 Hz",
        "2024-11-29 10:00",
        "Units: m, kg, s",
    ],
)
def test_lines_that_state_nothing_of_the_table(read, line):
    """Text above the table that speaks of other things is no contradiction."""
    assert read(f"{line}\ntime,q_1,q_2\n0,1,2\n0.1,3,4\n").time.tolist() == [0.0, 0.1]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("Time in ms", None),
        ("% all times in ms, coordinates in m", None),
        ("Time unit = ms", None),
        ("Zeiteinheit: ms", None),
        ("Unit of time: parsec", "'parsec' is no unit of time"),
        ("Columns: 4", "the header states 4 columns"),
        ("Number of modes: 1", "the header states 1 modes"),
        ("Sample interval: 5 ms", "the header states a step of 0.005 s, the usual step of the table is 100 s"),
        ("Number of samples = 3", "the header states 3 samples, the table has 2 rows"),
    ],
)
def test_lines_that_state_something(read, line, message):
    """Units, counts and sampling in a line of text are used, or contradict the table."""
    text = f"{line}\ntime,q_1,q_2\n0,1,2\n100,3,4\n"
    if message is None:
        assert read(text).time.tolist() == [0.0, 0.1]
        return
    with pytest.raises(DataError, match=f"line 1: {message}"):
        read(text)
