"""Result tables on disk: Parquet with unit and meaning of every column."""

import base64
import difflib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, given_names, given_path, refuse
from fatigue.files.mishaps import is_of_the_system, refusal, refused_writing
from fatigue.results.columns import ASSESSED, NOT_IN_OLDER, TABLES
from fatigue.results.dictionary.column import ColumnType

_ARROW_TYPE: dict[ColumnType, pa.DataType] = {
    "text": pa.string(),
    "int": pa.int64(),
    "flag": pa.bool_(),
    "float": pa.float64(),
}
_HOLDS: dict[ColumnType, str] = {"text": "texts", "int": "whole numbers", "flag": "flags", "float": "numbers"}
_CODED_TEXT = pa.dictionary(pa.int32(), pa.string())
_ROWS_PER_GROUP = dict.fromkeys(TABLES, 65_536) | {"structural_stress": 131_072, "nodes": 16_384, "welds": 2_048}
"""Rows wait in memory until a group of them is full, and what Parquet says of each group until the file is closed.

A waiting row takes 100 to 250 bytes, and twice as much where few rows come at once, as they do for welds. What is said
of a group takes 0.9 kB a column. With these sizes both are small for a million nodes: at most 70 MB for all tables.
"""
_ENCODING: dict[str, Any] = {
    "compression": "zstd",
    "compression_level": -5,  # computed floats hardly compress: level 1 takes twice the time for 2 % of the size
    "data_page_size": 1 << 18,  # within the second-level cache
    "write_batch_size": 1 << 14,
    "write_page_checksum": True,
}


def schema(table: str) -> pa.Schema:
    """Arrow schema of a result table with unit and meaning of every column in its field metadata."""
    return pa.schema(
        [
            pa.field(c.name, _ARROW_TYPE[c.type], metadata={"unit": c.unit, "description": c.meaning})
            for c in TABLES[table]
        ],
        metadata={"program": "fatigue", "table": table},
    )


def coded(codes: NDArray[np.integer], texts: Sequence[str]) -> pa.DictionaryArray:
    """Text column ``texts[codes]``, null where a code is below 0; it keeps the codes and is quick to write."""
    missing = codes < 0
    indices = pa.array(codes.astype(np.int32), mask=missing if missing.any() else None)
    return pa.DictionaryArray.from_arrays(indices, pa.array(texts, pa.string()))


class TableWriter:
    """Writes one result table in row groups of a fixed size, whatever the number of rows it is given at once."""

    def __init__(self, table: str, writer: pq.ParquetWriter, path: Path) -> None:
        self._schema = _coded_schema(table)
        self._writer = writer
        self._path = path
        self._rows_per_group = _ROWS_PER_GROUP[table]
        self._waiting: list[pa.Table] = []
        self._rows = 0

    def write(self, columns: Mapping[str, Any]) -> None:
        """Append rows; every column of the table must be there, NaN in a float column meaning "not available".

        Columns are sequences, numpy arrays, or Arrow arrays as ``coded`` makes them. Arrays may be kept for a while
        without a copy: they must not be changed afterwards.
        """
        arrays = [_arrow_array(columns[f.name], f.type) for f in self._schema]
        self._waiting.append(pa.Table.from_arrays(arrays, schema=self._schema))
        self._rows += len(arrays[0])
        if self._rows >= self._rows_per_group:
            self._write(self._rows - self._rows % self._rows_per_group)

    def flush(self) -> None:
        """Write what is waiting."""
        if self._rows:
            self._write(self._rows)

    def _write(self, rows: int) -> None:
        """Write so many of the rows that are waiting."""
        table = pa.concat_tables(self._waiting)
        # codes of different calls mean different texts; Parquet keeps codes only where a row group has one meaning
        with refused_writing(self._path):
            self._writer.write_table(table.slice(0, rows).unify_dictionaries(), row_group_size=self._rows_per_group)
        self._waiting, self._rows = [table.slice(rows)], self._rows - rows


def _arrow_array(values: Any, type_: pa.DataType) -> pa.Array:
    """Arrow array of a column, NaN as null; numbers without a copy where the array allows it."""
    if isinstance(values, pa.Array):
        return values
    if isinstance(values, np.ndarray) and values.dtype == np.float64:
        missing = np.isnan(values)
        return pa.array(values, type_, mask=missing if missing.any() else None)
    if type_ == _CODED_TEXT:
        return pa.array(values, pa.string(), from_pandas=True).dictionary_encode()
    return pa.array(values, type_, from_pandas=True)


def _coded_schema(table: str) -> pa.Schema:
    """Schema of a result table as it is handed to Parquet, which is quickest with texts that have codes."""
    plain = schema(table)
    fields = [f.with_type(_CODED_TEXT) if f.type == pa.string() else f for f in plain]
    return pa.schema(fields, metadata=plain.metadata)


@contextmanager
def table_writer(folder: Path, table: str, result: str = "") -> Iterator[TableWriter]:
    """Open ``<table>.parquet`` in a folder for writing, some rows at a time; ``result``: hash of its result.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    path = folder / f"{table}.parquet"
    floats = [c.name for c in TABLES[table] if c.type == "float"]
    texts = [c.name for c in TABLES[table] if c.type == "text"]
    # The file says that texts are texts, as its readers shall see them, and not the coded ones that it is made from.
    plain = schema(table)
    said = {**plain.metadata, "ARROW:schema": base64.b64encode(plain.serialize())} | (
        {"result": result} if result else {}
    )
    with refused_writing(path):
        writer = pq.ParquetWriter(
            path,
            _coded_schema(table),
            use_dictionary=texts,
            column_encoding=dict.fromkeys(floats, "BYTE_STREAM_SPLIT"),
            write_statistics=[c.name for c in TABLES[table] if c.type != "float"],
            store_schema=False,
            **_ENCODING,
        )
    try:
        rows = TableWriter(table, writer, path)
        yield rows
        rows.flush()
        writer.add_key_value_metadata(said)
    except BaseException:
        with suppress(OSError):  # what went wrong first is told
            writer.close()
        raise
    with refused_writing(path):
        writer.close()


@contextmanager
def result_tables(
    folder: Path, result: str = "", names: Iterable[str] = tuple(ASSESSED)
) -> Iterator[dict[str, TableWriter]]:
    """Open tables of an assessment in a folder for writing, by name; ``result``: hash of the result."""
    with refused_writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    with ExitStack() as stack:
        yield {table: stack.enter_context(table_writer(folder, table, result)) for table in names}


def read_table(folder: Path | str, table: str, columns: Sequence[str] | None = None) -> pa.Table:
    """Read a result table; ``columns`` of it, or one, in the order given, by default all.

    Raises
    ------
    DataError : the folder holds no such table, there is no such table or column at all, or the file is damaged
    CaseError : ``folder`` is no path, or ``columns`` are no names
    """
    path = table_path(folder, table)
    own = [column.name for column in TABLES[table]]
    wanted = own if columns is None else list(given_names(columns, "columns"))
    refuse(DataError, unknown_columns(path, wanted, own))
    with readable(path):
        later = later_columns(path, table)
        named = None if columns is None else [name for name in wanted if name not in later]
        found = pq.read_table(path, columns=named, page_checksum_verification=True)
        expect_columns(found.schema, table, wanted)
        return with_later_columns(found, table, wanted)


def later_columns(path: Path, table: str) -> list[str]:
    """Columns that a table lacks because an older version wrote it: see ``NOT_IN_OLDER``."""
    later = NOT_IN_OLDER.get(table, {})
    there = pq.read_schema(path).names if later else []
    return [name for name in later if name not in there]


def with_later_columns(found: pa.Table, table: str, wanted: Sequence[str]) -> pa.Table:
    """The same rows with the wanted columns that a table of an older version lacks: see ``NOT_IN_OLDER``."""
    there = found.column_names
    later = {name: value for name, value in NOT_IN_OLDER.get(table, {}).items() if name in wanted and name not in there}
    if not later:
        return found
    for name, value in later.items():
        field = schema(table).field(name)
        found = found.append_column(field, pa.array([value] * found.num_rows, field.type))
    return found.select([*wanted, *(name for name in there if name not in wanted)])


def expect_columns(found: pa.Schema, table: str, wanted: Sequence[str]) -> None:
    """Refuse a table without one of some columns, or with texts where numbers belong or the reverse.

    Columns that tables of older versions lack need not be there, unless the table has a column of no version: then one
    of them may stand under a damaged name.

    Raises
    ------
    pyarrow.ArrowInvalid : the first such column
    """
    is_older = {column.name for column in TABLES[table]}.issuperset(found.names)
    for column in TABLES[table]:
        if column.name not in wanted:
            continue
        columns = found.names.count(column.name)
        if columns == 0 and is_older and column.name in NOT_IN_OLDER.get(table, {}):
            continue
        if columns != 1:
            raise pa.ArrowInvalid(f"it has {columns or 'no'} column{'s' * bool(columns)} {column.name}")
        kind = found.field(column.name).type
        kind = kind.value_type if pa.types.is_dictionary(kind) else kind
        is_text = pa.types.is_string(kind) or pa.types.is_large_string(kind)
        is_number = pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind)
        if not (pa.types.is_null(kind) or (is_text if column.type == "text" else is_number)):
            raise pa.ArrowInvalid(f"its column {column.name} holds {kind}, not {_HOLDS[column.type]}")


def table_path(folder: Path | str, table: str) -> Path:
    """Where a result table is.

    Raises
    ------
    DataError : no table of results has this name
    """
    if not (isinstance(table, str) and table in TABLES):
        names = ", ".join(TABLES)
        raise DataError(
            Problem("no_table", str(folder), f"there is no table {table!r} of a result", f"Name one of {names}")
        )
    return given_path(folder, "folder") / f"{table}.parquet"


def unknown_columns(path: Path, wanted: Sequence[str], own: Sequence[str]) -> Iterator[Problem]:
    """Name columns that such a table never has, and what may have been meant."""
    for name in wanted:
        if name not in own:
            near = difflib.get_close_matches(str(name), own, n=1)
            remedy = f"Name {near[0]!r}" if near else f"Name some of {', '.join(own)}"
            yield Problem("no_column", str(path), f"the table has no column {name!r}", remedy)


@contextmanager
def readable(path: Path) -> Iterator[None]:
    """Say in the words of the program why a result table cannot be read.

    Raises
    ------
    DataError : there is no such table, or the file is damaged
    """
    try:
        yield
    except FileNotFoundError:
        problem = Problem(
            "no_result", str(path), "no such result table", "Run `fatigue assess CASE -o DIR` first and give its DIR"
        )
    except (pa.ArrowException, OSError, ValueError, LookupError, OverflowError, MemoryError) as error:
        if isinstance(error, OSError) and is_of_the_system(error):
            raise DataError(refusal(error, path)) from error
        detail = str(error).splitlines()[0] if str(error) else type(error).__name__
        problem = Problem(
            "damaged_result", str(path), f"the table cannot be read ({detail})", "Run the assessment again"
        )
    else:
        return
    raise DataError(problem)
