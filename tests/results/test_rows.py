"""Rows of a table read row group by row group are those of the whole table."""

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.results import (
    TABLES,
    number_groups,
    read_codes,
    read_rows,
    read_table,
    row_count,
    row_groups,
    rows_of_welds,
    table_writer,
    tables,
    worst_toes,
)

ROWS, WELDS = 1000, ["W7", "a", "Z", "שלום"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Table of nodes of 1000 rows in row groups of 64, welds in runs that end anywhere; one event is missing."""
    folder = tmp_path_factory.mktemp("parts")
    rng = np.random.default_rng(2)
    value = {
        "text": np.array(["x", "y", None], dtype=object)[np.arange(ROWS) % 3],
        "int": np.arange(ROWS),
        "flag": np.arange(ROWS) % 5 > 0,
        "float": np.round(rng.normal(size=ROWS), 1),
    }
    rows = {c.name: value[c.type] for c in TABLES["nodes"]}
    rows["weld"] = np.repeat(WELDS, [130, 70, 500, 300])
    rows["screened"] = np.array(["", "modal bound", ""], dtype=object)[np.arange(ROWS) % 3]
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(tables._ROWS_PER_GROUP, "nodes", 64)
        with table_writer(folder, "nodes") as writer:
            for first in range(0, ROWS, 90):
                writer.write({name: values[first : first + 90] for name, values in rows.items()})
    return folder


@pytest.fixture(scope="module")
def whole(folder):
    """The table as pandas reads it."""
    return pd.read_parquet(folder / "nodes.parquet")


@settings(deadline=None, max_examples=30)
@given(st.lists(st.integers(0, ROWS - 1), max_size=60))
def test_rows_come_in_the_order_asked_for(folder, whole, rows):
    """Any rows, repeated ones too, from any row groups."""
    found = read_rows(folder, "nodes", np.array(rows, dtype=np.int64)).to_pandas()
    pd.testing.assert_frame_equal(found, whole.iloc[rows].reset_index(drop=True), check_dtype=bool(rows))


def test_only_some_columns(folder, whole):
    """Columns that nobody wants are not read."""
    found = read_rows(folder, "nodes", np.array([999, 3]), ["weld", "node"]).to_pandas()
    assert list(found.columns) == ["weld", "node"]
    assert found.to_numpy().tolist() == whole.loc[[999, 3], ["weld", "node"]].to_numpy().tolist()


def test_rows_of_welds(folder, whole):
    """All rows of each weld, also of one that begins and ends within row groups; none of one that is not there."""
    found = rows_of_welds(folder, "nodes", ["Z", "שלום", "nowhere"])
    assert set(found) == {"Z", "שלום", "nowhere"}
    for weld, rows in found.items():
        assert rows.tolist() == np.flatnonzero(whole["weld"] == weld).tolist()


def test_row_groups_are_the_table(folder, whole):
    """One after the other, texts as texts."""
    pieces = [piece.to_pandas() for piece in row_groups(folder, "nodes")]
    assert len(pieces) == 16
    pd.testing.assert_frame_equal(pd.concat(pieces, ignore_index=True), whole)


def test_an_empty_table_has_one_empty_piece(tmp_path):
    """Its columns are known all the same."""
    with table_writer(tmp_path, "cycles"):
        pass
    (piece,) = row_groups(tmp_path, "cycles")
    assert (piece.num_rows, piece.column_names) == (0, [c.name for c in TABLES["cycles"]])


def test_codes_of_texts(folder, whole):
    """Codes lead to the texts, a missing one is -1."""
    codes, texts = read_codes(folder, "nodes", "governing_event")
    assert [texts[code] if code >= 0 else None for code in codes] == [
        None if pd.isna(text) else text for text in whole["governing_event"]
    ]


@pytest.mark.parametrize("welds", [(), ("a", "Z")])
def test_worst_toes(folder, whole, welds):
    """By utilisation, of equal ones the first; faces without a toe and points that were not counted left out."""
    points = whole[whole["toe"] & (whole["screened"] == "") & (whole["weld"].isin(welds) if welds else True)]
    expected = points.sort_values("utilisation", ascending=False, kind="stable").index[:25]
    assert worst_toes(folder, 25, welds).tolist() == expected.tolist()


def test_columns_as_numbers(folder, whole):
    """Numbers and flags as they are, of a text its place among those that are known."""
    known = {"weld": ["Z", "a"], "governing_event": ["y", "x"]}
    pieces = list(number_groups(folder, "nodes", ["node", "toe", "life_km"], known))
    assert len(pieces) == 16
    found = {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}
    for name in ("node", "toe", "life_km"):
        assert found[name].tolist() == whole[name].tolist()
    for name, texts in known.items():
        expected = [texts.index(text) if text in texts else -1 for text in whole[name]]
        assert found[name].tolist() == expected


def test_row_count(folder, whole):
    """Known without reading a row."""
    assert row_count(folder, "nodes") == len(whole)


@pytest.mark.parametrize("gone", ["weld", "order"])
def test_a_table_without_a_column_is_damaged(tmp_path, whole, gone):
    """Of texts or of numbers: the column is named."""
    whole.drop(columns=gone).to_parquet(tmp_path / "nodes.parquet")
    for read in (
        lambda: list(number_groups(tmp_path, "nodes", ["order"], {"weld": WELDS})),
        lambda: read_rows(tmp_path, "nodes", np.array([0]), ["weld", "order"]),
    ):
        with pytest.raises(DataError, match=rf"nodes\.parquet: the table cannot be read \(it has no column {gone}\)"):
            read()


def test_a_missing_or_damaged_table_is_named(tmp_path, folder):
    """The same words as for a whole table."""
    for read in (
        lambda: rows_of_welds(tmp_path, "nodes", ["A"]),
        lambda: read_rows(tmp_path, "nodes", np.array([0])),
        lambda: read_table(tmp_path, "nodes"),
    ):
        with pytest.raises(DataError, match=r"nodes\.parquet: no such result table"):
            read()
    (tmp_path / "nodes.parquet").write_bytes((folder / "nodes.parquet").read_bytes()[:-20])
    with pytest.raises(DataError, match="the table cannot be read"):
        read_codes(tmp_path, "nodes", "weld")


def test_a_table_without_statistics_is_read_as_a_whole(folder, whole, tmp_path):
    """A file that another program wrote again says nothing of its row groups: every one is looked into."""
    pq.write_table(
        pq.read_table(folder / "nodes.parquet"), tmp_path / "nodes.parquet", row_group_size=64, write_statistics=False
    )
    found = rows_of_welds(tmp_path, "nodes", ["Z", "nowhere"])
    assert found["Z"].tolist() == np.flatnonzero(whole["weld"] == "Z").tolist()
    assert found["nowhere"].tolist() == []


def test_only_row_groups_that_may_hold_a_weld_are_read(folder, whole, monkeypatch):
    """Of 16 row groups those between whose first and last name the weld lies, and no other."""
    read = []
    original = pq.ParquetFile.read_row_group

    def looked_into(file, number, columns):
        read.append(number)
        return original(file, number, columns)

    monkeypatch.setattr(pq.ParquetFile, "read_row_group", looked_into)
    rows_of_welds(folder, "nodes", ["a"])
    groups = whole["weld"].groupby(np.arange(ROWS) // 64)
    assert read == [n for n, names in groups if names.min() <= "a" <= names.max()] != [*range(16)]
