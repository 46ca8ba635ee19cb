"""Blocks of OP2 tables: whose results they are, data in several records, and tables nobody needs."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.results.op2 import read_op2
from tests.readers.foreign.nastran.results.test_op2 import one_mode, read_back
from tests.readers.op2_writer import Op2Writer

SUBTITLE = "a subtitle".ljust(99)


@pytest.mark.parametrize(
    ("label", "superelement"),
    [
        ("CAR BODY, SUPERELEMENT 5 AS SHELLS", None),
        ("SUPERELEMENTS 3 AND 4", None),
        ("SUPERELEMENT 30", 30),
        ("T".ljust(128) + SUBTITLE + "SUPERELEMENT 0       ,   1", None),
        ("T".ljust(128) + SUBTITLE + "SUPERELEMENT 7       ,   1", 7),
        ("SUPERELEMENT 5 IN THE TITLE".ljust(128) + SUBTITLE + "SUPERELEMENT 0", None),
        ("T".ljust(128) + "S".ljust(128) + "WITH SUPERELEMENT 9", None),
        ("\x00\xe9\xff\x01 caisse n\xb0 4 \x80", None),
    ],
)
@pytest.mark.parametrize("word", [4, 8])
def test_superelements_are_told_from_titles(tmp_path, word, label, superelement):
    """The number behind the subtitle says whose results these are; the words of the user's titles say nothing."""
    path = tmp_path / "a.op2"
    writer = Op2Writer(word)
    one_mode(writer, label=label)
    path.write_bytes(writer.close())
    if superelement is None:
        assert read_op2(path).mode.tolist() == [1]
    else:
        with pytest.raises(DataError, match=f"belong to a superelement: {superelement}"):
            read_op2(path)


def test_superelements_beside_the_residual_structure(tmp_path):
    """The residual structure is read, and a warning says that superelements are left out."""
    label = "T".ljust(128) + SUBTITLE + "SUPERELEMENT {}"
    tables = [lambda w, s=s: one_mode(w, label=label.format(s)) for s in (0, 10, 20)]
    found = read_back(tmp_path / "a.op2", *tables)
    assert found.force.shape == (1, 1, 6)
    assert found.warnings[0].what.startswith("2 blocks of superelements are left out")


def test_shapes_and_eigenvalues_of_superelements_are_not_those_of_the_residual_structure(tmp_path):
    """Blocks of superelements behind those of the residual structure have the same subcase and mode."""
    label = "T".ljust(128) + SUBTITLE + "SUPERELEMENT 10"

    def both(writer):
        blocks = []
        for grid, eigenvalue, text in ((1, 400.0, ""), (7, 900.0, label)):
            head = writer.identification(2, 7, 1, 8, eigenvalue=eigenvalue, label=text)
            blocks += [head, writer.shape([(grid, [1.0] * 6)])]
        writer.table("OUGV1", blocks)

    found = read_back(tmp_path / "a.op2", one_mode, both)
    assert found.shape_node.tolist() == [1]
    assert found.frequency == pytest.approx([20 / (2 * np.pi)])


def test_tables_nobody_needs_are_never_a_reason_to_refuse(tmp_path):
    """Odd numbers of records, unknown codes, temperatures, velocities, SORT2, short and empty records, other forces."""

    def others(w):
        w.table("GEOM2", [w.ints(1, 2, 3)])
        w.table("OUGV2", [w.identification(2, 2007, 11, 8), w.ints(1, 2, 3), w.ints(4)])
        w.table("OUGV1", [w.identification(1, 1, 0, 8, thermal=1), w.ints(1, 2, 3)])
        w.table("OUGV1", [w.identification(6, 10, 0, 8), w.ints(1, 2, 3)])
        w.table("OUGV1", [w.identification(2, 11, 1, 14), w.ints(1)])
        w.table("BOUGV1", [w.ints(1), w.ints(2), w.ints(3)])
        w.table("OQG1", [b"", w.ints(5)])
        w.table("RAGCONS", [w.identification(2, 19, 1, 10), w.ints(1)])
        w.table("OGPFB2", [w.identification(2, 2019, 1, 10), w.ints(1)])
        w.table("CLAMA", [w.identification(9, 9, 0, 6), w.ints(1)])
        w.table("", [])

    assert read_back(tmp_path / "a.op2", others, one_mode, others).mode.tolist() == [1]


@pytest.mark.parametrize("name", ["OUGV1", "OUG1", "LAMA", "OGPFB1", "OQG1"])
def test_tables_without_records_hold_nothing(tmp_path, name):
    """Beside forces they do not matter; alone they are no forces."""
    found = read_back(tmp_path / "a.op2", one_mode, lambda writer: writer.table(name, []))
    assert found.force.shape == (1, 1, 6)
    with pytest.raises(DataError, match=f"no grid point forces .*tables found: {name}"):
        read_back(tmp_path / "b.op2", lambda writer: writer.table(name, []))


def test_data_in_several_records(tmp_path):
    """The rows of a mode may be cut into several records behind one identification."""
    rows = [(n, n, "QUAD4", [float(n)] * 6) for n in range(1, 8)]

    def table(w):
        parts = [w.forces(rows[:3]), w.forces(rows[3:4]), w.forces(rows[4:])]
        w.table("OGPFB1", [w.identification(2, 19, 1, 10), *parts, w.identification(2, 19, 2, 10), w.forces(rows)])

    found = read_back(tmp_path / "a.op2", table)
    assert found.force[:, :, 0].tolist() == [[1, 2, 3, 4, 5, 6, 7]] * 2
