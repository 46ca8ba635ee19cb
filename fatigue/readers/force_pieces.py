"""The table of modal nodal forces, group of welds by group of welds, in memory that does not grow with the body.

A Parquet file sorted by weld is read from front to back, row group by row group. Any other order, and CSV, is sorted
once on disk. Row numbers in messages stay those of the file as it was given.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.readers.files import Columns
from fatigue.readers.forces import open_nodal_forces
from fatigue.readers.tables import Table

ROWS_AT_ONCE = 4_000_000  # of row groups decoded together, about 200 MB
_ROW = "row of the file"  # no name of the neutral format


class ForcePieces:
    """The rows of each group of welds as a table of its own.

    ``groups`` are the names of the welds of each group; tables are asked for in this order, from the first again as
    often as wanted. ``scratch`` is a folder for the sorted copy of a file that needs one.

    Raises
    ------
    DataError : the file is no table, has no column ``weld`` or an unknown weld in it
    """

    def __init__(self, path: Path, groups: Sequence[Sequence[str]], scratch: Path) -> None:
        self._path = path
        self._groups = groups
        if len(groups) == 1:
            return
        whole = open_nodal_forces(path)
        whole.expect(("weld",), whole.position, strict=False)
        self._weld = whole.columns.names[whole.position["weld"]]
        self._kinds = whole.columns.kinds
        group_of = {weld: i for i, welds in enumerate(groups) for weld in welds}
        if path.suffix.lower() == ".parquet":
            file = pq.ParquetFile(path, read_dictionary=[self._weld])
            found = _row_groups_of(file, self._weld, group_of, whole)
            if all(_rows(file, row_groups) <= ROWS_AT_ONCE for row_groups in found):
                self._file, self._row_groups = file, found
        if not hasattr(self, "_file"):
            copy = _sorted_by_group(whole, self._weld, group_of, scratch)
            self._file = pq.ParquetFile(copy, read_dictionary=[self._weld])
            self._row_groups = _row_groups_of(self._file, self._weld, group_of, whole)
        self._first = np.cumsum([0, *(_rows(self._file, [i]) for i in range(self._file.num_row_groups))])
        self._decoded: dict[int, pa.Table] = {}

    def table(self, group: int) -> Table:
        """Rows of one group of welds."""
        if len(self._groups) == 1:
            return open_nodal_forces(self._path)
        wanted = self._row_groups[group]
        self._decoded = {i: self._decoded.get(i) or self._file.read_row_group(i) for i in wanted}
        rows = pa.concat_tables(self._decoded.values()).unify_dictionaries()
        if _ROW in rows.column_names:
            number = rows.column(_ROW).to_numpy()
        else:
            number = np.concatenate([np.arange(self._first[i], self._first[i + 1]) for i in wanted])
        here = np.isin(_group_codes(rows.column(self._weld), dict.fromkeys(self._groups[group], 0)), 0)
        mine = rows.drop_columns([_ROW] if _ROW in rows.column_names else []).filter(pa.array(here))
        columns = Columns(tuple(mine.column_names), self._kinds, mine.num_rows, mine.column, number[here])
        return Table(self._path, columns, {name.strip(): i for i, name in enumerate(mine.column_names)})


def _rows(file: pq.ParquetFile, row_groups: Sequence[int]) -> int:
    return sum(file.metadata.row_group(i).num_rows for i in row_groups)


def _group_codes(weld: pa.ChunkedArray, group_of: Mapping[str, int]) -> NDArray[np.int64]:
    """Group of each row, -1 where its weld belongs to none."""
    codes = []
    for chunk in weld.chunks if pa.types.is_dictionary(weld.type) else pc.dictionary_encode(weld).chunks:
        group = np.array([group_of.get((name or "").strip(), -1) for name in chunk.dictionary.to_pylist()] + [-1])
        codes.append(group[chunk.indices.fill_null(len(group) - 1).to_numpy()])
    return np.concatenate(codes)


def _row_groups_of(file: pq.ParquetFile, weld: str, group_of: Mapping[str, int], whole: Table) -> list[list[int]]:
    """Row groups in which each group of welds has rows; an unknown weld is refused."""
    found: list[list[int]] = [[] for _ in range(max(group_of.values()) + 1)]
    for i in range(file.num_row_groups):
        column = file.read_row_group(i, columns=[weld]).column(0)
        codes = np.unique(_group_codes(column, group_of))
        if codes[0] < 0:
            names, code = whole.groups("weld")
            whole.known("weld", names, code, group_of.keys(), "the welds")
            whole.refuse()
        for group in codes:
            found[group].append(i)
    return found


def _sorted_by_group(whole: Table, weld: str, group_of: Mapping[str, int], scratch: Path) -> Path:
    """Write the rows sorted by group of welds, each with its number in the file.

    Pieces of the file are sorted one by one; each group is then gathered from all pieces, which stay on disk.
    """
    scratch.mkdir(parents=True, exist_ok=True)
    groups = max(group_of.values()) + 1
    pieces: list[Path] = []
    ends: list[NDArray[np.int64]] = []
    first = 0
    for rows in _batches(whole):
        code = _group_codes(rows.column(weld), group_of)
        numbered = rows.append_column(_ROW, pa.array(np.arange(first, first + rows.num_rows)))
        pieces.append(scratch / f"piece-{len(pieces):05d}.arrow")
        with pa.OSFile(str(pieces[-1]), "wb") as sink, pa.ipc.new_file(sink, numbered.schema) as writer:
            writer.write_table(numbered.take(pa.array(np.argsort(code, kind="stable"))))
        ends.append(np.cumsum(np.bincount(code[code >= 0], minlength=groups)) + np.count_nonzero(code < 0))
        first += rows.num_rows
    sorted_file = scratch / "forces-by-weld.parquet"
    opened = [pa.ipc.open_file(pa.memory_map(str(piece))).read_all() for piece in pieces]
    with pq.ParquetWriter(sorted_file, opened[0].schema, compression="zstd") as writer:
        for group in range(groups):
            begins = [int(end[group - 1]) if group else 0 for end in ends]
            slices = [t.slice(b, int(end[group]) - b) for t, b, end in zip(opened, begins, ends, strict=True)]
            writer.write_table(pa.concat_tables(slices))
    del opened
    for piece in pieces:
        piece.unlink()
    return sorted_file


def _batches(whole: Table) -> Iterator[pa.Table]:
    """Read a table in pieces of bounded size; a CSV file is in memory once it is open."""
    names = whole.columns.names
    if whole.path.suffix.lower() == ".parquet":
        for batch in pq.ParquetFile(whole.path).iter_batches(batch_size=ROWS_AT_ONCE // 4):
            yield pa.Table.from_batches([batch])
    else:
        yield pa.table([whole.columns.read(i) for i in range(len(names))], names=list(names))
