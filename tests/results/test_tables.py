"""Result tables: data dictionary, values that come back as they were, and what happens when a table is damaged."""

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.results import tables
from fatigue.results.columns import ASSESSED, TABLES
from fatigue.results.tables import coded, read_table, schema, table_writer


def rows(table, n=3):
    """Rows of a table with plausible values of every type."""
    value = {"text": ["<script>"] * n, "int": list(range(n)), "flag": [True] * n, "float": [1.5, np.inf, np.nan][:n]}
    return {c.name: value[c.type] for c in TABLES[table]}


@pytest.mark.parametrize("table", sorted(TABLES))
def test_every_column_has_unit_and_meaning(table):
    """Units in the name and in the metadata agree."""
    suffix = {"_mm": "mm", "_km": "km", "_MPa": "MPa", "_s": "s", "_years": "a"}
    for column in TABLES[table]:
        assert column.meaning
        for end, unit in suffix.items():
            if column.name.endswith(end) and not column.name.endswith(("_per_km", "_per_1e6_km", "_per_s")):
                assert column.unit == unit, column.name
    assert len({c.name for c in TABLES[table]}) == len(TABLES[table])


@pytest.mark.parametrize("table", sorted(TABLES))
def test_tables_round_trip_with_null_for_nan_and_infinity_kept(tmp_path, table):
    """NaN is "not available": null in the file; infinite life stays infinite."""
    with table_writer(tmp_path, table) as writer:
        writer.write(rows(table))
        writer.write(rows(table))
    found = read_table(tmp_path, table)
    assert found.num_rows == 6
    assert found.schema.metadata[b"table"] == table.encode()
    for column in TABLES[table]:
        if column.type == "float":
            assert found.column(column.name).to_pylist()[:3] == [1.5, np.inf, None]


@pytest.mark.parametrize("at_once", [(7, 7, 7), (1, 20), (21,)])
def test_the_same_rows_written_otherwise_give_the_same_row_groups(tmp_path, monkeypatch, at_once):
    """Row groups are cut by number of rows, not by how the rows arrive."""
    monkeypatch.setitem(tables._ROWS_PER_GROUP, "nodes", 8)
    names = [f"weld {i // 2}" for i in range(21)]
    with table_writer(tmp_path, "nodes") as writer:
        first = 0
        for n in at_once:
            writer.write(columns(names[first : first + n]))
            first += n
    file = pq.ParquetFile(tmp_path / "nodes.parquet")
    assert [file.metadata.row_group(i).num_rows for i in range(file.num_row_groups)] == [8, 8, 5]
    assert file.read()["weld"].to_pylist() == names


def test_rows_that_wait_take_little_memory():
    """All tables of an assessment together, numbers and codes of eight bytes at most, before their groups are full."""
    waiting = {table: 8 * tables._ROWS_PER_GROUP[table] * len(TABLES[table]) for table in ASSESSED}
    assert sum(waiting.values()) < 50e6
    assert waiting["welds"] < 1e6  # its rows come a few at a time: each piece has arrays and texts of its own


def columns(names):
    """All columns of the table of nodes, with these names of welds."""
    value = {"text": "x", "int": 1, "flag": True, "float": 0.5}
    return {c.name: [value[c.type]] * len(names) for c in TABLES["nodes"]} | {"weld": names}


def test_coded_texts_are_plain_texts_to_every_reader(tmp_path):
    """Text in the schema, strings in pandas, null for a code below 0, whatever codes the pieces have."""
    pieces = [(np.array([1, 0, 1]), ["b", "a"]), (np.array([0, -1]), ["c"]), (np.array([0, 2]), ["a", "c", "d"])]
    with table_writer(tmp_path, "nodes") as writer:
        for codes, texts in pieces:
            writer.write(columns(["w"] * len(codes)) | {"governing_event": coded(codes, texts)})
    found = pq.read_table(tmp_path / "nodes.parquet")
    assert found.schema.equals(schema("nodes"), check_metadata=True)
    assert found["governing_event"].to_pylist() == ["a", "b", "a", "c", None, "a", "d"]
    assert pd.api.types.is_string_dtype(pd.read_parquet(tmp_path / "nodes.parquet")["weld"])
    kept = pq.ParquetFile(tmp_path / "nodes.parquet").metadata.row_group(0)
    events = next(c for c in (kept.column(i) for i in range(kept.num_columns)) if c.path_in_schema == "governing_event")
    assert events.has_dictionary_page


def test_the_numbers_are_the_same_bits(tmp_path):
    """No encoding rounds: smallest, largest, negative zero, whole numbers beyond 2**53."""
    numbers = np.array([5e-324, 1.7976931348623157e308, -0.0, np.pi, np.inf])
    whole = np.array([2**62 + 1, -(2**62) - 1, 0, 1, -1])
    with table_writer(tmp_path, "nodes") as writer:
        writer.write(columns(["w"] * 5) | {"life_km": numbers, "node": whole})
    found = pq.read_table(tmp_path / "nodes.parquet")
    assert found["life_km"].to_numpy().tobytes() == numbers.tobytes()
    assert found["node"].to_numpy().tobytes() == whole.tobytes()


def test_a_missing_column_is_a_programming_error(tmp_path):
    """Rows must be complete."""
    incomplete = rows("welds")
    del incomplete["life_km"]
    with pytest.raises(KeyError, match="life_km"), table_writer(tmp_path, "welds") as writer:
        writer.write(incomplete)


def test_read_table_names_what_is_wrong(tmp_path):
    """No table, and a truncated one."""
    with pytest.raises(DataError, match=r"nodes\.parquet: no such result table\. Run `fatigue assess"):
        read_table(tmp_path, "nodes")
    with table_writer(tmp_path, "nodes") as writer:
        writer.write(rows("nodes"))
    path = tmp_path / "nodes.parquet"
    path.write_bytes(path.read_bytes()[:-20])
    with pytest.raises(DataError, match="the table cannot be read"):
        read_table(tmp_path, "nodes")


def test_schema_types():
    """Life is a float, the node an integer, the toe a flag, the weld a text."""
    types = {f.name: str(f.type) for f in schema("nodes")}
    assert (types["life_km"], types["node"], types["toe"], types["weld"]) == ("double", "int64", "bool", "string")
