"""Columns of a CSV file: read as a whole by Arrow, or block by block, in the layout that its head shows."""

import csv
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.neutral.columns import Columns, damaged
from fatigue.readers.neutral.table_units import units_row_warnings
from fatigue.readers.text.encoding import encoding_of, not_utf8_warning, read_text
from fatigue.readers.text.layout import TableLayout, table_layout
from fatigue.readers.text.lines import text_lines
from fatigue.readers.text.numbers import as_numbers, split_fields

CSV_BLOCK = 1 << 22  # bytes of a CSV file decoded together, some 50 000 rows


def open_csv(path: Path, texts: Collection[str]) -> Columns:
    """Read a CSV file as a whole; where its head did not tell everything, in the light of the rest."""
    layout, table = _csv_table(path, table_layout(path, texts), texts)
    warnings = units_row_warnings(path.name, layout)
    if layout.encoding == "cp1252":
        warnings += (not_utf8_warning(path, path.read_bytes()),)
    numbers, empty = None, _without_values(table)
    if empty.any():
        empty &= _empty_lines(path, layout, empty.size)
        numbers = np.flatnonzero(~empty)
        table = table.filter(pa.array(~empty))
    wordy = [k for k, name in enumerate(layout.names) if pa.string() == table.schema.types[k] and name not in texts]
    if wordy and (again := _repeated_names(table, layout.names)).any():
        numbers = (np.arange(again.size) if numbers is None else numbers)[~again]
        table = table.filter(pa.array(~again))
    for k in wordy:
        read = as_numbers(table.column(k), layout.decimal)
        if read is not None:
            table = table.set_column(k, str(k), read)
    return Columns(layout.names, tuple(table.schema.types), table.num_rows, table.column, numbers, warnings)


def _csv_table(path: Path, layout: TableLayout, texts: Collection[str]) -> tuple[TableLayout, pa.Table]:
    """Read a table in the encoding of its head, or in that of the whole file."""
    try:
        table = _arrow_table(path, layout, texts)
        if pa.binary() in table.schema.types:  # Arrow's last resort over bytes that are not UTF-8
            raise pa.ArrowInvalid("invalid UTF8 data")
    except pa.ArrowInvalid as error:
        encoding = encoding_of(path, path.read_bytes())
        if encoding == layout.encoding:
            raise DataError(_csv_problem(path, layout, error)) from None
        return _csv_table(path, replace(layout, encoding=encoding), texts)
    return layout, table


def _arrow_table(path: Path, layout: TableLayout, texts: Collection[str]) -> pa.Table:
    # Arrow wants unique names; positions serve, and repeated names are told by whoever knows which columns matter
    positions = [str(i) for i in range(len(layout.names))]
    kinds = {i: pa.string() for i, name in zip(positions, layout.names, strict=True) if name.strip() in texts}
    options = pa_csv.ReadOptions(column_names=positions, skip_rows=layout.first, encoding=layout.encoding)
    return pa_csv.read_csv(
        _csv_source(path, layout),
        options,
        parse_options=pa_csv.ParseOptions(delimiter=layout.separator or "\t"),
        convert_options=pa_csv.ConvertOptions(column_types=kinds, decimal_point=layout.decimal or "."),
    )


def _csv_source(path: Path, layout: TableLayout) -> Path | BytesIO:
    """Give Arrow the file itself, or a text it can read: blanks divide its cells or stand before quotation marks, DOS.

    DOS ends a text with a control character.
    """
    if layout.separator is not None and not layout.padded and not _ends_as_dos(path):
        return path
    lines = text_lines(read_text(path)[0])
    if layout.separator is None:
        rows = ["\t".join(split_fields(line, None)) for line in lines]
    else:
        before = re.compile(rf'({re.escape(layout.separator)}|^)[ \t]+(?=")')
        rows = [before.sub(r"\1", line) for line in lines] if layout.padded else lines
    return BytesIO("\n".join(rows).encode(layout.encoding))


def _ends_as_dos(path: Path) -> bool:
    with path.open("rb") as file:
        file.seek(0, 2)
        file.seek(max(0, file.tell() - 1))
        return file.read() == b"\x1a"


def _empty_lines(path: Path, layout: TableLayout, rows: int) -> NDArray[np.bool_]:
    """Rows (r,) of nothing but separators, as spreadsheets leave them below a table; NaN is something."""
    with path.open(encoding=layout.encoding, newline="") as stream:
        for _ in range(layout.first):
            next(stream, "")
        cells = csv.reader(stream, delimiter=layout.separator or "\t")
        empty = [not any(map(str.strip, row)) for row in cells if row]
    return np.array(empty) if len(empty) == rows else np.zeros(rows, dtype=np.bool_)


def _without_values(rows: pa.Table | pa.RecordBatch) -> NDArray[np.bool_]:
    """Rows (r,) in which every one of several cells is empty or NaN."""
    empty = np.full(rows.num_rows, rows.num_columns > 1)
    for column in rows.columns:
        absent = column.is_null()
        if pt.is_string(column.type):
            absent = pc.or_kleene(absent, pc.equal(pc.utf8_trim_whitespace(column), ""))
        elif not column.null_count:
            return np.zeros_like(empty)
        empty &= np.asarray(absent.fill_null(True).to_numpy(zero_copy_only=False), dtype=np.bool_)
        if not empty.any():
            break
    return empty


def _repeated_names(table: pa.Table, names: Sequence[str]) -> NDArray[np.bool_]:
    """Rows (r,) that hold the names of the columns once more."""
    again = np.ones(table.num_rows, dtype=np.bool_)
    for k, name in enumerate(names):
        column = table.column(k)
        if column.type != pa.string():
            return np.zeros(table.num_rows, dtype=np.bool_)
        same = pc.equal(pc.utf8_trim_whitespace(column), name.strip())
        again &= np.asarray(same.fill_null(False).to_numpy(zero_copy_only=False), dtype=np.bool_)
    return again


def csv_batches(path: Path, layout: TableLayout, kinds: Mapping[str, pa.DataType]) -> Iterator[pa.RecordBatch]:
    """Read some columns of a CSV file of any size, ``CSV_BLOCK`` bytes at a time, as values of the given kinds.

    Raises
    ------
    pa.ArrowException, UnicodeDecodeError, OSError
        what is wrong is better told by ``open_columns``, which reads the file as a whole
    """
    names = [name.strip() for name in layout.names]
    read_as = {name: pa.string() if layout.fortran and pt.is_floating(kind) else kind for name, kind in kinds.items()}
    reader = pa_csv.open_csv(
        _csv_source(path, layout),
        pa_csv.ReadOptions(column_names=names, skip_rows=layout.first, block_size=CSV_BLOCK, encoding=layout.encoding),
        parse_options=pa_csv.ParseOptions(delimiter=layout.separator or "\t"),
        convert_options=pa_csv.ConvertOptions(
            include_columns=list(kinds), column_types=read_as, decimal_point=layout.decimal or "."
        ),
    )
    for read in reader:
        if _without_values(read).any():
            raise pa.ArrowInvalid("a row without values")
        if not layout.fortran:
            yield read
            continue
        columns = {}
        for name, kind in kinds.items():
            column = read.column(name)
            if read_as[name] != kind:
                numbers = as_numbers(pa.chunked_array([column]), layout.decimal)
                if numbers is None:
                    raise pa.ArrowInvalid(f"a cell of {name} is no number")
                column = numbers.combine_chunks()
            columns[name] = column
        yield pa.RecordBatch.from_pydict(columns)


def _csv_problem(path: Path, layout: TableLayout, error: Exception) -> Problem:
    """Find out what Arrow stumbled over: a row with too few or many cells, or something else."""
    width, separator = len(layout.names), layout.separator or "\t"
    try:
        with path.open(encoding=layout.encoding, newline="") as stream:
            for _ in range(layout.first):
                next(stream, "")
            rows = (cells for cells in csv.reader(stream, delimiter=separator) if cells)
            for row, cells in enumerate(rows, 1):
                if len(cells) != width:
                    return _ragged(path, row, cells, layout)
    except UnicodeDecodeError:
        return damaged(path, error)
    except csv.Error as broken:
        return damaged(path, broken)
    return damaged(path, error)


def _ragged(path: Path, row: int, cells: Sequence[str], layout: TableLayout) -> Problem:
    """Describe a row with too few or too many cells."""
    width = len(layout.names)
    what = f"{len(cells)} cells in a table of {width} columns"
    remedy = "Write one cell per column, texts with commas in double quotes"
    whole = [re.fullmatch(r"\s*[+-]?\d*\s*", cell) is not None for cell in cells]
    many = width < len(cells) <= 2 * width and (row == 1 or len(cells) > width + 1)
    if layout.separator == "," and many and sum(whole) > len(cells) // 2:
        what += ": commas stand between the columns and, it seems, in the numbers"
        remedy = "Write semicolons between the columns, or points in the numbers"
    return Problem("ragged_row", f"{path.name}: row {row}", what, remedy)
