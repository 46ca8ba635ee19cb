"""Rows of dataclasses on disk: Parquet with unit and meaning of every column, and CSV, in a folder of their own."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from fatigue.files.mishaps import refused_writing
from fatigue.results.dictionary.column import Column

_TYPES = {"text": pa.string(), "int": pa.int64(), "flag": pa.bool_(), "float": pa.float64()}
_FORMULA = r"^([=+\-@\t\r])"  # what a spreadsheet would take for one gets an apostrophe before it


def table_of(name: str, columns: Sequence[Column], rows: Sequence[Any]) -> pa.Table:
    """Rows as an Arrow table, a field for each column; NaN and None are null."""
    fields = [pa.field(c.name, _TYPES[c.type], metadata={"unit": c.unit, "description": c.meaning}) for c in columns]
    arrays = [pa.array([getattr(row, f.name) for row in rows], f.type, from_pandas=True) for f in fields]
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata={"program": "fatigue", "table": name}))


def write_table(folder: Path, name: str, columns: Sequence[Column], rows: Sequence[Any]) -> Path:
    """Write ``<name>.parquet`` of the rows.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    path = folder / f"{name}.parquet"
    with refused_writing(path):
        pq.write_table(table_of(name, columns, rows), path, compression="zstd", write_page_checksum=True)
    return path


def write_csv(folder: Path, name: str, columns: Sequence[Column], rows: Sequence[Any]) -> Path:
    """Write ``<name>.csv`` of the rows: UTF-8, decimal points, empty where nothing is available.

    Raises
    ------
    DataError : as ``write_table``
    """
    path, table = folder / f"{name}.csv", table_of(name, columns, rows)
    for i, field in enumerate(table.schema):
        if field.type == pa.string():
            table = table.set_column(i, field, pc.replace_substring_regex(table[i], _FORMULA, r"'\1"))
    with refused_writing(path):
        pa_csv.write_csv(table, path, pa_csv.WriteOptions(quoting_style="needed"))
    return path
