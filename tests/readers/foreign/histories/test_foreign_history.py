"""Modal coordinates of other programs: layouts, maps of columns to modes, values that are none."""

import random

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_coordinates
from tests.readers.foreign.histories.test_mcf import MCF


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
