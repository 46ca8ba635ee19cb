"""Forces by group: sorted or not, Parquet or CSV, a group of welds gets its rows, numbered as in the file."""

import gzip
import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.readers.neutral.forces import by_group as module
from fatigue.readers.neutral.forces import sorted_copy
from fatigue.readers.neutral.forces.by_group import ForcesByGroup

GROUPS = (("A", "B"), ("C",), ("D", "E"))


def forces(rows=60, seed=0, shuffled=False):
    """Rows of five welds; fx_N tells the row's place in the file."""
    rng = np.random.default_rng(seed)
    weld = np.sort(rng.choice(list("ABCDE"), rows))
    if shuffled:
        rng.shuffle(weld)
    return pd.DataFrame({"weld": weld, "node": rng.integers(1, 9, rows), "fx_N": np.arange(rows, dtype=float)})


def groups_of(path, scratch):
    """Read every group: welds, row numbers, values."""
    by_group = ForcesByGroup(path, GROUPS, scratch)
    for welds, i in zip(GROUPS, range(len(GROUPS)), strict=True):
        table = by_group.table(i)
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
        patch.setattr(module, "ROWS_KEPT", at_once)
        for welds, names, value, where in groups_of(path, tmp_path / "scratch"):
            wanted = table[table.weld.isin(welds)]
            assert sorted(value) == wanted.fx_N.tolist()
            assert [n for _, n in sorted(zip(value, names, strict=True))] == wanted.weld.tolist()
            assert where == [int(v) + 1 for v in value]


def test_a_sorted_file_is_not_copied(tmp_path):
    """Sorted by weld: read from where it is."""
    forces().to_parquet(tmp_path / "f.parquet", index=False, row_group_size=10)
    list(groups_of(tmp_path / "f.parquet", tmp_path / "scratch"))
    assert not (tmp_path / "scratch").exists()


def test_an_unsorted_file_that_does_not_fit_is_sorted_on_disk(tmp_path, monkeypatch):
    """More rows than may be decoded at once: a parted copy, small parts of the file in each."""
    monkeypatch.setattr(sorted_copy, "ROWS_OF_BUCKET", 21)
    monkeypatch.setattr(module, "ROWS_KEPT", 16)
    forces(shuffled=True).to_parquet(tmp_path / "f.parquet", index=False, row_group_size=5)
    list(groups_of(tmp_path / "f.parquet", tmp_path / "scratch"))
    buckets = [pa.ipc.open_file(path).read_all().num_rows for path in (tmp_path / "scratch").iterdir()]
    assert len(buckets) == 3
    assert sum(buckets) == 60


def test_tables_can_be_asked_for_again(tmp_path):
    """First pass to check, second to use."""
    forces().to_parquet(tmp_path / "f.parquet", index=False, row_group_size=10)
    by_group = ForcesByGroup(tmp_path / "f.parquet", GROUPS, tmp_path / "scratch")
    first = [by_group.table(i).numbers("fx_N").tolist() for i in range(3)]
    assert [by_group.table(i).numbers("fx_N").tolist() for i in range(3)] == first


@pytest.mark.parametrize("suffix", ["parquet", "csv"])
def test_an_unknown_weld_is_refused_with_its_row(tmp_path, suffix):
    """A name in no group: file, row, value."""
    table = forces()
    table.loc[41, "weld"] = "F"
    path = tmp_path / f"f.{suffix}"
    table.to_csv(path, index=False) if suffix == "csv" else table.to_parquet(path, index=False, row_group_size=9)
    with pytest.raises(DataError, match=rf"f\.{suffix}: column weld, row 42: 'F' is not one of the welds"):
        ForcesByGroup(path, GROUPS, tmp_path / "scratch")


def test_a_group_without_rows_is_an_empty_table(tmp_path):
    """Its gaps are told by whoever knows its nodes."""
    table = forces()
    for suffix in ("parquet", "csv"):
        path = tmp_path / f"f.{suffix}"
        rest = table[table.weld != "C"]
        rest.to_csv(path, index=False) if suffix == "csv" else rest.to_parquet(path, index=False)
        empty = ForcesByGroup(path, GROUPS, tmp_path / suffix).table(1)
        assert (empty.rows, empty.numbers("fx_N").size, empty.groups("weld")[1].size) == (0, 0, 0)


@pytest.fixture
def small_groups(tmp_path, monkeypatch):
    """Forty groups of ten rows in row groups of 64, of which three fit, and the list of those decoded."""
    welds = [f"W{i:02d}" for i in range(40)]
    table = pd.DataFrame({"weld": np.repeat(welds, 10), "node": 1, "fx_N": np.arange(400.0)})
    table.to_parquet(tmp_path / "f.parquet", index=False, row_group_size=64)
    monkeypatch.setattr(module, "ROWS_KEPT", 200)
    by_group = ForcesByGroup(tmp_path / "f.parquet", [(weld,) for weld in welds], tmp_path / "scratch")
    source, decoded = by_group._source, []
    monkeypatch.setattr(by_group, "_source", replace(source, read=lambda i: decoded.append(i) or source.read(i)))
    return by_group, decoded


def values_of(by_group, group):
    """Values of a group's rows."""
    return by_group.table(group).numbers("fx_N").tolist()


def test_groups_asked_for_nearly_in_order_decode_every_row_group_once(small_groups):
    """Several groups share a row group; those asked for are up to six apart."""
    by_group, decoded = small_groups
    order = [first + i for first in range(0, 40, 5) for i in (3, 0, 4, 1, 2)]
    for group in order:
        assert values_of(by_group, group) == list(range(10 * group, 10 * group + 10))
        assert sum(by_group._source.rows[i] for i in by_group._decoded) <= 200
    assert sorted(decoded) == list(range(7))
    assert values_of(by_group, 0) == list(range(10))  # and any group at any time


def test_a_piece_is_dropped_when_all_its_groups_have_been_asked_for(small_groups):
    """Groups asked for in turn: one piece in memory, and none at the end."""
    by_group, decoded = small_groups
    for group in range(40):
        assert values_of(by_group, group) == list(range(10 * group, 10 * group + 10))
        assert len(by_group._decoded) <= 1
    assert not by_group._decoded
    assert decoded == list(range(7))


def test_threads_share_what_is_decoded(small_groups):
    """Each thread gets the rows of the group it asks for."""
    by_group, _ = small_groups
    with ThreadPoolExecutor(6) as pool:
        values = list(pool.map(lambda group: values_of(by_group, group), [*range(40), *range(39, -1, -1)]))
    once = [list(range(10 * i, 10 * i + 10)) for i in range(40)]
    assert values == once + once[::-1]


def test_a_row_group_too_large_is_parted(tmp_path, monkeypatch):
    """A sorted file in one row group is copied into parts that fit."""
    monkeypatch.setattr(module, "ROWS_KEPT", 30)
    forces().to_parquet(tmp_path / "f.parquet", index=False)
    list(groups_of(tmp_path / "f.parquet", tmp_path / "scratch"))
    assert (tmp_path / "scratch").exists()


@pytest.mark.parametrize("name", ["node", "fx_N"])
def test_a_csv_file_of_unusual_types_is_read_all_the_same(tmp_path, name):
    """Whole numbers written as 1.0, and texts, which are refused with their row."""
    table = forces()
    table["node"] = table.node.astype(float)
    table.to_csv(tmp_path / "f.csv", index=False)
    by_group = ForcesByGroup(tmp_path / "f.csv", GROUPS, tmp_path / "scratch")
    assert sorted(np.concatenate([by_group.table(i).integers("node") for i in range(3)])) == sorted(table.node)
    table[name] = table[name].astype(object)
    table.loc[table.weld[table.weld == "C"].index[0], name] = "x"
    table.to_csv(tmp_path / "f.csv", index=False)
    spoilt = ForcesByGroup(tmp_path / "f.csv", GROUPS, tmp_path / "again").table(1)
    spoilt.numbers(name)
    assert str(spoilt.problems[0]).startswith(f"f.csv: column {name}, row {(table.weld < 'C').sum() + 1}: 'x' is not")


def test_welds_may_be_numbers(tmp_path):
    """Names that look like numbers are names."""
    table = pd.DataFrame({"weld": [1, 1, 2, 3], "node": [1, 2, 1, 1], "fx_N": [0.0, 1.0, 2.0, 3.0]})
    for suffix in ("parquet", "csv"):
        path = tmp_path / f"f.{suffix}"
        table.to_csv(path, index=False) if suffix == "csv" else table.to_parquet(path, index=False)
        by_group = ForcesByGroup(path, (("3", "1"), ("2",)), tmp_path / suffix)
        assert by_group.table(0).texts("weld") == ["1", "1", "3"]
        assert by_group.table(0).numbers("fx_N").tolist() == [0.0, 1.0, 3.0]


def test_a_damaged_row_group_is_refused(tmp_path):
    """A file whose bytes are spoilt beyond the footer is told as damaged, not as a failure of the program."""
    path = tmp_path / "f.parquet"
    forces(rows=3000).to_parquet(path, index=False, compression="zstd")
    content = bytearray(path.read_bytes())
    content[100:4000] = bytes(3900)
    path.write_bytes(content)
    with pytest.raises(DataError, match=r"f\.parquet: cannot be read as Parquet"):
        list(groups_of(path, tmp_path / "scratch"))


def test_many_unknown_welds_are_told_by_name(tmp_path):
    """Every name once, with its first row; missing names are counted."""
    table = forces()
    table.loc[[3, 7], "weld"] = "X"
    table.loc[[5], "weld"] = "Y"
    table.loc[[50, 51], "weld"] = None
    table.to_parquet(tmp_path / "f.parquet", index=False, row_group_size=9)
    with pytest.raises(DataError) as refusal:
        ForcesByGroup(tmp_path / "f.parquet", GROUPS, tmp_path / "scratch")
    assert [str(problem).split(". ")[0] for problem in refusal.value.problems] == [
        "f.parquet: column weld, row 51: the text is missing (and 1 more row)",
        "f.parquet: column weld, row 4: 'X' is not one of the welds",
        "f.parquet: column weld, row 6: 'Y' is not one of the welds",
    ]


@pytest.mark.parametrize("index", [True, False])
@pytest.mark.parametrize("suffix", ["parquet", "csv"])
def test_columns_without_a_name(tmp_path, index, suffix):
    """An index is told in every piece; empty columns, as spreadsheets leave them, are nothing."""
    table = forces()
    table.insert(0, "", np.arange(60) if index else None)
    path = tmp_path / f"forces.{suffix}"
    table.to_csv(path, index=False) if suffix == "csv" else table.to_parquet(path, index=False, row_group_size=7)
    piece = ForcesByGroup(path, GROUPS, tmp_path / "scratch").table(1)
    piece.expect(("weld", "node", "fx_N"), (), strict=False)
    assert [warning.code for warning in piece.warnings] == (["unknown_column"] if index else [])
    assert piece.numbers("fx_N").tolist() == table[table.weld == "C"].fx_N.tolist()


def test_a_packed_file_is_named(tmp_path):
    """Bytes of another format under the name of a CSV file are told as what they are."""
    path = tmp_path / "forces.csv"
    path.write_bytes(gzip.compress(forces().to_csv(index=False).encode()))
    with pytest.raises(DataError, match=r"forces\.csv: this is a gzip archive"):
        ForcesByGroup(path, GROUPS, tmp_path / "scratch")


@pytest.mark.parametrize("shuffled", [False, True])
def test_a_row_of_units_is_compared_where_forces_are_dealt_out(tmp_path, shuffled):
    """Units of the names pass, others are refused before a row is read."""
    for unit, problem in (("N", None), ("kN", "f.csv: column fx_N, row of units: the unit is kN")):
        names, *rows = forces(shuffled=shuffled).to_csv(index=False).splitlines()
        (tmp_path / "f.csv").write_text("\n".join([names, f",,{unit}", *rows]))
        if problem is None:
            assert sum(len(value) for *_, value, _ in groups_of(tmp_path / "f.csv", tmp_path / unit)) == len(rows)
            continue
        with pytest.raises(DataError, match=re.escape(problem)):
            list(groups_of(tmp_path / "f.csv", tmp_path / unit))


def test_units_in_the_metadata_of_forces(tmp_path):
    """What a Parquet file says of its columns beside their names has to agree with them, however it is read."""
    columns = {name: pa.array(values) for name, values in forces().items()}
    for unit, agrees in (("N", True), ("kN", False)):
        stated = {name: {"unit": unit if name == "fx_N" else ""} for name in columns}
        fields = [pa.field(name, columns[name].type, metadata=stated[name]) for name in columns]
        pq.write_table(pa.table(list(columns.values()), pa.schema(fields)), tmp_path / "f.parquet")
        if agrees:
            assert len(list(groups_of(tmp_path / "f.parquet", tmp_path / unit))) == len(GROUPS)
            continue
        with pytest.raises(DataError, match=r"f\.parquet: column fx_N: the unit is kN, and the column is one of N"):
            list(groups_of(tmp_path / "f.parquet", tmp_path / unit))


@pytest.mark.parametrize("shuffled", [False, True])
def test_warnings_about_the_file_reach_every_piece(tmp_path, shuffled):
    """A unit that nothing uses and a letter that is not UTF-8 are told also where rows are dealt out in batches."""
    table = forces(shuffled=shuffled).assign(weld=lambda t: t.weld.replace("E", "É"))
    names, *rows = table.to_csv(index=False).splitlines()
    (tmp_path / "f.csv").write_text("\n".join([names, "-,kg,N", *rows]), encoding="cp1252")
    by_group = ForcesByGroup(tmp_path / "f.csv", (("A", "B"), ("C",), ("D", "É")), tmp_path / "scratch")
    for group in range(3):
        said = [str(warning) for warning in by_group.table(group).warnings]
        assert said[0] == ("f.csv: column node, row of units: the unit kg is not used. Remove it, or check the values.")
        assert "is read as Windows-1252, where it is 'É'" in said[1]
        assert len(said) == 2
