"""Names of the columns of a table: where each stands, which are missing, unknown, twice there, or without a name."""

import difflib
from collections.abc import Collection, Iterator

from fatigue.errors import DataError, Problem, refuse
from fatigue.files.naming import composed
from fatigue.readers.neutral.columns import Columns


def positions_of(file: str, columns: Columns) -> dict[str, int]:
    """Position of each column by its trimmed name.

    Raises
    ------
    DataError : two columns have one name
    """
    position: dict[str, int] = {}
    problems = [
        Problem("duplicate_column", f"{file}: column {name}", "the column appears twice", "Remove one of them")
        for i, stored in enumerate(columns.names)
        if (name := composed(stored)) and position.setdefault(name, i) != i
    ]
    refuse(DataError, problems)
    return position


def missing_columns(file: str, present: Collection[str], required: Collection[str]) -> Iterator[Problem]:
    """Name the required columns that are not there."""
    for name in required:
        if name not in present:
            remedy = f"Add it; the columns are {', '.join(name for name in present if name)}"
            yield Problem("missing_column", f"{file}: column {name}", "the column is missing", remedy)


def unknown_columns(file: str, present: Collection[str], known: Collection[str]) -> Iterator[Problem]:
    """Name the columns that nothing reads, and what may have been meant."""
    for name in (name for name in present if name not in known):
        near = difflib.get_close_matches(name, set(known) - set(present), n=1)
        remedy = f"Rename it to {near[0]!r}" if near else "Remove it"
        yield Problem("unknown_column", f"{file}: column {name}", "the column is unknown and not read", remedy)


def nameless_columns(file: str, columns: Columns) -> Iterator[Problem]:
    """Name columns without a name that hold something; spreadsheets write empty ones, which are nothing."""
    for position, name in enumerate(columns.names):
        if composed(name) or not columns.rows:
            continue
        filled = [value for value in columns.read(position).to_pylist() if value is not None and str(value).strip()]
        if filled:
            what = f"the column has no name and is not read, it holds {str(filled[0])[:30]!r}"
            yield Problem("unknown_column", f"{file}: column {position + 1}", what, "Give it a name, or remove it")
