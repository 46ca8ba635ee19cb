"""Damage that leaves a file readable and takes something away: found by the fuzz, each told in one line."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_coordinates, read_forces, read_model
from fatigue.readers.neutral.register.register_file import open_register
from fatigue.results import read_table
from fatigue.results.tables import schema
from tests.fuzz.sources import punch, small_run
from tests.readers.foreign.histories.test_foreign_history import MCF

HEAD = "weld,line,status,reason,description"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time;q_1;q_2\n0,0;\u20131;2,0\n0,1;1;2\n0,2;1;3\n", "line 2: '\u20131' stands in a row of values"),
        ("time,q_1,q_2\n0,x,2\n0.1,1,2\n0.2,1,3\n", "line 2: 'x' stands in a row of values"),
        (
            "run 1\ntime\tq_1\tq_2\n0\t1\t2\t0.1\t1\t2\n0.2\t1\t3\n0.3\t1\t3\n",
            "line 3: a row of 6 cells in a table of 3",
        ),
    ],
)
def test_the_first_rows_of_a_history_are_not_taken_for_its_header(tmp_path, text, message):
    """A word among the numbers or a lost line end does not cost a sample in silence."""
    path = tmp_path / "q.txt"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(DataError, match=r", line \d: ") as refusal:
        read_coordinates(path, None, None)
    assert message in str(refusal.value)


def test_a_header_line_of_an_mcf_that_is_not_understood(tmp_path):
    """Frequencies under a damaged name are not lost without a word."""
    path = tmp_path / "q.mcf"
    path.write_text(MCF.replace("Frequency:", "Frxquency:"))
    found = read_coordinates(path, None, None)
    assert np.isnan(found.frequency).all()
    assert [remark.code for remark in found.remarks] == ["unread_line"] * 2
    path.write_text(MCF)
    assert not read_coordinates(path, None, None).remarks


@pytest.mark.parametrize("heading", ["$GRID POINT FORCE BA ANCE", "$LABEL   = $GRID POINT FORCE BALANCE", "$"])
def test_force_rows_under_a_damaged_heading(tmp_path, heading):
    """The second mode of three is not left out in silence."""
    text = punch(small_run()).decode()
    first, second = text.split("$GRID POINT FORCE BALANCE", 1)
    path = tmp_path / "run.pch"
    path.write_text(text)
    assert read_forces(path, None).mode.tolist() == [1, 2, 3]
    path.write_text(first + "$GRID POINT FORCE BALANCE" + second.replace("$GRID POINT FORCE BALANCE", heading, 1))
    with pytest.raises(DataError, match="a row of forces stands in a block that does not begin with"):
        read_forces(path, None)


def test_a_register_whose_first_row_became_part_of_its_names(tmp_path):
    """A lost line end does not cost a weld."""
    path = tmp_path / "welds_register.csv"
    path.write_text(f"{HEAD}roof,T-1,assess,,seam\nwall,T-2,assess,,seam\n")
    with pytest.raises(DataError, match="9 names in the line of names, and at most 5 cells in the rows"):
        open_register(path, strict=False)
    path.write_text(f"{HEAD},,\nroof,T-1,assess,,seam\n")
    assert [row.key for row in open_register(path, strict=False).rows] == ["T-1"]


def test_a_result_table_without_one_of_its_columns(tmp_path):
    """A damaged name of a column is a damaged table, not a crash of whoever asks for it."""
    plain = schema("nodes")
    columns = {f.name: pa.array([None], f.type) for f in plain if f.name != "life_km"}
    pq.write_table(pa.table(columns), tmp_path / "nodes.parquet")
    for asked in (None, ["weld", "life_km"]):
        with pytest.raises(DataError, match=r"nodes\.parquet: the table cannot be read .*life_km"):
            read_table(tmp_path, "nodes", asked)


def test_elements_of_an_hdf5_model_that_are_no_table(tmp_path):
    """Shells do not go unseen where their table is damaged, and what is left out is told."""
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "m.h5"
    path.write_bytes(Path("data/nastran/modes_elements.h5").read_bytes())
    assert "5 'CQUAD4'" not in str(read_model(path).remarks)
    with h5py.File(path, "r+") as file:
        file.move("NASTRAN/INPUT/ELEMENT/CQUAD4", "NASTRAN/INPUT/ELEMENT/CQUAD6")
    assert "5 'CQUAD6'" in str(read_model(path).remarks)
    with h5py.File(path, "r+") as file:
        file.create_group("NASTRAN/INPUT/ELEMENT/CQUAD4")
    with pytest.raises(DataError, match="CQUAD4 is no table"):
        read_model(path)
