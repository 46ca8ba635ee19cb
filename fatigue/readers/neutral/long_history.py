"""Long histories, block after block of rows: memory does not grow with the record.

What is wrong with a table is better told by ``tables``, which has a column in memory as a whole. So a table that is not
regular (cells without a number, a row of another width, times in another type) is left to it, and so is a short one.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.errors import DataError
from fatigue.readers.neutral.column_values import floats_of
from fatigue.readers.neutral.columns import DAMAGE, Columns
from fatigue.readers.neutral.csv_columns import csv_batches
from fatigue.readers.neutral.files import open_columns
from fatigue.readers.neutral.table_units import units_row_warnings
from fatigue.readers.neutral.tables import Table, named
from fatigue.readers.text.layout import table_layout

LONG_NUMBERS = 4_000_000  # of a Parquet file, times and coordinates: 32 MB in double precision
LONG_BYTES = 32 << 20  # of a CSV file
NUMBERS_AT_ONCE = 1_000_000  # of a block: 8 MB
BUFFER = 1 << 18  # bytes of each column of a Parquet file that are read together


class Irregular(Exception):
    """The table cannot be read block by block, or has a mistake in it."""


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Some rows of a history: times (r,) [s], and coordinates (m, r) in the precision of the file."""

    time: NDArray[np.float64]
    q: NDArray[np.floating]


def is_long(path: Path) -> bool:
    """Whether a file is so long that it is worth being read block by block."""
    try:
        if path.suffix.lower() == ".csv":
            return path.stat().st_size > LONG_BYTES
        metadata = pq.read_metadata(path)
    except DAMAGE:
        return False
    return bool(metadata.num_rows * metadata.num_columns > LONG_NUMBERS)


def long_table(path: Path) -> Table:
    """Names, types and units of the columns of a long history, none of which is read.

    Raises
    ------
    Irregular : its head says that it is better read as a whole
    """
    try:
        if path.suffix.lower() != ".csv":
            return named(path, open_columns(path, ()))
        layout = table_layout(path, ())
        if layout.encoding != "utf-8":
            raise Irregular
        kinds = (pa.float64(),) * len(layout.names)
        warnings = units_row_warnings(path.name, layout)
        return named(path, Columns(layout.names, kinds, 1, _not_read, warnings=warnings))
    except (*DAMAGE, DataError):
        raise Irregular from None


def blocks(table: Table, names: Sequence[str], kind: np.dtype[np.floating]) -> Iterator[Block]:
    """Blocks of a long history in the order of its rows; ``names`` are the columns of its modes.

    Raises
    ------
    Irregular : a number is missing or not finite, or the file is damaged
    """
    try:
        for batch in _batches(table, names):
            time, *q = (_numbers(column) for column in batch.columns)
            yield Block(time.astype(np.float64), np.stack(q).astype(kind, copy=False))
    except (*DAMAGE, DataError):
        raise Irregular from None


@dataclass(slots=True)
class Times:
    """What is known of the times of the blocks so far: number, first and last one, shortest and longest step [s]."""

    samples: int = 0
    first: float = np.nan
    last: float = np.nan
    shortest: float = np.inf
    longest: float = -np.inf

    def add(self, time: NDArray[np.float64]) -> None:
        """Take the times of the next block."""
        if self.samples == 0:
            self.first = self.last = float(time[0])
        steps = np.diff(time, prepend=self.last)[0 if self.samples else 1 :]
        self.samples += time.size
        self.last = float(time[-1])
        self.shortest = min(self.shortest, float(steps.min(initial=np.inf)))
        self.longest = max(self.longest, float(steps.max(initial=-np.inf)))

    @property
    def mean_step(self) -> float:
        """Mean of the time steps so far [s]; NaN before the second sample."""
        return (self.last - self.first) / (self.samples - 1) if self.samples > 1 else np.nan

    def step(self, tolerance: float) -> float:
        """Uniform time step [s], from which no step differs by more than ``tolerance`` of it.

        Raises
        ------
        Irregular : some do, or there is none
        """
        if self.samples < 2:
            raise Irregular
        step = (self.last - self.first) / (self.samples - 1)
        off = max(abs(self.shortest - step), abs(self.longest - step))
        if not (self.shortest > 0.0 and off <= tolerance * step):
            raise Irregular
        return step


def _batches(table: Table, names: Sequence[str]) -> Iterator[pa.RecordBatch]:
    """Times and coordinates of a table, some rows at a time, columns in the order asked for."""
    wanted = ["time_s", *names]
    rows = max(1, NUMBERS_AT_ONCE // len(wanted))
    if table.path.suffix.lower() == ".csv":
        layout = table_layout(table.path, ())
        for batch in csv_batches(table.path, layout, dict.fromkeys(wanted, pa.float64())):
            yield from (batch.slice(first, rows).select(wanted) for first in range(0, batch.num_rows, rows))
        return
    stored = [table.columns.names[table.position[name]] for name in wanted]
    with pq.ParquetFile(table.path, buffer_size=BUFFER) as file:
        read = 0
        for batch in file.iter_batches(rows, columns=stored):
            read += batch.num_rows
            yield batch.select(stored)
        if read != table.rows:
            raise Irregular


def _numbers(column: pa.Array) -> NDArray[np.floating]:
    values = floats_of(pa.chunked_array([column]))
    if values is None or not np.isfinite(values).all():
        raise Irregular
    return values


def _not_read(position: int) -> pa.ChunkedArray:
    raise Irregular
