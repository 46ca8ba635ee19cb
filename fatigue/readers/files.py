"""Open one table of the neutral format, Parquet or CSV; a file that is no such table is refused with the reason."""

import csv
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.known_formats import misplaced
from fatigue.naming import missing_file

CSV_BLOCK = 1 << 22  # bytes of a CSV file decoded together, some 50 000 rows
DAMAGE = (pa.ArrowException, OSError, UnicodeDecodeError)  # what Arrow raises over bytes that make no sense


@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """An open file: names and types of its columns, number of rows, and how to read one column by its position.

    ``numbers`` are the rows' own numbers in the file, from 0, where these are only a part of it.
    """

    names: tuple[str, ...]
    kinds: tuple[pa.DataType, ...]
    rows: int
    read: Callable[[int], pa.ChunkedArray]
    numbers: NDArray[np.int64] | None = None


def open_columns(path: Path, texts: Collection[str]) -> Columns:
    """Open a ``.parquet`` or ``.csv`` file; ``texts`` are the columns that hold names, never numbers.

    Raises
    ------
    DataError
        missing, unreadable, damaged, not UTF-8, without header or without rows
    """
    suffix = path.suffix.lower()
    opener = {".parquet": _open_parquet, ".csv": _open_csv}.get(suffix)
    if path.is_dir():
        raise DataError(missing_file(path))
    if opener is None or suffix == ".csv":
        refuse(DataError, filter(None, [_named_otherwise(path, text=opener is None)]))
    if opener is None:
        raise DataError(
            Problem(
                "unknown_format", str(path), f"unknown kind of file {path.suffix!r}", "Give a .parquet or .csv file"
            )
        )
    try:
        columns = opener(path, texts)
    except FileNotFoundError:
        raise DataError(missing_file(path)) from None
    except PermissionError:
        raise DataError(Problem("unreadable_file", str(path), "may not be read", "Check its permissions")) from None
    except DAMAGE as error:
        raise DataError(other_format(path) or damaged(path, error)) from None
    except DataError:
        refuse(DataError, filter(None, [other_format(path)]))
        raise
    if columns.rows == 0:
        refuse(DataError, filter(None, [other_format(path)]))
        raise DataError(Problem("empty_table", path.name, "the table has no rows", "Write the file again"))
    return columns


def _named_otherwise(path: Path, *, text: bool) -> Problem | None:
    """Refusal of a file that surely is of another format than a table; not of one that merely cannot be recognised."""
    problem = misplaced(path, path.name, text=text)
    return None if problem is None or problem.code == "unknown_binary" else problem


def other_format(path: Path) -> Problem | None:
    """Refusal of bytes that are another format than the name says; None where they are not known to be one."""
    if path.suffix.lower() != ".parquet":
        return misplaced(path, path.name)
    with path.open("rb") as file:
        return None if file.read(4) == b"PAR1" else _named_otherwise(path, text=True)


def _open_parquet(path: Path, texts: Collection[str]) -> Columns:
    schema = pq.read_schema(path)
    names = tuple(schema.names)
    file = pq.ParquetFile(path, read_dictionary=[name for name in names if name.strip() in texts])

    rows = file.metadata.num_rows

    def read(position: int) -> pa.ChunkedArray:
        try:
            column = file.read(columns=[names[position]]).column(0)
            column.validate(full=True)
        except DAMAGE as error:
            raise DataError(damaged(path, error)) from None
        if len(column) != rows:
            raise DataError(damaged(path, EOFError(f"{len(column)} of {rows} rows")))
        return column

    return Columns(names, tuple(schema.types), rows, read)


def _open_csv(path: Path, texts: Collection[str]) -> Columns:
    names = csv_names(path)
    # Arrow wants unique names; positions serve, and repeated names are told by whoever knows which columns matter
    positions = [str(i) for i in range(len(names))]
    try:
        table = pa_csv.read_csv(
            path,
            pa_csv.ReadOptions(column_names=positions, skip_rows=1),
            convert_options=pa_csv.ConvertOptions(
                column_types={i: pa.string() for i, name in zip(positions, names, strict=True) if name.strip() in texts}
            ),
        )
    except pa.ArrowInvalid as error:
        raise DataError(_csv_problem(path, len(names), error)) from None
    if pa.binary() in table.schema.types:  # Arrow's last resort where a column is neither numbers nor UTF-8
        raise DataError(_not_utf8(path))
    return Columns(tuple(names), tuple(table.schema.types), table.num_rows, table.column)


def csv_names(path: Path) -> list[str]:
    """Read the first line of a CSV file, the names of its columns.

    Raises
    ------
    DataError
        not UTF-8, an empty line, or one that is divided by something other than commas
    """
    try:
        names = next(_csv_rows(path), [])
    except UnicodeDecodeError:
        raise DataError(_not_utf8(path)) from None
    if not names:
        raise DataError(Problem("empty_table", path.name, "the first line is empty", "Write the column names there"))
    for separator, word in ((";", "semicolons"), ("\t", "tabs")):
        if len(names) == 1 and separator in names[0]:
            raise DataError(
                Problem(
                    "csv_separator",
                    f"{path.name}: line 1",
                    f"the columns are separated by {word}",
                    "Write the file with commas between columns and points in numbers",
                )
            )
    return names


def csv_batches(path: Path, kinds: Mapping[str, pa.DataType]) -> Iterator[pa.RecordBatch]:
    """Read some columns of a CSV file of any size, ``CSV_BLOCK`` bytes at a time, as values of the given kinds.

    Raises
    ------
    pa.ArrowException, UnicodeDecodeError, OSError
        what is wrong is better told by ``open_columns``, which reads the file as a whole
    """
    names = [name.strip() for name in csv_names(path)]
    reader = pa_csv.open_csv(
        path,
        pa_csv.ReadOptions(column_names=names, skip_rows=1, block_size=CSV_BLOCK),
        convert_options=pa_csv.ConvertOptions(include_columns=list(kinds), column_types=dict(kinds)),
    )
    yield from reader


def _csv_rows(path: Path) -> Iterator[list[str]]:
    with path.open(encoding="utf-8-sig", newline="") as stream:
        yield from csv.reader(stream)


def _csv_problem(path: Path, width: int, error: Exception) -> Problem:
    """Find out what Arrow stumbled over: an undecodable byte, a row with too few or many cells, or something else."""
    try:
        rows = (cells for cells in _csv_rows(path) if cells)
        for row, cells in enumerate(rows):
            if len(cells) != width:
                return Problem(
                    "ragged_row",
                    f"{path.name}: row {row}",
                    f"{len(cells)} cells in a table of {width} columns",
                    "Write one cell per column, texts with commas in double quotes",
                )
    except UnicodeDecodeError:
        return _not_utf8(path)
    except csv.Error as broken:
        return damaged(path, broken)
    return damaged(path, error)


def _not_utf8(path: Path) -> Problem:
    """Name the line of the first byte that is not UTF-8."""
    text = path.read_bytes().decode(errors="surrogateescape")
    good = re.split("[\udc80-\udcff]", text, maxsplit=1)[0]
    line, byte = good.count("\n") + 1, ord(text[len(good)]) - 0xDC00
    return Problem("not_utf8", f"{path.name}: line {line}", f"byte {byte:#04x} is not UTF-8", "Save it as UTF-8")


def damaged(path: Path, error: Exception) -> Problem:
    """Say that a file, or a part of it, cannot be decoded, and why."""
    kind = "Parquet" if path.suffix.lower() == ".parquet" else "CSV"
    reason = str(error).strip().splitlines()[0].rstrip(".")
    return Problem(
        "damaged_file", path.name, f"cannot be read as {kind}, it is damaged or cut short ({reason})", "Write it again"
    )
