"""A table of a page beside the report, its columns those of the data dictionary."""

import math
from collections.abc import Sequence
from typing import Any

from fatigue.report.sections.cells import Cell, Heading, PageTable, num, percent, text
from fatigue.results.dictionary.column import Column

MOST_ROWS = 600  # of a table on a page; the files have all
FILTERED_FROM = 25  # rows


def rows_table(name: str, columns: Sequence[Column], rows: Sequence[Any]) -> PageTable:
    """Rows, dataclasses with the columns as fields, as a table of a page; what no row has is left out."""
    shown = rows[:MOST_ROWS]
    there = [column for column in columns if any(_is_there(getattr(row, column.name)) for row in shown)]
    headings = tuple(_heading(column) for column in there)
    cells = tuple(tuple(_cell(column, getattr(row, column.name)) for column in there) for row in shown)
    return PageTable(name.replace("_", "-") + "-table", headings, cells, filter_label(len(shown), "row"))


def filter_label(rows: int, what: str) -> str:
    """Label of the filter above a table of so many rows; a short table has none."""
    return f"Find a {what}" if rows >= FILTERED_FROM else ""


def _is_there(value: Any) -> bool:
    return value is not None and value != "" and not (isinstance(value, float) and math.isnan(value))


def _heading(column: Column) -> Heading:
    """Name of a column in words; a unit that it ends with stands beside it."""
    name = column.name
    for ending in ("_hz", "_mm_per_N", "_km", "_s", "_MPa"):
        name = name.removesuffix(ending)
    return Heading(
        name.replace("_", " "), "" if _is_share(column) else column.unit, numeric=column.type in ("int", "float")
    )


def _cell(column: Column, value: Any) -> Cell:
    if not _is_there(value):
        return num(None) if column.type in ("int", "float") else text(None)
    if column.type == "flag":
        return text("yes" if value else "no")
    if column.type == "int":
        return Cell(str(value), float(value))
    if column.type == "float":
        return percent(value) if _is_share(column) else num(value)
    return text(value)


def _is_share(column: Column) -> bool:
    return column.unit == "-" and "share" in column.name.split("_")
