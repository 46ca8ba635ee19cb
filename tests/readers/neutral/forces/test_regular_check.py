"""The check of forces in their own order: it takes what most programs write, and never what would be refused."""

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.readers.neutral.forces import regular_check
from fatigue.readers.neutral.forces.by_group import ForcesByGroup
from fatigue.readers.neutral.forces.convention import COMPONENTS
from fatigue.readers.neutral.forces.nodal_forces import check_nodal_forces
from fatigue.readers.neutral.forces.regular_check import NotRegular
from fatigue.readers.neutral.line_file import line_file
from tests.readers.neutral_tables import small_body

GROUPS = (("seam",), ("ring",))
IGNORED = 40


@pytest.fixture(scope="module")
def body(tmp_path_factory):
    """Modes and lines of the small body."""
    return small_body(tmp_path_factory.mktemp("body"))


def table_of(lines, modes, stations, cycle):
    """Forces node by node, the nodes in any order, each with all modes of the cycle."""
    weld = [name for name, size in zip(lines.weld, np.diff(lines.begin), strict=True) for _ in range(size)]
    rows = [(weld[i], lines.node[i], mode) for i in stations for mode in cycle]
    table = pd.DataFrame(rows, columns=["weld", "node", "mode"])
    return table.assign(**{name: np.arange(len(table), dtype=np.float32) + i for i, name in enumerate(COMPONENTS)})


def is_regular(path, body, scratch, strict=True):
    """Run the check over all pieces."""
    modes, lines = body
    forces = ForcesByGroup(path, GROUPS, scratch)
    check = forces.regular_check(line_file(lines), modes, {IGNORED}, strict=strict)
    try:
        return check is not None and check.covers([check.runs(i) for i in range(len(check.rows))])
    except NotRegular:
        return False


def refuse(path, body, scratch):
    """Check every group row by row."""
    modes, lines = body
    forces = ForcesByGroup(path, GROUPS, scratch)
    for i in range(len(GROUPS)):
        check_nodal_forces(forces.table(i), lines.lines(slice(i, i + 1)), modes, {IGNORED}, strict=True)


@settings(deadline=None, max_examples=60)
@given(data=st.data(), ignored=st.booleans(), row_group=st.integers(1, 30), at_once=st.integers(1, 12))
def test_rows_node_by_node_are_regular_and_spoilt_ones_are_not(
    body, tmp_path_factory, data, ignored, row_group, at_once
):
    """Wherever row groups and batches end; a table that passes is never one that is refused row by row."""
    tmp_path = tmp_path_factory.mktemp("forces")
    modes, lines = body
    stations = data.draw(st.permutations(range(lines.node.size)))
    cycle = data.draw(st.permutations([*modes.mode.tolist(), *([IGNORED] if ignored else [])]))
    table = table_of(lines, modes, stations, cycle)
    path = tmp_path / "f.parquet"
    table.to_parquet(path, index=False, row_group_size=row_group)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(regular_check, "ROWS_AT_ONCE", max(at_once, len(cycle) + 1))
        assert is_regular(path, body, tmp_path)
        row, other = (data.draw(st.integers(0, len(table) - 1)) for _ in range(2))
        spoil = data.draw(st.sampled_from(["weld", "node", "mode", "fx_N", "mz_Nmm", "row", "repeated", "swapped"]))
        if spoil == "row":
            spoilt = table.drop(index=row)
        elif spoil == "repeated":
            spoilt = pd.concat([table.iloc[:row], table.iloc[row : row + 1], table.iloc[row:]])
        elif spoil == "swapped":
            spoilt = table.iloc[[{row: other, other: row}.get(i, i) for i in range(len(table))]]
        elif spoil in COMPONENTS:
            spoilt = table.copy()
            spoilt.loc[row, spoil] = data.draw(st.sampled_from([np.nan, np.inf, -np.inf]))
        else:
            spoilt = table.copy()
            spoilt.loc[row, spoil] = table.loc[other, spoil]
        spoilt.to_parquet(path, index=False, row_group_size=row_group)
        if is_regular(path, body, tmp_path / "scratch"):
            refuse(path, body, tmp_path / "again")
        if spoil in COMPONENTS:
            assert not is_regular(path, body, tmp_path / "scratch")


@pytest.mark.parametrize("column", [*COMPONENTS, "node", "mode"])
def test_an_empty_cell_is_left_to_the_other_check(body, tmp_path, column):
    """It says in which row."""
    modes, lines = body
    table = table_of(lines, modes, range(lines.node.size), modes.mode)
    whole = pa.Table.from_pandas(table, preserve_index=False)
    values = whole.column(column).to_pylist()
    values[4] = None
    at = whole.column_names.index(column)
    spoilt = whole.set_column(at, column, pa.array(values, whole.schema.field(column).type))
    pq.write_table(spoilt, tmp_path / "f.parquet")
    assert not is_regular(tmp_path / "f.parquet", body, tmp_path)
    with pytest.raises(DataError, match=f"column {column}, row 5"):
        refuse(tmp_path / "f.parquet", body, tmp_path)


def test_mode_by_mode_and_csv_are_left_to_the_other_check(body, tmp_path):
    """So are columns that are missing, unknown or of another type."""
    modes, lines = body
    table = table_of(lines, modes, range(lines.node.size), modes.mode)
    table.to_csv(tmp_path / "f.csv", index=False)
    assert not is_regular(tmp_path / "f.csv", body, tmp_path)
    path = tmp_path / "f.parquet"
    for other in (
        table.sort_values("mode", kind="stable"),
        table.drop(columns="my_Nmm"),
        table.assign(more=1),
        table.astype({"node": float}),
        table.astype({"fy_N": int}),
    ):
        other.to_parquet(path, index=False)
        assert not is_regular(path, body, tmp_path)
    table.assign(more=1).to_parquet(path, index=False)
    assert is_regular(path, body, tmp_path, strict=False)


def test_row_groups_without_rows_are_no_matter(body, tmp_path):
    """Some programs write them."""
    modes, lines = body
    whole = pa.Table.from_pandas(table_of(lines, modes, range(lines.node.size), modes.mode), preserve_index=False)
    with pq.ParquetWriter(tmp_path / "f.parquet", whole.schema) as writer:
        for part in (whole.slice(0, 0), whole.slice(0, 10), whole.slice(0, 0), whole.slice(10)):
            writer.write_table(part)
    refuse(tmp_path / "f.parquet", body, tmp_path)
    assert is_regular(tmp_path / "f.parquet", body, tmp_path)
