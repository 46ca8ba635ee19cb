"""The record structure of OP2 files as MSC Nastran, NX and OptiStruct write it, and its damage to the last byte."""

import os
import random
from contextlib import suppress
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.results.op2 import read_op2
from fatigue.readers.foreign.nastran.results.op2_records import read_records
from tests.readers.op2_writer import MSC_2014, OPTISTRUCT, PLAIN, Dialect, Op2Writer

GENUINE = Path(__file__).parents[4] / "data" / "nastran"
LAYOUTS = [(4, "<"), (4, ">"), (8, "<"), (8, ">")]
ROWS = [
    *((node, 1, "QUAD4", [float(node), -1.5, 0.25, 3.0, 0.0, -7.0]) for node in (1, 2, 3, 4)),
    *((node, 12, "TRIA3", [0.5 * node, 2.0, 0.0, 0.0, 8.0, 1.0]) for node in (2, 3, 5)),
    (2, 0, "*TOTALS*", [3.0, 0.5, 0.25, 3.0, 8.0, -6.0]),
]


def scaled(factor):
    """Force rows of another mode."""
    return [(node, element, kind, [factor * x for x in force]) for node, element, kind, force in ROWS]


def small(writer, modes=3):
    """Add a table nobody needs and a table of forces of some modes."""
    writer.table("GEOM1", [writer.ints(4501, 45, 1), writer.ints(65535, 65535, 65535)])
    blocks = []
    for mode in range(1, modes + 1):
        blocks += [
            writer.identification(2, 19, mode, 10, own=((2 * np.pi * mode) ** 2, mode)),
            writer.forces(scaled(mode)),
        ]
    writer.table("OGPFB1", blocks)
    return writer


def is_right(found, modes=3):
    """Whether all that was written was read."""
    force = np.array([force for _, _, _, force in ROWS])
    return (
        found.mode.tolist() == list(range(1, modes + 1))
        and [*zip(found.node.tolist(), found.element.tolist(), found.kind.tolist(), strict=True)]
        == [row[:3] for row in ROWS]
        and all(np.array_equal(block, mode * force) for mode, block in enumerate(found.force, start=1))
        and np.allclose(found.frequency, np.arange(1, modes + 1))
    )


def test_msc_2014_post_1():
    """A genuine file with version records of six words after label and table names: printed forces sum to 132000 N."""
    found = read_op2(GENUINE / "msc_2014_1_static.op2")
    assert np.abs(found.force).sum() == 132000.0
    assert (found.analysis, found.mode.tolist(), found.force.shape) == ("static", [1], (1, 33, 6))
    tables = [table.name for table in read_records(GENUINE / "msc_2014_1_static.op2").tables]
    assert tables[:2] == ["GEOM1", "GEOM2"]
    assert tables[-1] == "QUALINFO"
    assert found.solver == "XXXXXXXX 20141 0"


@pytest.mark.parametrize(("word", "order"), LAYOUTS)
@pytest.mark.parametrize("header", [True, False])
@pytest.mark.parametrize(
    "dialect",
    [
        PLAIN,
        MSC_2014,
        OPTISTRUCT,
        replace(MSC_2014, table_version=0),
        replace(MSC_2014, label_version=0),
        replace(MSC_2014, versioned=("OGPFB1",)),
        replace(MSC_2014, label_version=1, table_version=9),
        replace(OPTISTRUCT, label_version=6, table_version=6, jump=1000),
        Dialect(date=1),
        Dialect(date=0),
        Dialect(full_words=True, chunk=7),
    ],
)
def test_every_way_of_writing_is_read(tmp_path, word, order, header, dialect):
    """With and without header, date and version records; chunks of any size; numbers that jump; both long words."""
    path = tmp_path / "a.op2"
    path.write_bytes(small(Op2Writer(word, order, header, dialect)).close())
    assert is_right(read_op2(path))


def test_random_ways_of_writing_are_read(tmp_path):
    """Two hundred mixtures of them, none refused."""
    rng = random.Random(15)
    path = tmp_path / "a.op2"
    for _ in range(200):
        dialect = Dialect(
            date=rng.choice([0, 1, 3]),
            label_version=rng.choice([0, 1, 6, 9]),
            table_version=rng.choice([0, 1, 6, 30]),
            versioned=rng.choice([None, ("GEOM1",), ("OGPFB1",), ()]),
            chunk=rng.choice([1, 2, 3, 10, 13, 146, 1000]),
            jump=rng.choice([0, 1, 2, 50]),
            full_words=rng.random() < 0.5,
        )
        modes = rng.choice([1, 2, 5])
        writer = Op2Writer(*rng.choice(LAYOUTS), header=rng.random() < 0.7, dialect=dialect)
        path.write_bytes(small(writer, modes).close())
        assert is_right(read_op2(path), modes)


def test_chunks_of_one_row(tmp_path):
    """Thousands of equal chunks, the last one shorter or not, are joined in their order and stepped over at once."""
    rows = [(n, n, "QUAD4", [float(n), *[0.0] * 5]) for n in range(1, 5001)]
    path = tmp_path / "a.op2"
    for chunk in (10, 15, 4096):
        writer = Op2Writer(dialect=Dialect(chunk=chunk))
        writer.table("OGPFB1", [writer.identification(2, 19, 1, 10), writer.forces(rows)])
        path.write_bytes(writer.close())
        assert np.array_equal(read_op2(path).force[0, :, 0], np.arange(1, 5001))
        assert len(read_records(path).tables[0].records[1]) <= 2


def test_a_damaged_mark_among_equal_chunks_is_found(tmp_path):
    """Length marks and markers of every one of 300 rows of their own, one spoilt at a time."""
    rows = [(n, n, "QUAD4", [1.0] * 6) for n in range(1, 301)]
    writer = Op2Writer(dialect=OPTISTRUCT)
    writer.table("OGPFB1", [writer.identification(2, 19, 1, 10), writer.forces(rows)])
    data = writer.close()
    first = data.index(b"QUAD4") - 12
    path = tmp_path / "a.op2"
    for row, mark in product((0, 1, 17, 150, 298, 299), (-12, -8, -4, 0, 44)):
        spoilt = bytearray(data)
        spoilt[first + 60 * row + mark] ^= 2
        path.write_bytes(spoilt)
        with pytest.raises(DataError, match="cut or damaged"):
            read_op2(path)


@pytest.mark.parametrize(("word", "order", "dialect"), [(4, "<", MSC_2014), (4, ">", OPTISTRUCT), (8, "<", PLAIN)])
def test_a_file_cut_anywhere_is_refused_or_right(tmp_path, word, order, dialect):
    """At every byte: a refusal, or all forces where only the end mark is missing."""
    data = small(Op2Writer(word, order, dialect=dialect), modes=1).close()
    path = tmp_path / "a.op2"
    path.write_bytes(data)
    read = []
    for end in range(len(data) - 1, 0, -1):
        os.truncate(path, end)
        try:
            found = read_op2(path)
        except DataError:
            continue
        assert is_right(found, modes=1)
        assert [warning.code for warning in found.warnings] == ["no_end_mark"]
        read.append(len(data) - end)
    assert read == [word + 8]


def test_the_genuine_file_cut_or_spoilt(tmp_path):
    """Every 29th byte of the MSC file: cut there it is refused or doubted, with a bit flipped refused or read."""
    data = (GENUINE / "msc_2014_1_static.op2").read_bytes()
    path, cut = tmp_path / "a.op2", tmp_path / "cut.op2"
    cut.write_bytes(data)
    for at in range(len(data) - 1, 0, -29):
        os.truncate(cut, at)
        with suppress(DataError):
            assert read_op2(cut).warnings[-1].code == "no_end_mark"
        spoilt = bytearray(data)
        spoilt[at] ^= 1 << (at % 8)
        path.write_bytes(spoilt)
        with suppress(DataError):
            assert read_op2(path).force.shape[1:] == (33, 6)


def test_record_numbers_must_fall(tmp_path):
    """A record number that repeats the last one, or goes back, is damage."""
    writer = small(Op2Writer())
    data = writer.close()
    four = writer.ints(4)
    mark = four + writer.ints(-4) + four
    at = data.rindex(mark)
    path = tmp_path / "a.op2"
    for number in (-3, -2, 5):
        path.write_bytes(data[:at] + four + writer.ints(number) + four + data[at + 12 :])
        with pytest.raises(DataError, match=r"cut or damaged: .*marker|runs past|announced"):
            read_op2(path)


def test_a_run_appended_to_another(tmp_path):
    """Two runs in one file: the one that has forces is read, of two that have them neither."""
    path = tmp_path / "a.op2"
    other = Op2Writer()
    other.table("OUGV1", [other.identification(1, 1, 0, 8), other.shape([(1, [0.0] * 6)])])
    path.write_bytes(small(Op2Writer()).close() + other.close())
    assert is_right(read_op2(path))
    path.write_bytes(other.data + small(Op2Writer(dialect=MSC_2014)).close())
    assert is_right(read_op2(path))
    path.write_bytes(small(Op2Writer()).close() + small(Op2Writer()).close())
    with pytest.raises(DataError, match="holds 2 runs with grid point forces"):
        read_op2(path)
    path.write_bytes(small(Op2Writer()).close() + small(Op2Writer(header=False)).close())
    with pytest.raises(DataError, match="more than once, as superelements, restarts, appended runs"):
        read_op2(path)


def test_end_marks(tmp_path):
    """No end mark or several are as good as one; other bytes behind it are damage."""
    path = tmp_path / "a.op2"
    data = small(Op2Writer()).data
    zero = Op2Writer(header=False).close()
    for ends in range(4):
        path.write_bytes(data + ends * zero)
        assert is_right(read_op2(path))
        assert read_records(path).is_closed == (ends > 0)
    path.write_bytes(data + zero + b"\x04\0\0\0\x09\0\0\0\x04\0\0\0")
    with pytest.raises(DataError, match="12 bytes follow the end mark"):
        read_op2(path)


def test_damaged_records_never_crash(tmp_path):
    """Four hundred files of all dialects with bytes flipped, cut, doubled or moved: refused, or rows as written."""
    rng = random.Random(7)
    path = tmp_path / "a.op2"
    kinds = {"refused": 0, "nameless": 0, "read": 0}
    for _ in range(400):
        data = bytearray(
            small(Op2Writer(*rng.choice(LAYOUTS), dialect=rng.choice([PLAIN, MSC_2014, OPTISTRUCT]))).close()
        )
        at, size = rng.randrange(len(data)), rng.choice([1, 4, 12, 60, 400])
        match rng.randrange(4):
            case 0:
                data[at] ^= 1 << rng.randrange(8)
            case 1:
                del data[at : at + size]
            case 2:
                data[at:at] = data[at : at + size]
            case _:
                data[at : at + size] = bytes(rng.randrange(256) for _ in range(size))
        path.write_bytes(data)
        try:
            found = read_op2(path)
        except DataError as error:
            kinds["refused" if str(path) in str(error) else "nameless"] += 1
            continue
        kinds["read"] += 1
        assert np.isfinite(found.force[:, found.of_element]).all()
        assert found.force.shape[0] == found.mode.size
    assert kinds["nameless"] == 0
    assert min(kinds["refused"], kinds["read"]) > 20
