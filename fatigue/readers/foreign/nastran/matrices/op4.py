"""Matrices of a formatted OUTPUT4 file: dense columns, or strings of values with either kind of string header.

A matrix begins with a line of columns, rows, form, type, name and format, in fields of 8. Each column follows with a
line of its number, its first row and its number of words; a first row of 0 tells of strings, of one header word
``row + 65536 (L + 1)``, or of two words ``L + 1, row`` where the number of rows is given below 0. A string has L words,
two of them a value in double precision. A column beyond the last ends the matrix.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy import sparse

from fatigue.errors import DataError, Problem

FIELD = 8
WORDS = {1: 1, 2: 2}  # of a value, by type: single and double precision
SYMMETRIC = 6
SHIFT = 65536
_FORMAT = re.compile(r"(?:1P,)?(\d+)[ED](\d+)\.\d+")


@dataclass(slots=True)
class _Lines:
    """Lines of a file, one after the other, with their number."""

    path: Path
    lines: list[str]
    at: int = 0

    def next(self) -> str:
        """The next line."""
        if self.at >= len(self.lines):
            raise self.bad("the file ends within a matrix")
        self.at += 1
        return self.lines[self.at - 1]

    def whole(self, count: int) -> list[int]:
        """Whole numbers of the next line, in fields of 8."""
        line = self.next()
        try:
            return [int(line[k * FIELD : (k + 1) * FIELD]) for k in range(count)]
        except ValueError:
            raise self.bad(f"{line[:40]!r} are no {count} whole numbers in fields of {FIELD}") from None

    def bad(self, what: str) -> DataError:
        """Refusal of the line read last."""
        where = f"{self.path}, line {self.at}"
        return DataError(Problem("bad_matrix", where, what, "Write it again with OUTPUT4, FORMATTED"))


@dataclass(slots=True)
class _Entries:
    """Rows, columns and values of a matrix."""

    row: list[np.ndarray] = field(default_factory=list)
    column: list[np.ndarray] = field(default_factory=list)
    value: list[np.ndarray] = field(default_factory=list)

    def add(self, column: int, first: int, values: np.ndarray) -> None:
        """Take values in, from a row on."""
        self.row.append(np.arange(first - 1, first - 1 + values.size))
        self.column.append(np.full(values.size, column - 1))
        self.value.append(values)


def read_op4(path: Path) -> dict[str, sparse.csc_array]:
    """Real matrices of a formatted OUTPUT4 file by name; of a symmetric one (form 6) both triangles.

    Raises
    ------
    DataError : a binary file, a complex matrix, a line that is none of the format
    """
    try:
        text = path.read_bytes().decode("ascii")
    except UnicodeDecodeError:
        what = "is no formatted OUTPUT4 file"
        remedy = "Write it as text, with ASSIGN OUTPUT4 ... FORMATTED, or give .mtx or .npz"
        raise DataError(Problem("binary_op4", str(path), what, remedy)) from None
    lines = _Lines(path, text.splitlines())
    matrices: dict[str, sparse.csc_array] = {}
    while lines.at < len(lines.lines) and lines.lines[lines.at].strip():
        name, matrix = _matrix(lines)
        matrices[name] = matrix
    if not matrices:
        lines.at = 1
        raise lines.bad("no matrix begins here")
    return matrices


def _matrix(lines: _Lines) -> tuple[str, sparse.csc_array]:
    columns, rows, form, kind = lines.whole(4)
    head = lines.lines[lines.at - 1]
    name, found = head[4 * FIELD : 5 * FIELD].strip().upper(), _FORMAT.search(head[5 * FIELD :])
    if kind not in WORDS:
        raise lines.bad(f"{name} is complex (type {kind})")
    if found is None:
        raise lines.bad(f"{head[5 * FIELD :].strip()!r} is no format of numbers, as 1P,5E16.9 is")
    per_line, width = int(found[1]), int(found[2])
    two_words, rows = rows < 0, abs(rows)
    entries = _Entries()
    while True:
        column, first, words = lines.whole(3)
        if not 1 <= column <= columns:
            _values(lines, words, per_line, width)
            break
        if first:
            entries.add(column, first, _values(lines, words, per_line, width))
        while not first and words > 0:
            length, row = lines.whole(2) if two_words else divmod(lines.whole(1)[0], SHIFT)
            count, left = divmod(length - 1, WORDS[kind])
            if count < 1 or left:
                raise lines.bad(f"a string of {length - 1} words holds no whole values of {WORDS[kind]}")
            entries.add(column, row, _values(lines, count, per_line, width))
            words -= length + two_words
    return name, _assembled(lines, name, entries, rows, columns, form)


def _values(lines: _Lines, count: int, per_line: int, width: int) -> np.ndarray:
    values: list[float] = []
    while len(values) < count:
        line = lines.next()
        some = min(per_line, count - len(values))
        try:
            fields = [line[k * width : (k + 1) * width].upper().replace("D", "E") for k in range(some)]
            values += [float(one) for one in fields]
        except ValueError:
            raise lines.bad(f"{line[:40]!r} are no {some} numbers in fields of {width}") from None
    return np.array(values)


def _assembled(lines: _Lines, name: str, entries: _Entries, rows: int, columns: int, form: int) -> sparse.csc_array:
    if not entries.value:
        return sparse.csc_array((rows, columns))
    i, j, value = (np.concatenate(part) for part in (entries.row, entries.column, entries.value))
    if i.min() < 0 or i.max() >= rows:
        raise lines.bad(f"{name} has {rows} rows, and a value beyond them")
    matrix = sparse.csc_array((value, (i, j)), shape=(rows, columns))
    one_sided = sparse.triu(matrix, 1).nnz == 0 or sparse.tril(matrix, -1).nnz == 0
    if form == SYMMETRIC and rows == columns and one_sided:
        matrix = sparse.csc_array(matrix + matrix.T - sparse.diags_array(matrix.diagonal()))
    return matrix
