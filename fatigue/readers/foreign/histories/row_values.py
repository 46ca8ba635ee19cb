"""The values of the rows of numbers of a text table, each with its line in the file."""

import re
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
from numpy.typing import NDArray

from fatigue.errors import DataError
from fatigue.readers.foreign.histories.bad_rows import row_problem
from fatigue.readers.foreign.histories.number_rows import NUMERIC_START, NumberRows, is_rule
from fatigue.readers.text.encoding import Encoding, read_text
from fatigue.readers.text.layout import COMMENTS
from fatigue.readers.text.lines import text_lines
from fatigue.readers.text.numbers import is_gap, split_fields, written_apart

_ERROR = re.compile(r"#(?:N/?A|NV|[A-Z]+[!?]|[A-Z]+/0!)\Z")  # a spreadsheet's, which is no comment
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


def read_values(
    path: Path, encoding: Encoding, rows: NumberRows, headers: Sequence[Sequence[str]], names: Sequence[str]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Values of the rows of numbers, from the file itself or, where it holds more than these, line by line.

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
        raise DataError(row_problem(path, body, rows, names))
    return table, at.astype(np.int64)


def _file_of(body: Sequence[str]) -> BytesIO:
    return BytesIO("\n".join(body).encode())


def _line_count(path: Path, encoding: Encoding) -> int:
    """Number of lines of a file with letters of one byte; -1 where they are not simply told."""
    if encoding not in ("utf-8", "cp1252"):
        return -1
    count, last = 0, b"\n"
    with path.open("rb") as file:
        while block := file.read(1 << 22):
            count, last = count + block.count(b"\n"), block[-1:]
    return count + (last != b"\n")


def _parsed(source: Path | BytesIO, rows: NumberRows, skip: int, encoding: Encoding) -> NDArray[np.float64] | None:
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


def _value_line(line: str, headers: Sequence[Sequence[str]], rows: NumberRows) -> str:
    """Line with as many separators as the first row has; empty for comments and repeated lines of the header."""
    if is_rule(line):
        return ""
    if not NUMERIC_START.match(line):
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
    """Line with exponents of Fortran after an E."""
    line = re.sub(r"(?<=[\d.,])[DQdq](?=[+-]?\d)", "E", written_apart(line).replace("\u2212", "-"))
    return re.sub(r"(?<![\w])([+-]?(?:\d+[.,]\d*|[.,]\d+))([+-]\d{1,3})(?![\w.])", r"\1E\2", line)
