"""The modal nodal forces of a body, group of welds by group of welds, in memory that does not grow with the body."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.files.naming import composed
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.columns import Columns
from fatigue.readers.neutral.forces.in_place import in_place
from fatigue.readers.neutral.forces.nodal_forces import open_nodal_forces
from fatigue.readers.neutral.forces.regular_check import RegularCheck, regular_check
from fatigue.readers.neutral.forces.sorted_copy import sorted_copy
from fatigue.readers.neutral.forces.source import CODE, ROW, Source
from fatigue.readers.neutral.forces.unknown_welds import UnknownWelds
from fatigue.readers.neutral.forces.weld_codes import WeldCodes, weld_codes
from fatigue.readers.neutral.line_file import LineFile
from fatigue.readers.neutral.tables import Table

ROWS_KEPT = 2_500_000  # decoded, of 50 to 70 bytes each
DETOUR = 1.5  # a file is read where it is if all groups in turn decode no more than so many times its rows


@dataclass(frozen=True, slots=True, eq=False)
class _Bucket:
    """Decoded rows of a bucket in the order of the groups.

    ``begin``, (g + 1,), is where each group begins; ``expected`` are the groups that have not been asked for yet.
    """

    rows: pa.Table
    begin: NDArray[np.int64]
    expected: set[int]

    def rows_of(self, group: int) -> pa.Table:
        """Rows of one group, a view."""
        first, end = self.begin[group : group + 2]
        return self.rows.slice(first, end - first)


class ForcesByGroup:
    """The rows of each group of welds as a table of its own.

    ``groups`` are the names of the welds of each group, ``in_file`` those they have in the file if these are others,
    ``skipped`` the welds of the file that are not asked for. Any group may be asked for at any time, by several threads
    at once; those near the groups asked for last come without decoding anything again, and of groups asked for in turn
    hardly more than one bucket is in memory. ``scratch`` is a folder for a sorted copy of the file, should it need one;
    no other process may use it.

    Raises
    ------
    DataError : the file is no table, has no column ``weld`` or an unknown weld in it
    """

    def __init__(
        self,
        path: Path,
        groups: Sequence[Sequence[str]],
        scratch: Path,
        in_file: Mapping[str, str] | None = None,
        skipped: Collection[str] = (),
    ) -> None:
        self._path = path
        self._welds = weld_codes(groups, in_file, skipped)
        self._lock = Lock()
        self._decoded: dict[int, _Bucket] = {}
        if len(groups) > 1:
            self._source = _source(path, self._welds, scratch)
            self._nameless = _nameless(path, self._source.header)

    def table(self, group: int) -> Table:
        """Rows of one group of welds."""
        names = self._welds.groups[group]
        if len(self._welds.groups) == 1:
            table = open_nodal_forces(self._path)
            return table if self._welds.are_those_of_the_file else _renamed(table, self._welds)
        rows = self._rows(group)
        header, code = self._source.header, rows.column(CODE).to_numpy() - np.searchsorted(self._welds.group, group)
        weld = pa.chunked_array([pa.DictionaryArray.from_arrays(code.astype(np.int32), pa.array(names))])
        stored = {i: name for name, i in header.position.items()}

        def read(position: int) -> pa.ChunkedArray:
            if position in self._nameless:
                return self._nameless[position]
            return weld if stored[position] == "weld" else rows.column(stored[position])

        columns = Columns(header.columns.names, header.columns.kinds, rows.num_rows, read, rows.column(ROW).to_numpy())
        return Table(self._path, columns, header.position, warnings=_of_file(header))

    def regular_check(
        self, lines: LineFile, modes: Modes, ignore_modes: Collection[int], *, strict: bool
    ) -> RegularCheck | None:
        """Check of the file in its own order; None where its rows do not come node by node.

        ``lines`` has the lines of the welds of all groups.
        """
        if len(self._welds.groups) == 1:
            return None
        return regular_check(self._source, self._welds, lines, modes, ignore_modes, strict=strict)

    def _rows(self, group: int) -> pa.Table:
        """Rows of a group with their ``CODE`` and ``ROW``.

        A bucket stays decoded until all its groups have been asked for, those used last as long as there is room.
        """
        wanted = self._source.buckets[group]
        found = []
        with self._lock:
            for i in _dropped(list(self._decoded), wanted, self._source.rows):
                del self._decoded[i]
            for i in wanted:
                bucket = self._decoded.pop(i) if i in self._decoded else self._bucket(i)
                bucket.expected.discard(group)
                rows = bucket.rows_of(group)
                if bucket.expected:
                    self._decoded[i] = bucket
                elif i != wanted[-1]:
                    rows = rows.take(np.arange(len(rows)))  # a view would keep the bucket while the next one is decoded
                found.append(rows)
                del bucket
        return pa.concat_tables(found or [self._source.nothing])

    def _bucket(self, number: int) -> _Bucket:
        """Decode a bucket, its rows in the order of the groups; the rows of a group keep the order of the file."""
        rows = self._source.read(number)
        if self._welds.skipped:
            rows = rows.filter(pa.array(rows.column(CODE).to_numpy() >= 0))
        group = self._welds.group[rows.column(CODE).to_numpy()]
        if np.any(group[1:] < group[:-1]):
            order = np.argsort(group, kind="stable")
            rows, group = rows.take(order), group[order]
        begin = np.searchsorted(group, np.arange(len(self._welds.groups) + 1))
        return _Bucket(rows, begin, set(np.flatnonzero(np.diff(begin)).tolist()))


def _nameless(path: Path, header: Table) -> dict[int, pa.ChunkedArray]:
    """First value, if there is any, of every column without a name: it is told, and not kept in buckets."""
    places = [k for k, name in enumerate(header.columns.names) if not composed(name)]
    if not places:
        return {}
    columns = open_nodal_forces(path).columns
    filled = {k: (v for v in columns.read(k).to_pylist() if v is not None and str(v).strip()) for k in places}
    return {k: pa.chunked_array([[v for v in (next(values, None),) if v is not None]]) for k, values in filled.items()}


def _renamed(table: Table, welds: WeldCodes) -> Table:
    """Table of a whole file under the names that are asked for, without the rows of skipped welds.

    Raises
    ------
    DataError : an unknown weld
    """
    if "weld" not in table.position:
        return table
    position, columns = table.position["weld"], table.columns
    column = columns.read(position)
    code = welds.of(column)
    unknown = UnknownWelds(table)
    unknown.look(column, code, 0)
    unknown.refuse(welds)
    kept = np.flatnonzero(code >= 0)
    (names,) = welds.groups
    weld = pa.chunked_array([pa.DictionaryArray.from_arrays(code[kept].astype(np.int32), pa.array(names, pa.string()))])

    def read(at: int) -> pa.ChunkedArray:
        return weld if at == position else columns.read(at).take(pa.array(kept))

    pieces = Columns(columns.names, columns.kinds, kept.size, read, kept)
    return Table(table.path, pieces, table.position, warnings=_of_file(table))


def _of_file(header: Table) -> list[Problem]:
    """Warnings met while a file was opened; its unknown columns are told by whoever says which are known."""
    return [warning for warning in header.warnings if warning.code != "unknown_column"]


def _source(path: Path, welds: WeldCodes, scratch: Path) -> Source:
    """Source of the rows: the file where it is, or a sorted copy if its order meant decoding rows again and again."""
    if path.suffix.lower() == ".parquet":
        source = in_place(path, welds, ROWS_KEPT)
        if source and _rows_decoded(source) <= DETOUR * sum(source.rows):
            return source
    return sorted_copy(path, welds, scratch)


def _rows_decoded(source: Source) -> float:
    """Count the rows that are decoded when all groups are asked for in turn; infinite where they never fit."""
    decoded: list[int] = []
    rows = 0
    for wanted in source.buckets:
        if sum(source.rows[i] for i in wanted) > ROWS_KEPT:
            return np.inf
        rows += sum(source.rows[i] for i in wanted if i not in decoded)
        dropped = {*wanted, *_dropped(decoded, wanted, source.rows)}
        decoded = [i for i in decoded if i not in dropped] + list(wanted)
    return rows


def _dropped(decoded: Sequence[int], wanted: Collection[int], rows: Sequence[int]) -> list[int]:
    """Buckets to drop, of those decoded, the ones used last at the end, to keep ``ROWS_KEPT`` rows at most."""
    before = [i for i in reversed(decoded) if i not in wanted]
    kept = np.cumsum([sum(rows[i] for i in wanted), *(rows[i] for i in before)])[1:]
    return [i for i, total in zip(before, kept, strict=True) if total > ROWS_KEPT]
