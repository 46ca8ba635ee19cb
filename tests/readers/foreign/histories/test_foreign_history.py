"""Modal coordinates of other programs: layouts, mapping of columns to modes, time steps, .mcf files."""

import random
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory, matched, uniform
from fatigue.readers.foreign.histories.mcf import read_mcf
from fatigue.readers.foreign.read import read_coordinates, recognise

MCF = """\
Modal Coordinates File
Title: run 1
Number of Modes:   3
  Mode:                1              2              7
  Frequency:     0.1000000E+02  0.2000000E+02
                 0.3000000E+02
      Time          Coordinates...
 0.0000000E+00  0.1E+01  0.2E+01
                0.3E+01
 0.1000000E+00  0.4E+01  0.5E+01
                0.6E+01
"""


@pytest.fixture
def read(tmp_path):
    """Read coordinates given as text."""

    def reader(text, columns=None, time_column=None):
        path = tmp_path / "q.txt"
        path.write_text(text)
        return read_coordinates(path, columns, time_column)

    return reader


@pytest.mark.parametrize(
    "text",
    [
        "time,q_1,q_12\n0,1,2\n0.1,3,4\n",
        "Export 2024\nversion 9\nTime;$B.q(1);$B.q(12)\n[s];[m];[m]\n0,0;1,0;2\n0,1;3;4\n",
        "% t  m1  m12\n0 1 2\n.1 3 4\n",
        '"time"\t".FLEX.Q1 [kg^0.5 m]"\t".FLEX.Q12 [kg^0.5 m]"\n0\t1\t2\n.1\t3\t4\n',
        "q_12;t;q_1\n2;0;1\n4;0.1;3\n",
        "time, q_1, q_12,\n0, 1, 2,\n0.1, 3, 4,\n",
    ],
)
def test_layouts(read, text):
    """Separators, decimal commas, titles, units, quotation marks, any order of columns."""
    history = read(text)
    order = np.argsort(history.mode)
    assert history.mode[order].tolist() == [1, 12]
    assert history.time.tolist() == [0.0, 0.1]
    assert history.q[order].tolist() == [[1.0, 3.0], [2.0, 4.0]]


def test_parquet(tmp_path):
    """A Parquet table is read by the same rules; one of words is refused."""
    path = tmp_path / "q.parquet"
    pq.write_table(pa.table({"time_s": [0.0, 1.0], "q_3": [1.0, 2.0]}), path)
    assert read_coordinates(path, None, None).mode.tolist() == [3]
    pq.write_table(pa.table({"time_s": [0.0, 1.0], "q_3": ["a", "b"]}), path)
    with pytest.raises(DataError, match="holds no numbers"):
        read_coordinates(path, None, None)


def test_columns_by_map(read):
    """A map takes the named columns only and gives them their modes."""
    history = read("now,a,b,c\n0,1,2,3\n1,4,5,6\n", columns={"c": 5, "a": 9}, time_column="now")
    assert history.mode.tolist() == [5, 9]
    assert history.q.tolist() == [[3.0, 6.0], [1.0, 4.0]]
    for columns, time in (({"z": 1}, None), (None, "z")):
        with pytest.raises(DataError, match="'z'"):
            read("now,a\n0,1\n1,2\n", columns, time)


def test_matching(read):
    """Columns find modes by number, by frequency in their names, or in their order."""
    history = read("t,Mode 1 (10.02 Hz),Mode 2 (20 Hz)\n0,1,2\n1,3,4\n")
    modes, frequencies = np.array([4, 7]), np.array([20.0, 10.0])
    assert matched(history, modes, frequencies, "frequency").mode.tolist() == [7, 4]
    assert matched(history, modes, frequencies, "order").mode.tolist() == [4, 7]
    assert matched(history, modes, frequencies, "id").mode.tolist() == [1, 2]
    with pytest.raises(DataError, match=r"10\.02 Hz, the nearest mode"):
        matched(history, modes, np.array([20.0, 11.0]), "frequency")
    twice = read("t,q4,p4\n0,1,2\n1,3,4\n")
    with pytest.raises(DataError, match="mode 4 is claimed"):
        matched(twice, modes, frequencies, "id")
    with pytest.raises(DataError, match="names no mode"):
        matched(read("t,a\n0,1\n1,3\n"), modes, frequencies, "id")
    with pytest.raises(DataError, match="cannot be matched by frequency"):
        matched(read("t,a\n0,1\n1,3\n"), modes, frequencies, "frequency")
    with pytest.raises(DataError, match="1 columns for 2 modes"):
        matched(read("0,1\n1,3\n"), modes, frequencies, "order")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("hello\n", "no row of numbers"),
        ("t,q1\n0,1\n1,x\n", "numbers only"),
        ("t,q1\n0,1\n1,\n", "sample 2: a value is missing"),
        ("t,q1\n0,1\n", "1 samples"),
        ("t,q1\n0,1\n-1,2\n", "line 3, sample 2: time goes from 0 to -1 s"),
        ("t,q1\n0,1\n1,2,3\n", "numbers only"),
    ],
)
def test_refusals(read, text, words):
    """Words, gaps, single samples, time that stands still."""
    with pytest.raises(DataError, match=words):
        read(text)


def history(time):
    """One coordinate, a sine of 1 rad/s."""
    time = np.asarray(time, float)
    return ForeignHistory("q", np.array([1]), np.array([np.nan]), ("q_1",), time, np.sin(time)[None])


def test_uneven_steps_are_resampled_on_request():
    """An event with smaller steps is refused, and interpolated by cubic splines if a step is given."""
    uneven = history(np.concatenate([np.arange(0, 1, 0.1), np.arange(1, 2, 0.05)]))
    with pytest.raises(DataError, match=r"resample, for instance with a step of 0\.05 s"):
        uniform(uneven, None)
    even = uniform(uneven, 0.02)
    assert np.allclose(np.diff(even.time), 0.02)
    assert np.allclose(even.q[0], np.sin(even.time), atol=2e-5)
    assert [remark.code for remark in even.remarks] == ["resampled"]
    assert [remark.code for remark in uniform(uneven, 0.2).remarks] == ["resampled", "coarser"]
    assert uniform(history([0, 1, 2]), None).time.size == 3
    for step in (0.0, -1.0, 1e-12, 99.0):
        with pytest.raises(DataError, match="is impossible"):
            uniform(uneven, step)


def test_an_instant_written_twice():
    """Solvers write an event twice: with a step the later sample is kept, without one the place is named."""
    time = np.array([0.0, 0.1, 0.2, 0.2, 0.2, 0.3, 0.3, 0.4])
    twice = replace(history(time), q=np.arange(8.0)[None], lines=np.arange(2, 10))
    with pytest.raises(
        DataError, match=r"^q, line 5, sample 4: time goes from 0\.2 to 0\.2 s, it stands still \(and at 2"
    ):
        uniform(twice, None)
    even = uniform(twice, 0.1)
    assert even.time == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])
    assert even.q[0] == pytest.approx([0.0, 1.0, 4.0, 6.0, 7.0])
    assert [(remark.code, remark.count) for remark in even.remarks] == [("instant_twice", 3), ("resampled", 1)]
    with pytest.raises(DataError, match="time stands still"):
        uniform(history([1.0, 1.0]), 0.1)


def test_a_gap_is_told():
    """An interpolation over lost samples is a doubt that names the place."""
    gap = history([*np.arange(0, 1, 0.01), *np.arange(3, 4, 0.01)])
    assert [remark.code for remark in uniform(gap, 0.01).remarks] == ["resampled", "gap"]
    assert "from 0.99 s" in uniform(gap, 0.01).remarks[1].what


def stated(frequency, mode=(1, 2), resolution=None):
    """Two columns with frequencies, as a file states them."""
    half = None if resolution is None else np.full(2, resolution)
    names = tuple(f"q_{m}" for m in mode)
    q = np.zeros((2, 3))
    return ForeignHistory("q", np.array(mode), np.array(frequency, float), names, np.arange(3.0), q, resolution=half)


def test_a_frequency_that_fits_another_mode():
    """Better by more than the written digits explain is refused; a swap within them is not."""
    modes, fe = np.array([1, 2, 3]), np.array([10.0, 10.4, 20.0])
    assert matched(stated([10.0, 10.4]), modes, fe, "id").mode.tolist() == [1, 2]
    assert matched(stated([10.2, 10.2], resolution=0.05), modes, fe, "id").mode.tolist() == [1, 2]
    assert matched(stated([10.0, 10.0], resolution=0.5), modes, fe, "id").mode.tolist() == [1, 2]
    assert matched(stated([9.0, 11.0]), modes, fe, "id").mode.tolist() == [1, 2]  # far, and nearest to its own
    with pytest.raises(DataError) as refusal:
        matched(stated([10.4, 10.0], resolution=0.05), modes, fe, "id")
    assert [str(problem) for problem in refusal.value.problems] == [
        f"q: column 'q_{m}' has {f} Hz; its mode {m} has {own} Hz in the FE run, mode {other} has {f} Hz. Join by "
        "--match frequency, or use the same modal basis on both sides."
        for m, f, own, other in ((1, "10.4", "10", 2), (2, "10", "10.4", 1))
    ]
    assert matched(stated([10.4, 10.0]), modes, fe, "frequency").mode.tolist() == [2, 1]
    rigid = np.array([1e-5, 3e-5, 20.0])
    assert matched(stated([3e-5, 1e-5]), modes, rigid, "id").mode.tolist() == [1, 2]
    assert matched(stated([10.4, np.nan], (3, 2)), modes, np.array([1.0, 2.0, np.nan]), "id").mode.tolist() == [3, 2]


def test_order_without_rigid_modes():
    """One column too few for all modes and enough for the elastic ones: the way to leave the rigid ones out."""
    modes, fe = np.array([1, 2, 3, 4]), np.array([0.0, 1e-6, 10.0, 20.0])
    with pytest.raises(DataError, match=r"leaves out the rigid modes, add --ignore-modes 1,2\."):
        matched(stated([np.nan, np.nan]), modes, fe, "order")
    same = replace(stated([np.nan, np.nan], (1, 1)), name=("q_1", "q_1"))
    with pytest.raises(DataError, match="column 'q_1' is there 2 times"):
        matched(same, modes[2:], fe[2:], "order")


def test_mcf(tmp_path):
    """A wrapped file with mode numbers and frequencies; without the two lines modes count from 1."""
    path = tmp_path / "a.mcf"
    path.write_text(MCF)
    assert recognise(path).key == "mcf"
    found = read_coordinates(path, None, None)
    assert found.mode.tolist() == [1, 2, 7]
    assert found.frequency.tolist() == [10.0, 20.0, 30.0]
    assert found.q.tolist() == [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]
    lines = MCF.splitlines(keepends=True)
    path.write_text("".join(lines[:3] + lines[6:]))
    bare = read_mcf(path)
    assert bare.mode.tolist() == [1, 2, 3]
    assert np.isnan(bare.frequency).all()


def test_mcf_of_another_program(tmp_path):
    """Exponents of Fortran, UTF-16, more digits; the normalisation a header declares."""
    path = tmp_path / "a.mcf"
    path.write_bytes(MCF.replace("E+", "D+").encode("utf-16"))
    found = read_coordinates(path, None, None)
    assert found.frequency.tolist() == [10.0, 20.0, 30.0]
    assert found.resolution.tolist() == pytest.approx([5e-6] * 3)
    assert found.q.tolist() == [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]]
    assert found.normalisation is None
    for words, wanted in (
        ("Mode shapes normalized to the mass matrix", "mass"),
        ("The modes are mass normalised", "mass"),
        ("Normalization: unit modal mass", "mass"),
        ("Mode shapes normalized to unity", "length"),
        ("Modes normalised to maximum displacement", "length"),
    ):
        path.write_text(MCF.replace("Title: run 1", words))
        assert read_mcf(path).normalisation == wanted
    path.write_text(MCF.replace("Title: run 1", "modes normalized to mass\nmodes normalized to unity"))
    with pytest.raises(DataError, match="lines 2 and 3: two statements of the header disagree"):
        read_mcf(path)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("Number of Modes:   3", "Number of Modes:   4", "3 mode numbers for 4 modes"),
        ("Number of Modes", "Count", "are missing"),
        ("      Time ", "      Frequency ", "harmonic response"),
        ("0.6E+01\n", "\n", "no whole number of rows"),
        ("0.6E+01", "0.6?+01", "no number"),
        ("0.3000000E+02", "0.3E+02E", "3 modes|no number"),
    ],
)
def test_mcf_refusals(tmp_path, old, new, words):
    """Cut, damaged and harmonic files."""
    path = tmp_path / "a.mcf"
    path.write_text(MCF.replace(old, new))
    with pytest.raises(DataError, match=words):
        read_mcf(path)


def test_missing_files(tmp_path):
    """Missing, empty and unknown binary files are named."""
    for read in (read_mcf, recognise):
        with pytest.raises(DataError, match=r"none\.mcf"):
            read(tmp_path / "none.mcf")
    (tmp_path / "empty").touch()
    with pytest.raises(DataError, match="empty"):
        recognise(tmp_path / "empty")
    (tmp_path / "binary").write_bytes(b"abc\0def")
    with pytest.raises(DataError, match="unknown binary"):
        recognise(tmp_path / "binary")


def test_formats_by_content():
    """Real files are recognised by content."""
    folder = Path("data/nastran")
    names = {"modes_elements.op2": "op2", "modes_elements.h5": "h5", "modes_elements.bdf": "bdf", "geom.inc": "bdf"}
    assert {name: recognise(folder / name).key for name in names} == names


def test_damaged_tables_are_refused_or_read(read):
    """Hundreds of damaged tables give a history or a refusal, never a crash."""
    rng = random.Random(2)
    outcomes = set()
    for source in (MCF, "Run\ntime;q_1;q_2\ns;-;-\n0,0;1;2\n0,1;3;4\n0,2;5;6\n"):
        for _ in range(150):
            text = list(source)
            for _ in range(rng.choice([1, 3, 10])):
                text[rng.randrange(len(text))] = rng.choice('0123456789,.+-;" \n\tEex')
            try:
                outcomes.add(read("".join(text)).q.shape)
            except DataError as error:
                outcomes.add(error.problems[0].code)
    assert len(outcomes) > 3
