"""Columns of a Parquet file."""

from collections.abc import Collection
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from fatigue.errors import DataError
from fatigue.readers.neutral.columns import DAMAGE, Columns, damaged


def open_parquet(path: Path, texts: Collection[str]) -> Columns:
    """Open a Parquet file; ``texts`` are the columns that hold names, of which the codes are kept."""
    schema = pq.read_schema(path)
    names = tuple(schema.names)
    file = pq.ParquetFile(path, read_dictionary=[name for name in names if name.strip() in texts])
    rows = file.metadata.num_rows

    def read(position: int) -> pa.ChunkedArray:
        try:
            column = file.read(columns=[names[position]]).column(0)
            column.validate(full=True)
        except DAMAGE as error:
            raise DataError(damaged(path, error)) from None
        if len(column) != rows:
            raise DataError(damaged(path, EOFError(f"{len(column)} of {rows} rows")))
        return column

    fields = [schema.field(k) for k in range(len(names))]
    units = tuple(map(_unit_in_metadata, fields))
    return Columns(names, tuple(schema.types), rows, read, units=units)


def _unit_in_metadata(field: pa.Field) -> str:
    """Find the unit that the metadata of a column states, under any of the usual keys; empty if there is none."""
    stated = {key.decode("utf-8", "replace").lower(): value for key, value in (field.metadata or {}).items()}
    found = next((stated[key] for key in ("unit", "units", "unit_string", "uom") if key in stated), b"")
    return found.decode("utf-8", "replace").strip()
