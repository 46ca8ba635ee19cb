"""Forces in pieces: sorted or not, Parquet or CSV, a group of welds gets its rows, numbered as in the file."""

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.readers import force_pieces
from fatigue.readers.force_pieces import ForcePieces

GROUPS = (("A", "B"), ("C",), ("D", "E"))


def forces(rows=60, seed=0, shuffled=False):
    """Rows of five welds; fx_N tells the row's place in the file."""
    rng = np.random.default_rng(seed)
    weld = np.sort(rng.choice(list("ABCDE"), rows))
    if shuffled:
        rng.shuffle(weld)
    return pd.DataFrame({"weld": weld, "node": rng.integers(1, 9, rows), "fx_N": np.arange(rows, dtype=float)})


def pieces_of(path, scratch):
    """Read every group: welds, row numbers, values."""
    pieces = ForcePieces(path, GROUPS, scratch)
    for welds, i in zip(GROUPS, range(len(GROUPS)), strict=True):
        table = pieces.table(i)
        names, code = table.groups("weld")
        value = table.numbers("fx_N")
        where = [int(table.where("fx_N", row).rsplit(" ", 1)[1]) for row in range(table.rows)]
        yield welds, [names[c] for c in code], value, where


@settings(deadline=None, max_examples=25)
@given(
    seed=st.integers(0, 999),
    shuffled=st.booleans(),
    suffix=st.sampled_from(["parquet", "csv"]),
    at_once=st.sampled_from([8, 20, 10_000]),
)
def test_every_row_comes_once_with_its_number(tmp_path_factory, seed, shuffled, suffix, at_once):
    """All rows of a group and no others, whatever the order, the format and the room."""
    tmp_path = tmp_path_factory.mktemp("pieces")
    table = forces(seed=seed, shuffled=shuffled)
    path = tmp_path / f"forces.{suffix}"
    table.to_csv(path, index=False) if suffix == "csv" else table.to_parquet(path, index=False, row_group_size=7)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(force_pieces, "ROWS_AT_ONCE", at_once)
        for welds, names, value, where in pieces_of(path, tmp_path / "scratch"):
            wanted = table[table.weld.isin(welds)]
            assert sorted(value) == wanted.fx_N.tolist()
            assert [n for _, n in sorted(zip(value, names, strict=True))] == wanted.weld.tolist()
            assert where == [int(v) + 1 for v in value]


def test_a_sorted_file_is_not_copied(tmp_path):
    """Sorted by weld: read from where it is."""
    forces().to_parquet(tmp_path / "f.parquet", index=False, row_group_size=10)
    list(pieces_of(tmp_path / "f.parquet", tmp_path / "scratch"))
    assert not (tmp_path / "scratch").exists()


def test_an_unsorted_file_that_does_not_fit_is_sorted_on_disk(tmp_path, monkeypatch):
    """More rows than may be decoded at once: one sorted copy, nothing else left."""
    monkeypatch.setattr(force_pieces, "ROWS_AT_ONCE", 16)
    forces(shuffled=True).to_parquet(tmp_path / "f.parquet", index=False, row_group_size=5)
    list(pieces_of(tmp_path / "f.parquet", tmp_path / "scratch"))
    assert [p.name for p in (tmp_path / "scratch").iterdir()] == ["forces-by-weld.parquet"]
    assert pq.ParquetFile(tmp_path / "scratch" / "forces-by-weld.parquet").metadata.num_rows == 60


def test_tables_can_be_asked_for_again(tmp_path):
    """First pass to check, second to use."""
    forces().to_parquet(tmp_path / "f.parquet", index=False, row_group_size=10)
    pieces = ForcePieces(tmp_path / "f.parquet", GROUPS, tmp_path / "scratch")
    first = [pieces.table(i).numbers("fx_N").tolist() for i in range(3)]
    assert [pieces.table(i).numbers("fx_N").tolist() for i in range(3)] == first


@pytest.mark.parametrize("suffix", ["parquet", "csv"])
def test_an_unknown_weld_is_refused_with_its_row(tmp_path, suffix):
    """A name in no group: file, row, value."""
    table = forces()
    table.loc[41, "weld"] = "F"
    path = tmp_path / f"f.{suffix}"
    table.to_csv(path, index=False) if suffix == "csv" else table.to_parquet(path, index=False, row_group_size=9)
    with pytest.raises(DataError, match=rf"f\.{suffix}: column weld, row 42: 'F' is not one of the welds"):
        ForcePieces(path, GROUPS, tmp_path / "scratch")
