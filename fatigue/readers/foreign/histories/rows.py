"""The rows of numbers of a text table: where they begin, what divides them, and their values."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.text.encoding import Encoding, read_text
from fatigue.readers.text.layout import COMMENTS
from fatigue.readers.text.lines import text_lines
from fatigue.readers.text.no_rows import THOUSANDS, no_rows_problem
from fatigue.readers.text.numbers import Decimal, is_gap, is_number, split_fields, written_apart
from fatigue.readers.units.channel_names import time_unit_in

HEAD_LINES = 5000
_SAMPLE = 200
_SEPARATORS = ("\t", ";", ",", "|", None)  # None: blanks
_RULE = re.compile(r"[\s\-=_+|*#;,]+\Z")
_NUMERIC_START = re.compile("[\\s\"']*[-+\u2212.,;|\\d]|\\s*\\Z")
_ERROR = re.compile(r"#(?:N/?A|NV|[A-Z]+[!?]|[A-Z]+/0!)\Z")  # a spreadsheet's, which is no comment
_DATE = re.compile(
    r"(?<!\d)(\d{4}-\d{1,2}-\d{1,2}|\d{1,2}\.\d{1,2}\.\d{2,4}|\d{1,2}/\d{1,2}/\d{2,4}|\d{1,2}:\d{2}(?::\d{2})?)(?!\d)"
)
_NULLS = [
    "",
    "nan",
    "NaN",
    "NAN",
    "-nan",
    "-NaN",
    "NA",
    "N/A",
    "n/a",
    "null",
    "NULL",
    "-nan(ind)",
    "nan(ind)",
    "1.#QNAN",
]


@dataclass(frozen=True, slots=True)
class Rows:
    """Where the rows of numbers of a file begin and how they are written.

    ``width`` counts their columns, ``cells`` those and the empty ones at the end of the first row.
    """

    first: int
    separator: str | None
    decimal: Decimal
    width: int
    cells: int


def find_rows(path: Path, lines: Sequence[str]) -> Rows:
    """Find the first row of numbers: the separator and the decimal sign that explain the most rows.

    Raises
    ------
    DataError : no row of numbers, dates instead of times
    """
    found: list[tuple[int, int, Rows]] = []
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
                    (score, -rank, Rows(start, separator, decimal, width, _cells(head[start], separator, width)))
                )
    if found:
        rows = max(found, key=lambda f: f[:2])[2]
        _refuse_two_commas(path, head, rows)
        return rows
    dated = next(
        (k for k, line in enumerate(head) if _DATE.search(line) and re.search(r"\d[\s;,\t]+[-+.\d]", line)), None
    )
    if dated is not None:
        raise DataError(_date_problem(path, dated, head[dated]))
    raise DataError(no_rows_problem(path, head))


def _refuse_two_commas(path: Path, head: Sequence[str], rows: Rows) -> None:
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
    """Pass over a few rows of numbers that stand above a row of names of as many cells."""
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
    """Count the cells of a row with the empty ones at its end."""
    return width if separator is None else max(width, re.sub(r'"[^"]*"', "", line).count(separator) + 1)


def _width(line: str, separator: str | None, decimal: Decimal) -> int:
    """Count the cells of a row of numbers, some of which may be empty; 0 for any other line."""
    if not _NUMERIC_START.match(line) or (separator is not None and separator not in line):
        return 0
    cells, numbers = split_fields(line, separator), 0
    for cell in cells:
        if is_number(cell, decimal):
            numbers += 1
        elif not is_gap(cell):
            return 0
    return len(cells) if numbers > 1 else 0


def read_values(
    path: Path, encoding: Encoding, rows: Rows, headers: Sequence[Sequence[str]], names: Sequence[str]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Read the rows of numbers, from the file itself or, where it holds more than these, line by line.

    Parameters
    ----------
    headers : cells of the lines above the rows, which may be repeated among them
    names : of the columns, for messages

    Returns
    -------
    values (t, c), NaN where one is missing, and the lines of the rows in the file, from 1

    Raises
    ------
    DataError : a line that is no row of numbers, a row with too few or many cells, bytes that no encoding explains
    """
    table = _parsed(path, rows, rows.first, encoding)
    if table is not None and not np.isnan(table).all(axis=1).any():
        lines = _line_count(path, encoding) - rows.first
        if lines == len(table):
            return table, np.arange(rows.first + 1, rows.first + 1 + lines)
    body = [_value_line(line, headers, rows) for line in text_lines(read_text(path)[0])[rows.first :]]
    table = _parsed(_file_of(body), rows, 0, "utf-8")
    if table is None:
        table = _parsed(_file_of([_plain_exponents(line) for line in body]), rows, 0, "utf-8")
    at = rows.first + 1 + np.flatnonzero([bool(line.strip()) for line in body])
    if table is None or len(table) != at.size:
        raise DataError(_row_problem(path, body, rows, names))
    return table, at.astype(np.int64)


def _file_of(body: Sequence[str]) -> BytesIO:
    return BytesIO("\n".join(body).encode())


def _line_count(path: Path, encoding: Encoding) -> int:
    """Count the lines of a file with letters of one byte; -1 where they are not simply told."""
    if encoding not in ("utf-8", "cp1252"):
        return -1
    count, last = 0, b"\n"
    with path.open("rb") as file:
        while block := file.read(1 << 22):
            count, last = count + block.count(b"\n"), block[-1:]
    return count + (last != b"\n")


def _parsed(source: Path | BytesIO, rows: Rows, skip: int, encoding: Encoding) -> NDArray[np.float64] | None:
    """Values of lines that all are rows of numbers, else None."""
    columns = [str(k) for k in range(rows.cells)]
    try:
        table = pa_csv.read_csv(
            source if rows.separator else _folded(source, encoding),
            pa_csv.ReadOptions(column_names=columns, skip_rows=skip, encoding=encoding),
            parse_options=pa_csv.ParseOptions(delimiter=rows.separator or "\t"),
            convert_options=pa_csv.ConvertOptions(
                column_types=dict.fromkeys(columns, pa.float64()), decimal_point=rows.decimal, null_values=_NULLS
            ),
        )
    except (pa.ArrowInvalid, UnicodeDecodeError):  # among them bytes of another encoding
        return None
    values = np.empty((table.num_rows, rows.width))
    for k in range(rows.cells):
        column = table.column(k)
        if k < rows.width:
            values[:, k] = column.to_numpy()
        elif column.null_count < len(column):
            return None
    return values


def _folded(source: Path | BytesIO, encoding: Encoding) -> BytesIO:
    """Lines with a tab for every run of blanks."""
    folded = BytesIO()
    if encoding not in ("utf-8", "cp1252"):
        return folded
    with source.open("rb") if isinstance(source, Path) else source as file:
        rest = b""
        while block := file.read(1 << 22):
            *lines, rest = (rest + block).split(b"\n")
            folded.write(b"".join(b"\t".join(line.split()) + b"\n" for line in lines))
        folded.write(b"\t".join(rest.split()))
    folded.seek(0)
    return folded


def _value_line(line: str, headers: Sequence[Sequence[str]], rows: Rows) -> str:
    """Leave out comments and repeated lines of the header; give every row as many separators as the first has."""
    if is_rule(line):
        return ""
    if not _NUMERIC_START.match(line):
        cells = split_fields(line, rows.separator)
        is_comment = line.lstrip().startswith(COMMENTS) and not (len(cells) == rows.width and _ERROR.match(cells[0]))
        if is_comment or tuple(cells) in headers:
            return ""
        return line
    if rows.separator is None or '"' in line:
        return line
    cells = ["" if is_gap(cell) else cell for cell in split_fields(line, rows.separator)]
    return rows.separator.join(cells + [""] * (rows.cells - len(cells))) if len(cells) == rows.width else line


def _plain_exponents(line: str) -> str:
    """Write exponents of Fortran after an E."""
    line = re.sub(r"(?<=[\d.,])[DQdq](?=[+-]?\d)", "E", written_apart(line).replace("\u2212", "-"))
    return re.sub(r"(?<![\w])([+-]?(?:\d+[.,]\d*|[.,]\d+))([+-]\d{1,3})(?![\w.])", r"\1E\2", line)


def _row_problem(path: Path, body: Sequence[str], rows: Rows, names: Sequence[str]) -> Problem:
    """Describe the first line that is no row of numbers."""
    for k, line in enumerate(body):
        if not line.strip():
            continue
        number = rows.first + k + 1
        where = f"{path}, line {number}"
        cells = split_fields(line, rows.separator)
        wrong = [c for c, cell in enumerate(cells) if not (is_number(cell, rows.decimal) or is_gap(cell))]
        if wrong and _DATE.search(line):
            return _date_problem(path, number - 1, line)
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


def _cell_problem(where: str, cell: str, column: int, rows: Rows, names: Sequence[str]) -> Problem:
    """Describe a cell that is no number."""
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


def _count_problem(where: str, count: int, rows: Rows) -> Problem:
    """Describe a row of another number of cells."""
    what = f"{count} numbers in a table of {rows.width} columns; the table does not hold numbers only in full rows"
    remedy = "Export again; the file may be cut"
    if rows.separator == "," and rows.width <= count <= 2 * rows.width:
        what += "; commas seem to stand both between the columns and in the numbers"
        remedy = "Write semicolons between the columns, or points in the numbers"
    return Problem("bad_table", where, what, remedy)


def _date_problem(path: Path, row: int, line: str) -> Problem:
    found = _DATE.search(line)
    text = found[0] if found else line
    return Problem(
        "date_column",
        f"{path}, line {row + 1}",
        f"{text!r} is a date or a time of day, where seconds from the start of the run are needed",
        "Export the time in seconds, and leave dates out",
    )


def _shown(line: str) -> str:
    text = line.strip()
    return repr(text if len(text) <= 60 else text[:57] + "...")


def is_rule(line: str) -> bool:
    """Whether a line is drawn to divide a table, or blank."""
    return _RULE.match(line) is not None or not line.strip()
