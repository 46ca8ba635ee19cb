"""Some rows of a result table that as a whole may not fit into memory, or one column of its texts.

One row group is in memory at a time. ``read_table`` reads the numbers of all rows, a column at a time.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.results.columns import NOT_IN_OLDER, TABLES
from fatigue.results.tables import expect_columns, read_table, readable, table_path, with_later_columns


def read_rows(
    folder: Path | str, table: str, rows: NDArray[np.integer], columns: Sequence[str] | None = None
) -> pa.Table:
    """Rows of these numbers, in the same order.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    ascending = np.argsort(rows, kind="stable")
    wanted = rows[ascending]
    with _opened(folder, table) as file:
        names = _wanted(file, table, columns)
        end = np.cumsum([0, *(file.metadata.row_group(i).num_rows for i in range(file.num_row_groups))])
        group = np.searchsorted(end, wanted, side="right") - 1
        groups = [file.schema_arrow.empty_table().select(names)]
        for number in np.unique(group):
            whole = file.read_row_group(number, names)
            groups.append(whole.take(pa.array(wanted[group == number] - end[number])))
    found = _plain(pa.concat_tables(groups).unify_dictionaries())
    found = with_later_columns(found, table, [c.name for c in TABLES[table]] if columns is None else columns)
    return found if (np.diff(rows) > 0).all() else found.take(pa.array(np.argsort(ascending)))


def row_groups(folder: Path | str, table: str) -> Iterator[pa.Table]:
    """Row groups of a table, one after the other; at least one, be it empty.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    with _opened(folder, table) as file:
        _wanted(file, table, None)
        every = [column.name for column in TABLES[table]]
        if file.num_row_groups == 0:
            yield with_later_columns(_plain(file.schema_arrow.empty_table()), table, every)
        for number in range(file.num_row_groups):
            yield with_later_columns(_plain(file.read_row_group(number)), table, every)


def row_count(folder: Path | str, table: str) -> int:
    """Number of rows of a table.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    with _opened(folder, table) as file:
        rows: int = file.metadata.num_rows
    return rows


def number_groups(
    folder: Path | str, table: str, numbers: Sequence[str], texts: Mapping[str, Sequence[str]]
) -> Iterator[dict[str, NDArray[Any]]]:
    """Columns of a table as plain arrays by name, one row group after the other.

    ``numbers`` are columns of numbers and flags, NaN where there is none. ``texts`` has a list of known texts for each
    column of texts; its array holds the place of each text in the list, -1 for any other and for a missing one.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    places = {name: {text: place for place, text in enumerate(known)} for name, known in texts.items()}
    with _opened(folder, table) as file:
        names = _wanted(file, table, [*numbers, *texts])
        for number in range(file.num_row_groups):
            group = with_later_columns(file.read_row_group(number, names), table, [*numbers, *texts])
            columns: dict[str, NDArray[Any]] = {name: group.column(name).to_numpy() for name in numbers}
            for name, place in places.items():
                codes, found = _coded(group.select([name]))
                columns[name] = np.array([*(place.get(text, -1) for text in found.to_pylist()), -1])[codes]
            yield columns


def rows_of_welds(folder: Path | str, table: str, welds: Sequence[str]) -> dict[str, NDArray[np.int64]]:
    """Numbers of the rows of each of some welds, ascending.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    found: dict[str, list[NDArray[np.int64]]] = {weld: [np.zeros(0, dtype=np.int64)] for weld in welds}
    first = 0
    with _opened(folder, table) as file:
        _wanted(file, table, ["weld"])
        at = file.schema_arrow.names.index("weld")
        for number in range(file.num_row_groups):
            group = file.metadata.row_group(number)
            if _may_hold(group.column(at).statistics, welds):
                codes, names = _coded(file.read_row_group(number, ["weld"]))
                for code, name in enumerate(names.to_pylist()):
                    if name in found:
                        found[name].append(first + np.flatnonzero(codes == code))
            first += group.num_rows
    return {weld: np.concatenate(rows) for weld, rows in found.items()}


def worst_toes(folder: Path | str, top: int, welds: Sequence[str] = ()) -> NDArray[np.int64]:
    """Numbers of the rows of the worst counted toe points in the table of nodes, worst first, of some welds or all.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    table = read_table(folder, "nodes", ["toe", "utilisation"])
    toe, utilisation = table["toe"].to_numpy(), table["utilisation"].to_numpy()
    tier, names = read_codes(folder, "nodes", "screened")
    rows = np.flatnonzero(toe & (np.array(names)[tier] == ""))
    if welds:
        of_welds = np.concatenate([*rows_of_welds(folder, "nodes", welds).values()])
        rows = np.intersect1d(rows, of_welds)
    return rows[np.argsort(-utilisation[rows], kind="stable")[:top]]


def read_codes(folder: Path | str, table: str, column: str) -> tuple[NDArray[np.int32], list[str]]:
    """Codes (n,) of a column of texts, -1 for a missing one, and the texts they stand for.

    Raises
    ------
    DataError : the folder holds no such table, or the file is damaged
    """
    with _opened(folder, table) as file:
        found = file.read(_wanted(file, table, [column]))
    codes, names = _coded(with_later_columns(found, table, [column]))
    return codes, names.to_pylist()


def _wanted(file: pq.ParquetFile, table: str, columns: Sequence[str] | None) -> list[str]:
    """Names of the columns to read, in the order of the file; all of them must be there."""
    there = file.schema_arrow.names
    expect_columns(file.schema_arrow, table, there if columns is None else columns)
    return [name for name in there if columns is None or name in columns]


@contextmanager
def _opened(folder: Path | str, table: str) -> Iterator[pq.ParquetFile]:
    """Open table, whose texts are read as codes."""
    path = table_path(folder, table)
    texts = [column.name for column in TABLES[table] if column.type == "text"]
    with readable(path):
        there = pq.read_schema(path).names
        texts = [name for name in texts if name in there or name not in NOT_IN_OLDER.get(table, {})]
        try:
            opened = pq.ParquetFile(path, read_dictionary=texts, page_checksum_verification=True)
        except KeyError as error:  # of the library, for a coded column that is not there
            raise pa.ArrowInvalid(f"it has no column {error.args[0].decode()}") from None
        with opened as file:
            yield file


def _may_hold(statistics: pq.Statistics | None, welds: Sequence[str]) -> bool:
    """Whether some of the welds may be in a row group, by the first and last name in it."""
    if statistics is None or not statistics.has_min_max:
        return True
    return any(statistics.min <= weld <= statistics.max for weld in welds)


def _plain(table: pa.Table) -> pa.Table:
    """Table in which coded texts are plain texts."""
    fields = [f.with_type(f.type.value_type) if pa.types.is_dictionary(f.type) else f for f in table.schema]
    return table.cast(pa.schema(fields, metadata=table.schema.metadata))


def _coded(table: pa.Table) -> tuple[NDArray[np.int32], pa.Array]:
    """Codes and texts of the one column of a table."""
    column = table.unify_dictionaries().column(0).combine_chunks()
    column = column if pa.types.is_dictionary(column.type) else column.dictionary_encode()
    return pc.fill_null(column.indices, -1).to_numpy(), column.dictionary
