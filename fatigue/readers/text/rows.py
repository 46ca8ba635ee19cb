"""A small text table as rows of texts, in any layout: registers and other tables that are edited by hand."""

import csv
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from io import StringIO
from pathlib import Path

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.misplaced import misplaced
from fatigue.files.naming import composed
from fatigue.readers.text.encoding import read_text
from fatigue.readers.text.layout import TableLayout, layout_of
from fatigue.readers.text.lines import text_lines
from fatigue.readers.text.numbers import plain_number


@dataclass(frozen=True, slots=True)
class TextRow:
    """One row: its number in the table and its line in the file, from 1, and its trimmed cells by column."""

    number: int
    line: int
    cells: dict[str, str]


def read_rows(path: Path, numbers: Collection[str] = ()) -> tuple[tuple[str, ...], list[TextRow]]:
    """Read a table of texts as a whole: names of its columns, and its rows.

    Parameters
    ----------
    numbers : columns whose numbers are returned with a decimal point and an E before the exponent

    Raises
    ------
    DataError
        unreadable, no names, bytes that no encoding explains, a row with more cells than names, a column named twice
    """
    refuse(DataError, filter(None, [misplaced(path, str(path), text=False)]))
    text, encoding = read_text(path)
    lines = text_lines(text)
    layout = layout_of(path, lines, encoding, lambda name: name in numbers)
    names = tuple(composed(name) for name in layout.names)
    if "weld" not in names:  # which every register has
        refuse(DataError, filter(None, [misplaced(path, str(path))]))
    twice = [name for name in names if name and names.count(name) > 1]
    if twice:
        where = f"{path}: line {layout.line}"
        raise DataError(Problem("duplicate_column", where, f"column {twice[0]} appears twice", "Remove one of them"))
    rows: list[TextRow] = []
    widest = 0
    for line, cells in _cells(path, layout, lines):
        if not any(cells) or cells == list(names):  # blank, or the names again
            continue
        if any(cells[len(names) :]):
            what = f"{len(cells)} cells in a table of {len(names)} columns"
            remedy = "Write one cell per column, texts with separators in double quotes"
            raise DataError(Problem("ragged_row", f"{path}: row {len(rows) + 1}, line {line}", what, remedy))
        widest = max(widest, len(cells))
        found = dict.fromkeys(names, "") | dict(zip(names, cells, strict=False))
        for name in numbers:
            if name in found:
                found[name] = plain_number(found[name], layout.decimal or ",")
        rows.append(TextRow(len(rows) + 1, line, found))
    named = len(names) - next((k for k, name in enumerate(reversed(names)) if name), 0)
    if rows and named - widest >= max(2, widest - 1):  # as where the first row lost its line end
        what = f"{named} names in the line of names, and at most {widest} cells in the rows"
        raise DataError(Problem("ragged_row", f"{path}: line {layout.line}", what, "Write one name for each column"))
    return names, rows


def _cells(path: Path, layout: TableLayout, lines: Sequence[str]) -> list[tuple[int, list[str]]]:
    """Line and cells of every row below the names."""
    if layout.separator is None:
        return [(k + 1, composed(lines[k]).split()) for k in range(layout.first, len(lines))]
    reader = csv.reader(StringIO("\n".join(lines[layout.first :])), delimiter=layout.separator)
    try:
        found = [(layout.first + reader.line_num, [composed(cell) for cell in cells]) for cells in reader]
        _refuse_open_quotation(lines[layout.first :], layout.separator)
        return found
    except csv.Error as error:
        where = f"{path}: line {layout.first + reader.line_num}"
        raise DataError(Problem("unreadable", where, f"it cannot be read ({error})", "Save it as CSV")) from error


def _refuse_open_quotation(lines: Sequence[str], separator: str) -> None:
    """Refuse a cell whose quotation never ends: it has swallowed the rows below; other freedoms of quoting are fine."""
    try:
        for _ in csv.reader(StringIO("\n".join(lines)), delimiter=separator, strict=True):
            pass
    except csv.Error as error:
        if "unexpected end of data" in str(error):
            raise
