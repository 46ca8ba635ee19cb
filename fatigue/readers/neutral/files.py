"""Open one table of the neutral format, Parquet or CSV; a file that is no such table is refused with the reason."""

from collections.abc import Collection
from pathlib import Path

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.misplaced import misplaced
from fatigue.files.naming import missing_file
from fatigue.readers.neutral.columns import DAMAGE, Columns, damaged
from fatigue.readers.neutral.csv_columns import open_csv
from fatigue.readers.neutral.parquet_columns import open_parquet


def open_columns(path: Path, texts: Collection[str]) -> Columns:
    """Open a ``.parquet`` or ``.csv`` file; ``texts`` are the columns that hold names, never numbers.

    Raises
    ------
    DataError
        missing, unreadable, damaged, not UTF-8, without header or without rows
    """
    suffix = path.suffix.lower()
    opener = {".parquet": open_parquet, ".csv": open_csv}.get(suffix)
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
        raise DataError(Problem("empty_table", path.name, "the table has no rows", "Write at least one row"))
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
