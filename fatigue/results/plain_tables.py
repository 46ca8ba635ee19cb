"""Rows on disk: Parquet with unit and meaning of every column, and CSV, in a folder that a command fills."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from fatigue import __version__
from fatigue.files.hashes import sha256
from fatigue.files.mishaps import refused_writing
from fatigue.files.recorded import Filled, put_in_place
from fatigue.files.whole import staged
from fatigue.results.dictionary.column import Column
from fatigue.results.json_records import write_json

Rows: TypeAlias = Sequence[Any] | pd.DataFrame  # dataclasses with the columns as fields, or the columns of many rows

_TYPES = {"text": pa.string(), "int": pa.int64(), "flag": pa.bool_(), "float": pa.float64()}
_FORMULA = r"^([=+\-@\t\r])"  # what a spreadsheet would take for one gets an apostrophe before it


def table_of(name: str, columns: Sequence[Column], rows: Rows) -> pa.Table:
    """Rows as an Arrow table, a field for each column; NaN and None are null."""
    fields = [pa.field(c.name, _TYPES[c.type], metadata={"unit": c.unit, "description": c.meaning}) for c in columns]
    given = (
        (rows[f.name] for f in fields)
        if isinstance(rows, pd.DataFrame)
        else ([getattr(row, f.name) for row in rows] for f in fields)
    )
    arrays = [pa.array(values, f.type, from_pandas=True) for values, f in zip(given, fields, strict=True)]
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata={"program": "fatigue", "table": name}))


def write_table(folder: Path, name: str, columns: Sequence[Column], rows: Rows) -> Path:
    """Write ``<name>.parquet`` of the rows.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    path = folder / f"{name}.parquet"
    with refused_writing(path):
        pq.write_table(table_of(name, columns, rows), path, compression="zstd", write_page_checksum=True)
    return path


def write_csv(folder: Path, name: str, columns: Sequence[Column], rows: Rows) -> Path:
    """Write ``<name>.csv`` of the rows: UTF-8, decimal points, empty where nothing is available.

    Raises
    ------
    DataError : as ``write_table``
    """
    path, table = folder / f"{name}.csv", table_of(name, columns, rows)
    for i, field in enumerate(table.schema):
        if field.type == pa.string():
            table = table.set_column(i, field, pc.replace_substring_regex(table[i], _FORMULA, r"'\1"))
    table = table.rename_columns([re.sub(_FORMULA, r"'\1", name) for name in table.column_names])
    with refused_writing(path):
        pa_csv.write_csv(table, path, pa_csv.WriteOptions(quoting_style="needed"))
    return path


def fill(
    folder: Path,
    filled: Filled,
    tables: Mapping[str, tuple[Sequence[Column], Rows]],
    pages: Mapping[str, str],
    said: Mapping[str, Any],
    *,
    csv: bool,
) -> list[str]:
    """Write tables, pages by their names, and the record that lists them with their SHA-256; returns all names.

    They are put in place together; what an earlier run wrote and this one does not is removed. ``said`` is what else
    stands in the record, ``csv``: tables as CSV as well.

    Raises
    ------
    DataError : as ``write_table``
    """
    with staged(folder, f".{filled.what}-") as stage:
        for name, (columns, rows) in tables.items():
            write_table(stage, name, columns, rows)
            if csv:
                write_csv(stage, name, columns, rows)
        for name, text in pages.items():
            path = stage / name
            with refused_writing(path):
                path.write_text(text, encoding="utf-8", errors="backslashreplace", newline="\n")
        outputs = {path.name: sha256(path) for path in sorted(stage.iterdir())}
        record = {"program": filled.program, "version": __version__, **said, "outputs": outputs}
        write_json(stage / filled.record, record)
        put_in_place(stage, folder, filled, outputs)
    return [*outputs, filled.record]


def table_files(names: Sequence[str]) -> tuple[str, ...]:
    """Names of the files of tables, in either format."""
    return tuple(f"{name}.{kind}" for name in names for kind in ("parquet", "csv"))
