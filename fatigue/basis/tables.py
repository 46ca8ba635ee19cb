"""Tables of a basis on disk, by their names in the dictionary."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa

from fatigue.results import plain_tables
from fatigue.results.dictionary.basis import BASIS


def table_of(name: str, rows: Sequence[Any]) -> pa.Table:
    """Rows as an Arrow table; NaN and None are null."""
    return plain_tables.table_of(name, BASIS[name], rows)


def write_table(folder: Path, name: str, rows: Sequence[Any]) -> Path:
    """Write ``<name>.parquet`` of the rows.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    return plain_tables.write_table(folder, name, BASIS[name], rows)


def write_csv(folder: Path, name: str, rows: Sequence[Any]) -> Path:
    """Write ``<name>.csv`` of the rows: UTF-8, decimal points, empty where nothing is available.

    Raises
    ------
    DataError : as ``write_table``
    """
    return plain_tables.write_csv(folder, name, BASIS[name], rows)
