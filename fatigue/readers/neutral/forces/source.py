"""A table of nodal forces in buckets of rows that are decoded together: row groups of a file, or files of a copy."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import numpy as np
import pyarrow as pa

from fatigue.readers.neutral.forces.convention import COMPONENTS
from fatigue.readers.neutral.forces.weld_codes import WeldCodes
from fatigue.readers.neutral.tables import Table

Rows = TypeVar("Rows", pa.Table, pa.RecordBatch)
Batches: TypeAlias = Callable[[int, int], Iterator[pa.RecordBatch]]

CODE, ROW = "weld among all", "row of the file"  # columns of a bucket; no names of the neutral format
TEXTS = ("weld", "unit_load")  # columns of names
KINDS = {"weld": pa.string(), "unit_load": pa.string(), "node": pa.int64(), "mode": pa.int64()} | dict.fromkeys(
    COMPONENTS, pa.float64()
)


@dataclass(frozen=True, slots=True, eq=False)
class Source:
    """A table of forces in buckets, which are decoded one by one.

    Attributes
    ----------
    header : path, names and types of the columns
    rows : number of rows in each bucket
    buckets : the buckets in which each group has rows
    read : decodes a bucket: its columns by trimmed name, the weld as ``CODE``, and the row in the file as ``ROW``
    nothing : the same columns without rows
    batches : decodes the columns of a bucket as they are in the file, so many rows at a time, by several threads at
        once; without it the rows are not in the order of the file
    """

    header: Table
    rows: tuple[int, ...]
    buckets: tuple[tuple[int, ...], ...]
    read: Callable[[int], pa.Table]
    nothing: pa.Table
    batches: Batches | None = None


def force_columns(header: Table) -> dict[str, str]:
    """Columns that are read: their trimmed names, by their names in the file.

    Raises
    ------
    DataError : there is no column ``weld``
    """
    header.expect(("weld",), header.position, strict=False)
    return {header.columns.names[i]: name for name, i in header.position.items() if name in KINDS}


def trimmed(table: Rows, columns: Mapping[str, str]) -> Rows:
    """Rename the columns that ``force_columns`` names as they are trimmed."""
    return table.rename_columns([columns[name] for name in table.schema.names])


def coded(rows: pa.Table, welds: WeldCodes, first: int) -> pa.Table:
    """Replace the names of welds by their numbers and add the rows' own numbers, from ``first``."""
    code = pa.array(welds.of(rows.column("weld")))
    number = pa.array(np.arange(first, first + rows.num_rows))
    return rows.drop_columns(["weld"]).append_column(CODE, code).append_column(ROW, number)
