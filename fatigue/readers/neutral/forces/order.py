"""Where the rows of each group of welds stand in a table of nodal forces, and a copy of a table that has them all over.

A Parquet file in about the order of the groups serves as it is. Any other is parted once: its rows are dealt out to
files that hold a few groups each, so that never more than a batch of rows is in memory.
"""

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeAlias, TypeVar

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.errors import DataError, refuse
from fatigue.known_formats import misplaced
from fatigue.naming import composed
from fatigue.readers.neutral.files import DAMAGE, Columns, csv_batches, damaged
from fatigue.readers.neutral.forces.tables import COMPONENTS, open_nodal_forces
from fatigue.readers.neutral.tables import Table, codes_of, named
from fatigue.readers.text.layout import table_layout

Rows = TypeVar("Rows", pa.Table, pa.RecordBatch)
Batches: TypeAlias = Callable[[int, int], Iterator[pa.RecordBatch]]

CODE, ROW = "weld among all", "row of the file"  # columns of a piece; no names of the neutral format
BATCH = 200_000  # rows in memory together while a file is parted
ROWS_APART = 500_000  # about as many in one part
MOST_PARTS = 500  # files open at the same time
MOST_STRAYS = 1_000_000  # rows of unknown welds that are looked at
READ_BUFFER = 1 << 20  # bytes
CSV_ROW = 60  # bytes, about
CSV_KINDS = {"weld": pa.string(), "node": pa.int64(), "mode": pa.int64()} | dict.fromkeys(COMPONENTS, pa.float64())


@dataclass(frozen=True, slots=True, eq=False)
class WeldCodes:
    """The welds of all groups, numbered group by group.

    ``groups`` are their names, ``code`` the number of each by its name in the file, ``group``, (w,), the group of each
    number. ``skipped`` are welds of the file that nobody asks for.
    """

    groups: tuple[tuple[str, ...], ...]
    code: Mapping[str, int]
    group: NDArray[np.int32]
    skipped: frozenset[str]

    @property
    def are_those_of_the_file(self) -> bool:
        """Whether the file has these welds, under these names, and no others."""
        return not self.skipped and all(name in self.code for group in self.groups for name in group)

    def of(self, welds: pa.ChunkedArray) -> NDArray[np.int32]:
        """Numbers of a column of names, (r,); -1 where there is no such weld, -2 where it is skipped."""
        numbers = [known[place] for known, place in self.coded(welds)]
        return numbers[0] if len(numbers) == 1 else np.concatenate([np.zeros(0, dtype=np.int32), *numbers])

    def among(self, welds: pa.ChunkedArray) -> NDArray[np.int32]:
        """Distinct numbers in a column of names, ascending; below 0 as in ``of``."""
        present = [np.zeros(0, dtype=np.int32)]
        for known, place in self.coded(welds):
            used = np.zeros(known.size, dtype=np.bool_)
            used[place] = True
            present.append(known[used])
        return np.unique(np.concatenate(present))

    def coded(self, welds: pa.ChunkedArray) -> Iterator[tuple[NDArray[np.int32], NDArray[np.integer]]]:
        """Numbers of the distinct names of each chunk, -1 last, and the place of each row's name among them."""
        if not pt.is_dictionary(welds.type):
            welds = welds.cast(pa.string()).dictionary_encode()
        for chunk in welds.chunks:
            names = chunk.dictionary.cast(pa.string()).to_pylist()
            known = np.array([*(self._number(composed(name or "")) for name in names), -1], dtype=np.int32)
            yield known, codes_of(chunk, len(names))

    def _number(self, name: str) -> int:
        return self.code.get(name, -2 if name in self.skipped else -1)


def weld_codes(
    groups: Sequence[Sequence[str]], in_file: Mapping[str, str] | None = None, skipped: Collection[str] = ()
) -> WeldCodes:
    """Give the welds of all groups their numbers; ``in_file`` are the names they have there if these are others."""
    names = [weld for group in groups for weld in group]
    code = {name if in_file is None else in_file[name]: i for i, name in enumerate(names)}
    group = np.repeat(np.arange(len(groups), dtype=np.int32), [len(group) for group in groups])
    return WeldCodes(tuple(map(tuple, groups)), code, group, frozenset(skipped))


@dataclass(frozen=True, slots=True, eq=False)
class Source:
    """A table of forces in pieces that are decoded one by one.

    Attributes
    ----------
    header : path, names and types of the columns
    rows : number of rows in each piece
    pieces : the pieces in which each group has rows
    read : decodes a piece: its columns by trimmed name, the weld as ``CODE``, and the row in the file as ``ROW``
    nothing : the same columns without rows
    batches : decodes the columns of a piece as they are in the file, so many rows at a time, by several threads at
        once; without it the rows are not in the order of the file
    """

    header: Table
    rows: tuple[int, ...]
    pieces: tuple[tuple[int, ...], ...]
    read: Callable[[int], pa.Table]
    nothing: pa.Table
    batches: Batches | None = None


def in_place(path: Path, welds: WeldCodes, most_rows: int) -> Source | None:
    """Look up which row groups of a Parquet file hold which groups of welds; None if one has more than ``most_rows``.

    Raises
    ------
    DataError : the file is no table, has no column ``weld`` or an unknown weld in it
    """
    header = open_nodal_forces(path)
    columns = _columns(header)
    weld = next(stored for stored, name in columns.items() if name == "weld")
    file = pq.ParquetFile(path, read_dictionary=[weld], pre_buffer=False)
    rows = tuple(file.metadata.row_group(i).num_rows for i in range(file.num_row_groups))
    if max(rows) > most_rows:
        return None
    first = np.cumsum([0, *rows])
    strays = Strays(header)
    pieces: list[list[int]] = [[] for _ in welds.groups]
    for i in range(len(rows)):
        column = _decoded(path, partial(file.read_row_group, i, [weld])).column(0)
        present = welds.among(column)
        if (present == -1).any():
            strays.look(column, welds.of(column), int(first[i]))
        for group in np.unique(welds.group[present[present >= 0]]):
            pieces[group].append(i)
    strays.refuse(welds)

    def read(piece: int) -> pa.Table:
        table = _decoded(path, partial(file.read_row_group, piece, list(columns)))
        return _coded(_trimmed(table, columns), welds, int(first[piece]))

    def batches(piece: int, at_once: int) -> Iterator[pa.RecordBatch]:
        own = pq.ParquetFile(path, metadata=file.metadata, read_dictionary=[weld], pre_buffer=False)
        for batch in own.iter_batches(at_once, [piece], list(columns), use_threads=False):
            batch.validate(full=True)
            yield _trimmed(batch, columns)

    nothing = _coded(_trimmed(file.schema_arrow.empty_table().select(list(columns)), columns), welds, 0)
    return Source(header, rows, tuple(map(tuple, pieces)), read, nothing, batches)


def parted(path: Path, welds: WeldCodes, scratch: Path) -> Source:
    """Deal out the rows of a file to parts in ``scratch`` that hold a few groups each.

    Raises
    ------
    DataError : the file is no table, has no column ``weld`` or an unknown weld in it
    """
    if path.suffix.lower() != ".csv":
        header = open_nodal_forces(path)
        return _dealt_out(header, header.rows, _parquet_batches(path, _columns(header)), welds, scratch)
    refuse(DataError, filter(None, [misplaced(path, path.name, text=False)]))
    layout = table_layout(path, ("weld",))
    kinds = tuple(CSV_KINDS.get(name.strip(), pa.string()) for name in layout.names)
    header = named(path, Columns(layout.names, kinds, 0, _unread))
    columns = _columns(header)
    try:
        batches = csv_batches(path, layout, {name: CSV_KINDS[name] for name in columns.values()})
        tables = (pa.Table.from_batches([batch]) for batch in batches)
        return _dealt_out(header, path.stat().st_size // CSV_ROW, tables, welds, scratch)
    except DAMAGE:  # a mistake, or numbers of another type: told, or read, with the file in memory
        header = open_nodal_forces(path)
        whole = [header.columns.read(header.position[name]) for name in columns.values()]
        return _dealt_out(header, header.rows, [pa.table(whole, list(columns.values()))], welds, scratch)


def _columns(header: Table) -> dict[str, str]:
    """Columns that are read: their name in the file, and trimmed."""
    header.expect(("weld",), header.position, strict=False)
    return {header.columns.names[i]: name for name, i in header.position.items() if name in CSV_KINDS}


def _dealt_out(header: Table, rows: int, batches: Iterable[pa.Table], welds: WeldCodes, scratch: Path) -> Source:
    """Deal out batches of about so many rows, columns by trimmed name, to files of neighbouring groups."""
    scratch.mkdir(parents=True, exist_ok=True)
    groups = len(welds.groups)
    parts = min(max(1, math.ceil(rows / ROWS_APART)), groups, MOST_PARTS)
    part_of_group = np.arange(groups) * parts // groups
    files = [scratch / f"forces-{part:03d}.arrow" for part in range(parts)]
    size = np.zeros(parts, dtype=np.int64)
    strays = Strays(header)
    first = 0
    with ExitStack() as stack:
        writers: dict[int, pa.ipc.RecordBatchFileWriter] = {}
        for batch in batches:
            numbered = _coded(batch, welds, first)
            code = numbered.column(CODE).to_numpy()
            strays.look(batch.column("weld"), code, first)
            first += len(code)
            part = np.where(code < 0, parts, part_of_group[welds.group[code]])
            ordered = numbered.take(np.argsort(part, kind="stable"))
            ends = np.searchsorted(np.sort(part), np.arange(parts + 1))
            for i in np.flatnonzero(np.diff(ends)).tolist():
                if i not in writers:
                    sink = stack.enter_context(pa.OSFile(str(files[i]), "wb"))
                    options = pa.ipc.IpcWriteOptions(compression="lz4")
                    writers[i] = stack.enter_context(pa.ipc.new_file(sink, ordered.schema, options=options))
                writers[i].write_table(ordered.slice(ends[i], ends[i + 1] - ends[i]))
            size += np.diff(ends)
    strays.refuse(welds)

    def read(part: int) -> pa.Table:
        with pa.OSFile(str(files[part])) as stored:
            return pa.ipc.open_file(stored).read_all().combine_chunks()

    pieces = tuple((int(part),) if size[part] else () for part in part_of_group)
    return Source(header, tuple(size.tolist()), pieces, read, numbered.schema.empty_table())


class Strays:
    """Rows of a file whose weld nobody knows, to be told all together."""

    def __init__(self, header: Table) -> None:
        self.header = header
        self.names: list[pa.ChunkedArray] = []
        self.numbers: list[NDArray[np.int64]] = []

    def look(self, weld: pa.ChunkedArray, code: NDArray[np.int32], first: int) -> None:
        """Note the rows of a piece that begins at row ``first`` of the file."""
        rows = np.flatnonzero(code == -1)
        if rows.size and sum(map(len, self.numbers)) < MOST_STRAYS:
            name = weld.take(rows)
            self.names.append(name.cast(name.type.value_type) if pt.is_dictionary(name.type) else name)
            self.numbers.append(first + rows)

    def refuse(self, welds: WeldCodes) -> None:
        """Refuse the file if there were any."""
        if not self.names:
            return
        number = np.concatenate(self.numbers)
        names = pa.chunked_array([chunk for column in self.names for chunk in column.chunks])
        header = self.header
        rows = Columns(header.columns.names, header.columns.kinds, number.size, lambda _: names, number)
        table = Table(header.path, rows, header.position)
        table.known("weld", *table.groups("weld"), {*welds.code, *welds.skipped}, "the welds")
        table.refuse()


def _parquet_batches(path: Path, columns: Mapping[str, str]) -> Iterator[pa.Table]:
    """Read a Parquet file in batches; buffered, so that not even a whole column of a row group is in memory."""
    weld = [stored for stored, name in columns.items() if name == "weld"]
    file = pq.ParquetFile(path, read_dictionary=weld, buffer_size=READ_BUFFER, pre_buffer=False)
    try:
        for batch in file.iter_batches(BATCH, columns=list(columns)):
            yield _trimmed(pa.Table.from_batches([batch]), columns)
    except DAMAGE as error:
        raise DataError(damaged(path, error)) from None


def _trimmed(table: Rows, columns: Mapping[str, str]) -> Rows:
    return table.rename_columns([columns[name] for name in table.schema.names])


def _coded(rows: pa.Table, welds: WeldCodes, first: int) -> pa.Table:
    """Replace the names of welds by their numbers and add the rows' own numbers, from ``first``."""
    code = pa.array(welds.of(rows.column("weld")))
    number = pa.array(np.arange(first, first + rows.num_rows))
    return rows.drop_columns(["weld"]).append_column(CODE, code).append_column(ROW, number)


def _decoded(path: Path, read: Callable[[], pa.Table]) -> pa.Table:
    """Read a piece of a file; one that cannot be decoded is refused."""
    try:
        table = read()
        table.validate(full=True)
    except DAMAGE as error:
        raise DataError(damaged(path, error)) from None
    return table


def _unread(position: int) -> pa.ChunkedArray:
    raise NotImplementedError(f"column {position} of a file that is read in pieces")
