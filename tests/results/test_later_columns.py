"""Tables of older versions, which lack columns that were added since."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.results.columns import NOT_IN_OLDER, TABLES
from fatigue.results.rows import number_groups, read_codes, read_rows, row_groups
from fatigue.results.tables import read_table, schema
from fatigue.results.weld_table import assessed, read_welds


def older(folder, table, rows=3):
    """Write a table of ``rows`` rows as an older version did."""
    filled = {"text": "assessed", "int": 4, "flag": True, "float": 0.5}
    columns = [c for c in TABLES[table] if c.name not in NOT_IN_OLDER[table]]
    fields = [schema(table).field(c.name) for c in columns]
    arrays = [pa.array([filled[c.type]] * rows, f.type) for c, f in zip(columns, fields, strict=True)]
    pq.write_table(pa.Table.from_arrays(arrays, schema=pa.schema(fields)), folder / f"{table}.parquet")


def test_later_columns_are_read_as_empty(tmp_path):
    """Every way to read a table finds the columns that it lacks, without values and in their order."""
    older(tmp_path, "nodes")
    names = [c.name for c in TABLES["nodes"]]
    asked = ["weld", "multiaxial_verdict", "multiaxial_bound"]
    assert read_table(tmp_path, "nodes").column_names == names
    assert read_table(tmp_path, "nodes", asked).column_names == asked
    assert read_table(tmp_path, "nodes", asked)["multiaxial_verdict"].null_count == 3
    assert read_rows(tmp_path, "nodes", np.array([2, 0]), asked).num_rows == 2
    assert read_rows(tmp_path, "nodes", np.array([0])).column_names == names
    assert [group.column_names for group in row_groups(tmp_path, "nodes")] == [names]
    codes, texts = read_codes(tmp_path, "nodes", "multiaxial_status")
    assert codes.tolist() == [-1, -1, -1]
    assert texts == []
    groups = list(number_groups(tmp_path, "nodes", ["multiaxial_bound"], {"multiaxial_status": ["counted"]}))
    assert np.isnan(groups[0]["multiaxial_bound"]).all()
    assert groups[0]["multiaxial_status"].tolist() == [-1, -1, -1]


def test_welds_of_older_results_have_no_checks(tmp_path):
    """A weld of an older result has no check beside its toe, and no check that is not assessed."""
    older(tmp_path, "welds")
    welds = assessed(read_welds(tmp_path))
    assert welds["checks_not_assessed"].tolist() == [0, 0, 0]
    assert welds["worst_check"].isna().all()


def test_other_missing_columns_are_refused(tmp_path):
    """A column that every version wrote is not made up."""
    older(tmp_path, "nodes")
    path = tmp_path / "nodes.parquet"
    pq.write_table(pq.read_table(path).drop_columns(["utilisation"]), path)
    with pytest.raises(DataError, match="utilisation"):
        read_table(tmp_path, "nodes", ["utilisation"])
