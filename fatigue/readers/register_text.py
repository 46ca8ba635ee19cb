"""The weld register as rows of texts, however a spreadsheet has saved it."""

import csv
from collections.abc import Collection
from io import StringIO
from pathlib import Path

from fatigue.errors import DataError, Problem

_SEPARATORS = ";\t,"


def read_cells(path: Path, numbers: Collection[str]) -> tuple[tuple[str, ...], list[tuple[int, dict[str, str]]]]:
    """Read the names of the columns, and of every row that is not blank its number, from 1, and its trimmed cells.

    ``numbers`` are columns whose decimal comma becomes a point.

    Raises
    ------
    DataError : the file cannot be read, a column comes twice, a row has more cells than there are columns
    """
    try:
        text = _decoded(path.read_bytes())
        header, _, _ = text.lstrip().partition("\n")
        separator = next((mark for mark in _SEPARATORS if mark in header), ",")
        lines = [[cell.strip() for cell in row] for row in csv.reader(StringIO(text), delimiter=separator)]
    except (OSError, UnicodeError, csv.Error) as error:
        what = f"it cannot be read ({error})"
        raise DataError(Problem("unreadable", str(path), what, "Save it as CSV, UTF-8")) from error
    names, *rows = [row for row in lines if any(row)] or [[]]
    if twice := [name for name in names if name and names.count(name) > 1]:
        what = f"column {twice[0]} appears twice"
        raise DataError(Problem("duplicate_column", str(path), what, "Remove one of them"))
    found = []
    for number, row in enumerate(rows, start=1):
        if any(row[len(names) :]):
            what = f"{len(row)} cells in a table of {len(names)} columns"
            remedy = "Write one cell per column, texts with separators in double quotes"
            raise DataError(Problem("ragged_row", f"{path}: row {number}", what, remedy))
        cells = dict.fromkeys(names, "") | dict(zip(names, row, strict=False))
        if separator != ",":
            cells |= {name: cells[name].replace(",", ".") for name in numbers if name in cells}
        found.append((number, cells))
    return tuple(names), found


def _decoded(content: bytes) -> str:
    """Text of a file that a program on any system may have written."""
    if content.startswith((b"PK\x03\x04", b"PAR1", b"\x1f\x8b")):
        raise UnicodeError("it is a workbook or another binary file, no text")
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return content.decode("utf-16")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252")
