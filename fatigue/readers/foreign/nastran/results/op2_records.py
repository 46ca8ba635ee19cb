"""The record structure of a NASTRAN OUTPUT2 file: where every table and every record of it lies.

An OP2 file is a stream of Fortran records, each between two copies of its byte length. One-word records are markers: a
positive marker announces a record of that many words, falling negative markers number the logical records of a table,
and a zero ends a table or the file. What solvers do differently is read as it comes: the tape header and its version
records may be there or not, and so may the version record after each table name (MSC Nastran since 2014, PARAM,POST,1);
a logical record is one chunk or many (OptiStruct: one for each row); the numbers of records may jump. The structure is
checked to the last byte before anything is decoded, so that a cut or damaged file is refused whatever the damage hits.
"""

import mmap
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem


class Chunks(NamedTuple):
    """Equal chunks of a record at equal distances: first byte and length of one [bytes], number, distance [bytes]."""

    first: int
    length: int
    number: int = 1
    pitch: int = 0


Record = tuple[Chunks, ...]

_LAYOUTS = {
    b"\x04\x00\x00\x00": ("<", 4),
    b"\x08\x00\x00\x00": ("<", 8),
    b"\x00\x00\x00\x04": (">", 4),
    b"\x00\x00\x00\x08": (">", 8),
}
_NAME_WORDS = 2
_HEADER_STARTS = (3, 7)  # words of the date, or of the tape identification where there is no date
_COMPARED_AT_ONCE = 64, 1 << 18  # chunks, from the first to the largest step


@dataclass(frozen=True, slots=True, eq=False)
class Op2Table:
    """One table: its name, its logical records (name and trailer left out), and the number of the run that wrote it."""

    name: str
    records: tuple[Record, ...]
    run: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Op2File:
    """A structurally sound OP2 file.

    Attributes
    ----------
    order, word : byte order ("<" or ">") and bytes per word (4 or 8)
    label : version label of the solver, empty without a tape header
    tables : in the order of the file; a file to which a second run was appended has the tables of both
    is_closed : whether the file ends with its end mark
    """

    path: Path
    order: str
    word: int
    label: str
    tables: tuple[Op2Table, ...]
    is_closed: bool
    data: NDArray[np.uint8]

    def record(self, record: Record) -> NDArray[np.uint8]:
        """Bytes of one logical record, its chunks joined."""
        parts = [
            self.data[c.first : c.first + c.length]
            if c.number == 1
            else np.ndarray((c.number, c.length), np.uint8, self.data, c.first, (c.pitch, 1)).reshape(-1)
            for c in record
        ]
        return parts[0] if len(parts) == 1 else np.concatenate([self.data[:0], *parts])


def characters(raw: bytes, word: int) -> str:
    """Characters of words of 4 or 8 bytes; a 64-bit word carries four of them and four blanks, or eight."""
    quarters = [raw[k : k + 4] for k in range(0, len(raw), 4)] if word == 8 else []
    if quarters and not b"".join(quarters[1::2]).strip(b" \0"):
        raw = b"".join(quarters[::2])
    return raw.decode("latin-1")


def text_of(raw: bytes, word: int) -> str:
    """Characters of words as text: what cannot be printed is a blank, and blanks at the ends are left out."""
    return "".join(c if c.isprintable() else " " for c in characters(raw, word)).strip()


class _Cursor:
    """Walks through the Fortran records and names the byte at which the structure breaks."""

    def __init__(self, path: Path, data: mmap.mmap) -> None:
        self.path, self.data, self.position = path, data, 0
        self.table = ""
        self.between: dict[int, bytes] = {}  # words between one chunk and the next, by their number
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

    def bytes_of(self, value: int, size: int = 4) -> bytes:
        """Write an integer as the file does; a length mark has four bytes whatever the size of a word."""
        return value.to_bytes(size, self.endian, signed=True)  # type: ignore[arg-type]

    def record(self) -> Chunks:
        """Step over one Fortran record and return the place of its bytes."""
        head = self.data[self.position : self.position + 4]
        length = int.from_bytes(head, self.endian)  # type: ignore[arg-type]
        first = self.position + 4
        if len(head) < 4 or first + length + 4 > len(self.data):
            raise self.broken("a record runs past the end of the file")
        if self.data[first + length : first + length + 4] != head:
            raise self.broken(f"the two length marks of a record of {length} bytes differ")
        self.position = first + length + 4
        return Chunks(first, length)

    def marker(self) -> int:
        """Read a one-word record."""
        first, length, _, _ = self.record()
        if length != self.word:
            raise self.broken(f"a marker of {self.word} bytes was expected, the record has {length}")
        return int.from_bytes(self.data[first : first + length], self.endian, signed=True)  # type: ignore[arg-type]

    def expect(self, *markers: int) -> None:
        """Step over markers that must have these values."""
        for wanted in markers:
            if (found := self.marker()) != wanted:
                raise self.broken(f"marker {found} where {wanted} was expected")

    def words(self, count: int) -> Chunks:
        """Step over a record announced as ``count`` words."""
        record = self.record()
        if record.length != count * self.word:
            raise self.broken(f"a record of {count} words was announced, it has {record.length / self.word:g}")
        return record

    def chunks(self, count: int) -> Chunks:
        """Step over a record announced as ``count`` words and over those like it that follow."""
        one = self.words(count)
        if count not in self.between:
            mark, own = self.bytes_of(self.word), self.bytes_of(one.length)
            self.between[count] = own + mark + self.bytes_of(count, self.word) + mark + own
        between = self.between[count]
        at = one.first + one.length
        if self.data[at : at + len(between)] != between:
            return one
        pitch = one.length + len(between)
        repeats = self._repeats(between, at, pitch)
        self.position = one.first + repeats * pitch - 4
        self.words(count)  # the last one's own marks
        return Chunks(one.first, one.length, repeats + 1, pitch)

    def _repeats(self, between: bytes, at: int, pitch: int) -> int:
        """How often the same bytes stand at ``at`` and every ``pitch`` bytes behind it."""
        wanted = np.frombuffer(between, np.int32)
        most = (len(self.data) - at - len(between)) // pitch + 1
        found, (step, largest) = 0, _COMPARED_AT_ONCE
        while found < most:
            size = min(step, most - found)
            some = np.ndarray((size, wanted.size), np.int32, self.data, at + found * pitch, (pitch, 4))
            other = np.flatnonzero((some != wanted).any(axis=1))
            if other.size:
                return found + int(other[0])
            found, step = found + size, min(2 * step, largest)
        return found

    def is_before(self, *markers: int) -> bool:
        """Whether one of these markers comes next."""
        mark = self.bytes_of(self.word)
        following = self.data[self.position : self.position + self.word + 8]
        return any(following == mark + self.bytes_of(marker, self.word) + mark for marker in markers)

    def text(self, record: Chunks) -> str:
        """Characters of a record."""
        return text_of(self.data[record.first : record.first + record.length], self.word)


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
    labels: list[str] = []
    tables: list[Op2Table] = []
    is_closed = False
    while cursor.position < len(data):  # some runs do not close the file: a whole number of tables is all one can ask
        if is_closed and not cursor.is_before(0, _NAME_WORDS, *_HEADER_STARTS):
            raise cursor.broken(f"{len(data) - cursor.position} bytes follow the end mark of the file")
        key = cursor.marker()
        is_closed = key == 0
        if key in _HEADER_STARTS:
            labels.append(_header(cursor, key))
        elif key == _NAME_WORDS:
            tables.append(_table(cursor, max(len(labels) - 1, 0)))
        elif key != 0:
            raise cursor.broken(f"marker {key} where a table name of {_NAME_WORDS} words was expected")
    label = labels[0] if labels else ""
    return Op2File(path, cursor.order, cursor.word, label, tuple(tables), is_closed, np.frombuffer(data, np.uint8))


def _header(cursor: _Cursor, key: int) -> str:
    """Step through the tape header after its first marker; returns the solver's label with its version record."""
    if key == _HEADER_STARTS[0]:
        date = cursor.record()
        if date.length not in (cursor.word, 3 * cursor.word):  # some programs announce three words and write one
            raise cursor.broken(f"a date of 3 words was announced, the record has {date.length / cursor.word:g}")
        key = cursor.marker()
    texts = []
    while key > 0:
        texts.append(cursor.text(cursor.words(key)))
        key = cursor.marker()
    if key != -1:
        raise cursor.broken(f"marker {key} where the end of the header, -1, was expected")
    cursor.expect(0)
    return " ".join(" ".join(texts[1:]).split())  # the first is the tape identification


def _table(cursor: _Cursor, run: int) -> Op2Table:
    """Step through one table after its name's marker."""
    cursor.table = ""
    cursor.table = cursor.text(cursor.words(_NAME_WORDS))
    name = cursor.table
    level = cursor.marker()
    while level > 0:  # the version record of newer solvers
        cursor.words(level)
        level = cursor.marker()
    if level != -1:
        raise cursor.broken(f"marker {level} where the table's trailer, -1, was expected")
    cursor.words(cursor.marker())  # seven words in every file seen
    records: list[Record] = []
    key = cursor.marker()
    while True:
        if key >= level:
            raise cursor.broken(f"marker {key} where a record after {-level} was expected")
        level = key
        cursor.marker()  # 1: another record follows
        is_matrix = cursor.marker() != 0  # then its numbers may be wider than a word
        key = cursor.marker()
        if key == 0:
            break
        chunks: list[Chunks] = []
        while key > 0:
            chunks.append(cursor.record() if is_matrix else cursor.chunks(key))
            key = cursor.marker()
        records.append(tuple(chunks))
    cursor.table = ""
    return Op2Table(name, tuple(records[1:]), run)  # the first record repeats the name
