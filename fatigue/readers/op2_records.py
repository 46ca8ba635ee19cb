"""The record structure of a NASTRAN OUTPUT2 file: where every table and every record of it lies.

An OP2 file is a stream of Fortran records, each between two copies of its byte length. One-word records are markers: a
positive marker announces a record of that many words, the markers -1, -2, -3 ... count the logical records of a table,
and a zero ends a table or the file. The structure is checked to the last byte before anything is decoded, so that a
cut or damaged file is refused whatever the damage hits.
"""

import mmap
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem

Span = tuple[int, int]
"""First byte and length in bytes of one chunk of a record."""

_LAYOUTS = {
    b"\x04\x00\x00\x00": ("<", 4),
    b"\x08\x00\x00\x00": ("<", 8),
    b"\x00\x00\x00\x04": (">", 4),
    b"\x00\x00\x00\x08": (">", 8),
}


@dataclass(frozen=True, slots=True, eq=False)
class Op2Table:
    """One table: its name and its logical records, the identification and trailer records left out."""

    name: str
    records: tuple[tuple[Span, ...], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Op2File:
    """A structurally sound OP2 file.

    Attributes
    ----------
    order, word : byte order ("<" or ">") and bytes per word (4 or 8)
    label : version label of the solver, empty without a tape header
    """

    path: Path
    order: str
    word: int
    label: str
    tables: tuple[Op2Table, ...]
    data: NDArray[np.uint8]

    def record(self, spans: tuple[Span, ...]) -> NDArray[np.uint8]:
        """Bytes of one logical record, its chunks joined."""
        chunks = [self.data[first : first + length] for first, length in spans]
        return chunks[0] if len(chunks) == 1 else np.concatenate(chunks or [self.data[:0]])


class _Cursor:
    """Walks through the Fortran records and names the byte at which the structure breaks."""

    def __init__(self, path: Path, data: mmap.mmap) -> None:
        self.path, self.data, self.position = path, data, 0
        self.table = ""
        if data[:4] not in _LAYOUTS:
            raise DataError(
                Problem(
                    "not_op2", str(path), "this is not a NASTRAN OP2 file", "Give the .op2 of a run with PARAM,POST,-1"
                )
            )
        self.order, self.word = _LAYOUTS[data[:4]]
        self.endian = "little" if self.order == "<" else "big"

    def broken(self, found: str) -> DataError:
        """Refusal of a damaged file."""
        place = f"{self.path}, byte {self.position}" + (f", table {self.table}" if self.table else "")
        return DataError(
            Problem(
                "op2_damaged",
                place,
                f"the file is cut or damaged: {found}",
                "Copy the file again in binary mode, or repeat the run",
            )
        )

    def span(self) -> Span:
        """Step over one Fortran record and return its bytes' place."""
        head = self.data[self.position : self.position + 4]
        length = int.from_bytes(head, self.endian)  # type: ignore[arg-type]
        first = self.position + 4
        if len(head) < 4 or first + length + 4 > len(self.data):
            raise self.broken("a record runs past the end of the file")
        if self.data[first + length : first + length + 4] != head:
            raise self.broken(f"the two length marks of a record of {length} bytes differ")
        self.position = first + length + 4
        return first, length

    def marker(self) -> int:
        """Read a one-word record."""
        first, length = self.span()
        if length != self.word:
            raise self.broken(f"a marker of {self.word} bytes was expected, the record has {length}")
        return int.from_bytes(self.data[first : first + length], self.endian, signed=True)  # type: ignore[arg-type]

    def expect(self, *markers: int) -> None:
        """Step over markers that must have these values."""
        for wanted in markers:
            if (found := self.marker()) != wanted:
                raise self.broken(f"marker {found} where {wanted} was expected")

    def words(self, count: int) -> Span:
        """Step over a record announced as ``count`` words."""
        first, length = self.span()
        if length != count * self.word:
            raise self.broken(f"a record of {count} words was announced, it has {length / self.word:g}")
        return first, length

    def text(self, span: Span) -> str:
        """Characters of a record; in a 64-bit file each word carries four of them and four blanks."""
        raw = self.data[span[0] : span[0] + span[1]]
        if self.word == 8:
            raw = b"".join(raw[i : i + 4] for i in range(0, len(raw), 8))
        return raw.decode("latin-1").strip()


def read_records(path: Path) -> Op2File:
    """Find every table of an OP2 file, of either word size and byte order.

    Raises
    ------
    DataError : the file is missing, empty, no OP2 file, cut, or damaged anywhere in its structure
    """
    try:
        with path.open("rb") as file:
            data = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    except (OSError, ValueError) as error:  # ValueError: an empty file cannot be mapped
        raise DataError(
            Problem("unreadable", str(path), f"the file cannot be read ({error})", "Check the path and the file")
        ) from error
    cursor = _Cursor(path, data)
    label = ""
    key = cursor.marker()
    if key == 3:  # PARAM,POST,-1 begins with date, tape identification and version label
        cursor.words(3)
        cursor.expect(7)
        cursor.words(7)
        cursor.expect(2)
        label = cursor.text(cursor.words(2))
        cursor.expect(-1, 0)
        key = cursor.marker()
    tables = []
    while key != 0:
        if key != 2:
            raise cursor.broken(f"marker {key} where a table name of 2 words was expected")
        tables.append(_table(cursor))
        # Some runs do not close the file with a last zero; a whole number of tables is all that can be asked for.
        key = cursor.marker() if cursor.position < len(data) else 0
    if cursor.position != len(data):
        raise cursor.broken(f"{len(data) - cursor.position} bytes follow the end mark of the file")
    return Op2File(path, cursor.order, cursor.word, label, tuple(tables), np.frombuffer(data, np.uint8))


def _table(cursor: _Cursor) -> Op2Table:
    """Step through one table after its name's marker."""
    cursor.table = ""
    cursor.table = cursor.text(cursor.words(2))
    name = cursor.table
    cursor.expect(-1, 7)
    cursor.words(7)
    records: list[tuple[Span, ...]] = []
    level = -2
    while True:
        cursor.expect(level)
        cursor.marker()  # 1: another record follows
        is_matrix = cursor.marker() != 0  # then its numbers may be wider than a word
        key = cursor.marker()
        if key == 0:
            break
        spans = []
        while key > 0:
            spans.append(cursor.span() if is_matrix else cursor.words(key))
            key = cursor.marker()
        records.append(tuple(spans))
        level -= 1
        cursor.position -= cursor.word + 8  # the negative marker just read opens the next record
    cursor.table = ""
    return Op2Table(name, tuple(records[1:]))  # the first record repeats the name
