"""A sorted copy of a table of nodal forces: its rows dealt out to files, buckets, that hold a few groups of welds each.

Never more than a batch of rows is in memory.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fatigue.errors import DataError, refuse
from fatigue.files.mishaps import refused_writing
from fatigue.files.misplaced import misplaced
from fatigue.readers.neutral.columns import DAMAGE, Columns, damaged
from fatigue.readers.neutral.csv_columns import csv_batches
from fatigue.readers.neutral.forces.nodal_forces import open_nodal_forces
from fatigue.readers.neutral.forces.source import CODE, KINDS, TEXTS, Source, coded, force_columns, trimmed
from fatigue.readers.neutral.forces.unknown_welds import UnknownWelds
from fatigue.readers.neutral.forces.weld_codes import WeldCodes
from fatigue.readers.neutral.table_units import units_row_warnings
from fatigue.readers.neutral.tables import Table, named
from fatigue.readers.text.encoding import HEAD_BYTES, not_utf8_warning
from fatigue.readers.text.layout import table_layout

COPY = "give the same command again: forces in no order need a sorted copy on disk"
BATCH = 200_000  # rows in memory together
ROWS_OF_BUCKET = 500_000  # about
MOST_BUCKETS = 500  # files open at the same time
READ_BUFFER = 1 << 20  # bytes
CSV_ROW = 60  # bytes, about


def sorted_copy(path: Path, welds: WeldCodes, scratch: Path) -> Source:
    """Source that decodes buckets in ``scratch``, to which the rows of a file are dealt out.

    Raises
    ------
    DataError : the file is no table, has no column ``weld``, a unit that contradicts a column, or an unknown weld
    """
    if path.suffix.lower() != ".csv":
        header = open_nodal_forces(path)
        return _dealt_out(header, header.rows, _parquet_batches(path, force_columns(header)), welds, scratch)
    refuse(DataError, filter(None, [misplaced(path, path.name, text=False)]))
    layout = table_layout(path, TEXTS)
    kinds = tuple(KINDS.get(name.strip(), pa.string()) for name in layout.names)
    warnings = units_row_warnings(path.name, layout)
    if layout.encoding == "cp1252":
        warnings += (not_utf8_warning(path, _head_with_stray_byte(path)),)
    header = named(path, Columns(layout.names, kinds, 0, _unread, warnings=warnings))
    columns = force_columns(header)
    try:
        batches = csv_batches(path, layout, {name: KINDS[name] for name in columns.values()})
        tables = (pa.Table.from_batches([batch]) for batch in batches)
        return _dealt_out(header, path.stat().st_size // CSV_ROW, tables, welds, scratch)
    except DAMAGE:  # a mistake, or numbers of another type: told, or read, with the file in memory
        header = open_nodal_forces(path)
        whole = [header.columns.read(header.position[name]) for name in columns.values()]
        return _dealt_out(header, header.rows, [pa.table(whole, list(columns.values()))], welds, scratch)


def _dealt_out(header: Table, rows: int, batches: Iterable[pa.Table], welds: WeldCodes, scratch: Path) -> Source:
    """Source of batches of about so many ``rows`` together, dealt out to buckets of neighbouring groups."""
    with refused_writing(scratch):
        scratch.mkdir(parents=True, exist_ok=True)
    groups = len(welds.groups)
    buckets = min(max(1, math.ceil(rows / ROWS_OF_BUCKET)), groups, MOST_BUCKETS)
    bucket_of_group = np.arange(groups) * buckets // groups
    files = [scratch / f"forces-{bucket:03d}.arrow" for bucket in range(buckets)]
    size = np.zeros(buckets, dtype=np.int64)
    unknown = UnknownWelds(header)
    first = 0
    with ExitStack() as stack:
        writers: dict[int, pa.ipc.RecordBatchFileWriter] = {}
        for batch in batches:
            numbered = coded(batch, welds, first)
            code = numbered.column(CODE).to_numpy()
            unknown.look(batch.column("weld"), code, first)
            first += len(code)
            bucket = np.where(code < 0, buckets, bucket_of_group[welds.group[code]])
            ordered = numbered.take(np.argsort(bucket, kind="stable"))
            ends = np.searchsorted(np.sort(bucket), np.arange(buckets + 1))
            for i in np.flatnonzero(np.diff(ends)).tolist():
                with refused_writing(files[i], COPY):
                    if i not in writers:
                        sink = stack.enter_context(pa.OSFile(str(files[i]), "wb"))
                        options = pa.ipc.IpcWriteOptions(compression="lz4")
                        writers[i] = pa.ipc.new_file(sink, ordered.schema, options=options)
                    writers[i].write_table(ordered.slice(ends[i], ends[i + 1] - ends[i]))
            size += np.diff(ends)
        for i, writer in writers.items():
            with refused_writing(files[i], COPY):
                writer.close()
    unknown.refuse(welds)

    def read(bucket: int) -> pa.Table:
        with pa.OSFile(str(files[bucket])) as stored:
            return pa.ipc.open_file(stored).read_all().combine_chunks()

    buckets_of_group = tuple((int(bucket),) if size[bucket] else () for bucket in bucket_of_group)
    return Source(header, tuple(size.tolist()), buckets_of_group, read, numbered.schema.empty_table())


def _parquet_batches(path: Path, columns: Mapping[str, str]) -> Iterator[pa.Table]:
    """Read a Parquet file in batches; buffered, so that not even a whole column of a row group is in memory."""
    texts = [stored for stored, name in columns.items() if name in TEXTS]
    file = pq.ParquetFile(path, read_dictionary=texts, buffer_size=READ_BUFFER, pre_buffer=False)
    try:
        for batch in file.iter_batches(BATCH, columns=list(columns)):
            yield trimmed(pa.Table.from_batches([batch]), columns)
    except DAMAGE as error:
        raise DataError(damaged(path, error)) from None


def _head_with_stray_byte(path: Path) -> bytes:
    """Beginning of a file that is not UTF-8, whole lines, far enough for its first byte that is not."""
    head = b""
    with path.open("rb") as file:
        while block := file.read(HEAD_BYTES):
            head += block + file.readline()
            try:
                head.decode("utf-8")
            except UnicodeDecodeError:
                break
    return head


def _unread(position: int) -> pa.ChunkedArray:
    raise NotImplementedError(f"column {position} of a file that is read in batches")
