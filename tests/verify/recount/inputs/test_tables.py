"""Rows of neutral tables read anew, in pieces: the same rows whatever the file says of its row groups."""

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.verify.recount.inputs.tables import read_frame, read_pieces, read_rows_where

WELDS = ["a", "b ", "e\u0301", "z"]


def table():
    """Forty rows of four welds in turn, one name with a blank behind it and one of two letters."""
    rows = np.arange(40)
    return pa.table({"weld": [WELDS[k // 10] for k in rows], "node": rows // 2, "fx_N": rows * 0.5})


@pytest.mark.parametrize("statistics", [True, False, ["node"], ["weld"]], ids=str)
@pytest.mark.parametrize(
    ("key", "values", "rows"),
    [
        ("weld", ["a"], range(10)),
        ("weld", ["b", "z"], [*range(10, 20), *range(30, 40)]),
        ("weld", ["\u00e9"], range(20, 30)),
        ("weld", ["c"], []),
        ("node", [0, 5], [0, 1, 10, 11]),
        ("node", [19], [38, 39]),
        ("node", [20], []),
    ],
)
def test_rows_by_their_key(tmp_path, statistics, key, values, rows):
    """With least and greatest key in the file, of that column only, of another, or of none."""
    pq.write_table(table(), tmp_path / "t.parquet", row_group_size=7, write_statistics=statistics)
    whole = read_frame(tmp_path / "t.parquet")
    found = read_rows_where(tmp_path / "t.parquet", key, values)
    pd.testing.assert_frame_equal(found, whole.iloc[list(rows)].reset_index(drop=True))


def test_row_groups_that_surely_hold_none_are_not_read(tmp_path, monkeypatch):
    """By the least and the greatest node of a row group; its ends belong to it."""
    pq.write_table(table(), tmp_path / "t.parquet", row_group_size=10)
    read = []
    original = pq.ParquetFile.iter_batches

    def looked_into(file, size, groups, names):
        read.extend(groups)
        return original(file, size, groups, names)

    monkeypatch.setattr(pq.ParquetFile, "iter_batches", looked_into)
    for value, groups in ((0, [0]), (4, [0]), (5, [1]), (9, [1]), (19, [3]), (20, [])):
        read.clear()
        read_rows_where(tmp_path / "t.parquet", "node", [value])
        assert read == groups


def test_pieces_are_the_table(tmp_path):
    """One after the other, all columns or some, typed as the whole table is."""
    pq.write_table(table(), tmp_path / "t.parquet", row_group_size=7, write_statistics=False)
    whole = read_frame(tmp_path / "t.parquet")
    pieces = pd.concat([p for p in read_pieces(tmp_path / "t.parquet") if len(p)], ignore_index=True)
    pd.testing.assert_frame_equal(pieces, whole)
    some = pd.concat([p for p in read_pieces(tmp_path / "t.parquet", ["node"]) if len(p)], ignore_index=True)
    pd.testing.assert_frame_equal(some, whole[["node"]])


def test_a_letter_of_two_characters_among_plain_names(tmp_path):
    """The first and the last name of a row group do not tell that one between them is written decomposed."""
    names = pa.table({"weld": ["a", "e\u0301", "z", "z"], "node": [1, 2, 3, 4]})
    pq.write_table(names, tmp_path / "t.parquet", row_group_size=3)
    assert read_rows_where(tmp_path / "t.parquet", "weld", ["\u00e9"])["node"].tolist() == [2]
