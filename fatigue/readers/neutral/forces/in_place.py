"""A Parquet file of nodal forces, read where it is: its rows have about the order of the groups of welds."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fatigue.errors import DataError
from fatigue.readers.neutral.columns import DAMAGE, damaged
from fatigue.readers.neutral.forces.nodal_forces import open_nodal_forces
from fatigue.readers.neutral.forces.source import TEXTS, Source, coded, force_columns, trimmed
from fatigue.readers.neutral.forces.unknown_welds import UnknownWelds
from fatigue.readers.neutral.forces.weld_codes import WeldCodes


def in_place(path: Path, welds: WeldCodes, most_rows: int) -> Source | None:
    """Source that decodes the row groups of a Parquet file; None if one of them has more than ``most_rows``.

    Raises
    ------
    DataError : the file is no table, has no column ``weld`` or an unknown weld in it
    """
    header = open_nodal_forces(path)
    columns = force_columns(header)
    weld = next(stored for stored, name in columns.items() if name == "weld")
    texts = [stored for stored, name in columns.items() if name in TEXTS]
    file = pq.ParquetFile(path, read_dictionary=texts, pre_buffer=False)
    rows = tuple(file.metadata.row_group(i).num_rows for i in range(file.num_row_groups))
    if max(rows) > most_rows:
        return None
    first = np.cumsum([0, *rows])
    unknown = UnknownWelds(header)
    buckets: list[list[int]] = [[] for _ in welds.groups]
    for i in range(len(rows)):
        column = _decoded(path, partial(file.read_row_group, i, [weld])).column(0)
        present = welds.among(column)
        if (present == -1).any():
            unknown.look(column, welds.of(column), int(first[i]))
        for group in np.unique(welds.group[present[present >= 0]]):
            buckets[group].append(i)
    unknown.refuse(welds)

    def read(bucket: int) -> pa.Table:
        table = _decoded(path, partial(file.read_row_group, bucket, list(columns)))
        return coded(trimmed(table, columns), welds, int(first[bucket]))

    def batches(bucket: int, at_once: int) -> Iterator[pa.RecordBatch]:
        own = pq.ParquetFile(path, metadata=file.metadata, read_dictionary=texts, pre_buffer=False)
        for batch in own.iter_batches(at_once, [bucket], list(columns), use_threads=False):
            batch.validate(full=True)
            yield trimmed(batch, columns)

    nothing = coded(trimmed(file.schema_arrow.empty_table().select(list(columns)), columns), welds, 0)
    return Source(header, rows, tuple(map(tuple, buckets)), read, nothing, batches)


def _decoded(path: Path, read: Callable[[], pa.Table]) -> pa.Table:
    """Read columns of a row group; one that cannot be decoded is refused."""
    try:
        table = read()
        table.validate(full=True)
    except DAMAGE as error:
        raise DataError(damaged(path, error)) from None
    return table
