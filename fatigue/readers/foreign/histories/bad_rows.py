"""What is wrong with the first line among the rows of numbers that is none, in words."""

import re
from collections.abc import Sequence
from pathlib import Path

from fatigue.errors import Problem
from fatigue.readers.foreign.histories.number_rows import DATE, NumberRows, date_problem
from fatigue.readers.text.no_rows import THOUSANDS
from fatigue.readers.text.numbers import Decimal, is_gap, is_number, split_fields
from fatigue.readers.units.channel_names import time_unit_in


def row_problem(path: Path, body: Sequence[str], rows: NumberRows, names: Sequence[str]) -> Problem:
    """Refusal of the first line that is no row of numbers."""
    for k, line in enumerate(body):
        if not line.strip():
            continue
        number = rows.first + k + 1
        where = f"{path}, line {number}"
        cells = split_fields(line, rows.separator)
        wrong = [c for c, cell in enumerate(cells) if not (is_number(cell, rows.decimal) or is_gap(cell))]
        if wrong and DATE.search(line):
            return date_problem(path, number - 1, line)
        is_text = wrong[:1] == [0] and re.search(r"[^\W\d]{2}", cells[0])
        if len(wrong) == len(cells) or (wrong and (is_text or len(cells) != rows.width)):
            if len(wrong) == len(cells) and (len(cells) == rows.width or time_unit_in(cells[0]) is not None):
                what = f"{_shown(line)} stands among the rows of numbers, where another table seems to begin"
                return Problem("second_table", where, what, "Export all channels side by side, in one table")
            what = f"{_shown(line)} is no row of numbers; the table does not hold numbers only"
            return Problem("bad_table", where, what, "Remove what stands among or below the rows of numbers")
        if wrong:
            worst = next((c for c in wrong if THOUSANDS.match(cells[c])), wrong[0])
            return _cell_problem(where, cells[worst], worst, rows, names)
        if len(cells) != rows.width:
            return _count_problem(where, len(cells), rows)
    where = f"{path}, from line {rows.first + 1}"
    return Problem("bad_table", where, "the table does not hold numbers only", "Export plain columns of numbers")


def _cell_problem(where: str, cell: str, column: int, rows: NumberRows, names: Sequence[str]) -> Problem:
    """Refusal of a cell that is no number."""
    name = names[column] if column < len(names) and names[column] else f"column {column + 1}"
    what = f"{cell!r} in {name} is no number; the table does not hold numbers only"
    remedy = "Export plain columns of numbers below one line of names"
    other: Decimal = "," if rows.decimal == "." else "."
    if THOUSANDS.match(cell):
        what += "; it seems to have thousands separators"
        remedy = "Export without thousands separators"
    elif is_number(cell, other):
        what += f"; other numbers have {'points' if rows.decimal == '.' else 'commas'} as decimal sign"
        remedy = "Export with one decimal sign"
    return Problem("bad_table", where, what, remedy)


def _count_problem(where: str, count: int, rows: NumberRows) -> Problem:
    """Refusal of a row of another number of cells."""
    what = f"{count} numbers in a table of {rows.width} columns; the table does not hold numbers only in full rows"
    remedy = "Export again; the file may be cut"
    if rows.separator == "," and rows.width <= count <= 2 * rows.width:
        what += "; commas seem to stand both between the columns and in the numbers"
        remedy = "Write semicolons between the columns, or points in the numbers"
    return Problem("bad_table", where, what, remedy)


def _shown(line: str) -> str:
    text = line.strip()
    return repr(text if len(text) <= 60 else text[:57] + "...")
