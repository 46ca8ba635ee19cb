"""Where the rows of numbers of a text table begin, and what divides their numbers."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.readers.text.layout import COMMENTS
from fatigue.readers.text.no_rows import no_rows_problem
from fatigue.readers.text.numbers import Decimal, is_gap, is_number, split_fields

HEAD_LINES = 5000
_SAMPLE = 200
_SEPARATORS = ("\t", ";", ",", "|", None)  # None: blanks
_RULE = re.compile(r"[\s\-=_+|*#;,]+\Z")
NUMERIC_START = re.compile("[\\s\"']*[-+\u2212.,;|\\d]|\\s*\\Z")
DATE = re.compile(
    r"(?<!\d)(\d{4}-\d{1,2}-\d{1,2}|\d{1,2}\.\d{1,2}\.\d{2,4}|\d{1,2}/\d{1,2}/\d{2,4}|\d{1,2}:\d{2}(?::\d{2})?)(?!\d)"
)


@dataclass(frozen=True, slots=True)
class NumberRows:
    """Where the rows of numbers of a file begin and how they are written.

    ``width`` counts their columns, ``cells`` those and the empty ones at the end of the first row.
    """

    first: int
    separator: str | None
    decimal: Decimal
    width: int
    cells: int


def find_rows(path: Path, lines: Sequence[str]) -> NumberRows:
    """Place of the rows of numbers, and the separator and the decimal sign that explain the most of them.

    Raises
    ------
    DataError : no row of numbers, dates instead of times
    """
    found: list[tuple[int, int, NumberRows]] = []
    head = lines[:HEAD_LINES]
    for rank, separator in enumerate(_SEPARATORS):
        if separator is not None and not any(separator in line for line in head):
            continue
        for decimal in (".", ","):
            quoted = separator == "," and any('"' in line for line in head)
            if (decimal != separator or quoted) and (start := _first(head, separator, decimal)) is not None:
                width = _width(head[start], separator, decimal)
                sample = head[start : start + _SAMPLE]
                score = sum(_width(line, separator, decimal) == width for line in sample)
                found.append(
                    (score, -rank, NumberRows(start, separator, decimal, width, _cells(head[start], separator, width)))
                )
    if found:
        rows = max(found, key=lambda f: f[:2])[2]
        _refuse_two_commas(path, head, rows)
        return rows
    dated = next(
        (k for k, line in enumerate(head) if DATE.search(line) and re.search(r"\d[\s;,\t]+[-+.\d]", line)), None
    )
    if dated is not None:
        raise DataError(date_problem(path, dated, head[dated]))
    raise DataError(no_rows_problem(path, head))


def _refuse_two_commas(path: Path, head: Sequence[str], rows: NumberRows) -> None:
    """Refuse a table without a point whose whole numbers begin with a zero: they are what follows a decimal comma."""
    if rows.separator != "," or rows.decimal == ",":
        return
    sample = [split_fields(line, ",") for line in head[rows.first : rows.first + _SAMPLE]]
    if any("." in cell for cells in sample for cell in cells):
        return
    for k, cells in enumerate(sample):
        if any(re.fullmatch(r"0\d+", cell) for cell in cells):
            what = "commas seem to stand both between the columns and in the numbers"
            remedy = "Write semicolons between the columns, or points in the numbers"
            raise DataError(Problem("two_commas", f"{path}, line {rows.first + k + 1}", what, remedy))


def _first(head: Sequence[str], separator: str | None, decimal: Decimal) -> int | None:
    """First line of numbers that another of as many follows; rows of numbers above names are no such."""
    single = None
    for k, line in enumerate(head):
        width = _width(line, separator, decimal)
        if width < 2:
            continue
        following = next((n for n in head[k + 1 :] if n.strip()), None)
        if following is not None and _width(following, separator, decimal) == width:
            return _below_names(head, k, separator, decimal)
        single = k if single is None else single
    return single


def _below_names(head: Sequence[str], start: int, separator: str | None, decimal: Decimal) -> int:
    """First row below names of as many cells, which a few rows of numbers may stand above."""
    width = _width(head[start], separator, decimal)
    for k in range(start + 1, min(start + 6, len(head) - 1)):
        if _width(head[k], separator, decimal) == width or not head[k].strip():
            continue
        names = split_fields(head[k], separator)
        above = [split_fields(line, separator) for line in head[:start]]
        is_names = len(names) == width and names not in above and not head[k].lstrip().startswith(COMMENTS)
        return k + 1 if is_names and _width(head[k + 1], separator, decimal) == width else start
    return start


def _cells(line: str, separator: str | None, width: int) -> int:
    """Number of cells of a row with the empty ones at its end."""
    return width if separator is None else max(width, re.sub(r'"[^"]*"', "", line).count(separator) + 1)


def _width(line: str, separator: str | None, decimal: Decimal) -> int:
    """Number of cells of a row of numbers, some of which may be empty; 0 for any other line."""
    if not NUMERIC_START.match(line) or (separator is not None and separator not in line):
        return 0
    cells, numbers = split_fields(line, separator), 0
    for cell in cells:
        if is_number(cell, decimal):
            numbers += 1
        elif not is_gap(cell):
            return 0
    return len(cells) if numbers > 1 else 0


def date_problem(path: Path, row: int, line: str) -> Problem:
    """Refusal of a line, counted from 0, that holds a date or a time of day."""
    found = DATE.search(line)
    text = found[0] if found else line
    return Problem(
        "date_column",
        f"{path}, line {row + 1}",
        f"{text!r} is a date or a time of day, where seconds from the start of the run are needed",
        "Export the time in seconds, and leave dates out",
    )


def is_rule(line: str) -> bool:
    """Whether a line is drawn to divide a table, or blank."""
    return _RULE.match(line) is not None or not line.strip()
