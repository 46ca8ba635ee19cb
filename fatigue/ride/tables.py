"""The rows of a ride as columns of its tables: a row is a dataclass whose fields are named as the columns."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

from fatigue.results import RIDDEN, table_writer

Rows: TypeAlias = Sequence[Any]  # dataclasses with the columns of a table as fields

_FIELD = {"class": "vibration_class"}  # a word of the language


def column_values(table: str, rows: Rows) -> dict[str, list[Any]]:
    """Values of every column of a table, row after row; None of an empty text."""
    names = [column.name for column in RIDDEN[table]]
    values = {name: [getattr(row, _FIELD.get(name, name)) for row in rows] for name in names}
    return {name: [None if value == "" else value for value in of_column] for name, of_column in values.items()}


def write_tables(folder: Path, tables: Mapping[str, Rows], result: str) -> None:
    """Write all tables of a ride into a folder, also those without rows; ``result``: hash of its result.

    Raises
    ------
    DataError : the disk is full or the place cannot be written
    """
    for name, rows in tables.items():
        with table_writer(folder, name, result) as table:
            table.write(column_values(name, rows))
